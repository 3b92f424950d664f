"""A robot laid out for computing: its bodies, the constants between them, and its mimic joints.

Links joined by fixed joints move as one. So only moving joints matter: each carries a body, whose own frame is at the
joint with z along the joint's axis. Then a joint turns its body about z or slides it along z, whatever its axis is:

    body in root = parent body in root * mount * turn or slide
    link in root = body in root * offset
"""

from __future__ import annotations

from collections.abc import Collection, Mapping

import numpy as np
from numpy.typing import NDArray

from linkwright.geometry.arrays import Array, matrix_from_pose, row_from_pose
from linkwright.loading.lean_dataclasses import dataclass
from linkwright.urdf import Joint, Robot, children_of, parent_joints

Indices = NDArray[np.intp]

_TURNING = ("revolute", "continuous")
MOVING = (*_TURNING, "prismatic")


@dataclass(frozen=True, slots=True)
class Layout:
    """Bodies in the order of their depth, the root's first; links in the order of theirs.

    Attributes:
        link_names: every link that hangs from the root, parents before children.
        body_joints: the joint of each body but the root's.
        parents: index of each body's parent body, the root's body being 0; shape (bodies,).
        depths: how many moving joints are above each body; shape (bodies,).
        slides: whether the body slides (else it turns); shape (bodies,).
        mounts: from the parent body's frame to the joint, its axis along z; shape (bodies, 4, 4).
        link_bodies: the body of each link; shape (links,).
        offsets: from the body's frame to the link's; shape (links, 4, 4).
    """

    link_names: tuple[str, ...]
    body_joints: tuple[Joint, ...]
    parents: Indices
    depths: Indices
    slides: NDArray[np.bool_]
    mounts: Array
    link_bodies: Indices
    offsets: Array


def lay_out(robot: Robot) -> Layout:
    """Return the layout of a robot, without links that are not below its root."""
    children, above = children_of(robot), parent_joints(robot)
    link_names = [robot.root]
    link_bodies = [0]
    offsets = [np.eye(4)]
    body_joints: list[Joint | None] = [None]
    parents, depths, mounts = [0], [0], [np.eye(4)]
    # A queue: parents come before children and, level by level, bodies in the order of their depth in the link tree.
    at = 0
    while at < len(link_names):
        for joint in children[link_names[at]]:
            if above[joint.child] is not joint:
                continue  # a second parent, which urdfdom forgets
            body = link_bodies[at]
            to_joint = offsets[at] @ matrix_from_pose(row_from_pose(joint.origin))
            align = _align_z(joint.axis) if joint.type in MOVING else None
            if align is None:
                link_bodies.append(body)
                offsets.append(to_joint)
            else:
                link_bodies.append(len(body_joints))
                offsets.append(align.T)
                body_joints.append(joint)
                parents.append(body)
                depths.append(depths[body] + 1)
                mounts.append(to_joint @ align)
            link_names.append(joint.child)
        at += 1
    order = np.argsort(depths, kind="stable")
    place = np.empty_like(order)
    place[order] = np.arange(len(order))
    joints = tuple(joint for body in order if (joint := body_joints[body]) is not None)
    return Layout(
        tuple(link_names),
        joints,
        place[np.array(parents)[order]],
        np.array(depths)[order],
        np.array([False, *(joint.type == "prismatic" for joint in joints)]),
        np.array(mounts)[order],
        place[np.array(link_bodies)],
        np.array(offsets),
    )


def _align_z(axis: tuple[float, float, float]) -> Array | None:
    """A homogeneous matrix that turns z into the axis; None for a zero axis, about which nothing moves."""
    length = np.linalg.norm(axis)
    if not length > 0:
        return None
    z = np.array(axis) / length
    # Any x across z will do; the coordinate axis farthest from z keeps rotations between coordinate axes exact.
    x = np.cross(np.eye(3)[np.argmin(np.abs(z))], z)
    x /= np.linalg.norm(x)
    matrix = np.eye(4)
    matrix[:3, :3] = np.column_stack((x, np.cross(z, x), z))
    return matrix


@dataclass(frozen=True, slots=True)
class Following:
    """A mimic joint: position = factor * position of `leader` + offset; a free joint is its own leader."""

    leader: str
    factor: float = 1.0
    offset: float = 0.0


def resolve_mimics(robot: Robot, moving: Collection[str]) -> tuple[tuple[str, ...], Mapping[str, Following]]:
    """Follow each chain of mimics to its end.

    Args:
        robot: the robot.
        moving: the names of the joints that move.

    Returns:
        The moving joints that have a position of their own, in the order of the file, and what each moving joint
        follows. A joint whose chain goes in a circle or to a joint that does not exist moves by itself.
    """
    following: dict[str, Following] = {}
    for name in robot.joints:
        if name in moving:
            following[name] = _follow(name, robot)
    return tuple(name for name, how in following.items() if how.leader == name), following


def _follow(name: str, robot: Robot) -> Following:
    leader, factor, offset = name, 1.0, 0.0
    seen = {name}
    while (mimic := robot.joints[leader].mimic) is not None:
        if mimic.joint in seen or mimic.joint not in robot.joints:
            return Following(name)
        seen.add(mimic.joint)
        leader = mimic.joint
        offset += factor * mimic.offset
        factor *= mimic.multiplier
    return Following(leader, factor, offset)
