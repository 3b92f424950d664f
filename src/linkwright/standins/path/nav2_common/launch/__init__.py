"""Stands in for ``nav2_common.launch``."""

from linkwright.launch.rewriting import (
    HasNodeParams,
    LaunchConfigAsBool,
    ParseMultiRobotPose,
    ReplaceString,
    RewrittenYaml,
)

__all__ = ["HasNodeParams", "LaunchConfigAsBool", "ParseMultiRobotPose", "ReplaceString", "RewrittenYaml"]
