"""The connection of pages with a text editor: elements at its cursor, and selected ones."""

from __future__ import annotations

from typing import Literal

from linkwright.page.protocol.message import PageMessage, ServerMessage

ElementKind = Literal["link", "joint"]


class EditorAttached(ServerMessage):
    """A notice that a text editor jumps to the source of each selected element."""


class ShowElement(ServerMessage):
    """The link or joint at the cursor of the text editor, to be selected in the page."""

    display: str
    kind: ElementKind
    name: str


class ElementSelected(PageMessage):
    """The link or joint that the user has selected, for the text editor."""

    display: str
    kind: ElementKind
    name: str
