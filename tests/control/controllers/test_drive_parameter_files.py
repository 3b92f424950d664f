"""Parameter files of drives, as people have them, are read whole: what is in them is known, and the drive starts."""

from __future__ import annotations

from pathlib import Path

import pytest

from linkwright.control.controllers.registry import controller_class
from linkwright.graph.parameters.files import read_parameter_file
from tests.control.controllers.driving import warnings

FILE = Path(__file__).with_name("drives.yaml")
TYPES = {
    "humble_base": "diff_drive_controller/DiffDriveController",
    "jazzy_base": "diff_drive_controller/DiffDriveController",
    "fork": "tricycle_controller/TricycleController",
    "car": "ackermann_steering_controller/AckermannSteeringController",
    "tricycle": "tricycle_steering_controller/TricycleSteeringController",
    "bicycle": "bicycle_steering_controller/BicycleSteeringController",
    "mecanum": "mecanum_drive_controller/MecanumDriveController",
}


@pytest.mark.parametrize("name", TYPES)
async def test_a_parameter_file_is_read_whole(stand, name):
    for joint in ("left_front", "left_rear", "right_front", "right_rear"):
        stand.joint(joint, commands=("velocity",), position=0.0, velocity=0.0)
    for joint in ("steer_left", "steer_right"):
        stand.joint(joint, commands=("position",), position=0.0)
    parameters = read_parameter_file(FILE).for_node(f"/{name}")
    controller = stand.start(controller_class(TYPES[name]), name, **parameters)
    await stand.step(controller)
    assert not warnings(stand)
