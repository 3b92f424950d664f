"""geometry_msgs: vectors, rotations, poses and transforms. Metres; quaternions are x, y, z, w of unit length."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import ClassVar

from linkwright.messages.standard import Header


@dataclass(slots=True)
class Vector3:
    """A direction or a displacement; it has no origin."""

    TYPE_NAME: ClassVar[str] = "geometry_msgs/msg/Vector3"

    x: float = 0.0
    y: float = 0.0
    z: float = 0.0


@dataclass(slots=True)
class Point:
    """A position in space."""

    TYPE_NAME: ClassVar[str] = "geometry_msgs/msg/Point"

    x: float = 0.0
    y: float = 0.0
    z: float = 0.0


@dataclass(slots=True)
class Quaternion:
    """A rotation; no rotation by default."""

    TYPE_NAME: ClassVar[str] = "geometry_msgs/msg/Quaternion"

    x: float = 0.0
    y: float = 0.0
    z: float = 0.0
    w: float = 1.0


@dataclass(slots=True)
class Pose:
    """Position and orientation."""

    TYPE_NAME: ClassVar[str] = "geometry_msgs/msg/Pose"

    position: Point = field(default_factory=Point)
    orientation: Quaternion = field(default_factory=Quaternion)


@dataclass(slots=True)
class Transform:
    """Translation, then rotation: the pose of a child frame in its parent frame."""

    TYPE_NAME: ClassVar[str] = "geometry_msgs/msg/Transform"

    translation: Vector3 = field(default_factory=Vector3)
    rotation: Quaternion = field(default_factory=Quaternion)


@dataclass(slots=True)
class TransformStamped:
    """The pose of `child_frame_id` in `header.frame_id` at `header.stamp`."""

    TYPE_NAME: ClassVar[str] = "geometry_msgs/msg/TransformStamped"

    header: Header = field(default_factory=Header)
    child_frame_id: str = ""
    transform: Transform = field(default_factory=Transform)
