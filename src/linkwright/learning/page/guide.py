"""The interface of guides, which show a course or an exercise in pages."""

from __future__ import annotations

from collections.abc import Callable
from typing import Protocol

from linkwright.diagnostics import LinkwrightError
from linkwright.page.protocol import learning as messages
from linkwright.page.protocol.message import PageMessage, ServerMessage

Publish = Callable[[ServerMessage], object]
"""Sends a message to all pages."""


class Guide(Protocol):
    """A guide through a course or an exercise."""

    def opening_messages(self) -> list[ServerMessage]:
        """Return the messages for a newly opened page, the outline first."""

    def handle(self, message: PageMessage) -> None:
        """Handle a request of a page.

        Raises:
            LinkwrightError: the request cannot be executed.
        """

    def close(self) -> None:
        """Stop all activities of the guide."""


def problem_message(error: LinkwrightError) -> messages.CourseProblem:
    """Return the message that reports an error to pages."""
    diagnostic = error.diagnostics[0]
    return messages.CourseProblem(diagnostic.message, diagnostic.hint or "")
