"""What a display knows of the visualization that it is part of."""

from __future__ import annotations

from typing import Protocol

from linkwright.viewer.context import ViewerContext
from linkwright.viewer.frames.stream import FrameView, TimeControl
from linkwright.viewer.web.audience import PageGroup


class DisplayHost(Protocol):
    """A visualization, as its displays see it.

    Attributes:
        context: what all of the viewer works with.
        pages: those that see the display.
        frames: the frames now.
        time: whether time stands still, and what leads it.
    """

    context: ViewerContext
    pages: PageGroup
    frames: FrameView
    time: TimeControl

    def robot_changed(self, gone: set[str]) -> None:
        """A display has another robot; `gone` are the frames that only the one before had."""
