"""An index of tiny packages, from which packs are created without a network."""

from __future__ import annotations

import os
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import pytest

from linkwright.cli import main
from linkwright.learning.packing import pack_builder
from tests.learning.packing.fake_index import package_entry, write_source, write_wheel

PROGRAM = """
import sys

def main():
    if sys.argv[1] == "--version":
        print("linkwright 1.0")
"""


SCRIPTS = "[console_scripts]\nlinkwright = linkwright.program:main\n"


@dataclass
class FakeIndex:
    """A folder of packages, with the settings for Linkwright."""

    folder: Path
    own: list[Path]
    table: Mapping[str, Any]

    def pack(self, folder: Path, *words: str) -> int:
        """Make a pack with models and worlds left out."""
        wheels = [word for path in self.own for word in ("--wheel", str(path))]
        return main(["learn", "pack", str(folder), "--models", "none", "--no-worlds", *wheels, *words])


@pytest.fixture
def index(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> FakeIndex:
    return create_index(tmp_path, monkeypatch)


def create_index(parent: Path, monkeypatch: pytest.MonkeyPatch) -> FakeIndex:
    """Create an index below a folder, and make pip and packs use it."""
    folder = parent / "index"
    wheel = {
        name: write_wheel(folder, *name.split(" "))
        for name in (
            "pip 9.0",
            "pure 1.0",
            "native 1.0 cp312-cp312-win_amd64",
            "native 1.0 cp313-cp313-win_amd64",
            "native 1.0 cp313-cp313-macosx_11_0_arm64",
            "native 1.0 cp313-cp313-macosx_14_0_arm64",
            "native 1.0 cp310-abi3-manylinux_2_17_x86_64.manylinux2014_x86_64",
            "native 1.0 cp310-abi3-manylinux_2_39_aarch64",
        )
    }
    wheel["windows_only 1.0"] = write_wheel(folder, "windows-only", requires=["pure"])
    source = write_source(folder, "source")
    own = parent / "own"
    needs = ["native>=1", "source", 'windows-only; sys_platform == "win32"']
    table = {
        "linkwright": {
            "needs": [{"key": "linkwright-core"}],
            "extras": {
                "learn": [
                    {"key": "native 1.0"},
                    {"key": "source 1.0"},
                    {"key": "windows-only 1.0", "marker": "sys_platform == 'win32'"},
                ]
            },
            "files": [],
        },
        "linkwright-core": {"needs": [{"key": "pure 1.0"}], "files": []},
        "native 1.0": package_entry(*(path for name, path in wheel.items() if name.startswith("native"))),
        "pip 9.0": package_entry(wheel["pip 9.0"]),
        "pure 1.0": package_entry(wheel["pure 1.0"]),
        "source 1.0": package_entry(source),
        "windows-only 1.0": package_entry(wheel["windows_only 1.0"], needs=[{"key": "pure 1.0"}]),
    }
    monkeypatch.setattr(pack_builder, "load_locked_packages", lambda: table)
    monkeypatch.setenv("PIP_NO_INDEX", "1")
    monkeypatch.setenv("PIP_FIND_LINKS", str(folder))
    monkeypatch.setenv("PIP_CONFIG_FILE", os.devnull)
    wheels = [
        write_wheel(own, "linkwright-core", requires=["pure"]),
        write_wheel(
            own,
            "linkwright",
            requires=["linkwright-core==1.0", *(_for_extra(text) for text in needs)],
            extras=["learn"],
            files={
                "linkwright/__init__.py": "",
                "linkwright/program.py": PROGRAM,
                "linkwright-1.0.dist-info/entry_points.txt": SCRIPTS,
            },
        ),
    ]
    return FakeIndex(folder, wheels, table)


def _for_extra(requirement: str) -> str:
    name, _, marker = requirement.partition("; ")
    return f'{name}; {marker + " and " if marker else ""}extra == "learn"'
