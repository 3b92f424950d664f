"""The parts of a launch that are skipped because software is not installed."""

from __future__ import annotations

from typing import TYPE_CHECKING

from linkwright.diagnostics import Diagnostic, LinkwrightError, Note, Severity, counted, foreign, phrase
from linkwright.launch.errors.unavailable import is_unavailable

if TYPE_CHECKING:
    from linkwright.hosting.launch_log import LaunchLog

_MISSING_SOFTWARE_CODES = frozenset({"LAUNCH101", "LAUNCH124", "LAUNCH131", "LAUNCH142", "PKG101", "PKG102"})
"""The codes of findings that report missing software."""

_UNSET_VALUE_CODES = frozenset({"LAUNCH121", "LAUNCH123", "LAUNCH137"})
"""The codes of findings about unset values.

Skipped parts of the launch may have set such a value.
"""


class Omissions:
    """The parts of a launch that are skipped: the decision and the reports.

    Attributes:
        has_skipped: whether any part has been skipped.

    Args:
        log: the log of the launch.
        skip_all: whether to skip every part that cannot run. If False, only parts that need missing third-party
            software are skipped.
        command: the command that repeats the launch and skips the parts that cannot run; None if there is none.
    """

    def __init__(self, log: LaunchLog, command: str | None, *, skip_all: bool) -> None:
        self._log = log
        self._skip_all = skip_all
        self._command = command
        self.has_skipped = False
        self._unreported: list[Note] = []

    def skip(self, error: LinkwrightError) -> bool:
        """Return whether to skip the part of the launch that raised an error, and record it if so.

        A part is skipped if third-party software that it needs is missing. With `skip_all`, any missing package,
        program or file is enough. After a part has been skipped, a part with an unset value is skipped too.

        Returns:
            True if the part is skipped; False if the error must be reported.
        """
        is_consequence = self.has_skipped and any(
            diagnostic.code in _UNSET_VALUE_CODES for diagnostic in error.diagnostics
        )
        if not (is_consequence or is_unavailable(error) or (self._skip_all and _is_missing(error))):
            return False
        self.has_skipped = True
        self._unreported += [Note(diagnostic.message, diagnostic.span) for diagnostic in error.diagnostics]
        return True

    def report(self) -> None:
        """Log a warning that lists the parts skipped since the last call."""
        if not self._unreported:
            return
        message = counted(
            "one part of the launch is skipped, and the rest runs",
            "{count} parts of the launch are skipped, and the rest runs",
            len(self._unreported),
        )
        self._log.write_diagnostics(
            [Diagnostic("LAUNCH146", message, severity=Severity.WARNING, notes=tuple(self._unreported))]
        )
        self._unreported.clear()

    def with_skip_command(self, error: LinkwrightError) -> tuple[Diagnostic, ...]:
        """Return the findings of a fatal error, with a note about skipping the part if possible.

        The note contains the command, and is attached to the last finding.
        """
        *other_diagnostics, last_diagnostic = error.diagnostics
        if self._command is None or not _is_missing(error):
            return error.diagnostics
        note = Note(phrase("to launch without this part, run {command}", command=foreign(self._command)))
        return (*other_diagnostics, last_diagnostic.with_changes(notes=(*last_diagnostic.notes, note)))


def add_no_skip_note(error: LinkwrightError) -> None:
    """Add a note that no part of the launch can be skipped.

    The note is added only to an error about missing software that has a location.
    """
    *other_diagnostics, last_diagnostic = error.diagnostics
    if _is_missing(error) and last_diagnostic.span is not None:
        note = Note(phrase("the launch file itself needs the missing software, so no part can be skipped"))
        error.diagnostics = (*other_diagnostics, last_diagnostic.with_changes(notes=(*last_diagnostic.notes, note)))


def _is_missing(error: LinkwrightError) -> bool:
    if isinstance(error, (ModuleNotFoundError, FileNotFoundError)) or getattr(error, "is_missing", False):
        return True
    return any(diagnostic.code in _MISSING_SOFTWARE_CODES for diagnostic in error.diagnostics)
