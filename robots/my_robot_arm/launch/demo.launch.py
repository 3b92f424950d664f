# SPDX-License-Identifier: Apache-2.0
"""Plan motions of mbot's bigger sister without a simulator: the joints move as they are told."""

from moveit_configs_utils import MoveItConfigsBuilder
from moveit_configs_utils.launches import generate_demo_launch


def generate_launch_description():
    """Return what MoveIt starts for a package like this one."""
    moveit_config = MoveItConfigsBuilder('mbot_arm', package_name='my_robot_arm').to_moveit_configs()
    return generate_demo_launch(moveit_config)
