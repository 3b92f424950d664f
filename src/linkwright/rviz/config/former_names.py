"""The class names of RViz 1, and its keys for properties that were renamed in RViz 2.

A file of RViz 1 contains ``Class: rviz/Grid``, ``Topic: /scan`` next to ``Queue Size``, and ``Robot Description``.
Such a file is read through these names, and edits are written under them, so that it remains a file of RViz 1.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from types import MappingProxyType

Path = tuple[str, ...]

GROUP = "rviz_common/Group"
"""The class of a display that contains other displays."""

_RVIZ1_PREFIX = "rviz/"
_RVIZ2_PREFIX = "rviz_default_plugins/"
_RENAMED_PLUGINS = {
    "octomap_rviz_plugin/OccupancyGrid": "octomap_rviz_plugins/OccupancyGrid",
    "rtabmap_ros/Info": "rtabmap_rviz_plugins/Info",
    "rtabmap_ros/MapCloud": "rtabmap_rviz_plugins/MapCloud",
    "rtabmap_ros/MapGraph": "rtabmap_rviz_plugins/MapGraph",
    "rviz_plugin_covariance/Odometry": _RVIZ2_PREFIX + "Odometry",
    "rviz_plugins/AerialMapDisplay": "rviz_satellite/AerialMap",
}
"""The classes of other packages by their names in ROS 1."""

_RENAMED_CLASSES = {"Group": GROUP, "WrenchStamped": _RVIZ2_PREFIX + "Wrench"}


def is_former(cls: str) -> bool:
    """Return whether a class is named as in RViz 1."""
    return cls.startswith(_RVIZ1_PREFIX)


def to_modern_class(cls: str) -> str:
    """Return RViz 2's name for the class of a display, tool or view of RViz 1 or RViz 2."""
    if not is_former(cls):
        return _RENAMED_PLUGINS.get(cls, cls)
    name = cls.removeprefix(_RVIZ1_PREFIX)
    return _RENAMED_CLASSES.get(name, _RVIZ2_PREFIX + name)


@dataclass(frozen=True, slots=True)
class FormerKey:
    """The RViz 1 key for a property of RViz 2.

    Attributes:
        key: the key of RViz 1, at the same level as the ``Class`` of the display.
        read: converts a value to its spelling in RViz 2.
        write: converts a value to its spelling in RViz 1.
    """

    key: str
    read: Callable[[str], str] = str
    write: Callable[[str], str] = str


def get_former_keys(cls: str) -> Mapping[Path, FormerKey]:
    """Return the RViz 1 keys of a class, by property path.

    The mapping is empty for a class of RViz 2.
    """
    if not is_former(cls):
        return _NO_KEYS
    return _KEYS_BY_CLASS.get(cls.removeprefix(_RVIZ1_PREFIX), _TOPIC_KEYS)


def _reliability_from_unreliable(unreliable: str) -> str:
    return "Best Effort" if unreliable.strip().lower() in ("true", "1") else "Reliable"


def _unreliable_from_reliability(reliability: str) -> str:
    return "true" if reliability == "Best Effort" else "false"


def _namespace_from_update_topic(update_topic: str) -> str:
    return update_topic.removesuffix("/update")


def _update_topic_from_namespace(namespace: str) -> str:
    return f"{namespace.rstrip('/')}/update"


def _variance_from_deviation(deviation: str) -> str:
    try:
        return repr(float(deviation) ** 2)
    except (ValueError, OverflowError):
        return deviation


def _deviation_from_variance(variance: str) -> str:
    try:
        return repr(math.sqrt(float(variance)))
    except ValueError:
        return variance


def _qos_keys(topic: Path) -> dict[Path, FormerKey]:
    return {
        (*topic, "Depth"): FormerKey("Queue Size"),
        (*topic, "Reliability Policy"): FormerKey(
            "Unreliable", _reliability_from_unreliable, _unreliable_from_reliability
        ),
    }


def _topic_keys(topic: str) -> dict[Path, FormerKey]:
    return {("Topic",): FormerKey(topic), **_qos_keys(("Topic",))}


_NO_KEYS: Mapping[Path, FormerKey] = MappingProxyType({})
_TOPIC_KEYS: Mapping[Path, FormerKey] = MappingProxyType(_qos_keys(("Topic",)))
_KEYS_BY_CLASS: Mapping[str, Mapping[Path, FormerKey]] = MappingProxyType(
    {
        "Camera": _topic_keys("Image Topic"),
        "DepthCloud": _NO_KEYS,
        "Image": _topic_keys("Image Topic"),
        "InteractiveMarkers": {
            ("Interactive Markers Namespace",): FormerKey(
                "Update Topic", _namespace_from_update_topic, _update_topic_from_namespace
            )
        },
        "Marker": _topic_keys("Marker Topic"),
        "MarkerArray": _topic_keys("Marker Topic"),
        "RobotModel": {("Description Topic",): FormerKey("Robot Description")},
        "SetInitialPose": {
            ("Covariance x",): FormerKey("X std deviation", _variance_from_deviation, _deviation_from_variance),
            ("Covariance y",): FormerKey("Y std deviation", _variance_from_deviation, _deviation_from_variance),
            ("Covariance yaw",): FormerKey("Theta std deviation", _variance_from_deviation, _deviation_from_variance),
        },
    }
)
