"""Controllers in launch files, in processes that report their names."""

from __future__ import annotations

import re
from collections.abc import Callable
from pathlib import Path
from typing import Any

from launch_ros.actions import Node
from launch_ros.parameter_descriptions import ParameterFile

from tests.control.robots import joint, robot
from tests.launch.ending import end_when, has_printed

FILE = """
controller_manager:
  ros__parameters:
    arm: {type: joint_trajectory_controller/JointTrajectoryController}
arm:
  ros__parameters:
    joints: [hip, knee]
    command_interfaces: [position]
    state_interfaces: [position, velocity]
    open_lop_control: true
"""

ARM = """arm:
  ros__parameters:
    type: joint_trajectory_controller/JointTrajectoryController
    gpios: [{interfaces: [a, b]}, {interfaces: [c]}]"""


async def test_controller_log_messages_have_manager_process_prefix(launch: Any, write: Callable[[str, str], Path]):
    parameters = [str(write("controllers.yaml", FILE)), {"robot_description": robot(joint("hip") + joint("knee"))}]
    result = await launch(
        Node(package="controller_manager", executable="ros2_control_node", parameters=parameters),
        Node(package="controller_manager", executable="spawner", arguments=["arm"]),
        end_when(has_printed("Configured and activated arm")),
    )
    assert result.succeeded, result.err
    (line,) = [line for line in result.err.splitlines() if "open_lop_control" in line]
    assert re.match(r"\[ros2_control_node-1\] \[WARN\] \[[0-9.]+\] \[arm\]: ", line)
    assert line.endswith("'open_lop_control' is not a parameter of this controller; did you mean 'open_loop_control'?")


async def test_spawner_passes_on_parameter_files(launch: Any, write: Callable[[str, str], Path]):
    """The spawner passes on parameter files with substitutions.

    The manager has no file, as in the first example of ros2_control_demos.
    """
    controller = (
        FILE[FILE.index("arm:\n  ros") :]
        .replace("arm:\n  ros__parameters:", ARM)
        .replace("[hip, knee]", "[hip, $(var joint)]")
    )
    file = ParameterFile(str(write("controllers.yaml", controller)), allow_substs=True)
    description = {"robot_description": robot(joint("hip") + joint("knee"))}
    result = await launch(
        Node(package="controller_manager", executable="ros2_control_node", parameters=[description]),
        Node(
            package="controller_manager",
            executable="spawner",
            parameters=[{"joint": "knee"}, file],
            arguments=["arm"],
        ),
        end_when(has_printed("Configured and activated arm")),
        joint="knee",
    )
    assert result.succeeded, result.err
    assert "left out" in result.err
    assert "LAUNCH149" not in result.err
