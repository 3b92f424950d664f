"""Tells pages what stands behind the robots of RobotModel displays, as far as they ask."""

from __future__ import annotations

import asyncio
from collections.abc import Sequence
from typing import TYPE_CHECKING, ClassVar

from linkwright.diagnostics import Diagnostic
from linkwright.viewer.description.known import KnownDescription
from linkwright.viewer.displays.robot_model import RobotModelDisplay
from linkwright.viewer.features import Desk, PageFeature
from linkwright.viewer.protocol import (
    AskDescription,
    AskDescriptionText,
    AskInertia,
    AskStory,
    DescriptionChanged,
    DescriptionText,
    ServerMessage,
)

if TYPE_CHECKING:
    from linkwright.viewer.audience import Page
    from linkwright.viewer.manager import VisualizationManager

_Question = AskDescription | AskDescriptionText | AskInertia | AskStory


class DescriptionFeature(PageFeature):
    """Answers questions about descriptions, in the order in which they come, aside of the event loop.

    Of several questions of a page of one kind about one thing the newest counts.

    Args:
        desk: what it works with.
    """

    RECEIVES: ClassVar[tuple[type, ...]] = (AskDescription, AskDescriptionText, AskInertia, AskStory)

    def __init__(self, desk: Desk) -> None:
        self._desk = desk
        self._known: dict[str, KnownDescription] = {}
        self._faulty: dict[str, str] = {}
        self._answers: dict[tuple[Page, str], asyncio.Task[None]] = {}
        self._thinking = asyncio.Lock()

    def look(self) -> None:
        """Robots may have changed: tell the pages that see them of those that have."""
        shown: set[str] = set()
        for manager in self._desk.managers():
            for display in manager.robot_models():
                shown.add(display.id)
                before = self._known.get(display.id)
                known = self._look_at(display)
                if known is not None and known is not before:
                    manager.pages.publish(known.changed_from(before))
        for gone in self._known.keys() - shown:
            del self._known[gone]

    def show_diagnostics(self, diagnostics: Sequence[Diagnostic]) -> None:
        """Files that something is wrong with now; their text is told as the diagnostics know it."""
        self._faulty = {each.source.name: each.source.text for each in diagnostics if each.source is not None}

    def configured(self, manager: VisualizationManager) -> list[ServerMessage]:
        """Which descriptions can be asked for; nothing counts as changed."""
        known = [self._look_at(display) for display in manager.robot_models()]
        return [DescriptionChanged(each.display, each.revision, [], []) for each in known if each is not None]

    def receive(self, page: Page, message: _Question) -> None:
        """Answer a question, in a while."""
        about = message.file if isinstance(message, AskDescriptionText) else ""
        key = (page, f"{message.type} {message.display} {about}")
        if key in self._answers:
            self._answers[key].cancel()
        task = asyncio.get_running_loop().create_task(self._answer(page, message))
        self._answers[key] = task
        task.add_done_callback(lambda done: self._answers.pop(key) if self._answers.get(key) is done else None)

    def page_gone(self, page: Page) -> None:
        """Forget what it asked."""
        for (asking, _), task in list(self._answers.items()):
            if asking is page:
                task.cancel()

    def close(self) -> None:
        """Answer no more."""
        for task in self._answers.values():
            task.cancel()

    async def _answer(self, page: Page, question: _Question) -> None:
        seen = self._desk.manager_of(page).robot_models()
        display = next((each for each in seen if each.id == question.display), None)
        known = None if display is None else self._look_at(display)
        faulty = dict(self._faulty)

        def answer() -> ServerMessage | None:
            if isinstance(question, AskDescriptionText):
                return _text(known, faulty, question)
            if known is None:
                return None
            if isinstance(question, AskDescription):
                return known.account
            if isinstance(question, AskInertia):
                return known.findings(self._desk.finder)
            return display.story(question.link) if display is not None else None

        async with self._thinking:
            told = await asyncio.to_thread(answer)
        if told is not None:
            page.send(told)

    def _look_at(self, display: RobotModelDisplay) -> KnownDescription | None:
        """What is known of the description that a display shows now."""
        robot, prefix = display.robot, display.properties.text("TF Prefix")
        known = self._known.get(display.id)
        if robot is None:
            return known
        if known is None or known.robot is not robot or known.prefix != prefix:
            revision = known.revision + 1 if known else 1
            files = self._desk.library.files(display.text)
            known = KnownDescription(display.id, revision, robot, display.text, prefix, files)
            self._known[display.id] = known
        return known


def _text(known: KnownDescription | None, faulty: dict[str, str], question: AskDescriptionText) -> DescriptionText:
    """A text; of a file that something is wrong with, the one that it is wrong with and not that of the robot shown."""
    file = question.file
    if file in faulty:
        return DescriptionText(question.display, known.revision if known else 0, file, faulty[file])
    if known is None:
        return DescriptionText(question.display, 0, file, None)
    return known.named_text(file)
