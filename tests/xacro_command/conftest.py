"""Fixtures of the tests of the `xacro` command."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path

import pytest

from linkwright.cli import main

Write = Callable[[str, str], Path]
HEAD = '<robot name="r" xmlns:xacro="http://www.ros.org/wiki/xacro">'


@dataclass
class CommandResult:
    """The output and the exit status of a command."""

    status: int
    out: str
    err: str


@pytest.fixture
def write(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Write:
    """Return a function that writes a robot's file into the current folder.

    It adds the tags of the root.
    """
    monkeypatch.chdir(tmp_path)

    def file(name: str, inside: str) -> Path:
        path = tmp_path / name
        path.parent.mkdir(parents=True, exist_ok=True)
        text = inside if inside.startswith(("<?xml", "<robot")) else f"{HEAD}\n{inside}\n</robot>\n"
        path.write_text(text, encoding="utf-8")
        return Path(name)

    return file


@pytest.fixture
def run(capsys: pytest.CaptureFixture[str]) -> Callable[..., CommandResult]:
    """Return a function that runs ``linkwright xacro``."""

    def command(*words: str) -> CommandResult:
        capsys.readouterr()
        status = main(["xacro", *words])
        captured = capsys.readouterr()
        return CommandResult(status, captured.out, captured.err)

    return command
