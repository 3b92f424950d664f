"""The rigid bodies of a robot: links connected by fixed joints, and their poses in the body.

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
    """A link of a body, and its pose.

    Attributes:
        link: the link.
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
        parts: the link that names the body, then its descendants.
        joint: the joint that connects the body to its parent; None for the root.
        parent: the name of the parent body; ``world``, or empty for the root.
        pose: the pose of the joint in the parent body.
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


def bodies_of(robot: Robot, is_lumped: Callable[[Joint], bool]) -> list[Body]:
    """Return the bodies of a robot, parents before children.

    Children are ordered by joint name, as in gz.

    Args:
        robot: the robot; a root link called ``world`` represents the world.
        is_lumped: whether the child of a joint becomes a part of its parent's body.
    """
    below: dict[str, list[Joint]] = defaultdict(list)
    for joint in robot.joints.values():
        below[joint.parent].append(joint)
    root = Body([Part(robot.links[robot.root])])
    places: dict[str, tuple[Body, Part]] = {robot.root: (root, root.parts[0])}
    bodies = [] if robot.root == WORLD else [root]
    waiting = _by_name(below[robot.root])
    while waiting:
        joint = waiting.pop()
        link = robot.links[joint.child]
        body, above = places[joint.parent]
        origin = joint.origin
        if above.joint is not None:
            origin = pose_of(compose(above.pose, transform_of(origin)))
        if body.name != WORLD and is_lumped(joint):
            part = Part(link, transform_of(origin), joint)
            body.parts.append(part)
        else:
            part = Part(link)
            inner = Body([part], joint, body.name, origin)
            body.children.append(inner)
            bodies.append(inner)
            body = inner
        places[link.name] = body, part
        waiting += _by_name(below[link.name])
    return bodies


def _by_name(joints: list[Joint]) -> list[Joint]:
    """Return joints in reverse order of their names, because the caller pops them from the end."""
    return sorted(joints, key=lambda joint: joint.name, reverse=True)
