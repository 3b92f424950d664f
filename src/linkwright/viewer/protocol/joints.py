"""The Joints panel."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal


@dataclass(slots=True)
class JointControl:
    """A row of the Joints panel.

    `mimic` is the joint it follows, position = multiplier * position of that + offset: such a row cannot be moved.
    """

    name: str
    kind: Literal["revolute", "continuous", "prismatic"]
    lower: float
    upper: float
    zero: float
    mimic: str | None = None
    multiplier: float = 1.0
    offset: float = 0.0


@dataclass(slots=True)
class Joints:
    """The rows of the Joints panel; None closes the panel."""

    controls: list[JointControl] | None
    type: Literal["joints"] = "joints"


@dataclass(slots=True)
class JointPositions:
    """Positions of the Joints panel's joints, rad or m, mimicking joints included."""

    positions: dict[str, float]
    type: Literal["joint_positions"] = "joint_positions"


@dataclass(slots=True)
class SetJoint:
    """The user moved a joint, rad or m."""

    name: str
    position: float
    type: Literal["set_joint"] = "set_joint"


@dataclass(slots=True)
class SetJoints:
    """A pose was recalled, or a sweep goes on: several joints at once, rad or m."""

    positions: dict[str, float]
    type: Literal["set_joints"] = "set_joints"


@dataclass(slots=True)
class RandomizeJoints:
    """The Randomize button."""

    type: Literal["randomize_joints"] = "randomize_joints"


@dataclass(slots=True)
class CenterJoints:
    """The Center button."""

    type: Literal["center_joints"] = "center_joints"
