"""The TurtleSim panel: turtles, and the lines that their pens have drawn."""

from __future__ import annotations

from typing import ClassVar

from linkwright.page.protocol.message import PageMessage, Record, ServerMessage


class TurtleSimulator(Record):
    """A running turtlesim_node.

    Attributes:
        number: identifies the node while the program runs.
        name: the full name of the node.
    """

    number: int
    name: str


class TurtleSimulators(ServerMessage):
    """All running turtlesim_nodes, sent when one starts or ends."""

    simulators: list[TurtleSimulator]


class TurtlePose(Record):
    """A turtle: its place in units from the lower left corner, its heading in rad, and the number of its drawing.

    `topic` is that of its velocities.
    """

    name: str
    topic: str
    x: float
    y: float
    theta: float
    shape: int


class TurtleScene(ServerMessage):
    """The background of a turtlesim_node, such as ``#4556ff``, and its turtles."""

    NEWEST_OF: ClassVar[tuple[str, ...]] = ("number",)

    number: int
    background: str
    turtles: list[TurtlePose]


class TurtleLines(ServerMessage):
    """The lines in an area of a turtlesim_node, which has changed.

    Attributes:
        number: the node.
        version: increases with each change.
        left: the left edge of the area in pixels.
        top: the upper edge of the area in pixels.
        image: the pixels of the area as PNG, in base64; transparent where nothing is drawn.
    """

    NEWEST_OF: ClassVar[tuple[str, ...]] = ("number", "version")

    number: int
    version: int
    left: int
    top: int
    image: str


class WatchTurtles(PageMessage):
    """Whether the page receives turtles and lines from now on."""

    is_watched: bool
