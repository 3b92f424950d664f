"""The panels that programs such as ``rqt_plot`` open in pages."""

from __future__ import annotations

from typing import Literal

from linkwright.page.protocol.message import Record, ServerMessage

RequestedPanelName = Literal[
    "controllers",
    "displays",
    "graph",
    "image",
    "log",
    "parameters",
    "plot",
    "publishers",
    "services",
    "teleop",
    "topics",
    "trajectories",
]
"""The panels that programs can open. An ``image`` is the panel of an Image display."""


class RequestedSeries(Record):
    """A numeric field of a topic, to be plotted."""

    topic: str
    path: str


class RequestedVelocities(Record):
    """Settings of the Teleop panel; None and an empty topic leave a setting unchanged.

    The limits are in m/s and rad/s.
    """

    topic: str
    stamped: bool | None
    linear: float | None
    angular: float | None


class RequestedPanel(Record):
    """A panel that a program opens.

    Attributes:
        number: identifies the request in this run of the program.
        panel: the panel to bring to the front.
        display: the ID of the display to show; None if the panel needs none.
        series: the fields to plot together. Fields of topics that appear later are sent later.
        node: the node whose parameters are shown; None if the user chooses one.
        velocities: the settings of the Teleop panel; None for other panels.
    """

    number: int
    panel: RequestedPanelName
    display: str | None
    series: list[RequestedSeries]
    node: str | None
    velocities: RequestedVelocities | None


class RequestedPanels(ServerMessage):
    """All panels that programs have opened, in order, sent after each change."""

    panels: list[RequestedPanel]
