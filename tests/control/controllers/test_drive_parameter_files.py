"""Typical parameter files of drives: all parameters are known, and the drive starts."""

from __future__ import annotations

import re
from pathlib import Path

import pytest

from linkwright.control.controllers.registry import controller_class
from linkwright.diagnostics import SourceText
from linkwright.graph.parameters.files import parse_parameters, read_parameter_file
from tests.control.controllers.driving import logged_warnings, stamped_twist

FILE = Path(__file__).with_name("drives.yaml")
TYPES = {
    "humble_base": "diff_drive_controller/DiffDriveController",
    "jazzy_base": "diff_drive_controller/DiffDriveController",
    "fork": "tricycle_controller/TricycleController",
    "car": "ackermann_steering_controller/AckermannSteeringController",
    "tricycle": "tricycle_steering_controller/TricycleSteeringController",
    "bicycle": "bicycle_steering_controller/BicycleSteeringController",
    "mecanum": "mecanum_drive_controller/MecanumDriveController",
    "husarion": "mecanum_drive_controller/MecanumDriveController",
}


@pytest.mark.parametrize("name", TYPES)
async def test_all_parameters_of_file_are_recognized(bench, name):
    for joint in ("left_front", "left_rear", "right_front", "right_rear"):
        bench.joint(joint, commands=("velocity",), position=0.0, velocity=0.0)
    for joint in ("steer_left", "steer_right"):
        bench.joint(joint, commands=("position",), position=0.0)
    parameters = read_parameter_file(FILE).for_node(f"/{name}")
    controller = bench.start(controller_class(TYPES[name]).variant(list(parameters)), name, **parameters)
    await bench.step(controller)
    assert not logged_warnings(bench)


def documented_file(page: str) -> str:
    """Return the parameter file of a drive on a page."""
    text = (Path(__file__).resolve().parents[3] / "docs" / page).read_text("utf-8")
    (example,) = re.findall(r"```yaml\n(base_controller.*?)```", text, re.DOTALL)
    return example


@pytest.mark.parametrize("page", ["control.md", "zh/control.md"])
async def test_documented_drive_starts(bench, page):
    for joint in ("left_joint", "right_joint"):
        bench.joint(joint, commands=("velocity",), position=0.0, velocity=0.0)
    parameters = parse_parameters(SourceText(page, documented_file(page))).for_node("/base_controller")
    controller = bench.start(controller_class(TYPES["jazzy_base"]), "base_controller", **parameters)
    second = 1_000_000_000
    bench.publish("geometry_msgs/msg/TwistStamped", "/base_controller/cmd_vel", stamped_twist(second, 9.0))
    await bench.step(controller, 1.0)
    assert [command.value for command in controller.commands] == pytest.approx([0.8 / 0.06] * 2)
    assert not logged_warnings(bench)
