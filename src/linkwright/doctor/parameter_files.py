"""Problems of parameter files: sections for nodes that are not running."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from pathlib import Path

from linkwright.diagnostics import Diagnostic, Severity, did_you_mean, display_path, joined, phrase
from linkwright.doctor.record import Observation
from linkwright.graph.parameters.files import read_parameter_file


def examine_parameter_files(seen: Observation, files: Iterable[str | Path]) -> Iterator[Diagnostic]:
    """Yield findings on parameter files, given the running graph.

    Raises:
        LinkwrightError: GRAPH211 and GRAPH212, a file cannot be read.
    """
    nodes = sorted(set(seen.nodes))
    running = phrase("running nodes: {nodes}", nodes=joined(nodes)) if nodes else None
    for file in files:
        shown = display_path(file)
        for section in read_parameter_file(file).unmatched_patterns(nodes):
            message = phrase("section '{section}' of '{file}' matches no running node", section=section, file=shown)
            hint = did_you_mean(section, nodes) or running
            yield Diagnostic("DOC702", message, severity=Severity.WARNING, hint=hint)
