"""Links that fixed joints make one rigid body.

Simulators merge such links, so what a link lacks another of its body may have.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from functools import cached_property

from linkwright.geometry.placement import IDENTITY, Placement, placement
from linkwright.urdf.model import Joint, Link, Robot


@dataclass(frozen=True, slots=True, eq=False)
class Body:
    """Links that move as one.

    Attributes:
        joint: the joint that moves it; None for the body of the robot's root.
        frames: link -> its frame in the frame of the body's first link.
    """

    joint: Joint | None
    frames: dict[str, Placement]

    @property
    def links(self) -> tuple[str, ...]:
        """The names of its links, the one that the joint moves first."""
        return tuple(self.frames)


class Bodies:
    """The bodies of a robot; none without one."""

    def __init__(self, robot: Robot | None) -> None:
        self._robot = robot

    @cached_property
    def all(self) -> tuple[Body, ...]:
        """The bodies, that of the root first."""
        return tuple(dict.fromkeys(self._by_link.values()))

    def of(self, link: str) -> Body | None:
        """The body of a link."""
        return self._by_link.get(link)

    def members(self, body: Body) -> list[Link]:
        """The links of a body."""
        assert self._robot is not None, "there are bodies only where there is a robot"
        return [self._robot.links[name] for name in body.frames]

    def stands_for_others(self, link: Link) -> bool:
        """Whether a link's mass may be that of links fixed to it: one of them has shapes and no mass of its own."""
        body = self.of(link.name)
        others = () if body is None else (each for each in self.members(body) if each is not link)
        return any((each.visuals or each.collisions) and not _has_mass(each) for each in others)

    def mass(self, body: Body) -> float:
        """The positive masses of a body's links together, in kg."""
        inertials = [link.inertial for link in self.members(body)]
        return sum(inertial.mass for inertial in inertials if inertial is not None and inertial.mass > 0)

    @cached_property
    def _by_link(self) -> Mapping[str, Body]:
        robot = self._robot
        if robot is None:
            return {}
        below: dict[str, list[Joint]] = {}
        for joint in robot.joints.values():
            below.setdefault(joint.parent, []).append(joint)
        start = Placement(IDENTITY, (0.0, 0.0, 0.0))
        bodies: dict[str, Body] = {robot.root: Body(None, {robot.root: start})}
        waiting = [robot.root]
        for name in waiting:
            body = bodies[name]
            for joint in below.get(name, ()):
                if joint.child in bodies or joint.child not in robot.links:
                    continue
                if joint.type == "fixed":
                    body.frames[joint.child] = placement(joint.origin).inside(body.frames[name])
                    bodies[joint.child] = body
                else:
                    bodies[joint.child] = Body(joint, {joint.child: start})
                waiting.append(joint.child)
        return bodies


def _has_mass(link: Link) -> bool:
    return link.inertial is not None and link.inertial.mass > 0
