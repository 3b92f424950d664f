"""Which of RViz's panels are open. Each page arranges its panels by itself; the file says which it begins with."""

from __future__ import annotations

from typing import Literal

from linkwright.viewer.protocol.message import PageMessage, ServerMessage

PanelName = Literal["displays", "selection", "tool-properties", "views", "time", "transformation"]
"""The panels that RViz has, too; the names are the page's."""


class Panels(ServerMessage):
    """What the configuration says of panels.

    Attributes:
        opened: counts the configurations of this page's displays: with another number the page shows these panels.
        origin: by what a page knows a configuration again that has no file.
        shown: the panels that are open, in the order of the file; None where the file says nothing of panels.
    """

    opened: int
    origin: str
    shown: list[PanelName] | None


class ShowPanels(PageMessage):
    """The user opened or closed one of these panels, and these are open in the page now. The file takes that over."""

    shown: list[PanelName]
