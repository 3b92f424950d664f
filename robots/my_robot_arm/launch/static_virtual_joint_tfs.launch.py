# SPDX-License-Identifier: Apache-2.0
"""Publish where the robot is; without a simulator, it stays where it is."""

from moveit_configs_utils import MoveItConfigsBuilder
from moveit_configs_utils.launches import generate_static_virtual_joint_tfs_launch


def generate_launch_description():
    """Return what MoveIt starts for a package like this one."""
    moveit_config = MoveItConfigsBuilder('mbot_arm', package_name='my_robot_arm').to_moveit_configs()
    return generate_static_virtual_joint_tfs_launch(moveit_config)
