"""Find hardware of ros2_control that another simulator than before loads."""

from __future__ import annotations

from linkwright.descriptions.comparison import ROS2_CONTROL, Difference
from linkwright.diagnostics import Phrase, phrase
from linkwright.review.versions import Version

_CLASSIC, _NEW = "Gazebo Classic", "Gazebo"
_SIMULATORS = {
    "gazebo_ros2_control": _CLASSIC,
    "ign_ros2_control": _NEW,
    "gz_ros2_control": _NEW,
}
"""The simulators that load the hardware plugins of a package."""
_PROPERTY = "hardware plugin"


def find_simulator_reason(difference: Difference, version: Version, path: str | None) -> Phrase | None:
    """Return the reason why hardware for another simulator is breaking, or None if it is not.

    A description that still has the old hardware, behind a condition, can be used with both simulators.

    Args:
        difference: the difference between both versions.
        version: the new version.
        path: the path of the description that has the new value; None if it is unknown.
    """
    if not difference.name.startswith(ROS2_CONTROL) or difference.property != _PROPERTY or path is None:
        return None
    old, new = (text or "" for text in (difference.old, difference.new))
    old_simulator, new_simulator = (_SIMULATORS.get(text.partition("/")[0]) for text in (old, new))
    if None in (old_simulator, new_simulator) or old_simulator == new_simulator or old in version.text(path):
        return None
    return phrase("simulations that start the robot in {simulator} find no controllers", simulator=old_simulator or "")
