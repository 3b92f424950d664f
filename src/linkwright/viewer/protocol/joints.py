"""The Joints panel."""

from __future__ import annotations

from typing import Literal

from linkwright.viewer.protocol.record import record


@record
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


@record
class Joints:
    """The rows of the Joints panel; None closes the panel."""

    controls: list[JointControl] | None
    type: Literal["joints"] = "joints"


@record
class JointPositions:
    """Positions of the Joints panel's joints, rad or m, mimicking joints included."""

    positions: dict[str, float]
    type: Literal["joint_positions"] = "joint_positions"


@record
class SetJoint:
    """The user moved a joint, rad or m."""

    name: str
    position: float
    type: Literal["set_joint"] = "set_joint"


@record
class SetJoints:
    """A pose was recalled, or a sweep goes on: several joints at once, rad or m."""

    positions: dict[str, float]
    type: Literal["set_joints"] = "set_joints"


@record
class RandomizeJoints:
    """The Randomize button."""

    type: Literal["randomize_joints"] = "randomize_joints"


@record
class CenterJoints:
    """The Center button."""

    type: Literal["center_joints"] = "center_joints"
