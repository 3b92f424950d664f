"""Stands in for ``nav2_common.launch.parse_multirobot_pose``."""

from linkwright.launch.rewriting import ParseMultiRobotPose

__all__ = ["ParseMultiRobotPose"]
