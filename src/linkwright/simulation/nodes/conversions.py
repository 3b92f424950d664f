"""Message conversions for bridges whose two sides have different types.

Source: ros_gz_bridge (the ROS types to which each gz type can be converted).
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

from linkwright.messages import get_message

Conversion = Callable[[Any], Any]

TYPES_OF_GZ = {
    "gz.msgs.Twist": "geometry_msgs/msg/Twist",
    "gz.msgs.Wrench": "geometry_msgs/msg/WrenchStamped",
    "gz.msgs.Pose": "geometry_msgs/msg/TransformStamped",
    "gz.msgs.Pose_V": "tf2_msgs/msg/TFMessage",
}
"""The type that a topic of gz has in the graph, for types that bridges turn into more than one of ROS."""


def conversion(source: str, target: str) -> Conversion | None:
    """Return the function that converts messages of one type to another, or None if there is none."""
    if source == target:
        return lambda message: message
    inside = _WITH_HEADER.get(source)
    if inside is not None and inside[0] == target:
        return lambda message: getattr(message, inside[1])
    outside = _WITH_HEADER.get(target)
    if outside is not None and outside[0] == source:
        return lambda message: get_message(target)(**{outside[1]: message})
    return _POSES.get((source, target))


_WITH_HEADER = {
    "geometry_msgs/msg/TwistStamped": ("geometry_msgs/msg/Twist", "twist"),
    "geometry_msgs/msg/WrenchStamped": ("geometry_msgs/msg/Wrench", "wrench"),
    "geometry_msgs/msg/TransformStamped": ("geometry_msgs/msg/Transform", "transform"),
}
"""Types with a header: the type of their payload, and its field."""


def _pose(transform: Any) -> Any:
    moved = transform.transform.translation
    point = get_message("geometry_msgs/msg/Point")(moved.x, moved.y, moved.z)
    return get_message("geometry_msgs/msg/Pose")(point, transform.transform.rotation)


def _pose_stamped(transform: Any) -> Any:
    return get_message("geometry_msgs/msg/PoseStamped")(transform.header, _pose(transform))


def _poses(message: Any) -> Any:
    poses = get_message("geometry_msgs/msg/PoseArray")(poses=[_pose(transform) for transform in message.transforms])
    if message.transforms:
        poses.header = message.transforms[0].header
    return poses


_POSES: dict[tuple[str, str], Conversion] = {
    ("geometry_msgs/msg/TransformStamped", "geometry_msgs/msg/Pose"): _pose,
    ("geometry_msgs/msg/TransformStamped", "geometry_msgs/msg/PoseStamped"): _pose_stamped,
    ("tf2_msgs/msg/TFMessage", "geometry_msgs/msg/PoseArray"): _poses,
}
