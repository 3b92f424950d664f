"""The third chapter of the tutorial, followed by a reader.

It covers nodes that drive mbot, and their tests.
"""

from __future__ import annotations

import json
import math
import os
import shlex
import subprocess
import sys
from collections.abc import Callable, Iterator
from importlib import import_module
from pathlib import Path
from typing import Any

import pytest

from linkwright import standins
from linkwright.cli import main
from linkwright.standins import process
from linkwright.testing import SteppedSimulation
from tests.docs.pages import DOCS, read_blocks, read_commands
from tests.docs.reader import Outcome, write_block

pytest.importorskip("mujoco")

LANGUAGES = {"en": DOCS / "tutorial-control.md", "zh": DOCS / "zh" / "tutorial-control.md"}
ROBOT = "package://my_robot_description/urdf/mbot_gazebo.xacro"


@pytest.fixture(scope="module")
def package(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Return the package after the last step."""
    folder = tmp_path_factory.mktemp("control_ws")
    page = LANGUAGES["en"]
    create = next(line for line in read_commands(page) if line.startswith("linkwright pkg create "))
    assert main([*shlex.split(create)[1:], "--destination-directory", str(folder / "src")]) == 0
    package = folder / "src" / "my_control"
    for block in read_blocks(page):
        if block.title:
            write_block(block, package)
    return package


@pytest.fixture
def load_module(package: Path, monkeypatch: pytest.MonkeyPatch) -> Iterator[Any]:
    """Return a function that imports a module of the package."""
    standins.activate()
    monkeypatch.syspath_prepend(str(package))
    yield lambda name: import_module(f"my_control.{name}")
    for name in [name for name in sys.modules if name.partition(".")[0] == "my_control"]:
        del sys.modules[name]


def test_first_node_has_at_most_twenty_lines() -> None:
    (node,) = [block for block in read_blocks(LANGUAGES["en"]) if block.title == "my_control/first_move.py"]
    code_lines = [line for line in node.text.splitlines() if line]
    assert len(code_lines) <= 20


def test_first_node_drives_in_circle(load_module: Any) -> None:
    with SteppedSimulation("empty", ROBOT) as test:
        test.init_rclpy()
        load_module("first_move").FirstMove()
        test.advance(2.0 * math.pi)  # half a turn at 0.5 rad/s
        x, y, *_ = test.robot_pose()
        assert y == pytest.approx(2 * 0.2 / 0.5, abs=0.15), "the opposite side of a circle with a radius of 0.4 m"
        assert abs(x) < 0.2


def test_one_meter_node_drives_one_meter(load_module: Any) -> None:
    with SteppedSimulation("empty", ROBOT) as test:
        test.init_rclpy()
        load_module("one_meter").OneMeter()
        odometry = test.record("/odom")
        test.advance(15.0)
        assert odometry.last.pose.pose.position.x == pytest.approx(1.0, abs=0.01)
        assert abs(odometry.last.twist.twist.linear.x) < 1e-3


def test_distance_is_a_parameter(load_module: Any) -> None:
    with SteppedSimulation("empty", ROBOT) as test:
        test.init_rclpy(["--ros-args", "-p", "distance:=0.5"])
        load_module("one_meter").OneMeter()
        odometry = test.record("/odom")
        test.advance(10.0)
        assert odometry.last.pose.pose.position.x == pytest.approx(0.5, abs=0.01)


def test_stop_ahead_node_stops_before_block(load_module: Any) -> None:
    with SteppedSimulation("obstacles", ROBOT, arguments={"laser": True}) as test:
        test.init_rclpy()
        load_module("stop_ahead").StopAhead()
        scans = test.record("/scan")
        test.advance(20.0)
        distances_ahead = [distance for number, distance in enumerate(scans.last.ranges) if abs(number - 180) < 30]
        assert 0.4 < min(distances_ahead) <= 0.62


def test_check_of_package_finds_nothing(package: Path, capsys: pytest.CaptureFixture[str]) -> None:
    capsys.readouterr()
    assert main(["check", "--strict", "--format", "json", str(package)]) == 0
    assert json.loads(capsys.readouterr().out)["diagnostics"] == []


def test_nodes_are_listed_as_executables(
    package: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.chdir(package)
    assert main(["pkg", "executables", "my_control"]) == 0
    assert capsys.readouterr().out.split() == [
        *("my_control", "first_move", "my_control", "one_meter", "my_control", "stop_ahead")
    ]


def test_launch_file_includes_simulation(package: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["launch", str(package / "launch" / "stop_ahead.launch.py"), "--show-args"]) == 0
    assert "'rviz'" in capsys.readouterr().out


def test_tests_of_page_pass(package: Path) -> None:
    environment = process.create_environment({**os.environ, "LINKWRIGHT_DDS": "0"})
    result = subprocess.run(
        [sys.executable, "-m", "pytest", "-q", "-p", "no:cacheprovider", "-p", "no:asyncio", "test/test_nodes.py"],
        cwd=package,
        env=environment,
        capture_output=True,
        encoding="utf-8",
        timeout=240,
        check=False,
    )
    assert result.returncode == 0, result.stdout + result.stderr
    assert "2 passed" in result.stdout


def test_both_languages_show_same_files_and_commands() -> None:
    english, chinese = ([(block.title, block.text) for block in read_blocks(page)] for page in LANGUAGES.values())
    assert english == chinese


@pytest.mark.slow
def test_tutorial_commands_run_with_installed_wheel(follow: Callable[..., Path]) -> None:
    follow(
        LANGUAGES["en"],
        {
            "linkwright run my_control first_move": Outcome(node="/first_move"),
            "linkwright run teleop_twist_keyboard teleop_twist_keyboard": Outcome(output_text="stop"),
            "linkwright run my_control one_meter --ros-args -p distance:=2.0": Outcome(node="/one_meter"),
            "linkwright run my_control stop_ahead": Outcome(node="/stop_ahead"),
            "linkwright launch my_control stop_ahead.launch.py": Outcome(node="/stop_ahead"),
            **{
                f"linkwright launch my_robot_control {name}.launch.py": Outcome(node=f"/{name}")
                for name in ("drive_square", "follow_wall", "follow_line", "avoid_obstacles", "go_to_pose")
            },
        },
    )
