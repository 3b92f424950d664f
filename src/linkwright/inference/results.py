"""Inferences about a robot, each with its reason and its URDF elements."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Literal

from linkwright.diagnostics import Diagnostic
from linkwright.geometry.mass import MassProperties
from linkwright.geometry.single import Vector3
from linkwright.xmltree import Element

DriveKind = Literal["differential", "skid", "ackermann", "mecanum", "joints"]
"""Differential: two driven wheels. Skid: four or more, which turn by slipping. Ackermann: two steered and two driven.

Mecanum: wheels with rollers, which drive in any direction. Joints: no wheels; the base is fixed, and the joints hold
their commanded positions.
"""


@dataclass(frozen=True, slots=True)
class Wheel:
    """A wheel of a robot, with all joints at zero.

    Attributes:
        joint: the joint about which the wheel rotates.
        link: the link that the joint moves.
        center: the center of the wheel in the base frame, in m.
        axis: the unit vector of the joint's axis in the base frame, in the direction that the file declares.
        radius: the radius in m.
        width: the width in m; None for a ball.
        steering: the joint above that steers the wheel or lets it swivel; None if there is none.
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
        left: the driven wheels on the left, the foremost first; empty for ``joints``.
        right: the driven wheels on the right, in the order of the opposite wheels in `left`.
        steered: for ``ackermann``, the steered wheels, left and right.
        separation: the distance between the left and the right driven wheels in m; 0 for ``joints``.
    """

    kind: DriveKind
    left: tuple[Wheel, ...] = ()
    right: tuple[Wheel, ...] = ()
    steered: tuple[Wheel, ...] = ()
    separation: float = 0.0

    @property
    def radius(self) -> float:
        """The mean radius of the driven wheels in m, or 0 for ``joints``."""
        wheels = (*self.left, *self.right)
        return sum(wheel.radius for wheel in wheels) / len(wheels) if wheels else 0.0


@dataclass(frozen=True, slots=True)
class InferredFact:
    """A fact about a robot that was inferred or could not be inferred.

    Attributes:
        diagnostic: the inference and its reason, at the position of its subject in the user's file.
        owner: the element of the description that gets the new elements: a ``<link>``, a ``<joint>`` or the root; None
            if nothing is written.
        added: the new elements. A new element that the owner can have only once replaces the existing one.
        inertial: the values of a new ``<inertial>``, in the link frame; None if there is none.
    """

    diagnostic: Diagnostic
    owner: Element | None = None
    added: tuple[Element, ...] = ()
    inertial: MassProperties | None = None


@dataclass(frozen=True, slots=True)
class Inference:
    """Everything that was inferred about a robot.

    Attributes:
        drive: the inferred drive; None if the description has a working one, or if it is unknown.
        findings: the findings by kind, and in the order of the file within a kind.
        base_frame: the child frame of the odometry: ``base_footprint``, ``base_link`` or the root.
        casters: the links that touch the ground and only slide, or roll without a drive.
        held_joints: the joints, except those of wheels, that hold their position and can be commanded, in file order.
        fixed_base: whether the robot's root is fixed to the world.
        ground_z: the z of the ground in the root's frame, in m, with all joints at zero: that of the lowest wheel, or
            without wheels of the lowest point; 0 for a fixed base. A robot is placed in a world at minus this height.
        masses: the mass of each link in kg, declared or inferred.
        removed: the elements of the description that would disturb the drive.
    """

    drive: Drive | None
    findings: tuple[InferredFact, ...]
    base_frame: str
    casters: tuple[str, ...] = ()
    held_joints: tuple[str, ...] = ()
    fixed_base: bool = False
    ground_z: float = 0.0
    masses: Mapping[str, float] = field(default_factory=dict)
    removed: tuple[Element, ...] = ()

    @property
    def diagnostics(self) -> tuple[Diagnostic, ...]:
        """The diagnostics of the findings, in order."""
        return tuple(finding.diagnostic for finding in self.findings)
