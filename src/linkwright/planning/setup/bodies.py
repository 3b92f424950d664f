"""The rigid bodies of a robot: links that fixed joints connect move as one.

Groups are searched for in the tree of these bodies, in which every joint moves.
"""

from __future__ import annotations

from dataclasses import dataclass
from itertools import pairwise

import numpy as np

from linkwright.geometry.arrays import Array, matrix_from_pose, row_from_pose
from linkwright.kinematics.tree import MOVING_TYPES
from linkwright.urdf import Joint, Robot, children_of, parent_joints


@dataclass(frozen=True, slots=True)
class Body:
    """Links that move as one.

    Attributes:
        links: the links, parents before children; the joint moves the first one.
        joint: the joint that moves the body, or None for the body of the root link.
        parent: the index of the parent body; 0 for the root body.
        children: the indexes of the bodies that joints move relative to this one.
        depths: the number of fixed joints between each link and the first link.
        positions: the position of each link and child joint in the frame of the first link, in m, by name.
    """

    links: tuple[str, ...]
    joint: Joint | None
    parent: int
    children: tuple[int, ...]
    depths: dict[str, int]
    positions: dict[str, Array]

    @property
    def is_active(self) -> bool:
        """Whether the joint has a position of its own."""
        return self.joint is not None and self.joint.mimic is None

    @property
    def joint_name(self) -> str:
        """The name of the joint; empty for the root body."""
        return "" if self.joint is None else self.joint.name


def find_bodies(robot: Robot) -> list[Body]:
    """Return the bodies of a robot, parents before children, starting with the body of the root link.

    Links behind joints that move in several directions (``floating``, ``planar``) are left out.
    """
    children, parents = children_of(robot), parent_joints(robot)
    starts: list[tuple[str, Joint | None, int]] = [(robot.root, None, 0)]
    found: list[tuple[list[str], Joint | None, int, dict[str, int], dict[str, Array]]] = []
    numbers: dict[int, list[int]] = {}
    while len(found) < len(starts):
        number = len(found)
        first, moving_joint, parent = starts[number]
        links, depths, frames = [first], {first: 0}, {first: np.eye(4)}
        positions: dict[str, Array] = {first: np.zeros(3)}
        for link in links:
            for joint in children[link]:
                if parents[joint.child] is not joint:
                    continue  # Like urdfdom, ignore a second parent.
                frame = frames[link] @ matrix_from_pose(row_from_pose(joint.origin))
                if joint.type == "fixed" or (joint.type in MOVING_TYPES and not any(joint.axis)):
                    links.append(joint.child)
                    depths[joint.child], frames[joint.child] = depths[link] + 1, frame
                    positions[joint.child] = frame[:3, 3]
                elif joint.type in MOVING_TYPES:
                    positions[joint.name] = frame[:3, 3]
                    numbers.setdefault(number, []).append(len(starts))
                    starts.append((joint.child, joint, number))
        found.append((links, moving_joint, parent, depths, positions))
    return [
        Body(tuple(links), joint, parent, tuple(numbers.get(number, ())), depths, positions)
        for number, (links, joint, parent, depths, positions) in enumerate(found)
    ]


def count_active_joints(bodies: list[Body]) -> list[int]:
    """Return for each body how many joints with a position of their own it and the bodies below it have."""
    counts = [int(body.is_active) for body in bodies]
    for number in range(len(bodies) - 1, 0, -1):
        counts[bodies[number].parent] += counts[number]
    return counts


def bodies_below(bodies: list[Body], number: int) -> list[int]:
    """Return the indexes of a body and of all bodies below it, parents before children."""
    found = [number]
    for index in found:
        found += bodies[index].children
    return sorted(found)


def branch_length(bodies: list[Body], number: int) -> float:
    """Return the length in m of the longest chain that starts with the joint of a body.

    It is the sum of the distances between joints, the ranges of prismatic joints, and the distance of the farthest
    link of the last body.
    """
    lengths: dict[int, float] = {}
    for index in reversed(bodies_below(bodies, number)):
        body = bodies[index]
        own = max(float(np.linalg.norm(body.positions[link])) for link in body.links)
        below = (
            float(np.linalg.norm(body.positions[bodies[child].joint_name])) + lengths[child] for child in body.children
        )
        lengths[index] = max(own, *below) if body.children else own
        lengths[index] += travel(body.joint)
    return lengths[number]


def travel(joint: Joint | None) -> float:
    """Return the range of a prismatic joint in m, or 0 for another joint."""
    if joint is None or joint.type != "prismatic" or joint.limit is None:
        return 0.0
    return max(joint.limit.upper - joint.limit.lower, 0.0)


def chain_length(bodies: list[Body], chain: list[int]) -> float:
    """Return the length in m from the first joint of a chain of bodies to the last link of the chain."""
    length = sum(travel(bodies[number].joint) for number in chain)
    for parent, child in pairwise(chain):
        length += float(np.linalg.norm(bodies[parent].positions[bodies[child].joint_name]))
    last = bodies[chain[-1]]
    return length + max(float(np.linalg.norm(position)) for position in last.positions.values())
