"""Find controller managers that a plugin of the simulator replaces."""

from __future__ import annotations

import re

from linkwright.review.caching import cached_in_review
from linkwright.review.launches.included import IncludedActions
from linkwright.review.launches.outlines import Entry
from linkwright.review.versions import Version

_CONTROLLER_MANAGER = "controller_manager/ros2_control_node"
_SPAWNER = re.compile(r"(ros_gz_sim|ros_ign_gazebo)/create|gazebo_ros/spawn_entity\.py")
_PLUGIN = re.compile(r"<plugin\b[^>]*\b(?:gz|ign|gazebo)_ros2_control")
_COMMENT = re.compile(r"<!--.*?-->", re.DOTALL)


def is_simulated_controller_manager(entry: Entry, new: IncludedActions, version: Version) -> bool:
    """Return whether a removed node manages controllers, which a simulated robot of the launch file does itself.

    The file spawns a robot, and a description of the repository has a plugin of Gazebo for ros2_control.

    Args:
        entry: the removed action.
        new: the actions of the new file with those of its included files.
        version: the new version.
    """
    return entry.name == _CONTROLLER_MANAGER and new.find_node(_SPAWNER) is not None and _has_plugin(version)


@cached_in_review(maxsize=4)
def _has_plugin(version: Version) -> bool:
    paths = version.paths((".urdf", ".xacro", ".gazebo"))
    return any(_PLUGIN.search(_COMMENT.sub("", version.text(path))) for path in paths)
