"""Folders of students, and the processes that a run has left."""

from __future__ import annotations

import contextlib
import shutil
import tempfile
from collections.abc import Iterator
from pathlib import Path

import pytest


@pytest.fixture
def class_folder() -> Iterator[Path]:
    """Return a folder that every user may traverse, unlike pytest's folders."""
    folder = Path(tempfile.mkdtemp(prefix="linkwright-class-"))
    folder.chmod(0o755)
    yield folder
    shutil.rmtree(folder, ignore_errors=True)


@pytest.fixture
def student(class_folder: Path) -> Path:
    """Return a student's folder."""
    folder = class_folder / "student"
    folder.mkdir()
    return folder


def processes_with(word: str) -> list[int]:
    """Return the process IDs that have a word among their arguments."""
    process_numbers = []
    for process in Path("/proc").iterdir():
        if process.name.isdecimal():
            with contextlib.suppress(OSError):
                if word.encode() in (process / "cmdline").read_bytes():
                    process_numbers.append(int(process.name))
    return process_numbers
