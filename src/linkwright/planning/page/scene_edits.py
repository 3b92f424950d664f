"""Changes of the planning scene that the panel requests, as messages."""

from __future__ import annotations

import math
from collections.abc import Iterable, Sequence
from typing import Any

from linkwright.geometry.single import IDENTITY, Transform, compose, invert, quaternion_from_rpy, rpy_from_quaternion
from linkwright.messages import get_message
from linkwright.page.protocol.motion_planning import (
    AddSceneObject,
    AttachSceneObject,
    MoveSceneObject,
    ObjectShape,
    PlanningObject,
    RemoveSceneObject,
)
from linkwright.planning.page.move_group import make_pose
from linkwright.rviz.displays.moveit.robot import PosableRobot
from linkwright.rviz.displays.moveit.scene import Scene, SceneObject
from linkwright.rviz.markers.shapes import pose_to_values
from linkwright.urdf import Robot

_ADD, _REMOVE, _MOVE = b"\x00", b"\x01", b"\x03"
_SHAPES: dict[ObjectShape, tuple[int, int]] = {"box": (1, 3), "sphere": (2, 1), "cylinder": (3, 2), "cone": (4, 2)}
"""The number of each shape in shape_msgs/msg/SolidPrimitive, and how many sizes it has."""

_MAX_NAME_LENGTH = 200
_PLACE_X, _PLACE_Z = 0.5, 0.25
"""The place of a new object in front of the robot, as shares of its reach."""

SceneRequest = AddSceneObject | MoveSceneObject | RemoveSceneObject | AttachSceneObject
SCENE_REQUESTS = (AddSceneObject, MoveSceneObject, RemoveSceneObject, AttachSceneObject)


def describe_objects(scene: Scene) -> list[PlanningObject]:
    """Return the objects of a planning scene for the panel, sorted by name."""
    items = [(name, "", item) for name, item in scene.objects.items()]
    items += [(name, link, item) for name, (link, item) in scene.attached.items()]
    return [_describe(*item) for item in sorted(items, key=lambda item: item[0])]


def make_differences(request: SceneRequest, scene: Scene, robot: PosableRobot, arm_joints: Iterable[str]) -> list[Any]:
    """Return the scene differences (moveit_msgs/msg/PlanningScene) for a request; none if it is not valid.

    Args:
        request: the request of the panel.
        scene: the planning scene.
        robot: the robot.
        arm_joints: the joints of arms. Links that no such joint separates from the link of an attached object, such as
            those of a gripper, may touch it.
    """
    if isinstance(request, AddSceneObject):
        reach = max(robot.compute_reach(link) for link in robot.link_names)
        position = (_PLACE_X * reach, 0.0, _PLACE_Z * reach)
        difference = make_added_object(request, robot.frame_of(scene.state), position)
    elif isinstance(request, MoveSceneObject):
        difference = make_moved_object(request, scene)
    elif isinstance(request, RemoveSceneObject):
        return make_removed_object(request.name, scene)
    else:
        touched = find_links_around(robot.description, request.link, arm_joints) if request.link else ()
        is_known = not request.link or robot.has_link(request.link)
        difference = make_attached_object(request.name, request.link, scene, touched) if is_known else None
    return [] if difference is None else [difference]


def make_added_object(request: AddSceneObject, frame: str, position: Sequence[float]) -> Any:
    """Return the scene difference that adds an object, or None if the request is not valid.

    Args:
        request: the request.
        frame: the frame of the object.
        position: x, y, z in `frame`, in meters.
    """
    number, count = _SHAPES[request.shape]
    is_valid = len(request.size) == count and all(math.isfinite(size) and size > 0.0 for size in request.size)
    if not is_valid or not 0 < len(request.name) <= _MAX_NAME_LENGTH:
        return None
    primitive = get_message("shape_msgs/msg/SolidPrimitive")(type=number, dimensions=list(request.size))
    added = _make_object(request.name, frame, _ADD)
    x, y, z = position
    added.pose = make_pose((x, y, z, 0.0, 0.0, 0.0, 1.0))
    added.primitives, added.primitive_poses = [primitive], [make_pose(IDENTITY)]
    return _make_difference(added)


def make_moved_object(request: MoveSceneObject, scene: Scene) -> Any:
    """Return the scene difference that moves an object, or None if the request is not valid."""
    scene_object = scene.objects.get(request.name)
    numbers = [*request.position, *request.rpy]
    if scene_object is None or len(request.position) != 3 or len(numbers) != 6 or not all(map(math.isfinite, numbers)):
        return None
    x, y, z, roll, pitch, yaw = numbers
    return place_object(scene_object, (x, y, z, *quaternion_from_rpy((roll, pitch, yaw))))


def place_object(scene_object: SceneObject, target: Transform) -> Any:
    """Return the scene difference that moves an object so that its first shape has a pose in its frame."""
    moved = _make_object(scene_object.id, scene_object.frame, _MOVE)
    moved.pose = make_pose(compose(target, invert(_find_offset(scene_object))))
    return _make_difference(moved)


def find_object_pose(scene_object: SceneObject) -> Transform:
    """Return the pose of the first shape of an object in the frame of the object."""
    return compose(_to_transform(scene_object.pose), _find_offset(scene_object))


def make_removed_object(name: str, scene: Scene) -> list[Any]:
    """Return the scene differences that remove an object: an attached object is first detached."""
    removed = _make_difference(_make_object(name, "", _REMOVE))
    if name in scene.attached:
        return [_make_difference(attached=_make_attached(name, "", _REMOVE)), removed]
    return [removed] if name in scene.objects else []


def make_attached_object(name: str, link: str, scene: Scene, touched: Iterable[str]) -> Any:
    """Return the scene difference that attaches an object to a link, or detaches it if the link is empty, or None.

    Args:
        name: the object.
        link: the link, or an empty string.
        scene: the planning scene.
        touched: the links that the attached object may touch.
    """
    if link:
        attached = _make_attached(name, link, _ADD)
        attached.touch_links = sorted(touched)
        return _make_difference(attached=attached) if name in scene.objects else None
    return _make_difference(attached=_make_attached(name, "", _REMOVE)) if name in scene.attached else None


def find_links_around(robot: Robot, link: str, separating_joints: Iterable[str]) -> set[str]:
    """Return the links that are connected to a link without the joints of an arm, such as those of its gripper."""
    separating = set(separating_joints)
    neighbors: dict[str, list[str]] = {}
    for joint in robot.joints.values():
        if joint.name not in separating:
            neighbors.setdefault(joint.parent, []).append(joint.child)
            neighbors.setdefault(joint.child, []).append(joint.parent)
    found: set[str] = set()
    pending = [link]
    while pending:
        current = pending.pop()
        if current not in found:
            found.add(current)
            pending += neighbors.get(current, ())
    return found


def _describe(name: str, link: str, scene_object: SceneObject) -> PlanningObject:
    x, y, z, *rotation = find_object_pose(scene_object)
    qx, qy, qz, qw = rotation
    roll, pitch, yaw = rpy_from_quaternion((qx, qy, qz, qw))
    return PlanningObject(name, link, scene_object.frame or link, [x, y, z], [roll, pitch, yaw])


def _find_offset(scene_object: SceneObject) -> Transform:
    """Return the pose of the first shape in its object; programs often place the shape instead of the object."""
    poses = (*scene_object.primitive_poses, *scene_object.mesh_poses, *scene_object.plane_poses)
    return _to_transform(poses[0]) if poses else IDENTITY


def _to_transform(message: Any) -> Transform:
    x, y, z, qx, qy, qz, qw = pose_to_values(message)
    return x, y, z, qx, qy, qz, qw


def _make_object(name: str, frame: str, operation: bytes) -> Any:
    message = get_message("moveit_msgs/msg/CollisionObject")(id=name, operation=operation)
    message.header.frame_id = frame
    return message


def _make_attached(name: str, link: str, operation: bytes) -> Any:
    message = get_message("moveit_msgs/msg/AttachedCollisionObject")(link_name=link)
    message.object = _make_object(name, link, operation)
    return message


def _make_difference(*objects: Any, attached: Any = None) -> Any:
    scene = get_message("moveit_msgs/msg/PlanningScene")(is_diff=True)
    scene.robot_state.is_diff = True
    scene.world.collision_objects = list(objects)
    if attached is not None:
        scene.robot_state.attached_collision_objects = [attached]
    return scene
