"""Finds common problems of a running graph.

The graph is observed for a few seconds.
"""

from linkwright.doctor.examination import examine
from linkwright.doctor.parameter_files import examine_parameter_files
from linkwright.doctor.record import (
    ClockSeen,
    DescriptionSeen,
    DriversSeen,
    FixedFrame,
    FrameSeen,
    JointSeen,
    Observation,
    StampSeen,
    TransformSeen,
)
from linkwright.doctor.report import report
from linkwright.doctor.watching import observe

__all__ = [
    "ClockSeen",
    "DescriptionSeen",
    "DriversSeen",
    "FixedFrame",
    "FrameSeen",
    "JointSeen",
    "Observation",
    "StampSeen",
    "TransformSeen",
    "examine",
    "examine_parameter_files",
    "observe",
    "report",
]
