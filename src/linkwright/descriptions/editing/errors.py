"""The error raised when a robot cannot be edited."""

from __future__ import annotations

from linkwright.diagnostics import Diagnostic


class EditRefusedError(Exception):
    """Raised when an edit of a description is refused and no file was written.

    Attributes:
        diagnostic: the finding with the refused text, its location, the reason, and a hint.
    """

    def __init__(self, diagnostic: Diagnostic) -> None:
        super().__init__(diagnostic.message)
        self.diagnostic = diagnostic
