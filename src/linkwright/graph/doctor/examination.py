"""All examinations of what was seen of a running graph."""

from __future__ import annotations

from linkwright.diagnostics import Diagnostic, Severity
from linkwright.graph.doctor.clocks import examine_clocks
from linkwright.graph.doctor.frames import examine_frames
from linkwright.graph.doctor.record import Observation
from linkwright.graph.doctor.robots import examine_robots, robots_in
from linkwright.graph.doctor.surroundings import examine_lifecycle, examine_surroundings
from linkwright.graph.doctor.topics import examine_topics

_ORDER = (Severity.ERROR, Severity.WARNING, Severity.INFO)


def examine(seen: Observation) -> list[Diagnostic]:
    """What is wrong with a running graph, the worst first: what, why, and how to mend it (codes ``DOC...``)."""
    robots, found = robots_in(seen)
    found += examine_surroundings(seen)
    found += examine_frames(seen, robots)
    found += examine_robots(seen, robots)
    found += examine_topics(seen)
    found += examine_clocks(seen)
    found += examine_lifecycle(seen)
    return sorted(found, key=lambda each: _ORDER.index(each.severity))
