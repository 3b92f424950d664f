"""The rigid bodies of a robot: links that fixed joints connect, and their poses.

Source: libsdformat's parser of URDF, which merges links that fixed joints connect.
"""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Callable
from dataclasses import dataclass, field

from linkwright.geometry.single import IDENTITY, Pose, Transform, compose
from linkwright.sdf.frames import pose_of, transform_of
from linkwright.sdf.poses import WORLD
from linkwright.urdf import Robot
from linkwright.urdf.model import Joint, Link


@dataclass(frozen=True, slots=True)
class Part:
    """A link of a body, and the link's pose in the body.

    Attributes:
        link: the link of the robot.
        pose: the pose of the link's frame in the frame of the body.
        joint: the fixed joint that attaches the link; None for the link that names the body.
    """

    link: Link
    pose: Transform = IDENTITY
    joint: Joint | None = None


@dataclass(slots=True)
class Body:
    """Links connected by fixed joints.

    Attributes:
        parts: the link that names the body, then the links that are attached to it by fixed joints.
        joint: the joint that connects the body to its parent; None for the root.
        parent: the name of the parent body: ``world`` if it is the world, and empty for the root.
        pose: the pose of the connecting joint in the frame of the parent body.
        children: the child bodies.
    """

    parts: list[Part]
    joint: Joint | None = None
    parent: str = ""
    pose: Pose = field(default_factory=Pose)
    children: list[Body] = field(default_factory=list)

    @property
    def name(self) -> str:
        """The name of the SDF link that represents the body."""
        return self.parts[0].link.name


def find_rigid_bodies(robot: Robot, is_lumped: Callable[[Joint], bool]) -> list[Body]:
    """Return the bodies of a robot, parents before children.

    Children are ordered by joint name, as in gz.

    Args:
        robot: the robot; a root link called ``world`` represents the world.
        is_lumped: returns whether a fixed joint merges its child link into the body of its parent.
    """
    child_joints: dict[str, list[Joint]] = defaultdict(list)
    for joint in robot.joints.values():
        child_joints[joint.parent].append(joint)
    root = Body([Part(robot.links[robot.root])])
    bodies_by_link: dict[str, tuple[Body, Part]] = {robot.root: (root, root.parts[0])}
    bodies = [] if robot.root == WORLD else [root]
    pending = _sort_in_reverse(child_joints[robot.root])
    while pending:
        joint = pending.pop()
        link = robot.links[joint.child]
        body, parent_link = bodies_by_link[joint.parent]
        origin = joint.origin
        if parent_link.joint is not None:
            origin = pose_of(compose(parent_link.pose, transform_of(origin)))
        if body.name != WORLD and is_lumped(joint):
            part = Part(link, transform_of(origin), joint)
            body.parts.append(part)
        else:
            part = Part(link)
            child_body = Body([part], joint, body.name, origin)
            body.children.append(child_body)
            bodies.append(child_body)
            body = child_body
        bodies_by_link[link.name] = body, part
        pending += _sort_in_reverse(child_joints[link.name])
    return bodies


def _sort_in_reverse(joints: list[Joint]) -> list[Joint]:
    """Return joints sorted by name in reverse, because the caller pops them from the end."""
    return sorted(joints, key=lambda joint: joint.name, reverse=True)
