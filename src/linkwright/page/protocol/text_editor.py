"""The connection of pages with a text editor: the element at its cursor, and the element that the user selects."""

from __future__ import annotations

from typing import Literal

from linkwright.page.protocol.message import PageMessage, ServerMessage

ElementKind = Literal["link", "joint"]


class EditorAttached(ServerMessage):
    """A notice that a text editor goes to the source of each element that the user selects."""


class ShowElement(ServerMessage):
    """The link or joint at the cursor of the text editor, which the page selects."""

    display: str
    kind: ElementKind
    name: str


class ElementSelected(PageMessage):
    """The link or joint that the user has selected, for the text editor."""

    display: str
    kind: ElementKind
    name: str
