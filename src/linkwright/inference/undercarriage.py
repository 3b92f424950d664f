"""The undercarriage of a robot: wheels, casters, and the height of the ground.

All joints are at zero. Positions are in the base frame, which is that of ``base_link``, or of the root if there is no
such link. According to REP 103, x points forward in it, y to the left and z up.
"""

from __future__ import annotations

import re
from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from functools import cached_property
from math import sqrt

from linkwright.geometry.shapes import Placement, rotated
from linkwright.geometry.single import length, scaled
from linkwright.inertia import MeshLibrary, estimate
from linkwright.inference.model import Wheel
from linkwright.inference.shapes import Shape, lowest, round_shape, shapes_of
from linkwright.lint.frames import placements
from linkwright.urdf import Joint, Link, Mesh, Robot, parent_joints
from linkwright.urdf.bodies import Bodies
from linkwright.xacro.faults import Frame, frames

_CASTER = re.compile(r"cast(?:e|o)r|swivel|ball(?!ast)|idler|passive|omni_?ball", re.IGNORECASE)
_STEER = re.compile(r"steer|ackermann|knuckle", re.IGNORECASE)
_MECANUM = re.compile(r"mecanum|mechanum|swedish|ilon", re.IGNORECASE)

_UPRIGHT = 0.94
"""From this cosine on, 20 degrees, an axis counts as vertical, or as pointing to the side."""

_ENDLESS = 1000.0
"""Limits of a revolute joint further apart than this, in rad, count as no limits."""

_TOUCHING = 0.01
"""Parts within this height of the ground, in m, touch it once the robot has settled."""


@dataclass(frozen=True, slots=True)
class Undercarriage:
    """The undercarriage of a robot.

    Attributes:
        wheels: the wheels that may be driven, at the sides or steered, in file order.
        crooked: wheels that touch the ground, do not roll forward and are not steered.
        casters: the wheels and balls on joints that only roll along, and the links that slide.
        swivelling: the joints that let casters swivel, and the joints of the casters' wheels.
        ground: the z of the ground in the base frame, in m; None for a robot without shapes.
        lowest_link: the lowest link; empty without shapes.
        hanging: wheels that do not reach the ground, with their height above it, in m.
        unread: link that may be a wheel -> one of its meshes that cannot be read.
    """

    wheels: tuple[Wheel, ...]
    crooked: tuple[Wheel, ...]
    casters: tuple[str, ...]
    swivelling: frozenset[str]
    ground: float | None
    lowest_link: str
    hanging: tuple[tuple[Wheel, float], ...]
    unread: Mapping[str, str]


class Survey:
    """Analyses a robot as a whole.

    Args:
        robot: the robot.
        meshes: the library of its meshes.
    """

    def __init__(self, robot: Robot, meshes: MeshLibrary) -> None:
        self.robot = robot
        self.meshes = meshes
        self.bodies = Bodies(robot)
        self.base_link = "base_link" if "base_link" in robot.links else robot.root
        in_root = placements(robot)
        self.base_in_root = in_root[self.base_link]
        self._frames = {name: frame.seen_from(self.base_in_root) for name, frame in in_root.items()}
        self._above = parent_joints(robot)
        self._unread: dict[str, str] = {}

    @cached_property
    def heights(self) -> dict[str, float]:
        """The z of the lowest point of each link with measurable shapes, in the base frame."""
        found = {}
        for name, frame in self._frames.items():
            known = [lowest(shape, frame, self.meshes) for shape in shapes_of(self.robot.links[name])]
            values = [value for value in known if value is not None]
            if values:
                found[name] = min(values)
        return found

    @cached_property
    def rolling(self) -> tuple[Wheel, ...]:
        """The links that are round about the horizontal axis of a joint that rotates without limits, in file order."""
        return tuple(filter(None, map(self.wheel_on, self.robot.joints.values())))

    def wheel_on(self, joint: Joint) -> Wheel | None:
        """Return the wheel that rotates about a joint.

        Returns None if the joint has limits, or its link is not round.
        """
        size = length(joint.axis)
        frame = self._frames.get(joint.child)
        body = self.bodies.of(joint.child)
        if not is_endless(joint) or not size or frame is None or body is None or body.joint is not joint:
            return None
        own = scaled(joint.axis, 1.0 / size)
        axis = rotated(frame.rotation, own)
        if abs(axis[2]) > sqrt(1.0 - _UPRIGHT * _UPRIGHT):
            return None
        members = list(zip(self.bodies.members(body), body.frames.values(), strict=True))
        shape, unread = round_shape(members, (0.0, 0.0, 0.0), own, self.meshes)
        if unread:
            self._unread[joint.child] = unread[0]
        if shape is None:
            return None
        center = frame.point(scaled(own, shape.along))
        return Wheel(joint.name, joint.child, center, axis, shape.radius, shape.width, self._steering(joint))

    def frame(self, link: str) -> Placement:
        """Return the pose of a link in the base frame."""
        return self._frames[link]

    def undercarriage(self) -> Undercarriage:
        """Return the undercarriage of the robot."""
        rolling = self.rolling
        if not self.heights:
            return Undercarriage((), (), (), frozenset(), None, "", (), dict(self._unread))
        low_link = min(self.heights, key=lambda name: self.heights[name])
        bottom = self.heights[low_link]
        standing = [wheel for wheel in rolling if bottom_of(wheel) - bottom <= max(_TOUCHING, 0.25 * wheel.radius)]
        hanging = tuple((wheel, bottom_of(wheel) - bottom) for wheel in rolling if wheel not in standing)
        free = [wheel for wheel in standing if self._is_caster(wheel)]
        rest = [wheel for wheel in standing if wheel not in free]
        if any(wheel.width is not None for wheel in rest):
            free += [wheel for wheel in rest if wheel.width is None]  # balls in addition to wheels
        rest = [wheel for wheel in rest if wheel not in free]
        crooked = tuple(wheel for wheel in rest if wheel.steering is None and abs(wheel.axis[1]) < _UPRIGHT)
        wheels = tuple(wheel for wheel in rest if wheel not in crooked)
        ground = min(map(bottom_of, wheels)) if wheels else bottom
        sliding = self._sliding(ground) if wheels else ()
        swivelling = {name for wheel in free for name in (wheel.joint, wheel.steering) if name is not None}
        casters = tuple(dict.fromkeys((*(wheel.link for wheel in free), *sliding)))
        return Undercarriage(
            wheels, crooked, casters, frozenset(swivelling), ground, low_link, hanging, dict(self._unread)
        )

    def is_mecanum(self, wheels: tuple[Wheel, ...]) -> bool:
        """Return whether names suggest mecanum wheels.

        The names are those of the wheels, of their meshes, macros or files, and of the robot.
        """
        return all(_MECANUM.search(" ".join(self._words_about(wheel))) for wheel in wheels) or bool(
            _MECANUM.search(self.robot.name)
        )

    def chain(self, link: str) -> Iterator[Joint]:
        """Yield the joints above a link, the nearest first."""
        joint = self._above.get(link)
        while joint is not None:
            yield joint
            joint = self._above.get(joint.parent)

    def _words_about(self, wheel: Wheel) -> Iterator[str]:
        link = self.robot.links[wheel.link]
        yield wheel.joint
        yield wheel.link
        shapes: tuple[Shape, ...] = (*link.visuals, *link.collisions)
        for shape in shapes:
            if isinstance(shape.geometry, Mesh):
                yield shape.geometry.filename.rpartition("/")[2]
        if link.element is not None:
            if link.element.source is not None:
                yield link.element.source.name.rpartition("/")[2]
            if isinstance(link.element.origin, Frame):
                yield from (frame.macro for frame in frames(link.element.origin) if frame.macro is not None)

    def _steering(self, joint: Joint) -> str | None:
        """Return the nearest rotating joint with a vertical axis above a wheel's joint.

        Returns None if there is none.
        """
        for above in self.chain(joint.parent):
            size = length(above.axis)
            if above.type in ("revolute", "continuous") and size:
                z = rotated(self._frames[above.child].rotation, above.axis)[2] / size
                if abs(z) >= _UPRIGHT:
                    return above.name
        return None

    def _is_caster(self, wheel: Wheel) -> bool:
        """Return whether a wheel is a caster: by its name, or because it swivels without limits and is not steered."""
        names = f"{wheel.joint} {wheel.link}"
        if _CASTER.search(names):
            return True
        if wheel.steering is None:
            return False
        above = self.robot.joints[wheel.steering]
        names = f"{above.name} {above.child}"
        return bool(_CASTER.search(names)) or (is_endless(above) and not _STEER.search(names))

    def _sliding(self, ground: float) -> Iterator[str]:
        """Yield the links that slide: fixed to the base and touching the ground, except the chassis."""
        for name, height in self.heights.items():
            root = self.bodies.of(self.robot.root)
            if root is not None and name in root.frames and name != self.chassis and height - ground <= _TOUCHING:
                yield name

    @cached_property
    def chassis(self) -> str:
        """The link of the root's body with the largest shapes."""
        root = self.bodies.of(self.robot.root)
        names = [] if root is None else [name for name in root.links if shapes_of(self.robot.links[name])]
        return max(names, key=lambda name: self._size(self.robot.links[name]), default="")

    def _size(self, link: Link) -> float:
        """Return the mass of a link's shapes for a uniform density, without unreadable meshes."""
        found = estimate(link, self.meshes, density=1.0).properties
        return 0.0 if found is None else found.mass


def is_endless(joint: Joint) -> bool:
    """Return whether a joint rotates without limits."""
    if joint.type == "continuous":
        return True
    limit = joint.limit
    return joint.type == "revolute" and limit is not None and limit.upper - limit.lower > _ENDLESS


def bottom_of(wheel: Wheel) -> float:
    """Return the z of a wheel's lowest point in the base frame, in m."""
    level = sqrt(max(0.0, 1.0 - wheel.axis[2] ** 2)) if wheel.width is not None else 1.0
    return wheel.center[2] - wheel.radius * level - abs(wheel.axis[2]) * (wheel.width or 0.0) / 2.0
