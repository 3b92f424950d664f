"""The initial view of a world: the camera in its file, or a view of its robots."""

from __future__ import annotations

from math import isfinite

from linkwright.geometry.single import Pose, Transform
from linkwright.sdf.frames import transform_of
from linkwright.sdf.models import Model
from linkwright.sdf.worlds import World
from linkwright.xmltree import Element

_MIN_MOVING_JOINTS = 2
"""A model with at least this many moving joints is a robot. A model with fewer joints can be a door."""
_POSE_LENGTH = 6


def find_camera(world: World) -> Transform | None:
    """Return the pose of the camera that a world's file sets, in the world frame, or None.

    The camera looks along its x axis. Gazebo classic reads ``<gui><camera><pose>``; gz reads the ``<camera_pose>`` of
    the GUI plugin that renders. The result is None if the world has neither, or if the pose does not have six
    numbers.
    """
    gui = world.element.first("gui") if world.element is not None else None
    if gui is None:
        return None
    poses = [pose for camera in gui.elements("camera") for pose in camera.elements("pose")]
    poses += [pose for plugin in gui.elements("plugin") for pose in plugin.elements("camera_pose")]
    return _parse_pose(poses[0]) if poses else None


def find_robots(world: World) -> list[str]:
    """Return the names of the models that count as robots.

    These models are not static, and have sensors, plugins or at least two moving joints.
    """
    return [model.name for model in world.models if not model.static and _is_robot(model)]


def _parse_pose(element: Element) -> Transform | None:
    try:
        numbers = [float(token) for token in element.text().split()]
    except ValueError:
        return None
    if len(numbers) != _POSE_LENGTH or not all(map(isfinite, numbers)):
        return None
    x, y, z, roll, pitch, yaw = numbers
    return transform_of(Pose((x, y, z), (roll, pitch, yaw)))


def _is_robot(model: Model) -> bool:
    moving_joints = sum(joint.type != "fixed" for joint in model.joints)
    has_sensors = any(link.sensors for link in model.links)
    return (
        bool(model.plugins) or has_sensors or moving_joints >= _MIN_MOVING_JOINTS or any(map(_is_robot, model.models))
    )
