"""The inferences about a robot, each with its reason and its URDF elements."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Literal

from linkwright.diagnostics import Diagnostic
from linkwright.geometry.mass import MassProperties
from linkwright.geometry.single import Vector3
from linkwright.xmltree import Element

DriveKind = Literal["differential", "skid", "ackermann", "mecanum", "joints"]
"""Two driven wheels; four or more that turn by slipping; two steered and two driven; wheels with rollers, which go
every way; and no wheels: the base does not move, and the joints hold their commanded positions."""


@dataclass(frozen=True, slots=True)
class Wheel:
    """A wheel, with all joints at zero.

    Attributes:
        joint: the joint about which the wheel rotates.
        link: the link that the joint moves.
        center: the centre of the wheel in the base frame, in m.
        axis: the unit vector of the joint in the base frame, with the direction given in the file.
        radius: the radius in m.
        width: the width in m; None for a ball.
        steering: the parent joint that steers the wheel or lets it swivel; None if there is none.
    """

    joint: str
    link: str
    center: Vector3
    axis: Vector3
    radius: float
    width: float | None
    steering: str | None = None


@dataclass(frozen=True, slots=True)
class Drive:
    """The drive of a robot.

    Attributes:
        kind: the kind of drive.
        left: the driven wheels on the left, the foremost first; empty for `joints`.
        right: the driven wheels on the right, in the order of the wheels opposite to them in `left`.
        steered: for `ackermann`, the steered wheels, left and right.
        separation: the distance between the left and the right driven wheels in m; 0 for `joints`.
    """

    kind: DriveKind
    left: tuple[Wheel, ...] = ()
    right: tuple[Wheel, ...] = ()
    steered: tuple[Wheel, ...] = ()
    separation: float = 0.0

    @property
    def radius(self) -> float:
        """The mean radius of the driven wheels in m; 0 for `joints`."""
        wheels = (*self.left, *self.right)
        return sum(wheel.radius for wheel in wheels) / len(wheels) if wheels else 0.0


@dataclass(frozen=True, slots=True)
class Finding:
    """An inference about a robot.

    Attributes:
        diagnostic: the inference and its reason, at the place of its subject in the user's file.
        owner: the element of the description that gets the new elements: a ``<link>``, a ``<joint>`` or the root; None
            if nothing is written.
        added: the new elements; an element that the owner can have only once replaces the existing one.
        inertial: the values of a new ``<inertial>``, in the link frame.
    """

    diagnostic: Diagnostic
    owner: Element | None = None
    added: tuple[Element, ...] = ()
    inertial: MassProperties | None = None


@dataclass(frozen=True, slots=True)
class Inference:
    """All inferences about a robot.

    Attributes:
        drive: the inferred drive; None if the robot's file has one, or if it is unknown.
        findings: the successful and failed inferences, in the order of the file for each kind.
        base_frame: the child frame of the odometry: ``base_footprint``, ``base_link`` or the root.
        casters: the links that touch the ground and only slide or roll along.
        held: the joints, other than those of wheels, that hold their position and can be moved, in file order.
        fixed_base: whether the robot's root is fixed to the world.
        ground: the z of the ground, which is that of the lowest point, in the root's frame, in m, with all joints at
            zero. A robot is placed in a world at minus this height.
        masses: link -> its mass in kg, own or inferred.
    """

    drive: Drive | None
    findings: tuple[Finding, ...]
    base_frame: str
    casters: tuple[str, ...] = ()
    held: tuple[str, ...] = ()
    fixed_base: bool = False
    ground: float = 0.0
    masses: Mapping[str, float] = field(default_factory=dict)

    @property
    def diagnostics(self) -> tuple[Diagnostic, ...]:
        """The diagnostics of the findings, in order."""
        return tuple(finding.diagnostic for finding in self.findings)
