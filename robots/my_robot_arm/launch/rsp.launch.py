# SPDX-License-Identifier: Apache-2.0
"""Publish the description of the robot and the frames of its links."""

from moveit_configs_utils import MoveItConfigsBuilder
from moveit_configs_utils.launches import generate_rsp_launch


def generate_launch_description():
    """Return what MoveIt starts for a package like this one."""
    moveit_config = MoveItConfigsBuilder('mbot_arm', package_name='my_robot_arm').to_moveit_configs()
    return generate_rsp_launch(moveit_config)
