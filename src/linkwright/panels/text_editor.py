"""Selects the element at the cursor of a text editor in pages, and reports selected elements."""

from __future__ import annotations

import asyncio
from collections.abc import Callable, Coroutine, Iterator
from pathlib import Path
from typing import Any, ClassVar

from linkwright.page.audience import Page
from linkwright.page.protocol.description import Description, JointDetails, LinkDetails, SourceRange
from linkwright.page.protocol.message import ServerMessage
from linkwright.page.protocol.text_editor import EditorAttached, ElementKind, ElementSelected, ShowElement
from linkwright.panels.description import DescriptionFeature
from linkwright.panels.page_feature import FeatureHost, PageFeature


class TextEditorFeature(PageFeature):
    """The feature that selects the element at a text editor's cursor in all pages.

    Attributes:
        selected: called with the source range of each element that a user selects in a page.
    """

    RECEIVES: ClassVar[tuple[type, ...]] = (ElementSelected,)

    def __init__(self, viewer: FeatureHost) -> None:
        super().__init__(viewer)
        self.selected: Callable[[SourceRange], object] = lambda _: None
        self._task: asyncio.Task[None] | None = None

    def opening_messages(self) -> list[ServerMessage]:
        """Return the notice that an editor is attached."""
        return [EditorAttached()]

    def show(self, file: Path, line: int) -> None:
        """Select the element at a line in all pages, if the line contains one.

        Args:
            file: the source file.
            line: the line, from 1.
        """
        self._restart(self._show(file, line))

    def receive(self, page: Page, message: ElementSelected) -> None:
        """Report the source range of a selected element."""
        self._restart(self._report(message))

    def close(self) -> None:
        """Cancel the work that has not finished."""
        if self._task is not None:
            self._task.cancel()

    def _restart(self, work: Coroutine[Any, Any, None]) -> None:
        self.close()
        self._task = asyncio.get_running_loop().create_task(work)

    async def _show(self, file: Path, line: int) -> None:
        for manager in self.managers.all():
            for display in manager.robot_models():
                description = await self.viewer.add_feature(DescriptionFeature).details(display)
                found = None if description is None else element_at(description, file, line)
                if found is not None:
                    manager.pages.publish(ShowElement(display.id, *found))
                    break

    async def _report(self, message: ElementSelected) -> None:
        for manager in self.managers.all():
            for display in manager.robot_models():
                if display.id == message.display:
                    description = await self.viewer.add_feature(DescriptionFeature).details(display)
                    for kind, element in () if description is None else _elements(description):
                        place = element.written.origin
                        if (kind, element.name) == (message.kind, message.name) and place is not None:
                            self.selected(place)
                    return


def element_at(description: Description, file: Path, line: int) -> tuple[ElementKind, str] | None:
    """Return the kind and name of the innermost element at a line, or None.

    If the line contains only a macro call, the result is the call's first element.

    Args:
        description: the description.
        file: the source file.
        line: the line, from 1.
    """
    real = file.resolve()
    found: list[tuple[int, ElementKind, str]] = []
    called: list[tuple[ElementKind, str]] = []
    for kind, element in _elements(description):
        place = element.written.origin
        if place is not None and place.line <= line <= place.end_line and Path(place.file).resolve() == real:
            found.append((place.end_line - place.line, kind, element.name))
        elif any(call.line == line and Path(call.file).resolve() == real for call in element.written.calls):
            called.append((kind, element.name))
    if found:
        return min(found, key=lambda each: each[0])[1:]
    return called[0] if called else None


def _elements(description: Description) -> Iterator[tuple[ElementKind, LinkDetails | JointDetails]]:
    for link in description.links:
        yield "link", link
    for joint in description.joints:
        yield "joint", joint
