"""An arm and messages about it; for tests."""

from __future__ import annotations

from typing import Any

from linkwright.messages import get_message
from linkwright.rviz import RvizConfig

ARM = """\
<robot name="arm">
  <link name="base"><visual><geometry><box size="0.4 0.4 0.2"/></geometry>
    <material name="grey"><color rgba="0.5 0.5 0.5 1"/></material></visual></link>
  <link name="upper"><visual><origin xyz="0 0 0.5"/><geometry><cylinder radius="0.1" length="1"/></geometry></visual>
    <collision><geometry><box size="0.2 0.2 1"/></geometry></collision></link>
  <link name="hand"><visual><geometry><sphere radius="0.1"/></geometry></visual></link>
  <link name="tip"/>
  <joint name="shoulder" type="revolute"><parent link="base"/><child link="upper"/><axis xyz="0 1 0"/>
    <limit lower="-3" upper="3" effort="1" velocity="1"/></joint>
  <joint name="wrist" type="prismatic"><parent link="upper"/><child link="hand"/><origin xyz="0 0 1"/>
    <axis xyz="0 0 1"/><limit lower="0" upper="1" effort="1" velocity="1"/></joint>
  <joint name="fixed" type="fixed"><parent link="hand"/><child link="tip"/></joint>
</robot>
"""

Pose = get_message("geometry_msgs/msg/Pose")
SolidPrimitive = get_message("shape_msgs/msg/SolidPrimitive")
CollisionObject = get_message("moveit_msgs/msg/CollisionObject")
AttachedCollisionObject = get_message("moveit_msgs/msg/AttachedCollisionObject")
DisplayTrajectory = get_message("moveit_msgs/msg/DisplayTrajectory")
JointTrajectoryPoint = get_message("trajectory_msgs/msg/JointTrajectoryPoint")
ObjectColor = get_message("moveit_msgs/msg/ObjectColor")
PlanningScene = get_message("moveit_msgs/msg/PlanningScene")
RobotState = get_message("moveit_msgs/msg/RobotState")
RobotTrajectory = get_message("moveit_msgs/msg/RobotTrajectory")


def make_config(cls: str, extra: str = "") -> RvizConfig:
    """Return a file with one display of moveit_rviz_plugin."""
    return RvizConfig.parse(
        "Visualization Manager:\n  Global Options: {Fixed Frame: base}\n  Displays:\n"
        f"    - {{Class: moveit_rviz_plugin/{cls}, Enabled: true, Name: {cls}{extra}}}\n"
    )


def make_pose(x: float = 0.0, y: float = 0.0, z: float = 0.0) -> Any:
    message = Pose()
    message.position.x, message.position.y, message.position.z = x, y, z
    return message


def make_robot_state(**positions: float) -> Any:
    """Return a RobotState; without joints it is a diff."""
    message = RobotState(is_diff=not positions)
    message.joint_state.name = list(positions)
    message.joint_state.position = [float(position) for position in positions.values()]
    return message


def make_primitive(kind: int, *dimensions: float) -> Any:
    return SolidPrimitive(type=kind, dimensions=[float(dimension) for dimension in dimensions])


def make_collision_object(
    name: str, *primitives: Any, frame: str = "base", object_pose: Any = None, operation: bytes = b"\x00"
) -> Any:
    """Return a CollisionObject, by default a box of one meter."""
    message = CollisionObject(id=name, operation=operation, pose=object_pose or make_pose())
    message.header.frame_id = frame
    if operation in (b"\x00", b"\x02"):
        message.primitives = list(primitives) or [make_primitive(SolidPrimitive.BOX, 1, 1, 1)]
    return message


def make_scene(*objects: Any, robot: Any = None, diff: bool = False, **fields: Any) -> Any:
    message = PlanningScene(is_diff=diff, robot_state=robot or make_robot_state(), **fields)
    message.world.collision_objects = list(objects)
    return message


def make_attached_object(link: str, held: Any) -> Any:
    return AttachedCollisionObject(link_name=link, object=held)


def make_trajectory(*angles: float, seconds: float = 0.1) -> Any:
    """Return a DisplayTrajectory of the shoulder.

    The wrist is off by half a meter from the start.
    """
    part = RobotTrajectory()
    part.joint_trajectory.joint_names = ["shoulder"]
    for number, angle in enumerate(angles, start=1):
        point = JointTrajectoryPoint(positions=[angle])
        nanoseconds = round(number * seconds * 1e9)
        point.time_from_start.sec, point.time_from_start.nanosec = divmod(nanoseconds, 1_000_000_000)
        part.joint_trajectory.points.append(point)
    return DisplayTrajectory(trajectory=[part], trajectory_start=make_robot_state(shoulder=0.0, wrist=0.5))


def as_signed_bytes(data: bytes) -> list[int]:
    """Return bytes in the form of an Octomap."""
    return [byte - 256 if byte > 127 else byte for byte in data]
