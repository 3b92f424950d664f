"""Images of messages as arrays, and back."""

from __future__ import annotations

import numpy as np
import pytest
from cv_bridge import CvBridge, CvBridgeError, getCvType
from sensor_msgs.msg import CompressedImage, Image
from std_msgs.msg import Header

BRIDGE = CvBridge()

RED = np.array([[[0, 0, 255], [0, 0, 255]]], np.uint8)
"""Two red pixels; the first channel is blue."""


def make_image(array, encoding, **fields):
    message = BRIDGE.cv2_to_imgmsg(np.asarray(array), encoding)
    for name, value in fields.items():
        setattr(message, name, value)
    return message


class TestTypes:
    @pytest.mark.parametrize(
        ("name", "number", "dtype", "channels"),
        [
            ("mono8", 0, "uint8", 1),
            ("bgr8", 16, "uint8", 3),
            ("rgba8", 24, "uint8", 4),
            ("mono16", 2, "uint16", 1),
            ("16UC1", 2, "uint16", 1),
            ("32FC1", 5, "float32", 1),
            ("64FC4", 30, "float64", 4),
            ("bayer_rggb8", 0, "uint8", 1),
            ("yuv422", 8, "uint8", 2),
        ],
    )
    def test_encoding_maps_to_cv_type_and_dtype(self, name, number, dtype, channels):
        assert getCvType(name) == BRIDGE.encoding_to_cvtype2(name) == number
        assert BRIDGE.encoding_to_dtype_with_channels(name) == (dtype, channels)

    def test_unknown_encoding_is_rejected(self):
        with pytest.raises(RuntimeError, match=r"\[nonsense\]"):
            getCvType("nonsense")
        with pytest.raises(CvBridgeError, match=r"\[nonsense\]"):
            BRIDGE.imgmsg_to_cv2(Image(encoding="nonsense"))


class TestImages:
    @pytest.mark.parametrize("name", ["uint8", "int8", "uint16", "int16", "int32", "float32", "float64"])
    @pytest.mark.parametrize("shape", [(4, 6), (4, 6, 2), (4, 6, 3), (4, 6, 4)])
    def test_array_round_trips_through_message(self, name, shape):
        array = (np.arange(np.prod(shape)).reshape(shape) % 100).astype(name)
        message = BRIDGE.cv2_to_imgmsg(array)
        assert (message.height, message.width) == shape[:2]
        assert message.step == array.nbytes // 4
        back = BRIDGE.imgmsg_to_cv2(message)
        assert back.dtype == array.dtype
        assert np.array_equal(back, array)
        assert back.flags.writeable

    def test_header_is_set(self):
        header = Header(frame_id="camera")
        assert BRIDGE.cv2_to_imgmsg(RED, "bgr8", header=header).header.frame_id == "camera"

    def test_padded_rows_are_read(self):
        message = Image(height=2, width=2, step=4, encoding="mono8", data=[1, 2, 0, 0, 3, 4, 0, 0])
        assert BRIDGE.imgmsg_to_cv2(message).tolist() == [[1, 2], [3, 4]]

    def test_big_endian_image_is_read(self):
        message = Image(height=1, width=2, step=4, encoding="mono16", is_bigendian=1, data=[1, 0, 0, 2])
        array = BRIDGE.imgmsg_to_cv2(message)
        assert array.tolist() == [[256, 2]]
        assert array.dtype == np.uint16

    def test_too_short_data_is_rejected(self):
        with pytest.raises(TypeError, match="buffer is too small"):
            BRIDGE.imgmsg_to_cv2(Image(height=2, width=2, step=2, encoding="mono8", data=[1]))

    def test_non_array_is_rejected(self):
        with pytest.raises(TypeError, match="not a numpy array"):
            BRIDGE.cv2_to_imgmsg([[1, 2]])

    def test_encoding_of_other_type_is_rejected(self):
        with pytest.raises(CvBridgeError, match="encoding specified as mono8, but image has incompatible type 8UC3"):
            BRIDGE.cv2_to_imgmsg(RED, "mono8")


class TestConversions:
    @pytest.mark.parametrize(
        ("target_encoding", "pixel"),
        [
            ("rgb8", [255, 0, 0]),
            ("bgra8", [0, 0, 255, 255]),
            ("rgba8", [255, 0, 0, 255]),
            ("mono8", 76),
            ("rgb16", [65535, 0, 0]),
            ("8UC3", [0, 0, 255]),
            ("32FC3", [0.0, 0.0, 255.0]),
        ],
    )
    def test_bgr8_is_converted_to_other_encodings(self, target_encoding, pixel):
        assert BRIDGE.imgmsg_to_cv2(make_image(RED, "bgr8"), target_encoding)[0, 0].tolist() == pixel

    def test_depth_values_are_scaled_and_clamped(self):
        image_16_bit = make_image(np.array([[0, 65535, 32896]], np.uint16), "mono16")
        assert BRIDGE.imgmsg_to_cv2(image_16_bit, "mono8").tolist() == [[0, 255, 128]]
        assert BRIDGE.imgmsg_to_cv2(image_16_bit, "bgr8")[0, 1].tolist() == [255, 255, 255]
        meters = make_image(np.array([[1.6, np.nan, 1e9]], np.float32), "32FC1")
        assert BRIDGE.imgmsg_to_cv2(meters, "16UC1").tolist() == [[2, 0, 65535]]

    def test_bayer_image_is_demosaiced(self):
        mosaic = np.full((4, 4), 10, np.uint8)
        mosaic[::2, ::2] = 200
        assert BRIDGE.imgmsg_to_cv2(make_image(mosaic, "bayer_rggb8"), "rgb8")[2, 2].tolist() == [200, 10, 10]
        assert BRIDGE.imgmsg_to_cv2(make_image(mosaic, "bayer_rggb8"), "bgr8")[2, 2].tolist() == [10, 10, 200]

    def test_yuv422_is_converted(self):
        gray = np.array([[[128, 100], [128, 200]]], np.uint8)
        assert BRIDGE.imgmsg_to_cv2(make_image(gray, "yuv422"), "bgr8")[0, 0].tolist() == pytest.approx([98] * 3, abs=3)

    @pytest.mark.parametrize(
        ("source", "target_encoding", "words"),
        [
            ("32FC1", "bgr8", "is not a color format, and"),
            ("bgr8", "32FC1", "same number of channels"),
            ("bgr8", "bayer_rggb8", "Unsupported conversion"),
            ("bgr8", "nonsense", "nonsense"),
        ],
    )
    def test_impossible_conversions_are_rejected(self, source, target_encoding, words):
        array = RED if source == "bgr8" else np.zeros((2, 2), np.float32)
        with pytest.raises(CvBridgeError, match=words):
            BRIDGE.imgmsg_to_cv2(make_image(array, source), target_encoding)

    def test_converted_image_is_a_copy(self):
        message = make_image(RED, "bgr8")
        BRIDGE.imgmsg_to_cv2(message, "bgr8")[:] = 7
        assert 7 not in message.data


class TestCompressed:
    @pytest.mark.parametrize("format_", ["png", "bmp", "tiff"])
    def test_lossless_compression_round_trips(self, format_):
        array = np.arange(4 * 5 * 3, dtype=np.uint8).reshape(4, 5, 3)
        message = BRIDGE.cv2_to_compressed_imgmsg(array, format_)
        assert message.format == format_
        assert np.array_equal(BRIDGE.compressed_imgmsg_to_cv2(message), array)

    def test_jpeg_is_the_default_format(self):
        message = BRIDGE.cv2_to_compressed_imgmsg(np.full((16, 16, 3), (0, 0, 250), np.uint8))
        assert bytes(message.data[:2]) == b"\xff\xd8"
        assert BRIDGE.compressed_imgmsg_to_cv2(message, "rgb8")[8, 8].tolist() == pytest.approx([250, 0, 0], abs=4)

    def test_gray_image_is_compressed(self):
        message = BRIDGE.cv2_to_compressed_imgmsg(np.array([[1, 2], [3, 4]], np.uint8), "png")
        assert BRIDGE.compressed_imgmsg_to_cv2(message).tolist() == [[1, 2], [3, 4]]
        assert BRIDGE.compressed_imgmsg_to_cv2(message, "bgr8").shape == (2, 2, 3)

    def test_invalid_compressed_images_are_rejected(self):
        with pytest.raises(CvBridgeError, match="cannot be read"):
            BRIDGE.compressed_imgmsg_to_cv2(CompressedImage(data=[1, 2, 3]))
        with pytest.raises(CvBridgeError, match="cannot be written as 'nonsense'"):
            BRIDGE.cv2_to_compressed_imgmsg(RED, "nonsense")
        with pytest.raises(TypeError, match="not a numpy array"):
            BRIDGE.cv2_to_compressed_imgmsg("x")
