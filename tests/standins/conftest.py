"""Fixtures of the stand-in tests: fresh modules, and programs to import."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from pathlib import Path

import pytest

from linkwright.standins import activate

activate()

HEAD = '<robot name="r" xmlns:xacro="http://www.ros.org/wiki/xacro">'


@pytest.fixture(autouse=True)
def _fresh_module(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Iterator[None]:
    """Let each test use a newly imported module, in a separate folder."""
    import xacro

    monkeypatch.chdir(tmp_path)
    saved = xacro.root_dir, xacro.verbosity
    xacro.filestack = xacro.macrostack = None
    yield
    xacro.root_dir, xacro.verbosity = saved
    xacro.filestack = xacro.macrostack = None


@pytest.fixture
def write(tmp_path: Path) -> Callable[[str, str], Path]:
    """Return a function that writes a robot's file; it adds the tags of the root."""

    def file(name: str, inside: str) -> Path:
        path = tmp_path / name
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text(inside if name.endswith(".yaml") else f"{HEAD}{inside}</robot>", encoding="utf-8")
        return path

    return file
