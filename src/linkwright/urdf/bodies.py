"""Rigid bodies, each consisting of links that fixed joints connect.

Simulators merge such links, so another link of the body may provide the shapes or the mass that a link lacks.
"""

from __future__ import annotations

from collections.abc import Mapping
from functools import cached_property

from linkwright.geometry.shapes import IDENTITY, Placement, placement
from linkwright.loading.lean_dataclasses import dataclass
from linkwright.urdf.model import Joint, Link, Robot

WORLD = "world"
"""Links that are fixed to this link never move, and their masses do not matter."""


@dataclass(frozen=True, slots=True, eq=False)
class Body:
    """Links that move together as one body.

    Attributes:
        joint: the joint that moves the body, or None for the body of the robot's root.
        frames: the placements of the links in the frame of the body's first link, by link name.
    """

    joint: Joint | None
    frames: dict[str, Placement]

    @property
    def links(self) -> tuple[str, ...]:
        """The names of the body's links, starting with the link that the joint moves."""
        return tuple(self.frames)


class Bodies:
    """The bodies of a robot, or no bodies if there is no robot."""

    def __init__(self, robot: Robot | None) -> None:
        self._robot = robot
        self._masses: dict[Body, float] = {}

    @cached_property
    def all(self) -> tuple[Body, ...]:
        """All bodies, starting with the body of the root."""
        return tuple(dict.fromkeys(self._bodies_by_link.values()))

    def of(self, link: str) -> Body | None:
        """Return the body that contains a link, or None if there is none."""
        return self._bodies_by_link.get(link)

    def members(self, body: Body) -> list[Link]:
        """Return the links of a body."""
        assert self._robot is not None, "there are bodies only where there is a robot"
        return [self._robot.links[name] for name in body.frames]

    def turns(self, link: str) -> bool:
        """Return whether a link's body can rotate.

        The body cannot rotate if only prismatic joints connect it to the link `WORLD`.
        """
        body = self._bodies_by_link.get(link)
        while body is not None and body.joint is not None:
            if body.joint.type != "prismatic":
                return True
            body = self._bodies_by_link.get(body.joint.parent)
        return body is None or WORLD not in body.frames

    def includes_massless_links(self, link: Link) -> bool:
        """Return whether a link's mass may include massless links with shapes that are fixed to it."""
        return link.name in self._links_including_massless

    def mass(self, body: Body) -> float:
        """Return the sum of the positive masses of a body's links in kg, computed only once."""
        if body not in self._masses:
            inertials = [link.inertial for link in self.members(body)]
            self._masses[body] = sum(
                inertial.mass for inertial in inertials if inertial is not None and inertial.mass > 0
            )
        return self._masses[body]

    @cached_property
    def _links_including_massless(self) -> frozenset[str]:
        """The names of links with mass whose neighbors include a massless link with a shape.

        Neighbors are connected by fixed joints, possibly through massless links without a shape.
        """
        links = self._robot.links if self._robot is not None else {}
        neighbors: dict[str, list[str]] = {name: [] for name in links}
        for joint in self._robot.joints.values() if self._robot is not None else ():
            if joint.type == "fixed" and joint.parent in links and joint.child in links:
                neighbors[joint.parent].append(joint.child)
                neighbors[joint.child].append(joint.parent)
        massless_links = {name for name, link in links.items() if not _has_mass(link)}
        names: set[str] = set()
        visited: set[str] = set()
        for name in massless_links:
            if name in visited:
                continue
            visited.add(name)
            group = [name]
            for member in group:
                unvisited = [
                    neighbor for neighbor in neighbors[member] if neighbor in massless_links and neighbor not in visited
                ]
                visited.update(unvisited)
                group += unvisited
            if any(links[item].visuals or links[item].collisions for item in group):
                names.update(other for item in group for other in neighbors[item] if other not in massless_links)
        return frozenset(names)

    @cached_property
    def _bodies_by_link(self) -> Mapping[str, Body]:
        robot = self._robot
        if robot is None:
            return {}
        joints_by_parent: dict[str, list[Joint]] = {}
        for joint in robot.joints.values():
            joints_by_parent.setdefault(joint.parent, []).append(joint)
        origin_placement = Placement(IDENTITY, (0.0, 0.0, 0.0))
        bodies: dict[str, Body] = {robot.root: Body(None, {robot.root: origin_placement})}
        pending = [robot.root]
        for name in pending:
            body = bodies[name]
            for joint in joints_by_parent.get(name, ()):
                if joint.child in bodies or joint.child not in robot.links:
                    continue
                if joint.type == "fixed":
                    body.frames[joint.child] = placement(joint.origin).inside(body.frames[name])
                    bodies[joint.child] = body
                else:
                    bodies[joint.child] = Body(joint, {joint.child: origin_placement})
                pending.append(joint.child)
        return bodies


def _has_mass(link: Link) -> bool:
    return link.inertial is not None and link.inertial.mass > 0
