"""The second chapter of the tutorial, followed by a reader.

It covers a world, and a package that loads mbot into it.
"""

from __future__ import annotations

import json
import shlex
from collections.abc import Callable
from pathlib import Path

import pytest

from linkwright.cli import main
from tests.docs.pages import DOCS, read_blocks
from tests.docs.reader import write_block
from tests.robots.workspaces import colcon_build

LANGUAGES = {"en": DOCS / "tutorial-worlds.md", "zh": DOCS / "zh" / "tutorial-worlds.md"}


@pytest.fixture(params=LANGUAGES)
def package(request: pytest.FixtureRequest, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """Return the package after the last step."""
    monkeypatch.chdir(tmp_path)
    git = tmp_path / "gitconfig"
    git.write_text("[user]\nname = Ada\nemail = ada@linkwright.dev\n", encoding="utf-8")
    monkeypatch.setenv("GIT_CONFIG_GLOBAL", str(git))
    page = LANGUAGES[request.param]
    create = next(line for line in page.read_text("utf-8").splitlines() if line.startswith("linkwright pkg create "))
    assert main([*shlex.split(create)[1:], "--destination-directory", "src"]) == 0
    package = tmp_path / "src" / "my_worlds"
    for block in read_blocks(page):
        if block.title:
            write_block(block, package)
    return package


def test_check_of_world_and_package_finds_nothing(package: Path, capsys: pytest.CaptureFixture[str]) -> None:
    capsys.readouterr()
    for path in (package / "worlds" / "yard.world", package):
        assert main(["check", "--strict", "--format", "json", str(path)]) == 0
        assert json.loads(capsys.readouterr().out)["diagnostics"] == []


def test_launch_file_includes_simulation(package: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["launch", str(package / "launch" / "load_mbot.launch.py"), "--show-args"]) == 0
    captured = capsys.readouterr().out
    assert all(name in captured for name in ("'world'", "'gui'", "'pause'"))


def test_both_languages_show_same_files() -> None:
    english, chinese = ([(block.title, block.text) for block in read_blocks(page)] for page in LANGUAGES.values())
    assert english == chinese


@pytest.mark.slow
def test_colcon_installs_package_files(package: Path) -> None:
    workspace = package.parents[1]
    colcon_build(workspace, package.name)
    share = workspace / "install" / package.name / "share" / package.name
    assert (share / "worlds" / "yard.world").is_file()
    assert (share / "launch" / "load_mbot.launch.py").is_file()


@pytest.mark.slow
def test_tutorial_commands_run_with_installed_wheel(follow: Callable[..., Path]) -> None:
    follow(LANGUAGES["en"], {})
