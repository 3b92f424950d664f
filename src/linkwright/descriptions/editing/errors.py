"""The error raised when a robot cannot be edited."""

from __future__ import annotations

from linkwright.diagnostics import Diagnostic


class EditRefusedError(Exception):
    """Raised when an edit of a description is refused; nothing was written.

    Attributes:
        diagnostic: which text is refused, where, why, and what to do.
    """

    def __init__(self, diagnostic: Diagnostic) -> None:
        super().__init__(diagnostic.message)
        self.diagnostic = diagnostic
