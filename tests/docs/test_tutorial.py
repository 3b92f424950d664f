"""The first chapter of the tutorial, followed by a reader: the robots at its end."""

from __future__ import annotations

import json
import shlex
from collections.abc import Callable
from pathlib import Path

import pytest

from linkwright.cli import main
from linkwright.descriptions import load
from tests.docs.pages import DOCS, read_blocks
from tests.docs.reader import write_block
from tests.robots.workspaces import colcon_build

LANGUAGES = {"en": DOCS / "tutorial.md", "zh": DOCS / "zh" / "tutorial.md"}
BASE = {"base_link", "left_wheel_link", "right_wheel_link", "front_caster_link", "back_caster_link"}


@pytest.fixture(params=LANGUAGES)
def package(request: pytest.FixtureRequest, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """Return the package after the last step, for a reader whose name git knows."""
    monkeypatch.chdir(tmp_path)
    git = tmp_path / "gitconfig"
    git.write_text("[user]\nname = Ada\nemail = ada@linkwright.dev\n", encoding="utf-8")
    monkeypatch.setenv("GIT_CONFIG_GLOBAL", str(git))
    page = LANGUAGES[request.param].read_text(encoding="utf-8")
    create = next(line for line in page.splitlines() if line.startswith("linkwright pkg create "))
    assert main([*shlex.split(create)[1:], "--destination-directory", "src"]) == 0
    package = tmp_path / "src" / "my_robot_description"
    for block in read_blocks(LANGUAGES[request.param]):
        if block.title:
            write_block(block, package)
    return package


def test_urdf_and_xacro_models_match_tutorial(package: Path) -> None:
    urdf = load(package / "urdf" / "mbot_base.urdf")
    xacro = load(package / "urdf" / "mbot_base.xacro")
    assert set(urdf.links) == BASE | {"camera_link"}
    assert set(xacro.links) == BASE
    for robot in (urdf, xacro):
        assert robot.joints["left_wheel_joint"].origin.xyz == pytest.approx((0, 0.19, -0.05))
        assert robot.joints["right_wheel_joint"].origin.xyz == pytest.approx((0, -0.19, -0.05))
        assert robot.joints["front_caster_joint"].origin.xyz == pytest.approx((0.18, 0, -0.095))
        assert robot.joints["back_caster_joint"].origin.xyz == pytest.approx((-0.18, 0, -0.095))


def test_check_prints_tree_of_page(package: Path, capsys: pytest.CaptureFixture[str]) -> None:
    capsys.readouterr()
    assert main(["check", str(package / "urdf" / "mbot_base.xacro")]) == 0
    captured = capsys.readouterr().out
    for page in LANGUAGES.values():
        assert captured in [block.text for block in read_blocks(page) if block.language == "text"]


def test_check_of_package_finds_nothing(package: Path, capsys: pytest.CaptureFixture[str]) -> None:
    capsys.readouterr()
    assert main(["check", "--format", "json", str(package)]) == 0
    assert json.loads(capsys.readouterr().out)["diagnostics"] == []


def test_launch_file_lists_its_arguments(package: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["launch", str(package / "launch" / "display.launch.py"), "--show-args"]) == 0
    captured = capsys.readouterr().out
    assert all(name in captured for name in ("'gui'", "'model'", "'rvizconfig'"))


@pytest.mark.slow
def test_colcon_installs_package_files(package: Path) -> None:
    workspace = package.parents[1]
    colcon_build(workspace, package.name)
    share = workspace / "install" / package.name / "share" / package.name
    for path in ("urdf/mbot_base.urdf", "urdf/mbot_base.xacro", "launch/display.launch.py", "rviz/urdf.rviz"):
        assert (share / path).is_file()


@pytest.mark.slow
def test_tutorial_commands_run_with_installed_wheel(follow: Callable[..., Path]) -> None:
    home = follow(LANGUAGES["en"], {})
    assert (home / "ros2_ws" / "install" / "my_robot_description").is_dir()
