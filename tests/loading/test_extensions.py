"""The order of the extensions of packages."""

from __future__ import annotations

import sys
from pathlib import Path

import pytest

from linkwright.loading import extensions


@pytest.fixture
def install_packages(tmp_path: Path, monkeypatch: pytest.MonkeyPatch):
    """Install packages with entry points of one group, in the given order."""

    def install(**packages: list[str]) -> None:
        for name, lines in packages.items():
            facts = tmp_path / f"{name}-1.0.dist-info"
            facts.mkdir()
            (facts / "entry_points.txt").write_text("\n".join(["[linkwright.things]", *lines, ""]))
        extensions._read_all_groups.cache_clear()

    monkeypatch.setattr(sys, "path", [str(tmp_path)])
    yield install
    monkeypatch.undo()
    extensions._read_all_groups.cache_clear()


def names() -> list[str]:
    return list(extensions.extensions("linkwright.things"))


def test_linkwright_extensions_come_first_then_sorted_by_name(install_packages) -> None:
    install_packages(
        brought=["b = brought:b", "a = brought:a"],
        linkwright=["z = linkwright.z:z", "y = linkwright.y:y"],
        other=["ab = other:ab"],
    )
    assert names() == ["y", "z", "a", "ab", "b"]


def test_duplicate_extension_names_keep_first(install_packages) -> None:
    install_packages(
        brought=["y = brought:y", "a = brought:a"],
        linkwright=["y = linkwright.y:y"],
        other=["a = other:a"],
    )
    entries = extensions.extensions("linkwright.things")
    assert [entry.value for entry in entries.values()] == ["linkwright.y:y", "brought:a"]
