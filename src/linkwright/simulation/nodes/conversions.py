"""Message conversions for bridges whose two sides have different types.

Source: ros_gz_bridge (the ROS types to which each gz type can be converted).
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

from linkwright.messages import get_message

Conversion = Callable[[Any], Any]

DEFAULT_ROS_TYPES = {
    "gz.msgs.Twist": "geometry_msgs/msg/Twist",
    "gz.msgs.Wrench": "geometry_msgs/msg/WrenchStamped",
    "gz.msgs.Pose": "geometry_msgs/msg/TransformStamped",
    "gz.msgs.Pose_V": "tf2_msgs/msg/TFMessage",
}
"""The ROS type of each gz type that ros_gz_bridge can convert to several ROS types."""


def find_conversion(source: str, target: str) -> Conversion | None:
    """Return the function that converts messages between two types, or None if there is none."""
    if source == target:
        return lambda message: message
    source_payload = _PAYLOAD_FIELDS.get(source)
    if source_payload is not None and source_payload[0] == target:
        return lambda message: getattr(message, source_payload[1])
    target_payload = _PAYLOAD_FIELDS.get(target)
    if target_payload is not None and target_payload[0] == source:
        return lambda message: get_message(target)(**{target_payload[1]: message})
    return _POSE_CONVERSIONS.get((source, target))


_PAYLOAD_FIELDS = {
    "geometry_msgs/msg/TwistStamped": ("geometry_msgs/msg/Twist", "twist"),
    "geometry_msgs/msg/WrenchStamped": ("geometry_msgs/msg/Wrench", "wrench"),
    "geometry_msgs/msg/TransformStamped": ("geometry_msgs/msg/Transform", "transform"),
}
"""For each type with a header: the type of its payload, and the field that contains it."""


def _transform_to_pose(transform: Any) -> Any:
    translation = transform.transform.translation
    point = get_message("geometry_msgs/msg/Point")(x=translation.x, y=translation.y, z=translation.z)
    return get_message("geometry_msgs/msg/Pose")(position=point, orientation=transform.transform.rotation)


def _transform_to_pose_stamped(transform: Any) -> Any:
    return get_message("geometry_msgs/msg/PoseStamped")(header=transform.header, pose=_transform_to_pose(transform))


def _transforms_to_poses(message: Any) -> Any:
    poses = get_message("geometry_msgs/msg/PoseArray")(
        poses=[_transform_to_pose(transform) for transform in message.transforms]
    )
    if message.transforms:
        poses.header = message.transforms[0].header
    return poses


def _pose_to_transform(pose: Any) -> Any:
    position = pose.position
    translation = get_message("geometry_msgs/msg/Vector3")(x=position.x, y=position.y, z=position.z)
    transform = get_message("geometry_msgs/msg/Transform")(translation=translation, rotation=pose.orientation)
    return get_message("geometry_msgs/msg/TransformStamped")(transform=transform)


def _pose_stamped_to_transform(message: Any) -> Any:
    transform = _pose_to_transform(message.pose)
    transform.header = message.header
    return transform


def _poses_to_transforms(message: Any) -> Any:
    transforms = [_pose_to_transform(pose) for pose in message.poses]
    for transform in transforms:
        transform.header = message.header
    return get_message("tf2_msgs/msg/TFMessage")(transforms=transforms)


_POSE_CONVERSIONS: dict[tuple[str, str], Conversion] = {
    ("geometry_msgs/msg/TransformStamped", "geometry_msgs/msg/Pose"): _transform_to_pose,
    ("geometry_msgs/msg/Pose", "geometry_msgs/msg/TransformStamped"): _pose_to_transform,
    ("geometry_msgs/msg/TransformStamped", "geometry_msgs/msg/PoseStamped"): _transform_to_pose_stamped,
    ("geometry_msgs/msg/PoseStamped", "geometry_msgs/msg/TransformStamped"): _pose_stamped_to_transform,
    ("tf2_msgs/msg/TFMessage", "geometry_msgs/msg/PoseArray"): _transforms_to_poses,
    ("geometry_msgs/msg/PoseArray", "tf2_msgs/msg/TFMessage"): _poses_to_transforms,
}
