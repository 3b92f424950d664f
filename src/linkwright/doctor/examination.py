"""Runs all examinations of an observation."""

from __future__ import annotations

from linkwright.diagnostics import Diagnostic, Severity
from linkwright.doctor.clocks import examine_clocks
from linkwright.doctor.environment import examine_environment
from linkwright.doctor.frames import examine_frames
from linkwright.doctor.record import Observation
from linkwright.doctor.robots import examine_robots, find_robots
from linkwright.doctor.topics import examine_lifecycle, examine_topics

_SEVERITY_ORDER = (Severity.ERROR, Severity.WARNING, Severity.INFO)


def examine(observation: Observation) -> list[Diagnostic]:
    """Return the findings of all examinations (codes ``DOC...``), the most severe first."""
    robots, findings = find_robots(observation)
    findings += examine_environment(observation)
    findings += examine_frames(observation, robots)
    findings += examine_robots(observation, robots)
    findings += examine_topics(observation)
    findings += examine_clocks(observation)
    findings += examine_lifecycle(observation)
    return sorted(findings, key=lambda diagnostic: _SEVERITY_ORDER.index(diagnostic.severity))
