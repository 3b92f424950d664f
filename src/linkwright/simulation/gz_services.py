"""The services of gz that a simulator offers below ``/world/NAME``.

Source: gz-sim (names, types of gz) and ros_gz_bridge (types of ROS).
"""

from __future__ import annotations

from typing import Any, NamedTuple


class GzService(NamedTuple):
    """A service of gz.

    Attributes:
        name: the last part of its name.
        ros_type: the type of the service in ROS.
        gz_type: the type of the request in gz. The response is a ``gz.msgs.Boolean``.
    """

    name: str
    ros_type: str
    gz_type: str


CONTROL = GzService("control", "ros_gz_interfaces/srv/ControlWorld", "gz.msgs.WorldControl")
CREATE = GzService("create", "ros_gz_interfaces/srv/SpawnEntity", "gz.msgs.EntityFactory")
REMOVE = GzService("remove", "ros_gz_interfaces/srv/DeleteEntity", "gz.msgs.Entity")
SET_POSE = GzService("set_pose", "ros_gz_interfaces/srv/SetEntityPose", "gz.msgs.Pose")

WORLD_SERVICES = (CONTROL, CREATE, REMOVE, SET_POSE)
"""The services of a world."""


def remove_pose(factory: Any) -> None:
    """Mark the pose of an ``EntityFactory`` as absent: its quaternion consists of zeros, as in an empty message of gz.

    In ROS a message always has its fields, and the default of this one is a pose at the origin.
    """
    factory.pose.orientation.w = 0.0


def has_pose(factory: Any) -> bool:
    """Return whether an ``EntityFactory`` has a pose, which replaces the pose of the model."""
    orientation = factory.pose.orientation
    return any((orientation.x, orientation.y, orientation.z, orientation.w))
