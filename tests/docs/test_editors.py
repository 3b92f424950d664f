"""The settings for editors: all file patterns of the language server, and its command."""

from __future__ import annotations

import fnmatch
import json
import re
import sys
from pathlib import Path

import pytest

from linkwright.language.files import PATTERNS
from linkwright.language.formats import FORMATS
from linkwright.lint.targets import XML_SUFFIXES
from tests.docs.pages import DOCS, read_blocks

SHOWN = {block.title: block.text for block in read_blocks(DOCS / "howto-editor.md") if block.title}
ALL_PATTERNS = {pattern for patterns in PATTERNS.values() for pattern in patterns}
EXTENSION = DOCS.parent / "editors" / "vscode"


def example_path(pattern: str) -> str:
    """Return a path that a pattern covers."""
    return pattern.replace("*", "a")


def quoted_patterns(text: str) -> set[str]:
    """Return the patterns in quotes."""
    return set(re.findall(r'"([^"\s]*(?:\*[^"\s]*|package\.xml|model\.config|setup\.py|CMakeLists\.txt))"', text))


@pytest.mark.parametrize("title", ["init.lua", ".vimrc", "init.el", "settings.json", "linkwright.json"])
def test_editor_settings_start_language_server(title):
    text = SHOWN[title]
    assert re.search(r'"linkwright", "lsp"|"linkwright" "lsp"|\'command\': \'%e lsp\'', text)


def test_neovim_attaches_to_all_files():
    patterns = SHOWN["init.lua"].split("pattern = {", 1)[1].split("}", 1)[0]
    assert quoted_patterns(patterns) == ALL_PATTERNS


def test_vim_assigns_file_types_to_server():
    lines = re.findall(r"BufNewFile (\S+) set filetype=(\S+)", SHOWN[".vimrc"])
    assert {kind: tuple(patterns.split(",")) for patterns, kind in lines} == {
        {"interface": "ros"}.get(kind, f"{kind}.ros"): patterns for kind, patterns in PATTERNS.items()
    }
    assert "Define('ros'" in SHOWN[".vimrc"]


def test_emacs_assigns_modes_to_xml_yaml_and_interface_files():
    text = SHOWN["init.el"]
    expressions = [
        re.compile(
            written.replace("\\\\'", r"\Z")
            .replace("\\\\", "\\")
            .replace(r"\(", "(")
            .replace(r"\)", ")")
            .replace(r"\|", "|")
        )
        for written in re.findall(r'\("((?:[^"\\]|\\.)*)" \. ros-', text)
    ]
    for kind in ("xml", "yaml", "interface"):
        for pattern in PATTERNS[kind]:
            assert any(expression.search(example_path(pattern)) for expression in expressions), pattern


def test_helix_lists_files_of_its_own_languages():
    assert quoted_patterns(SHOWN["languages.toml"]) == {*PATTERNS["xml"], *PATTERNS["interface"], "*.rviz"}
    if sys.version_info >= (3, 11):
        import tomllib

        assert tomllib.loads(SHOWN["languages.toml"])["language-server"]["linkwright"]["args"] == ["lsp"]


@pytest.mark.parametrize("title", ["settings.json", "linkwright.json"])
def test_json_settings_are_valid(title):
    assert json.loads(SHOWN[title])


def test_vscode_extension_sends_all_files():
    source = (EXTENSION / "src" / "server" / "documents.ts").read_text(encoding="utf-8")
    lists = re.search(r"DESCRIPTION_PATTERN =([^;]*);.*?PACKAGE_PATTERN =([^;]*);", source, re.DOTALL)
    assert lists is not None
    patterns = {name for written in lists.groups() for name in re.sub(r'[*]{2}/|["+\s{}]', "", written).split(",")}
    assert patterns == {pattern.removeprefix("*/") for pattern in ALL_PATTERNS}


def test_patterns_match_supported_formats():
    for suffix in XML_SUFFIXES:
        assert any(fnmatch.fnmatch(f"a{suffix}", pattern) or suffix == pattern for pattern in PATTERNS["xml"]), suffix
    for pattern in (*PATTERNS["yaml"], *PATTERNS["interface"], "package.xml", "*.srdf", "*launch.py", "*/launch/*.py"):
        assert (
            any(file_format.covers(Path(example_path(pattern))) for file_format in FORMATS) or pattern == "*launch.py"
        ), pattern
    assert any(file_format.covers(Path("a.launch.py")) for file_format in FORMATS)
