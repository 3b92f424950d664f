"""Mimic joints: which joint each one follows in the end, and how."""

from __future__ import annotations

from collections.abc import Collection, Mapping
from dataclasses import dataclass

from linkwright.urdf import Robot


@dataclass(frozen=True, slots=True)
class Following:
    """Position = factor * position of `leader` + offset; a joint that moves by itself is its own leader."""

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
