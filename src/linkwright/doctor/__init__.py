"""Finds common problems of a running graph.

It observes the graph for a few seconds, and examines the recorded data.
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
