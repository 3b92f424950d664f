"""Explains the classic troubles of a running graph: collected in a few seconds, examined as plain data."""

from linkwright.graph.doctor.examination import examine
from linkwright.graph.doctor.record import (
    ClockSeen,
    DescriptionSeen,
    FixedFrame,
    JointSeen,
    Observation,
    StampSeen,
    TransformSeen,
)
from linkwright.graph.doctor.report import report
from linkwright.graph.doctor.watching import observe

__all__ = [
    "ClockSeen",
    "DescriptionSeen",
    "FixedFrame",
    "JointSeen",
    "Observation",
    "StampSeen",
    "TransformSeen",
    "examine",
    "observe",
    "report",
]
