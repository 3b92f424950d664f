"""The parts that a launch skips because software is not installed."""

from __future__ import annotations

from typing import TYPE_CHECKING

from linkwright.diagnostics import Diagnostic, LinkwrightError, Note, Severity, counted, foreign, phrase
from linkwright.launch.errors.unavailable import is_unavailable

if TYPE_CHECKING:
    from linkwright.hosting.launch_log import LaunchLog

_MISSING = frozenset({"LAUNCH101", "LAUNCH124", "LAUNCH131", "LAUNCH142", "PKG101", "PKG102"})
"""Codes of findings on missing software."""

_CONSEQUENCES = frozenset({"LAUNCH121", "LAUNCH123", "LAUNCH137"})
"""Codes of findings on unset values, which skipped parts may have set."""


class Omissions:
    """Decides which parts of a launch to skip, and reports them.

    Attributes:
        any: whether any part was skipped.

    Args:
        log: the log of the launch.
        wanted: whether to skip every part that cannot run; otherwise only parts that need missing third-party software.
        command: the command that repeats the launch and skips the parts that cannot run; None if there is none.
    """

    def __init__(self, log: LaunchLog, command: str | None, *, wanted: bool) -> None:
        self._log = log
        self._wanted = wanted
        self._command = command
        self.any = False
        self._unreported: list[Note] = []

    def skip(self, error: LinkwrightError) -> bool:
        """Skip the part of the launch that raised an error, if missing software is the cause.

        An error about an unset value is also skipped if an earlier skipped part may have set the value.

        Returns:
            Whether the part is skipped; False if the error must be reported.
        """
        consequence = self.any and any(diagnostic.code in _CONSEQUENCES for diagnostic in error.diagnostics)
        if not (consequence or is_unavailable(error) or (self._wanted and _is_missing(error))):
            return False
        self.any = True
        self._unreported += [Note(diagnostic.message, diagnostic.span) for diagnostic in error.diagnostics]
        return True

    def report(self) -> None:
        """Print a warning that lists the parts skipped since the last call, if there are any."""
        if not self._unreported:
            return
        message = counted(
            "one part of the launch is skipped, and the rest runs",
            "{count} parts of the launch are skipped, and the rest runs",
            len(self._unreported),
        )
        self._log.diagnostics(
            [Diagnostic("LAUNCH146", message, severity=Severity.WARNING, notes=tuple(self._unreported))]
        )
        self._unreported.clear()

    def with_skip_command(self, error: LinkwrightError) -> tuple[Diagnostic, ...]:
        """Return the findings of a fatal error.

        If a command would skip the missing part, the last finding gets a note with this command.
        """
        *others, last = error.diagnostics
        if self._command is None or not _is_missing(error):
            return error.diagnostics
        note = Note(phrase("run {command} to skip it and run the rest", command=foreign(self._command)))
        return (*others, last.with_changes(notes=(*last.notes, note)))


def add_no_skip_note(error: LinkwrightError) -> None:
    """Add a note to an error that no part of the launch can be skipped.

    The note is added only if the error is about missing software and has a location.
    """
    *others, last = error.diagnostics
    if _is_missing(error) and last.span is not None:
        note = Note(phrase("the launch file itself needs it, so no part can be skipped"))
        error.diagnostics = (*others, last.with_changes(notes=(*last.notes, note)))


def _is_missing(error: LinkwrightError) -> bool:
    if isinstance(error, (ModuleNotFoundError, FileNotFoundError)) or getattr(error, "missing", False):
        return True
    return any(diagnostic.code in _MISSING for diagnostic in error.diagnostics)
