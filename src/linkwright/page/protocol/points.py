"""Content of the displays with many points: clouds, scans and cells."""

from __future__ import annotations

from typing import ClassVar

from linkwright.page.protocol.message import Bytes, DataContent, Floats, PageMessage, ServerMessage


class CloudPoints(DataContent):
    """PointCloud2 and similar messages: points in the frame of the message, metres, shape (N, 3).

    `colours` has the RGBA colour of each point, shape (N, 4), or is empty if all points have the display's own colour.
    `translucent` is whether any alpha is less than full. `pixel` is the size of points relative to their depth in the
    frame, metres per metre; 0 if they have the display's size. For a slow connection only every `step`-th point is
    sent.
    """

    positions: Floats
    colours: Bytes
    translucent: bool = False
    pixel: float = 0.0
    step: int = 1


class CellGrid(DataContent):
    """GridCells: cell centres, shape (N, 3), and cell side lengths, metres, in the message's frame."""

    positions: Floats
    width: float
    height: float


class AskPoint(PageMessage):
    """The user selected a point of a display's content; answered by `PointFields`."""

    display: str
    key: str
    index: int


class PointFields(ServerMessage):
    """The fields of a point other than its coordinates, by name, in the order of the message.

    A packed colour is ``#rrggbbaa``; a number that is not finite is sent as text.
    """

    display: str
    key: str
    index: int
    fields: dict[str, float | str]
    NEWEST_OF: ClassVar[tuple[str, ...]] = ("display", "key", "index")
