"""Content of the Marker and MarkerArray displays."""

from __future__ import annotations

from typing import Literal

from linkwright.viewer.protocol.data import Bytes, Floats
from linkwright.viewer.protocol.message import DataContent, Record

MarkerKind = Literal[
    "arrow",
    "cube",
    "sphere",
    "cylinder",
    "line_strip",
    "line_list",
    "cube_list",
    "sphere_list",
    "points",
    "text",
    "mesh",
    "triangle_list",
    "arrow_strip",
]
"""In the order of visualization_msgs' numbers; the last since Jazzy."""


class MarkerMesh(Record):
    """The file of a mesh marker: an address, or the bytes that came with the message.

    `embedded` is whether its own materials are used, tinted by the marker's colour.
    """

    format: str
    url: str | None
    data: Bytes | None
    embedded: bool


class MarkerShape(Record):
    """One marker, as visualization_msgs/msg/Marker has it.

    `id` is ``<namespace>/<number>``. `pose` (x y z qx qy qz qw) is in the Fixed Frame, or, when `frame` is not empty,
    in that frame wherever it goes. `scale` is x, y, z; `color` red, green, blue, alpha. `points` has shape (N, 3),
    `colors` (N, 4) or none, `uvs` (N, 2) or none. `texture` is an address of an image.
    """

    id: str
    namespace: str
    shape: MarkerKind
    frame: str
    pose: list[float]
    scale: list[float]
    color: list[float]
    points: Floats
    colors: Floats
    uvs: Floats
    text: str
    mesh: MarkerMesh | None
    texture: str | None


class MarkersChanged(DataContent):
    """Marker and MarkerArray: markers that are new or others now, and those that have gone.

    With `everything` set, whatever was there before has gone too.
    """

    everything: bool
    gone: list[str]
    markers: list[MarkerShape]
