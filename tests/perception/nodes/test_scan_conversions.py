"""Nodes that convert depth images and clouds to scans."""

from __future__ import annotations

from math import hypot, inf, pi

import numpy as np
import pytest

from linkwright.diagnostics import LinkwrightError
from linkwright.geometry.single import quaternion_from_rpy
from linkwright.graph import STATIC_TF_PUBLISHER_QOS
from linkwright.messages import TFMessage, Time, TransformBatch, get_message
from linkwright.nodes import NodeOptions
from linkwright.perception.nodes.depthimage_to_laserscan import DepthImageToLaserScan
from linkwright.perception.nodes.laser_merger import LaserScanMultiMerger
from linkwright.perception.nodes.pointcloud_to_laserscan import (
    LaserScanToPointCloud,
    PointCloudToLaserScan,
    read_points,
)
from linkwright.testing.stepped import AsyncSteppedGraph


@pytest.fixture
async def test():
    async with AsyncSteppedGraph() as graph:
        yield graph


def start_node(test, kind, **parameters):
    return kind(test.graph, NodeOptions(parameters=parameters))


def logged_texts(test, level):
    return [record.text for record in test.log if record.level.name == level]


async def publish_message(test, topic, message):
    """Publish, with a publisher that the node has found before."""
    if not any(publisher.name == topic for publisher in test.node.publishers):
        test.node.create_publisher(type(message), topic, 10)
        await test.settle()
    test.publish(topic, message)
    await test.settle()


def message_in_frame(test, kind, frame):
    message = get_message(kind)()
    message.header.stamp, message.header.frame_id = Time.from_nanoseconds(test.clock.now_ns()), frame
    return message


def publish_depth_image(test, depths, encoding="32FC1"):
    message = message_in_frame(test, "sensor_msgs/msg/Image", "camera")
    rows = np.asarray(depths, "<f4" if encoding == "32FC1" else "<u2")
    message.height, message.width = rows.shape
    message.encoding, message.step = encoding, rows.strides[0]
    message.data = np.frombuffer(rows.tobytes(), np.uint8)
    return message


def publish_camera_info(test):
    message = message_in_frame(test, "sensor_msgs/msg/CameraInfo", "camera")
    message.p = [4.0, 0.0, 2.0, 0.0, 0.0, 4.0, 1.5, 0.0, 0.0, 0.0, 1.0, 0.0]
    return message


async def test_depth_image_becomes_scan(test):
    start_node(test, DepthImageToLaserScan, range_min=0.1, output_frame="laser")
    scan = test.record("/scan")
    await publish_message(test, "/depth", publish_depth_image(test, np.full((3, 5), 2.0)))
    assert len(scan) == 0
    assert logged_texts(test, "ERROR") == [
        "Could not convert depth image to laserscan: no camera_info with a focal length has arrived"
    ]
    await publish_message(test, "/depth_camera_info", publish_camera_info(test))
    await publish_message(test, "/depth", publish_depth_image(test, np.full((3, 5), 2.0)))
    assert scan.last.ranges[2] == 2.0
    assert scan.last.ranges[0] == pytest.approx(hypot(2.0, 0.5))
    assert scan.last.header.frame_id == "laser"
    assert scan.last.scan_time == pytest.approx(0.033)
    await publish_message(test, "/depth", publish_depth_image(test, np.full((3, 5), 1500), "16UC1"))
    assert scan.last.ranges[2] == pytest.approx(1.5)
    count = len(scan)
    await test.advance(10.0)
    image_of_odd_size = publish_depth_image(test, np.full((3, 5), 2.0))
    image_of_odd_size.encoding = "rgb8"
    await publish_message(test, "/depth", image_of_odd_size)
    assert len(scan) == count
    assert logged_texts(test, "ERROR")[-1].endswith("Depth image has unsupported encoding: rgb8")


async def test_conversion_subscribes_only_while_subscribed(test):
    running = start_node(test, DepthImageToLaserScan)
    await test.settle()
    assert test.graph.count_subscribers("/depth") == 0
    listener = test.node.create_subscription(get_message("sensor_msgs/msg/LaserScan"), "scan", lambda _: None, 10)
    await test.settle()
    assert test.graph.count_subscribers("/depth") == 1
    test.node.destroy_subscription(listener)
    await test.settle()
    assert test.graph.count_subscribers("/depth") == 0
    running.close()


def publish_cloud(test, points, frame="camera"):
    message = message_in_frame(test, "sensor_msgs/msg/PointCloud2", frame)
    kind = np.dtype({"names": ["x", "y", "z"], "formats": ["<f4"] * 3, "offsets": [4, 8, 12], "itemsize": 20})
    values = np.zeros(len(points), kind)
    for axis, name in enumerate("xyz"):
        values[name] = np.asarray(points)[:, axis]
    field = get_message("sensor_msgs/msg/PointField")
    message.fields = [field(name=name, offset=4 + 4 * axis, datatype=7, count=1) for axis, name in enumerate("xyz")]
    message.height, message.width, message.point_step, message.row_step = 1, len(points), 20, 20 * len(points)
    message.data = np.frombuffer(values.tobytes(), np.uint8)
    return message


def publish_transform(test, parent, child, rpy):
    batch = TransformBatch((parent,), (child,), 0, np.array([[0.0, 0.0, 0.5, *quaternion_from_rpy(rpy)]]))
    test.publish("/tf_static", TFMessage(batch=batch), STATIC_TF_PUBLISHER_QOS)


async def test_cloud_becomes_scan_in_target_frame(test):
    parameters = {"angle_increment": pi / 2, "min_height": 0.0, "max_height": 1.0, "range_max": 10.0}
    start_node(test, PointCloudToLaserScan, target_frame="base_link", **parameters)
    scan = test.record("/scan")
    await publish_message(test, "/cloud_in", publish_cloud(test, [[0.1, 1.0, 0.0]]))
    assert len(scan) == 0
    assert logged_texts(test, "WARN")[0].startswith("Transform failure:")
    publish_transform(test, "base_link", "camera", (0.0, 0.0, -pi / 2))
    await test.settle()
    await publish_message(test, "/cloud_in", publish_cloud(test, [[0.1, 1.0, 0.0], [0.1, 3.0, 0.0], [0.1, 0.5, 2.0]]))
    assert list(scan.last.ranges) == pytest.approx([inf, hypot(1.0, 0.1), inf, inf])
    assert scan.last.header.frame_id == "base_link"


async def test_rays_without_points_exceed_range_with_inf_epsilon(test):
    start_node(test, PointCloudToLaserScan, angle_increment=pi / 2, range_max=10.0, use_inf=False, inf_epsilon=2.0)
    scan = test.record("/scan")
    await publish_message(test, "/cloud_in", publish_cloud(test, np.zeros((0, 3))))
    await publish_message(test, "/cloud_in", publish_cloud(test, np.zeros((0, 3))))
    assert list(scan.last.ranges) == [12.0] * 4


async def test_scan_becomes_cloud(test):
    start_node(test, LaserScanToPointCloud, target_frame="base_link")
    clouds = test.record("/cloud")
    publish_transform(test, "base_link", "laser", (0.0, 0.0, pi / 2))
    message = message_in_frame(test, "sensor_msgs/msg/LaserScan", "laser")
    message.angle_increment, message.range_min, message.range_max = 0.1, 0.1, 5.0
    message.ranges, message.intensities = [1.0, inf, 2.0], [7.0, 8.0, 9.0]
    await publish_message(test, "/scan_in", message)
    await publish_message(test, "/scan_in", message)
    points = read_points(clouds.last)
    assert points[0] == pytest.approx([0.0, 1.0, 0.5], abs=1e-6)
    assert len(points) == 2
    assert [field.name for field in clouds.last.fields] == ["x", "y", "z", "intensity", "index"]
    values = np.frombuffer(bytes(clouds.last.data), np.dtype([("xyz", "<3f4"), ("intensity", "<f4"), ("index", "<i4")]))
    assert values["intensity"].tolist() == [7.0, 9.0]
    assert values["index"].tolist() == [0, 2]


async def test_invalid_parameters_are_rejected(test):
    with pytest.raises(LinkwrightError, match="'angle_increment' of 'pointcloud_to_laserscan' cannot be '0"):
        start_node(test, PointCloudToLaserScan, angle_increment=0.0)
    with pytest.raises(LinkwrightError, match="parameter 'scan_height' of 'depthimage_to_laserscan' cannot be '0'"):
        start_node(test, DepthImageToLaserScan, scan_height=0)


async def test_scans_of_several_lasers_are_merged_when_each_has_measured(test):
    start_node(
        test,
        LaserScanMultiMerger,
        destination_frame="base",
        laserscan_topics="/front /rear",
        scan_destination_topic="/merged",
        angle_min=-pi,
        angle_max=pi,
        angle_increment=pi / 4,
        range_min=0.1,
    )
    static = test.node.create_publisher(TFMessage, "/tf_static", STATIC_TF_PUBLISHER_QOS)
    poses = [(0.5, 0, 0.2, 0, 0, 0, 1), (-0.5, 0, 0.2, *quaternion_from_rpy((0, 0, pi)))]
    static.publish(TFMessage(batch=TransformBatch(("base", "base"), ("front_laser", "rear_laser"), 0, np.array(poses))))
    scans, clouds = test.record("/merged"), test.record("/merged_cloud")
    await test.settle()
    for name, ranges in (("front", [2.0, inf, 1.0]), ("rear", [3.0, inf, 2.5])):
        message = message_in_frame(test, "sensor_msgs/msg/LaserScan", f"{name}_laser")
        message.angle_min, message.angle_max, message.angle_increment = -0.01, 0.01, 0.01
        message.range_min, message.range_max, message.ranges = 0.05, 10.0, np.array(ranges, np.float32)
        assert not len(scans)
        await publish_message(test, f"/{name}", message)
    assert (scans.last.header.frame_id, len(scans.last.ranges)) == ("base", 8)
    front, rear = scans.last.ranges[4], min(scans.last.ranges[0], scans.last.ranges[7])
    assert (front, rear) == (pytest.approx(1.5, abs=0.01), pytest.approx(3.0, abs=0.01))
    assert scans.last.ranges[2] == pytest.approx(26.0)  # range_max + 1 without a point
    assert read_points(clouds.last)[:, 2] == pytest.approx([0.2] * 4)
    assert len(scans) == 1
