"""The page feature of courses and exercises, which forwards page requests to a guide."""

from __future__ import annotations

from typing import Any

from linkwright.diagnostics import LinkwrightError, phrase
from linkwright.learning.page.guide import Guide, problem_message
from linkwright.page.audience import Page
from linkwright.page.protocol import learning as messages
from linkwright.page.protocol.message import ServerMessage
from linkwright.panels.page_feature import FeatureHost, PageFeature


class CourseFeature(PageFeature):
    """The page feature of a course or an exercise.

    It ignores all requests before `show` is called.
    """

    RECEIVES = (
        messages.AnswerStep,
        messages.RequestCatchUp,
        messages.CatchUp,
        messages.CheckStep,
        messages.OpenStep,
        messages.TakeHint,
        messages.TakeSolution,
    )

    def __init__(self, viewer: FeatureHost) -> None:
        super().__init__(viewer)
        self._guide: Guide | None = None

    def show(self, guide: Guide) -> None:
        """Show a guide in the pages, and forward their requests to it."""
        self._guide = guide
        for message in guide.opening_messages():
            self.context.pages.publish(message)

    def opening_messages(self) -> list[ServerMessage]:
        """Return the guide's messages for a page that has just opened."""
        return [] if self._guide is None else self._guide.opening_messages()

    def receive(self, page: Page, message: Any) -> None:
        """Handle a request of a page, or report to the page why it was refused."""
        if self._guide is None:
            return
        if not page.is_local:
            problem = phrase("a course works only in pages on the machine where Linkwright runs")
            page.send(messages.CourseProblem(problem, ""))
            return
        try:
            self._guide.handle(message)
        except LinkwrightError as error:
            page.send(problem_message(error))
        else:
            page.send(messages.CourseProblem("", ""))

    def close(self) -> None:
        """Close the guide."""
        if self._guide is not None:
            self._guide.close()
