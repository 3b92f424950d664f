"""sensor_msgs: joint states."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field
from typing import ClassVar

import numpy as np
from numpy.typing import NDArray

from linkwright.messages.standard import Header

FloatSequence = Sequence[float] | NDArray[np.float64]
"""A float64[] field: any sequence of floats, or a numpy array where there are many."""


@dataclass(slots=True, eq=False)
class JointState:
    """What a set of joints does at one moment.

    Attributes:
        header: the moment; the frame means nothing.
        name: the joints; each of the other fields is empty or has one number for each name.
        position: radians or metres.
        velocity: rad/s or m/s.
        effort: N m or N.
    """

    TYPE_NAME: ClassVar[str] = "sensor_msgs/msg/JointState"

    header: Header = field(default_factory=Header)
    name: list[str] = field(default_factory=list)
    position: FloatSequence = field(default_factory=list)
    velocity: FloatSequence = field(default_factory=list)
    effort: FloatSequence = field(default_factory=list)

    def __eq__(self, other: object) -> bool:
        if not isinstance(other, JointState):
            return NotImplemented
        return (
            self.header == other.header
            and self.name == other.name
            and np.array_equal(self.position, other.position)
            and np.array_equal(self.velocity, other.velocity)
            and np.array_equal(self.effort, other.effort)
        )

    __hash__ = None  # type: ignore[assignment]  # a mutable value, like the other messages
