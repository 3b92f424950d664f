"""Problems of parameter files: sections for nodes that are not running."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from pathlib import Path

from linkwright.diagnostics import Diagnostic, Severity, did_you_mean, display_path, joined, phrase
from linkwright.doctor.record import Observation
from linkwright.graph.parameters.files import read_parameter_file


def examine_parameter_files(observation: Observation, files: Iterable[str | Path]) -> Iterator[Diagnostic]:
    """Yield findings about parameter files whose sections match no running node.

    Raises:
        LinkwrightError: GRAPH211 or GRAPH212, a file cannot be read.
    """
    nodes = sorted(set(observation.nodes))
    running_hint = phrase("running nodes: {nodes}", nodes=joined(nodes)) if nodes else None
    for file in files:
        shown_path = display_path(file)
        for section in read_parameter_file(file).unmatched_patterns(nodes):
            message = phrase(
                "section '{section}' of '{file}' matches no running node", section=section, file=shown_path
            )
            hint = did_you_mean(section, nodes) or running_hint
            yield Diagnostic("DOC702", message, severity=Severity.WARNING, hint=hint)
