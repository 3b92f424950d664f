"""Content of the displays for vision_msgs."""

from __future__ import annotations

from linkwright.page.protocol.message import Bytes, DataContent, Floats


class SolidBoxes(DataContent):
    """Boxes of Detection3D, BoundingBox3D and their arrays, in the frame of the content.

    `poses` has shape (N, 7): x y z (meters) qx qy qz qw of the box centers. `sizes` has shape (N, 3), in meters.
    `colors` has shape (N, 3), RGB. `scores` has shape (N,), from 0 to 1, and -1 if unknown. `names` contains the class
    names.
    """

    poses: Floats
    sizes: Floats
    colors: Bytes
    scores: Floats
    names: list[str]


class ImageBoxes(DataContent):
    """Boxes of a Detection2DArray, drawn over an image.

    `boxes` has shape (N, 5): x and y of the center, width and height in pixels of the image, and the rotation of the
    box in radians clockwise. The other fields are as in `SolidBoxes`.

    `of_image` is whether the boxes belong to the image with the same stamp. If not, they are drawn over the current
    image.
    """

    boxes: Floats
    colors: Bytes
    scores: Floats
    names: list[str]
    of_image: bool
