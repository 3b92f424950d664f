"""The node of the page about users' nodes, and its tests."""

from __future__ import annotations

import os
import shlex
import subprocess
import sys
from pathlib import Path

import pytest

from linkwright.cli import main
from linkwright.standins import process
from tests.docs.pages import DOCS, read_blocks, read_commands

PAGE = DOCS / "nodes.md"


@pytest.fixture(scope="module")
def sources(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Return the folder ``src`` after all steps of the page."""
    folder = tmp_path_factory.mktemp("ros2_ws") / "src"
    folder.mkdir()
    for line in read_commands(PAGE):
        arguments = shlex.split(line)[1:]
        if arguments[:2] == ["pkg", "create"]:
            assert main([*arguments, "--destination-directory", str(folder)]) == 0
    for block in read_blocks(PAGE):
        if block.title:
            path = folder / block.title
            path.parent.mkdir(exist_ok=True)
            path.write_text(block.text, encoding="utf-8")
    return folder


def test_tests_of_page_pass(sources: Path) -> None:
    environment = process.create_environment({**os.environ, "LINKWRIGHT_DDS": "0"})
    result = subprocess.run(
        [sys.executable, "-m", "pytest", "-q", "-p", "no:cacheprovider", "-p", "no:asyncio", "test/test_robot.py"],
        cwd=sources / "my_nodes",
        env=environment,
        capture_output=True,
        encoding="utf-8",
        timeout=60,
        check=False,
    )
    assert result.returncode == 0, result.stdout + result.stderr
    assert "3 passed" in result.stdout


def test_interfaces_work_without_build(sources: Path, monkeypatch: pytest.MonkeyPatch, capsys) -> None:
    monkeypatch.chdir(sources)
    assert main(["interface", "package", "my_interfaces"]) == 0
    interfaces = "my_interfaces/action/Drive\nmy_interfaces/msg/Battery\nmy_interfaces/srv/SetSpeed\n"
    assert capsys.readouterr().out == interfaces
    assert main(["pkg", "executables", "my_nodes"]) == 0
    assert capsys.readouterr().out == "my_nodes robot\n"


@pytest.mark.parametrize("page", [DOCS / "graph.md", DOCS / "zh" / "graph.md"], ids=["en", "zh"])
def test_graph_page_shows_same_interface(sources: Path, page: Path, monkeypatch, capsys) -> None:
    monkeypatch.chdir(sources)
    assert main(["interface", "show", "my_interfaces/msg/Battery"]) == 0
    assert capsys.readouterr().out in page.read_text(encoding="utf-8")
