"""The undercarriage of a robot: wheels, casters, and the height of the ground.

All joints are at zero. Positions are in the base frame: that of ``base_link``, or of the root if there is no such link.
By REP 103, its x points forward, y to the left and z up.
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
from linkwright.inference.results import Wheel
from linkwright.inference.shapes import Shape, find_lowest_z, find_round_shape, get_shapes
from linkwright.lint.frames import compute_placements
from linkwright.urdf import Joint, Link, Mesh, Robot, parent_joints
from linkwright.urdf.bodies import Bodies
from linkwright.xacro.faults import Frame, frames

_CASTER_PATTERN = re.compile(r"cast(?:e|o)r|swivel|ball(?!ast)|idler|passive|omni_?ball", re.IGNORECASE)
_STEERING_PATTERN = re.compile(r"steer|ackermann|knuckle", re.IGNORECASE)
_MECANUM_PATTERN = re.compile(r"mecanum|mechanum|swedish|ilon", re.IGNORECASE)

_VERTICAL_COSINE = 0.94
"""The cosine from which an axis counts as vertical, or as pointing to the side: 20 degrees."""

_UNLIMITED_RANGE = 1000.0
"""The range of a revolute joint, in rad, above which it counts as unlimited."""

_MAX_GROUND_GAP = 0.01
"""The maximum height in m of parts that touch the ground once the robot has settled."""


@dataclass(frozen=True, slots=True)
class Undercarriage:
    """The parts of a robot that touch the ground or could drive it.

    Attributes:
        wheels: the wheels that could be driven, on the sides or steered, in file order.
        misaligned: wheels that touch the ground but do not roll forward, and are not steered.
        casters: the links of wheels and balls that roll without a drive, and the links that slide.
        caster_joints: the joints that let casters swivel, and the joints of the casters' wheels.
        ground: the z of the ground in the base frame, in m; None for a robot without shapes.
        lowest_link: the link that reaches lowest; empty for a robot without shapes.
        raised_wheels: wheels that do not touch the ground, with their height above it, in m.
        unreadable_meshes: for each link that may be a wheel, one of its meshes that cannot be read.
    """

    wheels: tuple[Wheel, ...]
    misaligned: tuple[Wheel, ...]
    casters: tuple[str, ...]
    caster_joints: frozenset[str]
    ground: float | None
    lowest_link: str
    raised_wheels: tuple[tuple[Wheel, float], ...]
    unreadable_meshes: Mapping[str, str]


class Survey:
    """The facts about a robot's links and joints.

    Args:
        robot: the robot.
        meshes: the library that loads the robot's meshes.
    """

    def __init__(self, robot: Robot, meshes: MeshLibrary) -> None:
        self.robot = robot
        self.meshes = meshes
        self.bodies = Bodies(robot)
        self.base_link = "base_link" if "base_link" in robot.links else robot.root
        frames_in_root = compute_placements(robot)
        self.base_in_root = frames_in_root[self.base_link]
        self._frames = {name: frame.seen_from(self.base_in_root) for name, frame in frames_in_root.items()}
        self._parent_joints = parent_joints(robot)
        self._unreadable: dict[str, str] = {}

    @cached_property
    def heights(self) -> dict[str, float]:
        """The z of the lowest point of each link with readable shapes, in the base frame, in m."""
        heights = {}
        for name, frame in self._frames.items():
            lowest_points = [find_lowest_z(shape, frame, self.meshes) for shape in get_shapes(self.robot.links[name])]
            values = [value for value in lowest_points if value is not None]
            if values:
                heights[name] = min(values)
        return heights

    @cached_property
    def rolling_wheels(self) -> tuple[Wheel, ...]:
        """The links that are round about an unlimited joint's horizontal axis, in file order."""
        return tuple(filter(None, map(self.find_wheel, self.robot.joints.values())))

    def find_wheel(self, joint: Joint) -> Wheel | None:
        """Return the wheel that rotates about a joint.

        Return None if the joint has limits or no horizontal axis, if the link is not rotationally symmetric about the
        axis, or if the pose or the body of the link is unknown.
        """
        size = length(joint.axis)
        frame = self._frames.get(joint.child)
        body = self.bodies.of(joint.child)
        if not is_endless(joint) or not size or frame is None or body is None or body.joint is not joint:
            return None
        joint_axis = scaled(joint.axis, 1.0 / size)
        axis = rotated(frame.rotation, joint_axis)
        if abs(axis[2]) > sqrt(1.0 - _VERTICAL_COSINE * _VERTICAL_COSINE):
            return None
        members = list(zip(self.bodies.members(body), body.frames.values(), strict=True))
        shape, unreadable = find_round_shape(members, (0.0, 0.0, 0.0), joint_axis, self.meshes)
        if unreadable:
            self._unreadable[joint.child] = unreadable[0]
        if shape is None:
            return None
        center = frame.point(scaled(joint_axis, shape.along))
        return Wheel(joint.name, joint.child, center, axis, shape.radius, shape.width, self._find_steering(joint))

    def get_frame(self, link: str) -> Placement:
        """Return the pose of a link in the base frame."""
        return self._frames[link]

    def find_undercarriage(self) -> Undercarriage:
        """Return the wheels, the casters and the ground of the robot."""
        rolling = self.rolling_wheels
        if not self.heights:
            return Undercarriage((), (), (), frozenset(), None, "", (), dict(self._unreadable))
        lowest_link = min(self.heights, key=lambda name: self.heights[name])
        bottom = self.heights[lowest_link]
        ground_wheels = [
            wheel
            for wheel in rolling
            if compute_wheel_bottom(wheel) - bottom <= max(_MAX_GROUND_GAP, 0.25 * wheel.radius)
        ]
        raised = tuple((wheel, compute_wheel_bottom(wheel) - bottom) for wheel in rolling if wheel not in ground_wheels)
        caster_wheels = [wheel for wheel in ground_wheels if self._is_caster(wheel)]
        other_wheels = [wheel for wheel in ground_wheels if wheel not in caster_wheels]
        if any(wheel.width is not None for wheel in other_wheels):
            caster_wheels += [wheel for wheel in other_wheels if wheel.width is None]  # balls, in addition to wheels
        other_wheels = [wheel for wheel in other_wheels if wheel not in caster_wheels]
        misaligned = tuple(
            wheel for wheel in other_wheels if wheel.steering is None and abs(wheel.axis[1]) < _VERTICAL_COSINE
        )
        wheels = tuple(wheel for wheel in other_wheels if wheel not in misaligned)
        ground = min(map(compute_wheel_bottom, wheels)) if wheels else bottom
        sliding_links = self._find_sliding_links(ground) if wheels else ()
        caster_joints = {name for wheel in caster_wheels for name in (wheel.joint, wheel.steering) if name is not None}
        casters = tuple(dict.fromkeys((*(wheel.link for wheel in caster_wheels), *sliding_links)))
        return Undercarriage(
            wheels, misaligned, casters, frozenset(caster_joints), ground, lowest_link, raised, dict(self._unreadable)
        )

    def is_mecanum(self, wheels: tuple[Wheel, ...]) -> bool:
        """Return whether names suggest that wheels are mecanum wheels.

        The names are those of the wheels, of their meshes, macros and files, and of the robot.
        """
        return all(_MECANUM_PATTERN.search(" ".join(self._list_related_names(wheel))) for wheel in wheels) or bool(
            _MECANUM_PATTERN.search(self.robot.name)
        )

    def find_joints_above(self, link: str) -> Iterator[Joint]:
        """Yield the joints between a link and the root, the nearest to the link first."""
        joint = self._parent_joints.get(link)
        while joint is not None:
            yield joint
            joint = self._parent_joints.get(joint.parent)

    def _list_related_names(self, wheel: Wheel) -> Iterator[str]:
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

    def _find_steering(self, joint: Joint) -> str | None:
        """Return the rotating joint with a vertical axis that is nearest above a wheel's joint.

        Returns None if there is none.
        """
        for joint_above in self.find_joints_above(joint.parent):
            size = length(joint_above.axis)
            if joint_above.type in ("revolute", "continuous") and size:
                z = rotated(self._frames[joint_above.child].rotation, joint_above.axis)[2] / size
                if abs(z) >= _VERTICAL_COSINE:
                    return joint_above.name
        return None

    def _is_caster(self, wheel: Wheel) -> bool:
        """Return whether a wheel is a caster by its name, or swivels freely and is not steered."""
        names = f"{wheel.joint} {wheel.link}"
        if _CASTER_PATTERN.search(names):
            return True
        if wheel.steering is None:
            return False
        steering = self.robot.joints[wheel.steering]
        names = f"{steering.name} {steering.child}"
        return bool(_CASTER_PATTERN.search(names)) or (is_endless(steering) and not _STEERING_PATTERN.search(names))

    def _find_sliding_links(self, ground: float) -> Iterator[str]:
        """Yield the links that slide on the ground.

        They are fixed to the base, touch the ground, and are not the chassis.
        """
        for name, height in self.heights.items():
            root = self.bodies.of(self.robot.root)
            if root is not None and name in root.frames and name != self.chassis and height - ground <= _MAX_GROUND_GAP:
                yield name

    @cached_property
    def chassis(self) -> str:
        """The link of the root's body with the largest shapes, or an empty string without shapes."""
        root = self.bodies.of(self.robot.root)
        names = [] if root is None else [name for name in root.links if get_shapes(self.robot.links[name])]
        return max(names, key=lambda name: self._estimate_volume(self.robot.links[name]), default="")

    def _estimate_volume(self, link: Link) -> float:
        """Return the volume of a link's shapes in m3, without meshes that cannot be read."""
        properties = estimate(link, self.meshes, density=1.0).properties
        return 0.0 if properties is None else properties.mass


def is_endless(joint: Joint) -> bool:
    """Return whether a joint rotates without limits, or with very wide ones."""
    if joint.type == "continuous":
        return True
    limit = joint.limit
    return joint.type == "revolute" and limit is not None and limit.upper - limit.lower > _UNLIMITED_RANGE


def compute_wheel_bottom(wheel: Wheel) -> float:
    """Return the z of a wheel's lowest point in the base frame, in m."""
    radial_share = sqrt(max(0.0, 1.0 - wheel.axis[2] ** 2)) if wheel.width is not None else 1.0
    return wheel.center[2] - wheel.radius * radial_share - abs(wheel.axis[2]) * (wheel.width or 0.0) / 2.0
