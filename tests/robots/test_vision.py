"""The package of vision nodes.

The tests cover its launch files, its checks, and the node that follows an object in a world.
"""

from __future__ import annotations

import importlib
import math
import sys
from collections.abc import Iterator
from pathlib import Path
from types import ModuleType
from typing import Any

import pytest

from linkwright import standins
from linkwright.cli.command import main
from linkwright.nodes import EXECUTABLES
from tests.places import CONTROL_PACKAGE, VISION_PACKAGE
from tests.robots.workspaces import colcon_build
from tests.vision.nodes.seeking_robot import SeekingRobot

pytest.importorskip("mujoco")


@pytest.fixture
def follow_object(monkeypatch: pytest.MonkeyPatch) -> Iterator[ModuleType]:
    """Import the module of the package, as a sourced workspace does."""
    standins.activate()
    for package in (CONTROL_PACKAGE, VISION_PACKAGE):
        monkeypatch.syspath_prepend(str(package))
    yield importlib.import_module("my_robot_vision.follow_object")
    for name in [
        module for module in sys.modules if module.partition(".")[0] in ("my_robot_control", "my_robot_vision")
    ]:
        del sys.modules[name]


def test_follow_object_follows_moving_ball(follow_object: Any, tmp_path: Path) -> None:
    with SeekingRobot(tmp_path, (-1.5, 0.5)) as test:
        test.init_rclpy(["--ros-args", "-p", "thing:=ball", "-p", "use_sim_time:=true"])
        follow_object.FollowObject()
        for x, y in ((-1.5, 0.5), (-2.0, 1.5), (-1.0, 2.5)):
            test.delete("ball")
            test.put_ball(x, y)
            test.advance(20.0)
            assert 0.5 < test.distance() < 1.2
            robot_x, robot_y, _, _, _, *turn = test.robot_pose()
            bearing = math.atan2(y - robot_y, x - robot_x) - 2.0 * math.atan2(turn[0], turn[1])
            assert math.cos(bearing) > math.cos(0.15), "mbot faces the ball"
        test.detector.cancel()
        test.advance(1.0)
        speed = test.commands.last
        assert (speed.linear.x, speed.angular.z) == (0.0, 0.0), "mbot stops without detections"


def test_decision_tests_of_package_pass(follow_object: Any) -> None:
    path = VISION_PACKAGE / "test" / "test_decisions.py"
    names: dict[str, Any] = {"__name__": "test_decisions"}
    exec(compile(path.read_text(encoding="utf-8"), str(path), "exec"), names)
    tests = [value for name, value in names.items() if name.startswith("test_")]
    assert len(tests) == 3
    for test in tests:
        test()


def test_package_has_no_findings(capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["check", "--strict", str(VISION_PACKAGE)]) == 0, capsys.readouterr().out


@pytest.mark.parametrize("name", ["detect", "follow_object"])
def test_launch_files_start_nodes(name: str, capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["launch", str(VISION_PACKAGE / "launch" / f"{name}.launch.py"), "--print"]) == 0
    output = capsys.readouterr().out
    for executable in ("detector", "tracking_node", "detect_3d_node", "object_seeker", "voice_commander", "gazebo"):
        assert executable in output


def test_entry_points_match_executables() -> None:
    setup = (VISION_PACKAGE / "setup.py").read_text(encoding="utf-8")
    for name in ("detector", "tracking_node", "detect_3d_node", "object_seeker"):
        assert ("my_robot_vision", name) in EXECUTABLES
        assert f"'{name} = my_robot_vision.linkwright_nodes:{name}'" in setup


@pytest.mark.slow
def test_colcon_installs_package_completely(tmp_path: Path) -> None:
    (tmp_path / "src").mkdir()
    (tmp_path / "src" / VISION_PACKAGE.name).symlink_to(VISION_PACKAGE)
    colcon_build(tmp_path, VISION_PACKAGE.name)
    installed = tmp_path / "install" / VISION_PACKAGE.name
    for name in ("follow_object", "detector", "tracking_node", "detect_3d_node", "object_seeker"):
        assert (installed / "lib" / VISION_PACKAGE.name / name).is_file()
    share = installed / "share" / VISION_PACKAGE.name
    assert (share / "launch" / "detect.launch.py").is_file()
    assert (share / "rviz" / "vision.rviz").is_file()
