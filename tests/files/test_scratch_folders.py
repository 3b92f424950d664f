"""Temporary folders are removed with their process, or when the next one is created."""

from __future__ import annotations

import os
import re
import subprocess
import sys
import tempfile
from pathlib import Path

import pytest

from linkwright.files.scratch_folders import ScratchFolder, remove_abandoned
from tests.places import REPOSITORY

KILLED_PROGRAM = """
import os, pathlib, signal
from linkwright.files.scratch_folders import ScratchFolder
folder = ScratchFolder("test")
pathlib.Path(folder.name, "file").write_text("text")
print(folder.name, flush=True)
input()
os.kill(os.getpid(), signal.SIGKILL)
"""
needs_locks = pytest.mark.skipif(sys.platform == "win32", reason="Windows has no locks on folders")


@pytest.fixture
def temp_folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """The system's folder for temporary files."""
    monkeypatch.setenv("TMPDIR", str(tmp_path))
    monkeypatch.setattr(tempfile, "tempdir", None)
    return tmp_path


def names(temp_folder: Path) -> list[str]:
    return sorted(path.name for path in temp_folder.iterdir())


def test_scratch_folder_is_removed_when_closed(temp_folder: Path) -> None:
    with ScratchFolder("test") as name:
        assert Path(name).name.startswith("linkwright_test_")
        Path(name, "file").touch()
    assert names(temp_folder) == []


@needs_locks
def test_folder_of_killed_process_is_removed_by_next_one(temp_folder: Path) -> None:
    with subprocess.Popen(
        [sys.executable, "-c", KILLED_PROGRAM], stdin=subprocess.PIPE, stdout=subprocess.PIPE, text=True
    ) as process:
        assert process.stdin is not None
        assert process.stdout is not None
        name = Path(process.stdout.readline().strip())
        with ScratchFolder("test"):
            assert (name / "file").is_file()  # the folder is in use
        process.communicate("\n")
    assert (name / "file").is_file()
    with ScratchFolder("other"):
        assert not name.exists()
    assert names(temp_folder) == []


@needs_locks
def test_folders_in_use_or_of_others_are_kept(temp_folder: Path) -> None:
    (temp_folder / "linkwright_test_new").mkdir()  # its process has not locked it yet
    (temp_folder / "linkwright_of_nobody").write_text("a file")
    (temp_folder / "linkwright_link").symlink_to(temp_folder / "another")
    for name in ("another", "linkwright_test_old"):
        (temp_folder / name).mkdir()
    (temp_folder / "another" / "file").touch()
    os.utime(temp_folder / "linkwright_test_old", (1, 1))
    remove_abandoned(temp_folder)
    assert names(temp_folder) == ["another", "linkwright_link", "linkwright_of_nobody", "linkwright_test_new"]


def test_temporary_folders_are_scratch_folders() -> None:
    creation = re.compile(r"\bTemporaryDirectory\(|\bmkdtemp\(")
    kept_on_exit = {"link_folder.py"}
    inside_scratch_folder = {"contents.py", "jobs.py", "run.py"}  # the scratch folder of a sandbox's run
    allowed = {"scratch_folders.py"} | kept_on_exit | inside_scratch_folder
    found = {
        path.name for path in (REPOSITORY / "src").rglob("*.py") if creation.search(path.read_text(encoding="utf-8"))
    }
    assert found <= allowed
