"""The log of a launch that a check runs."""

from __future__ import annotations

import io
from collections.abc import Iterable

from linkwright.diagnostics import Diagnostic, Severity
from linkwright.hosting.launch_log import LaunchLog

_SKIPPED_NODE_CODE = "LAUNCH146"


class CheckedLog(LaunchLog):
    """The log of a launch during a check, which also collects the launch's problems.

    Args:
        output: the stream for all lines.
        problems: the list to which problems are added.
    """

    def __init__(self, output: io.StringIO, problems: list[Diagnostic]) -> None:
        super().__init__(output, output)
        self._problems = problems

    def write_diagnostics(self, diagnostics: Iterable[Diagnostic]) -> None:
        """Log findings about the learner's files, and collect the findings that are problems."""
        findings = list(diagnostics)
        for finding in findings:
            if finding.code == _SKIPPED_NODE_CODE:
                self._problems.extend(
                    Diagnostic(finding.code, note.message, note.span, hint=finding.hint) for note in finding.notes
                )
            elif finding.severity is Severity.ERROR:
                self._problems.append(finding)
        super().write_diagnostics(findings)
