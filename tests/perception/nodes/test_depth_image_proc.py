"""depth_image_proc: depths in meters and point clouds of images, against the formula of the pinhole camera."""

from __future__ import annotations

import numpy as np
import pytest

from linkwright.graph import SENSOR_DATA_QOS
from linkwright.messages import get_message
from linkwright.nodes import NodeOptions
from linkwright.perception.nodes.depth_image_proc import (
    ConvertMetricNode,
    PointCloudXyziNode,
    PointCloudXyzNode,
    PointCloudXyzrgbNode,
)
from linkwright.perception.nodes.image_arrays import to_array, to_image
from linkwright.perception.nodes.pointcloud_to_laserscan import read_points

IMAGE, INFO, CLOUD = (get_message(f"sensor_msgs/msg/{name}") for name in ("Image", "CameraInfo", "PointCloud2"))
P = [50.0, 0.0, 3.0, 0.0, 0.0, 40.0, 2.0, 0.0, 0.0, 0.0, 1.0, 0.0]
DEPTHS = np.linspace(1.0, 3.0, 30).reshape(5, 6).round(3)


def image(pixels, encoding, stamp=1):
    message = to_image(np.asarray(pixels)[..., None] if np.ndim(pixels) == 2 else pixels, IMAGE(encoding=encoding))
    message.header.stamp.nanosec, message.header.frame_id = stamp, "camera"
    return message


def millimeters(depths=DEPTHS):
    return np.nan_to_num(np.rint(depths * 1000)).astype("u2")


@pytest.fixture
async def start(harness):
    nodes, publishers = [], {}

    class Driver:
        def __init__(self, node_class, **parameters):
            nodes.append(node_class(harness.graph, NodeOptions(parameters=parameters)))
            self.clouds, self.images = [], []

        async def listen(self, topic="points", kind=CLOUD):
            results = self.clouds if kind is CLOUD else self.images
            harness.node.create_subscription(kind, topic, results.append, SENSOR_DATA_QOS)
            await harness.graph.settle()

        async def publish(self, topic, message):
            if topic not in publishers:
                publishers[topic] = harness.node.create_publisher(type(message), topic, 10)
                await harness.graph.settle()
            publishers[topic].publish(message)
            await harness.graph.settle()

    yield Driver
    for node in nodes:
        node.close()


def expected_points(depths):
    rows, columns = np.mgrid[:5, :6]
    return np.stack([(columns - 3.0) * depths / 50.0, (rows - 2.0) * depths / 40.0, depths], axis=-1).reshape(-1, 3)


@pytest.mark.parametrize("encoding", ["16UC1", "mono16", "32FC1"])
async def test_clouds_are_those_of_a_pinhole_camera(start, encoding):
    driver = start(PointCloudXyzNode)
    await driver.listen()
    depths = DEPTHS.copy()
    depths[1, 2] = np.nan
    await driver.publish("camera_info", INFO(p=P))
    await driver.publish(
        "image_rect", image(depths.astype("f4") if encoding == "32FC1" else millimeters(depths), encoding)
    )
    (cloud,) = driver.clouds
    assert (cloud.height, cloud.width, cloud.is_dense, cloud.header.frame_id) == (5, 6, False, "camera")
    np.testing.assert_allclose(read_points(cloud), expected_points(depths), rtol=1e-5)


async def test_region_and_binning_of_the_camera_are_used(start):
    driver = start(PointCloudXyzNode)
    await driver.listen()
    info = INFO(p=P, binning_x=2, binning_y=1)
    info.roi.x_offset = 10
    await driver.publish("camera_info", info)
    await driver.publish("image_rect", image(np.ones((5, 6), "f4"), "32FC1"))
    points = read_points(driver.clouds[0]).reshape(5, 6, 3)
    np.testing.assert_allclose(points[0, :, 0], (2 * np.arange(6) + 10 - 3) / 50, rtol=1e-5)


async def test_unknown_depths_get_the_given_depth(start):
    driver = start(PointCloudXyzNode, invalid_depth=9.0)
    await driver.listen()
    await driver.publish("camera_info", INFO(p=P))
    await driver.publish("image_rect", image(np.zeros((5, 6), "u2"), "16UC1"))
    np.testing.assert_allclose(read_points(driver.clouds[0])[:, 2], 9.0)


@pytest.mark.parametrize(
    ("encoding", "pixel", "color"),
    [
        ("rgb8", (1, 2, 3), 0x010203),
        ("bgr8", (1, 2, 3), 0x030201),
        ("bgra8", (1, 2, 3, 9), 0x030201),
        ("mono8", (7,), 0x070707),
    ],
)
async def test_colored_clouds_take_the_nearest_image(start, encoding, pixel, color):
    driver = start(PointCloudXyzrgbNode)
    await driver.listen()
    pixels = np.full((5, 6, len(pixel)), pixel, "u1")
    await driver.publish("rgb/camera_info", INFO(p=P))
    await driver.publish("rgb/image_rect_color", image(0 * pixels, encoding, stamp=5))
    await driver.publish("depth_registered/image_rect", image(millimeters(), "16UC1", stamp=10))
    assert not driver.clouds  # the next image may be nearer
    await driver.publish("rgb/image_rect_color", image(pixels, encoding, stamp=11))
    (cloud,) = driver.clouds
    assert [field.name for field in cloud.fields] == ["x", "y", "z", "rgb"]
    colors = np.frombuffer(bytes(cloud.data), "<u4").reshape(-1, 4)[:, 3]
    assert set(colors.tolist()) == {color}
    np.testing.assert_allclose(read_points(cloud), expected_points(DEPTHS), rtol=1e-5)


async def test_exact_synchronization_drops_other_times(start):
    driver = start(PointCloudXyzrgbNode, exact_sync=True)
    await driver.listen()
    pixels = np.zeros((5, 6, 3), "u1")
    await driver.publish("rgb/camera_info", INFO(p=P))
    await driver.publish("depth_registered/image_rect", image(millimeters(), "16UC1", stamp=10))
    await driver.publish("rgb/image_rect_color", image(pixels, "rgb8", stamp=11))
    assert not driver.clouds
    await driver.publish("depth_registered/image_rect", image(millimeters(), "16UC1", stamp=11))
    assert [cloud.header.stamp.nanosec for cloud in driver.clouds] == [11]


async def test_clouds_have_intensities(start):
    driver = start(PointCloudXyziNode)
    await driver.listen()
    values = np.arange(30, dtype="u2").reshape(5, 6)
    await driver.publish("intensity/camera_info", INFO(p=P))
    await driver.publish("depth/image_rect", image(millimeters(), "16UC1"))
    await driver.publish("intensity/image_rect", image(values, "mono16"))
    (cloud,) = driver.clouds
    assert cloud.fields[3].name == "intensity"
    assert np.frombuffer(bytes(cloud.data), "<f4").reshape(-1, 4)[:, 3].tolist() == values.ravel().tolist()


@pytest.mark.parametrize(
    ("info", "pixels", "part"),
    [
        (INFO(), np.ones((5, 6), "f4"), "not calibrated"),
        (INFO(p=P), np.ones((5, 6), "u1"), "unsupported encoding [mono8]"),
    ],
)
async def test_unusable_images_are_logged(start, log, info, pixels, part):
    driver = start(PointCloudXyzNode)
    await driver.listen()
    await driver.publish("camera_info", info)
    await driver.publish("image_rect", image(pixels, "mono8" if pixels.dtype == np.uint8 else "32FC1"))
    assert not driver.clouds
    assert any(part in str(record.text) for record in log)


async def test_sizes_that_differ_are_logged(start, log):
    driver = start(PointCloudXyzrgbNode)
    await driver.listen()
    await driver.publish("rgb/camera_info", INFO(p=P))
    await driver.publish("depth_registered/image_rect", image(millimeters(), "16UC1"))
    await driver.publish("rgb/image_rect_color", image(np.zeros((10, 12, 3), "u1"), "rgb8"))
    assert not driver.clouds
    assert any("(6x5) does not match" in str(record.text) for record in log)


@pytest.mark.parametrize(
    ("pixels", "encoding", "expected", "result"),
    [
        (millimeters(), "16UC1", DEPTHS, "32FC1"),
        (np.where(DEPTHS > 2, np.nan, DEPTHS).astype("f4"), "32FC1", np.where(DEPTHS > 2, 0, millimeters()), "16UC1"),
    ],
)
async def test_depths_are_converted_between_meters_and_millimeters(start, pixels, encoding, expected, result):
    driver = start(ConvertMetricNode)
    await driver.listen("image", IMAGE)
    await driver.publish("image_raw", image(pixels, encoding))
    (converted,) = driver.images
    assert converted.encoding == result
    np.testing.assert_allclose(to_array(converted)[..., 0], expected, rtol=1e-6)
