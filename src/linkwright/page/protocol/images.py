"""Content of the displays for images and maps."""

from __future__ import annotations

from typing import Literal

from linkwright.page.protocol.message import Bytes, DataContent, PageMessage, Record


class CameraModel(Record):
    """The pinhole camera of an image, from the projection matrix of its CameraInfo.

    Sizes, focal lengths and the principal point are in pixels. `offset_x` and `offset_y` are the camera's distance from
    the frame of the image, in meters to the right and down.
    """

    width: float
    height: float
    focal_x: float
    focal_y: float
    center_x: float
    center_y: float
    offset_x: float
    offset_y: float


class ImageFrame(DataContent):
    """An image of the displays Image and Camera.

    `width` and `height` are the size of the image in the message. `columns` and `rows` are the size of the data, which
    may be smaller. The data contains 8-bit pixels row by row, or a file that browsers can decode. `quality` is the
    quality (1 to 95) of a WebP file that was made from the image for a slow connection, or 0 for other data.
    """

    width: int
    height: int
    columns: int
    rows: int
    encoding: Literal["grey", "rgb", "rgba", "file"]
    data: Bytes
    camera: CameraModel | None = None
    quality: int = 0


class ImageSize(PageMessage):
    """The size of an Image display's panel in pixels, 0 while the panel is hidden.

    The page needs no images with more pixels.
    """

    display: str
    width: int
    height: int


class OccupancyMap(DataContent):
    """The cells of Map as bytes of int8 values, row by row from the corner at the origin.

    `origin` is the pose of this corner in the frame of the message: x y z (meters) qx qy qz qw.
    """

    width: int
    height: int
    resolution: float
    origin: list[float]
    cells: Bytes
