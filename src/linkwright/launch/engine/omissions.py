"""The parts that a launch leaves out because software they need is not installed."""

from __future__ import annotations

from typing import TYPE_CHECKING

from linkwright.diagnostics import Diagnostic, LinkwrightError, Note, Severity, counted, foreign, phrase
from linkwright.launch.errors.unavailable import is_unavailable

if TYPE_CHECKING:
    from linkwright.hosting.launch_log import LaunchLog

_MISSING = frozenset({"LAUNCH101", "LAUNCH124", "LAUNCH131", "LAUNCH142", "PKG101", "PKG102"})
"""Codes of findings that something is not there."""

_CONSEQUENCES = frozenset({"LAUNCH121", "LAUNCH123", "LAUNCH137"})
"""Codes of findings that a value is not set, which may be because of what was left out before."""


class Omissions:
    """Decides what may be left out, and tells it.

    Attributes:
        any: whether anything was left out.

    Args:
        log: of the launch.
        wanted: whether all that cannot run is to be left out; otherwise that which others make and is not here.
        command: the command that launches the same and leaves out what cannot run; None where there is none.
    """

    def __init__(self, log: LaunchLog, command: str | None, *, wanted: bool) -> None:
        self._log = log
        self._wanted = wanted
        self._command = command
        self.any = False
        self._untold: list[Note] = []

    def take(self, error: LinkwrightError) -> bool:
        """Leave out what an error kept from running, if something is missing and may be left out; whether it was."""
        consequence = self.any and any(diagnostic.code in _CONSEQUENCES for diagnostic in error.diagnostics)
        if not (consequence or is_unavailable(error) or (self._wanted and _is_missing(error))):
            return False
        self.any = True
        self._untold += [Note(diagnostic.message, diagnostic.span) for diagnostic in error.diagnostics]
        return True

    def tell(self) -> None:
        """Print what was left out since the last time."""
        if not self._untold:
            return
        message = counted(
            "one part of the launch is left out, the rest runs",
            "{count} parts of the launch are left out, the rest runs",
            len(self._untold),
        )
        self._log.diagnostics([Diagnostic("LAUNCH146", message, severity=Severity.WARNING, notes=tuple(self._untold))])
        self._untold.clear()

    def offered(self, error: LinkwrightError) -> tuple[Diagnostic, ...]:
        """The findings of an error that ends the launch, with the command that would do without what is missing."""
        *others, last = error.diagnostics
        if self._command is None or not _is_missing(error):
            return error.diagnostics
        note = Note(phrase("to run what can run without it: {command}", command=foreign(self._command)))
        return (*others, last.but(notes=(*last.notes, note)))


def note_that_nothing_is_left(error: LinkwrightError) -> None:
    """Add to an error that kept the launch file itself from being read why no part of it can be left out."""
    *others, last = error.diagnostics
    if _is_missing(error) and last.span is not None:
        note = Note(phrase("the launch file itself needs it: without it there are no parts that could be left out"))
        error.diagnostics = (*others, last.but(notes=(*last.notes, note)))


def _is_missing(error: LinkwrightError) -> bool:
    if isinstance(error, (ModuleNotFoundError, FileNotFoundError)) or getattr(error, "missing", False):
        return True
    return any(diagnostic.code in _MISSING for diagnostic in error.diagnostics)
