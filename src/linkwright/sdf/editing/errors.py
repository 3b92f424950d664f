"""The error of edits that cannot be applied to a world."""

from __future__ import annotations

from linkwright.diagnostics import Phrase


class EditError(Exception):
    """Raised when an edit is refused.

    Attributes:
        message: the reason, as a sentence without a full stop.
    """

    def __init__(self, message: Phrase | str) -> None:
        super().__init__(message)
        self.message = message
