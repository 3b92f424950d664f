"""The documentation matches the program, in both languages."""

from __future__ import annotations

import argparse
import re
import shlex
from collections.abc import Iterator
from pathlib import Path

import pytest

from linkwright.cli.command import collect_help_texts, create_parser
from tests.docs.pages import DOCS, READMES, Block, find_pages, read_blocks, read_commands
from tests.places import REPOSITORY
from tests.repository_tools import load_tool

ENGLISH = sorted(path.name for path in DOCS.glob("*.md"))


def page_name(page: Path) -> str:
    return str(page.relative_to(REPOSITORY))


def find_leaf_parsers(parser: argparse.ArgumentParser) -> Iterator[argparse.ArgumentParser]:
    """Return the parser, or the parsers of its subcommands."""
    subparser_actions = [action for action in parser._actions if isinstance(action, argparse._SubParsersAction)]
    if not subparser_actions:
        yield parser
    for action in subparser_actions:
        for subparser in action.choices.values():
            yield from find_leaf_parsers(subparser)


def test_command_reference_is_current() -> None:
    tool = load_tool("command_reference")
    assert (DOCS / "commands.md").read_text(encoding="utf-8") == tool.generate(), "run tools/command_reference.py"
    assert tool.TABLE_PATH.read_text(encoding="utf-8") == tool.make_completion_table(), "run tools/command_reference.py"


def test_stale_command_reference_is_found_and_fixed(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    tool = load_tool("command_reference")
    monkeypatch.setattr(tool, "TARGET", tmp_path / "commands.md")
    assert tool.main(["--check"]) == 1
    assert tool.main([]) == 0
    assert tool.main(["--check"]) == 0


@pytest.mark.parametrize("page", [DOCS / "commands.md", DOCS / "zh" / "commands.md"], ids=page_name)
@pytest.mark.parametrize("verb", collect_help_texts())
def test_all_options_are_documented(page: Path, verb: str) -> None:
    sections = dict(re.findall(r"^## (.+?)\n(.*?)(?=^## |\Z)", page.read_text("utf-8"), re.MULTILINE | re.DOTALL))
    for parser in find_leaf_parsers(create_parser(verb)):
        section = sections[parser.prog]
        for action in parser._actions:
            if action.dest != "help":
                for name in _documented_names(action):
                    assert name in section, f"{parser.prog} {name}"


@pytest.mark.parametrize("page", find_pages(), ids=page_name)
def test_documented_commands_are_accepted(page: Path) -> None:
    for line in read_commands(page):
        arguments = shlex.split(line)
        assert arguments[1] in collect_help_texts(), line
        create_parser(arguments[1]).parse_args(arguments[2:])


@pytest.mark.parametrize("page", find_pages(), ids=page_name)
def test_links_have_existing_targets(page: Path) -> None:
    for target in re.findall(r"\]\(([^)#\s]+)", page.read_text(encoding="utf-8")):
        if not target.startswith("https://"):
            assert (page.parent / target).exists(), target


@pytest.mark.parametrize("name", ENGLISH)
def test_pages_have_chinese_translation_with_same_blocks(name: str) -> None:
    english, chinese = read_blocks(DOCS / name), read_blocks(DOCS / "zh" / name)
    if name != "commands.md":
        assert list(map(_common_text, chinese)) == list(map(_common_text, english))


def test_readmes_show_same_commands() -> None:
    assert read_commands(READMES[0]) == read_commands(READMES[1])


@pytest.mark.parametrize("page", find_pages(), ids=page_name)
def test_ros_programs_are_not_run_with_plain_python(page: Path) -> None:
    page_blocks = read_blocks(page)
    nodes = {
        block.title for block in page_blocks if "import rclpy" in block.text or "nav2_simple_commander" in block.text
    }
    lines = {line.strip() for block in page_blocks if block.language == "bash" for line in block.text.splitlines()}
    assert not lines & {f"{python} {name}" for python in ("python", "python3") for name in nodes if name}


def _documented_names(action: argparse.Action) -> list[str]:
    if action.option_strings:
        return [name for name in action.option_strings if "_" not in name]
    return re.findall(r"[A-Z]+", str(action.metavar))


def _common_text(block: Block) -> tuple[str, list[str]]:
    """Return the language-independent part of a block.

    The program's output is in the language of the page.
    """
    return block.language, [] if block.language == "text" else _without_comments(block.text)


def _without_comments(text: str) -> list[str]:
    return [re.sub(r"\s+# .*", "", line) for line in text.splitlines()]
