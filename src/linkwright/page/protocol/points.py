"""Content of the displays with many points: clouds, scans and cells."""

from __future__ import annotations

from typing import ClassVar

from linkwright.page.protocol.message import Bytes, DataContent, Floats, PageMessage, ServerMessage


class CloudPoints(DataContent):
    """The points of PointCloud2 and similar messages, meters, shape (N, 3).

    They are in the frame of the message.

    `colors` has the RGBA color of each point, shape (N, 4), or is empty if all points have the color of the
    display. `translucent` is whether any alpha is less than 255. `pixel` is the width of a point in m per meter of its
    depth, or 0 if points have the size of the display. For a slow connection, only every `step`-th point is sent.
    """

    positions: Floats
    colors: Bytes
    translucent: bool = False
    pixel: float = 0.0
    step: int = 1


class CellGrid(DataContent):
    """The cells of GridCells in the frame of the message, in meters.

    `positions` are the centers, shape (N, 3). `width` and `height` are the side lengths.
    """

    positions: Floats
    width: float
    height: float


class RequestPoint(PageMessage):
    """A request for the fields of a point that the user has selected.

    The response is `PointFields`.
    """

    display: str
    key: str
    index: int


class PointFields(ServerMessage):
    """The channels of a point by name, in the order of the message.

    A packed color is ``#rrggbbaa``. A number that is not finite is sent as text.
    """

    display: str
    key: str
    index: int
    fields: dict[str, float | str]
    NEWEST_OF: ClassVar[tuple[str, ...]] = ("display", "key", "index")
