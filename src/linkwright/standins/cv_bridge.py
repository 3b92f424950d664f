"""Conversion between image messages and arrays without OpenCV (API of ``cv_bridge``)."""

from __future__ import annotations

import io
import sys
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from linkwright.messages import get_message
from linkwright.standins.image_encodings import (
    DEPTHS,
    NUMPY_NAMES,
    ConversionError,
    convert_image,
    parse_encoding,
    split_cv_type,
)

if TYPE_CHECKING:
    from PIL.Image import Image as PillowImage

_PILLOW_FORMATS = {"jpg": "JPEG", "jpeg": "JPEG", "jpe": "JPEG", "jp2": "JPEG2000", "tif": "TIFF", "tiff": "TIFF"}
_JPEG_QUALITY = 95  # OpenCV's default


class CvBridgeError(TypeError):
    """Raised when an image cannot be converted.

    The message states the reason.
    """


def getCvType(encoding_name: str) -> int:  # name as in cv_bridge
    """Return OpenCV's type number for an encoding, such as 16 (``CV_8UC3``) for ``bgr8``.

    Raises:
        RuntimeError: the encoding is unknown.
    """
    return parse_encoding(encoding_name).cv_type


class CvBridge:
    """A converter between sensor_msgs images and numpy arrays.

    Attributes:
        cvtype_to_name: OpenCV's names of pixel types without ``CV_``, such as ``8UC3``, by OpenCV's type number.
        cvdepth_to_numpy_depth: the names of numpy types, by OpenCV's depth number.
        numpy_type_to_cvtype: OpenCV's depth names by the name of the numpy type, and vice versa.
    """

    def __init__(self) -> None:
        self.cvtype_to_name = {
            index + ((channels - 1) << 3): f"{depth}C{channels}"
            for index, depth in enumerate(DEPTHS)
            for channels in (1, 2, 3, 4)
        }
        self.cvdepth_to_numpy_depth = dict(enumerate(NUMPY_NAMES))
        self.numpy_type_to_cvtype = dict(zip(NUMPY_NAMES, DEPTHS, strict=True))
        self.numpy_type_to_cvtype |= dict(zip(DEPTHS, NUMPY_NAMES, strict=True))

    def dtype_with_channels_to_cvtype2(self, dtype: np.dtype[Any], n_channels: int) -> str:
        """Return OpenCV's name of a pixel type, such as ``8UC3``, for a numpy type."""
        return f"{self.numpy_type_to_cvtype[dtype.name]}C{n_channels}"

    def cvtype2_to_dtype_with_channels(self, cvtype: int) -> tuple[str, int]:
        """Return the name of the numpy type and the number of channels for OpenCV's type number."""
        depth, channels = split_cv_type(cvtype)
        return self.numpy_type_to_cvtype[depth], channels

    def encoding_to_cvtype2(self, encoding: str) -> int:
        """Return OpenCV's type number for an encoding, as `getCvType` does.

        Raises:
            CvBridgeError: the encoding is unknown.
        """
        try:
            return getCvType(encoding)
        except ConversionError as error:
            raise CvBridgeError(error) from error

    def encoding_to_dtype_with_channels(self, encoding: str) -> tuple[str, int]:
        """Return the name of the numpy type and the number of channels for an encoding."""
        return self.cvtype2_to_dtype_with_channels(self.encoding_to_cvtype2(encoding))

    def imgmsg_to_cv2(self, img_msg: Any, desired_encoding: str = "passthrough") -> NDArray[Any]:
        """Convert a sensor_msgs/msg/Image to an array of pixels.

        Args:
            img_msg: the image message.
            desired_encoding: the encoding of the result; ``passthrough`` to keep the encoding of the message.

        Returns:
            An array of shape (height, width), or (height, width, channels) for several channels.

        Raises:
            CvBridgeError: an encoding is unknown, or the image cannot be converted to the desired encoding.
            TypeError: the message has too few bytes.
        """
        name, channels = self.encoding_to_dtype_with_channels(img_msg.encoding)
        dtype = np.dtype(name).newbyteorder(">" if img_msg.is_bigendian else "<")
        columns = img_msg.step // dtype.itemsize // channels
        shape = (img_msg.height, columns) if channels == 1 else (img_msg.height, columns, channels)
        padded_pixels: NDArray[Any] = np.ndarray(shape, dtype, buffer=bytes(img_msg.data))
        image = np.ascontiguousarray(padded_pixels[:, : img_msg.width]).astype(dtype.newbyteorder("="))
        return self._convert(image, img_msg.encoding, desired_encoding)

    def cv2_to_imgmsg(self, cvim: Any, encoding: str = "passthrough", header: Any = None) -> Any:
        """Convert an array to a sensor_msgs/msg/Image.

        Args:
            cvim: the pixels, of shape (height, width) or (height, width, channels).
            encoding: the encoding of the array; ``passthrough`` for OpenCV's name of its type, such as ``8UC3``.
            header: the header of the message; None for an empty header.

        Raises:
            TypeError: `cvim` is not an array.
            CvBridgeError: the array's type does not match the encoding.
        """
        _check_array(cvim)
        message = get_message("sensor_msgs/msg/Image")()
        message.height, message.width = cvim.shape[:2]
        if header is not None:
            message.header = header
        type_name = self.dtype_with_channels_to_cvtype2(cvim.dtype, 1 if cvim.ndim < 3 else cvim.shape[2])
        if encoding == "passthrough":
            message.encoding = type_name
        else:
            message.encoding = encoding
            if self.cvtype_to_name.get(self.encoding_to_cvtype2(encoding)) != type_name:
                raise CvBridgeError(f"encoding specified as {encoding}, but image has incompatible type {type_name}")
        is_big_endian = cvim.dtype.byteorder == ">" or (cvim.dtype.byteorder == "=" and sys.byteorder == "big")
        message.is_bigendian = int(is_big_endian)
        message.data = cvim.tobytes()
        message.step = len(message.data) // message.height if message.height else 0
        return message

    def compressed_imgmsg_to_cv2(self, cmprs_img_msg: Any, desired_encoding: str = "passthrough") -> NDArray[Any]:
        """Decode a sensor_msgs/msg/CompressedImage to an array of 8-bit pixels.

        Args:
            cmprs_img_msg: the compressed image message.
            desired_encoding: the encoding of the result; ``passthrough`` for ``mono8`` or ``bgr8``, depending on the
                file.

        Raises:
            CvBridgeError: the data is not an image, or the image cannot be converted.
        """
        from PIL import Image, UnidentifiedImageError  # an optional dependency, imported only when needed

        try:
            with Image.open(io.BytesIO(bytes(cmprs_img_msg.data))) as pillow_image:
                is_gray = pillow_image.mode in ("1", "L", "LA", "I", "I;16", "F")
                pixels = np.asarray(pillow_image.convert("L" if is_gray else "RGB"))
        except (UnidentifiedImageError, OSError, SyntaxError) as error:
            raise CvBridgeError(f"the data of the compressed image cannot be read: {error}") from error
        image = pixels.copy() if is_gray else np.ascontiguousarray(pixels[..., ::-1])
        return self._convert(image, "mono8" if is_gray else "bgr8", desired_encoding)

    def cv2_to_compressed_imgmsg(self, cvim: Any, dst_format: str = "jpg") -> Any:
        """Encode an array as a sensor_msgs/msg/CompressedImage.

        Args:
            cvim: 8-bit pixels of shape (height, width), or (height, width, 3 or 4) with the blue channel first.
            dst_format: the format, as a file suffix: ``jpg``, ``png``, ``bmp``, ``webp``, ``tiff``...

        Raises:
            TypeError: `cvim` is not an array.
            CvBridgeError: the format does not exist, or does not support such an image.
        """
        _check_array(cvim)
        message = get_message("sensor_msgs/msg/CompressedImage")()
        message.format = dst_format
        buffer = io.BytesIO()
        try:
            pillow_image = _to_pillow_image(cvim)
            pillow_format = _PILLOW_FORMATS.get(dst_format.lower(), dst_format.upper())
            if pillow_format == "JPEG" and pillow_image.mode == "RGBA":
                pillow_image = pillow_image.convert("RGB")
            pillow_image.save(buffer, pillow_format, quality=_JPEG_QUALITY)
        except (KeyError, OSError, ValueError, TypeError) as error:
            raise CvBridgeError(f"the image cannot be written as '{dst_format}': {error}") from error
        message.data = buffer.getvalue()
        return message

    def _convert(self, image: NDArray[Any], source_encoding: str, desired_encoding: str) -> NDArray[Any]:
        if desired_encoding == "passthrough":
            return image
        try:
            return convert_image(image, source_encoding, desired_encoding)
        except ConversionError as error:
            raise CvBridgeError(error) from error


def _check_array(image: object) -> None:
    if not isinstance(image, np.ndarray | np.generic):
        raise TypeError("Your input type is not a numpy array")


def _to_pillow_image(image: NDArray[Any]) -> PillowImage:
    from PIL import Image

    if image.ndim == 3 and image.shape[2] == 1:
        image = image[..., 0]
    if image.ndim == 3:
        image = np.ascontiguousarray(image[..., [2, 1, 0, 3][: image.shape[2]]])
    return Image.fromarray(image)
