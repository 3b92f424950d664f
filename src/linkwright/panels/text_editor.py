"""Selects the element at a text editor's cursor in pages, and reports selected elements."""

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
                shown_element = None if description is None else find_element_at(description, file, line)
                if shown_element is not None:
                    manager.pages.publish(ShowElement(display.id, *shown_element))
                    break

    async def _report(self, message: ElementSelected) -> None:
        for manager in self.managers.all():
            for display in manager.robot_models():
                if display.id == message.display:
                    description = await self.viewer.add_feature(DescriptionFeature).details(display)
                    for kind, element in () if description is None else _iterate_elements(description):
                        origin = element.written.origin
                        if (kind, element.name) == (message.kind, message.name) and origin is not None:
                            self.selected(origin)
                    return


def find_element_at(description: Description, file: Path, line: int) -> tuple[ElementKind, str] | None:
    """Return the kind and name of the innermost element at a line, or None.

    If the line contains only a macro call, the result is the call's first element.

    Args:
        description: the description.
        file: the source file.
        line: the line, from 1.
    """
    source_path = file.resolve()
    matches: list[tuple[int, ElementKind, str]] = []
    call_elements: list[tuple[ElementKind, str]] = []
    for kind, element in _iterate_elements(description):
        origin = element.written.origin
        if origin is not None and origin.line <= line <= origin.end_line and Path(origin.file).resolve() == source_path:
            matches.append((origin.end_line - origin.line, kind, element.name))
        elif any(call.line == line and Path(call.file).resolve() == source_path for call in element.written.calls):
            call_elements.append((kind, element.name))
    if matches:
        return min(matches, key=lambda match: match[0])[1:]
    return call_elements[0] if call_elements else None


def _iterate_elements(description: Description) -> Iterator[tuple[ElementKind, LinkDetails | JointDetails]]:
    for link in description.links:
        yield "link", link
    for joint in description.joints:
        yield "joint", joint
