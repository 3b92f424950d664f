"""image_proc's node that crops images and reduces their resolution, with their camera_info.

Source: image_proc for ROS 2 (parameters, topics, defaults; binning and region of interest of the result).
"""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

from linkwright.graph import Node, Publisher
from linkwright.images.decoding import demosaic
from linkwright.messages import get_message
from linkwright.nodes.settings import check_positive
from linkwright.perception.nodes.image_arrays import LINEAR, NEAREST, create_resizing, to_array, to_image
from linkwright.perception.nodes.image_proc import CameraNode, get_info_topic

_IMAGE_TYPE, _INFO_TYPE = "sensor_msgs/msg/Image", "sensor_msgs/msg/CameraInfo"
_PUBLISHER_DEPTH = 10
_AREA = 3
"""OpenCV's number of the interpolation that averages."""


class CropDecimateNode(CameraNode):
    """The running node.

    Raises:
        LinkwrightError: a parameter has an invalid value or type (NODE433, GRAPH201).
    """

    DEFAULT_NAME, INPUT = "CropNonZeroNode", "in/image_raw"  # the name in image_proc
    DEFAULT_INTERPOLATION = NEAREST

    def declare_parameters(self, node: Node) -> None:
        """Declare the region and the decimation."""

        def declare(name: str, default: int) -> int:
            return int(node.declare_parameter(name, default).value)

        node.declare_parameter("queue_size", 5)
        self._target_frame: str = node.declare_parameter("target_frame_id", "").value
        self._decimation = tuple(
            int(check_positive(node, f"decimation_{axis}", declare(f"decimation_{axis}", 1))) for axis in "xy"
        )
        self._size = declare("width", 0), declare("height", 0)
        self._offset = declare("offset_x", 0), declare("offset_y", 0)
        self._mode: int = node.get_parameter("interpolation").value

    def create_publishers(self, node: Node) -> Publisher[Any]:
        """Return the publisher of the images, and create that of their camera_info."""
        topic = node.resolve_topic_name("out/image_raw")
        self._infos = node.create_publisher(get_message(_INFO_TYPE), get_info_topic(topic), _PUBLISHER_DEPTH)
        return node.create_publisher(get_message(_IMAGE_TYPE), topic, _PUBLISHER_DEPTH)

    def convert(self, image: Any, info: Any) -> None:
        """Publish the region of the image, decimated, and the camera_info that belongs to it."""
        is_bayer = image.encoding.startswith("bayer_")
        mask = ~1 if is_bayer else ~0  # An odd offset would change the pattern of the mosaic.
        x, y = (value & mask for value in self._offset)
        if x >= image.width or y >= image.height:
            raise ValueError(f"the offset ({x}, {y}) is outside of the image of {image.width} x {image.height} pixels")
        width, height = (
            min(size & mask or limit, limit)
            for size, limit in zip(self._size, (image.width - x, image.height - y), strict=True)
        )
        pixels = to_array(image)[y : y + height, x : x + width]
        source = image
        factors = self._decimation
        if is_bayer and factors != (1, 1):
            if factors[0] % 2 or factors[1] % 2:
                raise ValueError("Odd decimation not supported for Bayer images")
            pixels = demosaic(pixels[..., 0], image.encoding[6:10])[..., ::-1]
            source = get_message(_IMAGE_TYPE)(header=image.header, encoding=f"bgr{8 * pixels.dtype.itemsize}")
        result = to_image(_decimate(pixels, factors, self._mode), source)
        new_info = self._make_info(info, (x, y), (width, height), (image.width, image.height))
        if self._target_frame:
            result.header.frame_id = new_info.header.frame_id = self._target_frame
        self.publish_image(result)
        self._infos.publish(new_info)

    def _make_info(self, info: Any, offset: tuple[int, int], size: tuple[int, int], full_size: tuple[int, int]) -> Any:
        """Return the camera_info of a region of an image."""
        new_info = get_message(_INFO_TYPE)(
            **{name: getattr(info, name) for name in ("height", "width", "distortion_model", "d", "k", "r", "p")}
        )
        new_info.header.stamp, new_info.header.frame_id = info.header.stamp, info.header.frame_id
        binning_x, binning_y = max(info.binning_x, 1), max(info.binning_y, 1)
        new_info.binning_x, new_info.binning_y = binning_x * self._decimation[0], binning_y * self._decimation[1]
        roi = new_info.roi
        roi.x_offset = info.roi.x_offset + offset[0] * binning_x
        roi.y_offset = info.roi.y_offset + offset[1] * binning_y
        roi.width, roi.height = size[0] * binning_x, size[1] * binning_y
        roi.do_rectify = info.roi.do_rectify or size != full_size
        return new_info


def _decimate(pixels: NDArray[Any], factors: tuple[int, ...], mode: int) -> NDArray[Any]:
    """Return every n-th pixel along x and y, or interpolate between pixels."""
    x, y = factors
    if factors == (1, 1) or mode == NEAREST:
        return pixels[: pixels.shape[0] // y * y : y, : pixels.shape[1] // x * x : x]
    rows, columns = pixels.shape[0] // y, pixels.shape[1] // x
    if mode == _AREA:
        blocks = pixels[: rows * y, : columns * x].reshape(rows, y, columns, x, -1).mean(axis=(1, 3))
        rounded: NDArray[Any] = (np.rint(blocks) if pixels.dtype.kind in "ui" else blocks).astype(pixels.dtype)
        return rounded
    size = pixels.shape[1], pixels.shape[0]
    return create_resizing(size, (columns, rows), (columns / size[0], rows / size[1]), LINEAR).apply(pixels)
