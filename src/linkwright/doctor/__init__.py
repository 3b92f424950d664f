"""Finds common problems of a running graph.

The graph is observed for a few seconds.
"""

from linkwright.doctor.examination import examine
from linkwright.doctor.parameter_files import examine_parameter_files
from linkwright.doctor.record import (
    FixedFrame,
    Observation,
    ObservedClock,
    ObservedCommanders,
    ObservedDescription,
    ObservedFrame,
    ObservedJoint,
    ObservedStamp,
    ObservedTransform,
)
from linkwright.doctor.report import make_report
from linkwright.doctor.watching import observe

__all__ = [
    "FixedFrame",
    "Observation",
    "ObservedClock",
    "ObservedCommanders",
    "ObservedDescription",
    "ObservedFrame",
    "ObservedJoint",
    "ObservedStamp",
    "ObservedTransform",
    "examine",
    "examine_parameter_files",
    "make_report",
    "observe",
]
