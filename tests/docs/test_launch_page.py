"""The examples of the page about launch files."""

from __future__ import annotations

import shlex
from pathlib import Path

import pytest

from linkwright.cli import main
from tests.docs.pages import DOCS, Block, read_blocks, read_commands
from tests.repository_tools import load_tool

TOOL = load_tool("documented_output")
PAGES = {"en": DOCS / "launch.md", "zh": DOCS / "zh" / "launch.md"}


def read_files(page: Path) -> list[Block]:
    return [block for block in read_blocks(page) if block.title]


def write_files(page: Path, folder: Path) -> None:
    for block in read_files(page):
        path = folder / block.title
        path.parent.mkdir(exist_ok=True)
        path.write_text(block.text, encoding="utf-8")


@pytest.mark.parametrize("language", PAGES)
def test_python_xml_and_yaml_launch_files_are_equivalent(language: str, tmp_path: Path, capsys) -> None:
    write_files(PAGES[language], tmp_path)
    messages = []
    for suffix in ("py", "xml", "yaml"):
        arguments = ["launch", str(tmp_path / "launch" / f"robot.launch.{suffix}")]
        assert main([*arguments, "--show-args"]) == 0
        assert main([*arguments, "--print"]) == 0
        messages.append(capsys.readouterr().out)
    assert messages[0] == messages[1] == messages[2]
    assert "'period'" in messages[0]
    assert "ExecInPkg(pkg='my_nodes', exec='robot')" in messages[0]


def test_composed_launch_file_loads(tmp_path: Path, capsys) -> None:
    write_files(PAGES["en"], tmp_path)
    assert main(["launch", str(tmp_path / "composed.launch.py"), "--print"]) == 0
    assert "ComposableNodeContainer" in capsys.readouterr().out


@pytest.mark.parametrize("language", PAGES)
def test_shown_error_matches_output(language: str) -> None:
    page = PAGES[language]
    arguments = next(shlex.split(line) for line in read_commands(page) if "bringup" in line)
    output = TOOL.run_command(arguments[1:], [(file.title, file.text) for file in read_files(page)], language)
    assert output in [block.text for block in read_blocks(page) if block.language == "text"]
