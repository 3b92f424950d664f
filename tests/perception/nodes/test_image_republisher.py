"""The image republisher: raw, compressed and depth transports."""

from __future__ import annotations

import numpy as np
import pytest

from linkwright.diagnostics import LinkwrightError
from linkwright.messages import Time, get_message
from linkwright.nodes import NodeOptions
from linkwright.perception.nodes.depthimage_to_laserscan import read_depths
from linkwright.perception.nodes.image_republisher import ImageRepublisher
from linkwright.testing.stepped import AsyncSteppedGraph


@pytest.fixture
async def test():
    async with AsyncSteppedGraph() as graph:
        yield graph


def start_republisher(test, *words, remappings=(), **parameters):
    options = NodeOptions(arguments=list(words), parameters=parameters, remappings=list(remappings))
    return ImageRepublisher(test.graph, options)


def make_image(values, encoding):
    message = get_message("sensor_msgs/msg/Image")()
    message.header.stamp, message.header.frame_id = Time.from_nanoseconds(7), "camera"
    message.height, message.width = values.shape[:2]
    message.encoding, message.step = encoding, values.nbytes // values.shape[0]
    message.data = np.frombuffer(values.tobytes(), np.uint8)
    return message


def colored_pixels():
    pixels = np.zeros((16, 16, 3), np.uint8)
    pixels[:, :, 0] = 200
    return pixels


async def publish_image(test, topic, message):
    test.publish(topic, message)
    await test.settle()
    test.publish(topic, message)
    await test.settle()


async def test_raw_image_survives_compressed_round_trip(test):
    start_republisher(test, "raw", "compressed", remappings=[("in", "/camera/image_raw"), ("out", "/small")])
    start_republisher(test, "compressed", "raw", remappings=[("in/compressed", "/small/compressed"), ("out", "/back")])
    round_trip, compressed = test.record("/back"), test.record("/small/compressed")
    await test.settle()
    await publish_image(test, "/camera/image_raw", make_image(colored_pixels(), "bgr8"))
    assert compressed.last.format == "bgr8; jpeg compressed bgr8"
    assert (round_trip.last.encoding, round_trip.last.width, round_trip.last.step) == ("bgr8", 16, 48)
    pixels = np.frombuffer(bytes(round_trip.last.data), np.uint8).reshape(16, 16, 3)
    assert np.abs(pixels.astype(int) - colored_pixels()).max() <= 4
    assert round_trip.last.header.frame_id == "camera"


async def test_depths_in_meters_survive_compressed_depth(test):
    start_republisher(test, "raw", "compressedDepth")
    start_republisher(test, "compressedDepth", "raw", remappings=[("in", "/out"), ("out", "/back")])
    back = test.record("/back")
    await test.settle()
    depths = np.array([[0.5, 1.0, 2.0, 5.0, np.nan, 20.0]], np.float32)
    await publish_image(test, "/in", make_image(depths, "32FC1"))
    assert back.last.encoding == "32FC1"
    assert read_depths(back.last)[0] == pytest.approx([0.5, 1.0, 2.0, 5.0, np.nan, np.nan], rel=0.01, nan_ok=True)


async def test_depths_in_millimeters_are_unchanged_by_compressed_depth(test):
    start_republisher(test, "raw", "compressedDepth")
    start_republisher(test, "compressedDepth", "raw", remappings=[("in", "/out"), ("out", "/back")])
    back = test.record("/back")
    await test.settle()
    depths = np.array([[0, 1, 499, 65535]], np.uint16)
    await publish_image(test, "/in", make_image(depths, "16UC1"))
    assert np.frombuffer(bytes(back.last.data), "<u2").tolist() == [0, 1, 499, 65535]


async def test_all_output_transports_are_published_by_default(test):
    start_republisher(test, in_transport="raw")
    kinds = dict(test.graph.get_topic_names_and_types())
    assert {"/out", "/out/compressed", "/out/compressedDepth"} <= set(kinds)
    assert test.graph.count_subscribers("/in") == 0
    out = test.record("/out")
    message = make_image(colored_pixels(), "rgb8")
    await publish_image(test, "/in", message)
    assert out.last is message


async def test_encoding_and_decoding_errors_are_reported(test):
    start_republisher(test, "compressed", "raw")
    test.record("/out")
    broken = get_message("sensor_msgs/msg/CompressedImage")()
    broken.format, broken.data = "rgb8; jpeg compressed bgr8", b"no image"
    await publish_image(test, "/in/compressed", broken)
    (text,) = [record.text for record in test.log if record.level.name == "ERROR"]
    assert text.startswith("An image cannot be republished: The image is neither a PNG nor a JPEG")


@pytest.mark.parametrize(
    ("words", "text"),
    [
        (["theora"], "parameter 'in_transport' of 'image_republisher' cannot be 'theora'"),
        (["raw", "png"], "parameter 'out_transport' of 'image_republisher' cannot be 'png'"),
        (["raw", "raw", "raw"], "unexpected argument 'raw'"),
    ],
)
async def test_unknown_transports_are_rejected(test, words, text):
    with pytest.raises(LinkwrightError) as caught:
        start_republisher(test, *words)
    assert text in str(caught.value)
