"""The interface of guides, which show pages a course or an exercise."""

from __future__ import annotations

from collections.abc import Callable
from typing import Protocol

from linkwright.diagnostics import LinkwrightError
from linkwright.page.protocol import learning as messages
from linkwright.page.protocol.message import PageMessage, ServerMessage

Publish = Callable[[ServerMessage], object]
"""Sends a message to all pages."""


class Guide(Protocol):
    """A guide of a learner."""

    def opening_messages(self) -> list[ServerMessage]:
        """Return the messages for a page that opens, the outline first."""

    def handle(self, message: PageMessage) -> None:
        """Carry out a request of a page.

        Raises:
            LinkwrightError: the request cannot be carried out.
        """

    def close(self) -> None:
        """End all that runs for the learner."""


def problem_of(error: LinkwrightError) -> messages.CourseProblem:
    """Return the message that reports an error to pages."""
    diagnostic = error.diagnostics[0]
    return messages.CourseProblem(diagnostic.message, diagnostic.hint or "")
