"""Installation commands on pages, in messages and in robots.

They apply while no version is on a package index.
"""

from __future__ import annotations

import re
from functools import cache
from pathlib import Path

import pytest

from linkwright.diagnostics.installation import Installation, Origin
from tests.places import REPOSITORY
from tests.toml_files import EXTRAS, TOGETHER

WRITTEN = ("docs", "frontend/src", "robots", "src", "README.md", "README.zh-CN.md", "SECURITY.md", "SECURITY.zh-CN.md")
COMMAND_KINDS = {".html", ".md", ".po", ".py", ".toml", ".ts", ".txt", ".xml", ".yaml"}
RECORDS = REPOSITORY / "docs" / "decisions"
INSTALLING = re.compile(r"\b(?:pip|pipx|uv tool) install (?P<what>(?:-e )?(?:'[^'\n]+'|[^\s`'）)]+))")
OTHER_COMMANDS = {
    "--no-index",
    "-e my_wind",
    "-e street_displays",
    "-e team_rules",
    "ai-edge-litert",
    "jupyterlab",
    "linkwright_core-0.1.0-py3-none-any.whl",
    "path/to/linkwright",
    "path/to/linkwright/core",
    "roslibpy",
    "ty",
}
"""The packages besides Linkwright in documented commands, and Linkwright itself outside a checkout."""


@cache
def find_install_commands() -> list[tuple[Path, str]]:
    """Return each command of pip, pipx and uv for users: its location, and what it installs."""
    paths = [path for name in WRITTEN for path in sorted([REPOSITORY / name, *(REPOSITORY / name).rglob("*")])]
    return [
        (path.relative_to(REPOSITORY), match["what"])
        for path in paths
        if path.suffix in COMMAND_KINDS and path.is_file() and RECORDS not in path.parents
        for match in INSTALLING.finditer(path.read_text(encoding="utf-8"))
    ]


def test_readmes_show_install_commands() -> None:
    assert {"README.md", "README.zh-CN.md"} <= {path.name for path, _ in find_install_commands()}


def test_source_and_frontend_contain_no_install_commands() -> None:
    assert [
        command for command in find_install_commands() if command[0].parts[0] in ("frontend", "robots", "src")
    ] == []


def test_install_commands_match_a_checkout(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> None:
    monkeypatch.chdir(tmp_path)
    for path, command in find_install_commands():
        if command not in OTHER_COMMANDS:
            extras = [
                extra
                for extras_of_command in re.findall(r"\[([\w,]+)\]", command)
                for extra in extras_of_command.split(",")
            ]
            assert set(extras) <= {*EXTRAS, "all"}, (path, command)
            installation = Installation(Origin(str(tmp_path), command.startswith("-e ")), ("pip", "install"))
            normalized = re.sub(r"\[.*\]", f"[{','.join(sorted(extras))}]", command)
            assert f"pip install {normalized}" == installation.command_for_extras(*extras), (path, command)


@pytest.mark.parametrize(
    ("page", "sentence"),
    [
        ("README.md", r"brings all but ((?:`\w+`(?:, | and )?)+)"),
        ("README.zh-CN.md", r"包含除 ((?:`\w+`[、 和]*)+)以外的全部"),
        ("docs/decisions/0022-a-small-base.md", r"has them all, but for ((?:`\w+`(?:, | and )?)+)"),
    ],
)
def test_extras_not_in_all_are_named(page: str, sentence: str) -> None:
    (names,) = re.findall(sentence, " ".join((REPOSITORY / page).read_text(encoding="utf-8").split()))
    assert set(re.findall(r"`(\w+)`", names)) == EXTRAS.keys() - TOGETHER


def test_extras_in_brackets_exist() -> None:
    for page in [*REPOSITORY.glob("*.md"), *(REPOSITORY / "docs").rglob("*.md")]:
        for names in re.findall(r"(?:linkwright|\.whl|'\.)\[([a-z, ]+)\]", page.read_text(encoding="utf-8")):
            assert set(re.split(", ?", names)) <= {*EXTRAS, "all"}, page
