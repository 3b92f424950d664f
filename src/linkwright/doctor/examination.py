"""Runs all examinations of an observed graph."""

from __future__ import annotations

from linkwright.diagnostics import Diagnostic, Severity
from linkwright.doctor.clocks import examine_clocks
from linkwright.doctor.environment import examine_environment
from linkwright.doctor.frames import examine_frames
from linkwright.doctor.record import Observation
from linkwright.doctor.robots import examine_robots, robots_in
from linkwright.doctor.topics import examine_lifecycle, examine_topics

_ORDER = (Severity.ERROR, Severity.WARNING, Severity.INFO)


def examine(seen: Observation) -> list[Diagnostic]:
    """Run all examinations, and return the findings (codes ``DOC...``), most severe first."""
    robots, found = robots_in(seen)
    found += examine_environment(seen)
    found += examine_frames(seen, robots)
    found += examine_robots(seen, robots)
    found += examine_topics(seen)
    found += examine_clocks(seen)
    found += examine_lifecycle(seen)
    return sorted(found, key=lambda diagnostic: _ORDER.index(diagnostic.severity))
