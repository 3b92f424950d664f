"""Images of image_transport's `compressed` and `compressedDepth`.

The tests cover unpacking, and the displays that show them.
"""

from __future__ import annotations

import struct
from contextlib import suppress

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from hypothesis.extra.numpy import arrays

from linkwright.images import BadImageError, ImageSource, Unpacker
from linkwright.images.compressed_depth import BadRvlError, decode_rvl
from linkwright.messages import get_message
from linkwright.page.protocol.images import ImageFrame
from linkwright.rviz.image_compression import ImageCompressor
from tests.rviz.displays import test_cloud_displays as clouds
from tests.rviz.displays import test_image_displays as images
from tests.viewer.contents import unpack_contents
from tests.viewer.packed_images import (
    CompressedImage,
    depth_header,
    encode_rvl,
    encode_sized_rvl,
    make_compressed_image,
    make_depth_message,
    make_jpeg,
    make_png,
)
from tests.viewer.scene import open_world

CameraInfo = get_message("sensor_msgs/msg/CameraInfo")
MILLIMETERS = np.array([[0, 1000, 1001], [65535, 0, 1]], np.uint16)


def decode_compressed(message, transport: str = "compressedDepth"):
    return Unpacker().image(message, transport)


def image_values(image, kind: str) -> list:
    return image.data.view(kind).reshape(image.height, image.width).tolist()


# --- topics ----------------------------------------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("topic", "hint", "expected"),
    [
        ("/depth/image", "raw", ("/depth/image", "raw", "/depth/image")),
        ("/depth/image", "compressedDepth", ("/depth/image", "compressedDepth", "/depth/image/compressedDepth")),
        ("/depth/image/compressedDepth", "raw", ("/depth/image", "compressedDepth", "/depth/image/compressedDepth")),
        (" /color/compressed ", "theora", ("/color", "compressed", "/color/compressed")),
        ("/compressed_air", "", ("/compressed_air", "raw", "/compressed_air")),
        ("", "compressed", ("", "raw", "")),
    ],
)
def test_image_source_resolves_transport_topic(topic, hint, expected):
    source = ImageSource.of(topic, hint)
    assert (source.base, source.transport, source.topic) == expected
    assert source.message_type.endswith("/Image") == (source.transport == "raw")


# --- unpacking -------------------------------------------------------------------------------------------------------


@pytest.mark.parametrize("packing", ["png", "rvl"])
def test_integer_depths_are_decoded_losslessly(packing):
    image = decode_compressed(make_depth_message(MILLIMETERS, packing))
    assert (image.encoding, image.width, image.height, image.step) == ("16UC1", 3, 2, 6)
    assert image_values(image, "<u2") == MILLIMETERS.tolist()
    assert image.header.frame_id == "base"


@pytest.mark.parametrize("packing", ["png", "rvl"])
def test_depths_in_meters_are_decoded_within_quantization(packing):
    meters = np.array([[0.5, 1.0, 4.0, 9.0], [np.nan, np.inf, 11.0, 2.0]])
    image = decode_compressed(make_depth_message(meters, packing))
    assert image.encoding == "32FC1"
    expected = np.where(meters < 10.0, meters, np.nan)
    assert np.allclose(image.data.view("<f4").reshape(2, 4), expected, rtol=0.002, equal_nan=True)


@pytest.mark.parametrize(
    "form", ["16UC1", "16UC1; compressedDepth", "mono16; compressedDepth png", "16UC1;compressedDepth"]
)
def test_formats_of_older_publishers_are_read(form):
    assert (
        image_values(decode_compressed(make_compressed_image(form, depth_header() + make_png(MILLIMETERS))), "<u2")
        == MILLIMETERS.tolist()
    )


def test_color_and_gray_images_are_decoded():
    image = decode_compressed(
        make_compressed_image("rgb8; jpeg compressed bgr8", make_jpeg((200, 100, 50), 16, 8)), "compressed"
    )
    assert (image.encoding, image.width, image.height) == ("rgb8", 16, 8)
    assert np.allclose(image.data.reshape(-1, 3), [200, 100, 50], atol=3)
    image = decode_compressed(make_compressed_image("mono8; jpeg compressed ", make_jpeg(90, 4, 4)), "compressed")
    assert (image.encoding, image.data.tolist()) == ("mono8", [90] * 16)
    image = decode_compressed(make_compressed_image("png", make_png(MILLIMETERS)), "compressed")
    assert (image.encoding, image_values(image, "<u2")) == ("mono16", MILLIMETERS.tolist())


def test_depths_are_decoded_from_compressed_transport():
    image = decode_compressed(make_compressed_image("16UC1; png compressed ", make_png(MILLIMETERS)), "compressed")
    assert (image.encoding, image_values(image, "<u2")) == ("16UC1", MILLIMETERS.tolist())
    image = decode_compressed(make_compressed_image("16UC1; jpeg compressed mono8", make_jpeg(4, 1, 1)), "compressed")
    assert (image.encoding, image_values(image, "<u2")) == ("16UC1", [[1024]])


@given(arrays(np.uint16, st.integers(1, 60), elements=st.sampled_from([0, 0, 0, 1, 2, 900, 901, 40000, 65535])))
def test_rvl_round_trip(pixels):
    assert decode_rvl(np.frombuffer(encode_rvl(pixels), np.uint8), len(pixels)).tolist() == pixels.tolist()


@given(st.binary(max_size=200), st.integers(1, 5000))
def test_rvl_decoder_survives_arbitrary_bytes(data, pixels):
    with suppress(BadRvlError):
        assert len(decode_rvl(np.frombuffer(data, np.uint8), pixels)) == pixels


@pytest.mark.parametrize(
    ("form", "data", "text"),
    [
        ("jpeg", depth_header() + make_png(MILLIMETERS), "The format of the depth image is 'jpeg', but only 16UC1"),
        (
            "16UC1; compressedDepth zip",
            depth_header() + make_png(MILLIMETERS),
            "but only 16UC1, mono16 and 32FC1 are supported",
        ),
        (
            "8UC1; compressedDepth png",
            depth_header() + make_png(MILLIMETERS),
            "The format of the depth image is '8UC1;",
        ),
        ("16UC1; compressedDepth png", depth_header()[:7], "has 7 bytes, so it has no data after its header"),
        ("16UC1; compressedDepth png", depth_header() + b"depths", "neither a PNG nor a JPEG"),
        ("16UC1; compressedDepth png", depth_header() + make_png(MILLIMETERS)[:50], "The PNG cannot be read: "),
        ("16UC1; compressedDepth png", depth_header() + make_png(MILLIMETERS)[:20], "The PNG cannot be read: "),
        (
            "16UC1; compressedDepth png",
            depth_header() + make_png(MILLIMETERS, says=(60000, 60000)),
            "The PNG has 60000 x 60000 pixels; at most 16777216 are supported",
        ),
        (
            "16UC1; compressedDepth png",
            depth_header() + make_png(MILLIMETERS.astype(np.uint8)),
            "not a PNG of 16 bits and one channel",
        ),
        (
            "32FC1; compressedDepth png",
            depth_header(0.0, 1.0) + make_png(MILLIMETERS),
            "has an invalid scale of the depths: 0, 1",
        ),
        (
            "32FC1; compressedDepth png",
            depth_header(np.nan, 1.0) + make_png(MILLIMETERS),
            "has an invalid scale of the depths: nan, 1",
        ),
        ("16UC1; compressedDepth rvl", depth_header() + b"1234567", "is too short to contain its size"),
        (
            "16UC1; compressedDepth rvl",
            depth_header() + encode_sized_rvl(MILLIMETERS, says=(4_000_000_000, 4_000_000_000)),
            "declares 4000000000 x 4000000000 pixels; 1 to 16777216 are supported",
        ),
        ("16UC1; compressedDepth rvl", depth_header() + encode_sized_rvl(MILLIMETERS, says=(0, 7)), "declares 0 x 7"),
        (
            "16UC1; compressedDepth rvl",
            depth_header() + encode_sized_rvl(MILLIMETERS)[:-4],
            "The RVL depth image of 3 x 2 pixels cannot be read: it ends",
        ),
        ("16UC1; compressedDepth rvl", depth_header() + encode_sized_rvl(MILLIMETERS, says=(1, 2)), "pixels too many"),
        (
            "16UC1; compressedDepth rvl",
            depth_header() + encode_sized_rvl(MILLIMETERS, says=(30, 20)),
            "empty run|pixels too early",
        ),
        (
            "16UC1; compressedDepth rvl",
            depth_header() + struct.pack("<II", 2, 2) + b"\xff" * 40 + bytes(4),
            "a number of more than 30 bits",
        ),
    ],
)
def test_malformed_depth_image_is_rejected_with_reason(form, data, text):
    with pytest.raises(BadImageError, match=text):
        decode_compressed(make_compressed_image(form, data))


def test_malformed_color_image_is_rejected_with_reason():
    for data, text in (
        (b"", "neither a PNG nor a JPEG"),
        (make_jpeg(9, 64, 64)[:100], "The JPEG cannot be read: "),
        (make_png(MILLIMETERS, says=(1 << 30, 1 << 30)), r"The PNG has 1073741824 x 1073741824 pixels"),
    ):
        with pytest.raises(BadImageError, match=text):
            decode_compressed(make_compressed_image("rgb8; jpeg compressed bgr8", data), "compressed")


def test_image_with_too_many_pixels_is_not_compressed():
    data = np.frombuffer(make_png(MILLIMETERS, says=(9000, 9000)), np.uint8)
    frame = ImageFrame(0, 0, 0, 0, "file", data, None)
    assert ImageCompressor().compress(frame, 10) is frame


# --- displays --------------------------------------------------------------------------------------------------------


def publish_camera_info(node):
    node.create_publisher(CameraInfo, "/depth/camera_info", 5).publish(clouds.make_camera_info(2, 1))


@pytest.mark.parametrize("packing", ["png", "rvl"])
async def test_depth_cloud_follows_transport_hints(packing):
    topics = {
        "Depth_Map_Topic": "/depth/image",
        "Depth_Map_Transport_Hint": "compressedDepth",
        "Color_Image_Topic": "/color/image",
        "Color_Transport_Hint": "compressed",
    }
    async with open_world(clouds.make_config("DepthCloud", **topics)) as world:
        node = world.graph.create_node("camera")
        publish_camera_info(node)
        depths = node.create_publisher(CompressedImage, "/depth/image/compressedDepth", 5)
        colors = node.create_publisher(CompressedImage, "/color/image/compressed", 5)
        depths.publish(make_depth_message(np.array([[2000, 4000]], np.uint16), packing))
        colors.publish(make_compressed_image("rgb8; jpeg compressed bgr8", make_jpeg((0, 0, 250), 2, 1)))
        await world.settle()
        display = world.display("DepthCloud")
        (content,) = unpack_contents(display)
        assert content.fields["positions"].reshape(-1, 3).tolist() == [[0, 0, 2], [2, 0, 4]]
        assert np.allclose(clouds.drawn_colors(display), [[0, 0, 250, 255]] * 2, atol=4)
        status = world.status("DepthCloud")
        assert status["Message"] == ("ok", "Ok")
        assert (status["Depth Image Size"], status["Image Size"]) == (("ok", "2 x 1"), ("ok", "2 x 1"))


async def test_depth_topic_may_name_its_transport():
    async with open_world(clouds.make_config("DepthCloud", Depth_Map_Topic="/depth/image/compressedDepth")) as world:
        node = world.graph.create_node("camera")
        publish_camera_info(node)
        depths = node.create_publisher(CompressedImage, "/depth/image/compressedDepth", 5)
        depths.publish(make_depth_message(np.array([[2.0, np.nan]])))
        await world.settle()
        (content,) = unpack_contents(world.display("DepthCloud"))
        ((x, y, z),) = content.fields["positions"].reshape(-1, 3).tolist()
        assert (x, y, round(z, 2)) == (0.0, 0.0, 2.0)


async def test_malformed_depth_image_status_is_cleared_by_valid_image():
    topics = {"Depth_Map_Topic": "/depth/image", "Depth_Map_Transport_Hint": "compressedDepth"}
    async with open_world(clouds.make_config("DepthCloud", **topics)) as world:
        node = world.graph.create_node("camera")
        publish_camera_info(node)
        depths = node.create_publisher(CompressedImage, "/depth/image/compressedDepth", 5)
        depths.publish(make_compressed_image("16UC1; compressedDepth png", depth_header() + b"\x89PNG\r\n\x1a\n"))
        await world.settle()
        status = world.status("DepthCloud")
        assert {name for name, (level, _) in status.items() if level == "error"} == {"Message"}
        assert status["Message"][1].startswith("Error updating depth cloud: The PNG cannot be read: ")
        depths.publish(make_depth_message(np.array([[2000, 4000]], np.uint16)))
        await world.settle()
        assert world.status("DepthCloud")["Message"] == ("ok", "Ok")


async def test_depth_cloud_reports_unsupported_theora_transport():
    topics = {"Depth_Map_Topic": "/depth/image", "Color_Image_Topic": "/c", "Color_Transport_Hint": "theora"}
    async with open_world(clouds.make_config("DepthCloud", **topics)) as world:
        text = "Images of transport 'theora' are not supported: choose raw, compressed or compressedDepth"
        assert world.status("DepthCloud") == {"Color Transport Hint": ("error", text)}
        world.display("DepthCloud").set_property(("Color Transport Hint",), "compressed")
        await world.settle()
        assert "Color Transport Hint" not in world.status("DepthCloud")


async def test_image_display_shows_depths_in_gray():
    async with open_world(images.make_config("Image", "/camera/depth/compressedDepth")) as world:
        display = world.display("Image")
        publisher = world.graph.create_node("camera").create_publisher(
            CompressedImage, "/camera/depth/compressedDepth", 5
        )
        publisher.publish(make_depth_message(np.array([[0, 500, 1000]], np.uint16), "rvl"))
        await world.settle()
        (content,) = unpack_contents(display)
        fields = content.fields
        assert (fields["encoding"], fields["width"], fields["height"]) == ("gray", 3, 1)
        assert fields["data"].tolist() == [0, 127, 255]
        assert images.row_names(display) == {"Topic", "Normalize Range", "Median window"}
        display.set_property(("Normalize Range",), False)
        display.set_property(("Max Value",), 2000.0)
        assert unpack_contents(display)[0].fields["data"].tolist() == [0, 63, 127]
        publisher.publish(make_compressed_image("16UC1; compressedDepth rvl", depth_header() + bytes(8)))
        await world.settle()
        text = "The header of the RVL depth image declares 0 x 0 pixels; 1 to 16777216 are supported"
        assert world.status("Image")["Image"] == ("error", text)


async def test_compressed_16_bit_images_have_range():
    async with open_world(images.make_config("Image", "/camera/depth/compressed")) as world:
        publisher = world.graph.create_node("camera").create_publisher(CompressedImage, "/camera/depth/compressed", 5)
        publisher.publish(
            make_compressed_image("16UC1; png compressed ", make_png(np.array([[0, 500, 1000]], np.uint16)))
        )
        await world.settle()
        assert unpack_contents(world.display("Image"))[0].fields["data"].tolist() == [0, 127, 255]


async def test_camera_display_shows_compressed_depths():
    async with open_world(images.make_config("Camera", "/camera/depth/compressedDepth")) as world:
        node = world.graph.create_node("camera")
        node.create_publisher(CameraInfo, "/camera/camera_info", 5).publish(images.make_camera_info(2, 1))
        publisher = node.create_publisher(CompressedImage, "/camera/depth/compressedDepth", 5)
        publisher.publish(make_depth_message(np.array([[0, 9]], np.uint16)))
        await world.settle()
        (content,) = unpack_contents(world.display("Camera"))
        assert content.fields["data"].tolist() == [0, 255]
        assert content.fields["camera"]["focal_x"] == 100.0


@pytest.mark.parametrize("cls", ["Image", "Camera"])
async def test_theora_image_status_names_supported_topics(cls):
    async with open_world(images.make_config(cls, "/camera/image/theora")) as world:
        text = "Images of transport 'theora' are not supported: choose /camera/image or /camera/image/compressed"
        assert world.status(cls)["Topic"] == ("error", text)
