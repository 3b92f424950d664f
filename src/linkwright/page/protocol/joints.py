"""The Joints panel."""

from __future__ import annotations

from typing import Literal

from linkwright.page.protocol.message import PageMessage, Record, ServerMessage


class JointControl(Record):
    """A row of the Joints panel.

    `mimic` is the joint that it follows, position = multiplier * position of that + offset; the user cannot move it.
    """

    name: str
    kind: Literal["revolute", "continuous", "prismatic"]
    lower: float
    upper: float
    zero: float
    mimic: str | None = None
    multiplier: float = 1.0
    offset: float = 0.0


class Joints(ServerMessage):
    """The rows of the Joints panel; None closes the panel."""

    controls: list[JointControl] | None


class JointPositions(ServerMessage):
    """Positions of the Joints panel's joints, rad or m, including mimicking ones."""

    positions: dict[str, float]


class SetJoint(PageMessage):
    """The user moved a joint, rad or m."""

    name: str
    position: float


class SetJoints(PageMessage):
    """A pose was recalled, or a sweep advances: several joints at once, rad or m."""

    positions: dict[str, float]


class RandomizeJoints(PageMessage):
    """The Randomize button."""


class CenterJoints(PageMessage):
    """The Center button."""
