"""The laser filter node: chains of filters, and their parameters."""

from __future__ import annotations

from math import nan, pi

import numpy as np
import pytest

from linkwright.diagnostics import LinkwrightError
from linkwright.geometry.single import quaternion_from_rpy
from linkwright.graph import STATIC_TF_PUBLISHER_QOS
from linkwright.messages import TFMessage, Time, TransformBatch, get_message
from linkwright.nodes import NodeOptions
from linkwright.perception.nodes.laser_filters import ScanToScanFilterChain
from linkwright.testing.stepped import AsyncSteppedGraph

RANGE = {"name": "range", "type": "laser_filters/LaserScanRangeFilter", "params": {"upper_threshold": 5}}
BOUNDS = {
    "name": "front",
    "type": "laser_filters/LaserScanAngularBoundsFilter",
    "params": {"lower_angle": -0.15, "upper_angle": 0.15},
}
BOX = {
    "name": "box",
    "type": "laser_filters/LaserScanBoxFilter",
    "params": {
        "box_frame": "base_link", "min_x": -1.0, "max_x": 1.0, "min_y": -1.0, "max_y": 1.0, "min_z": -1.0, "max_z": 1.0,
    },
}  # fmt: skip


@pytest.fixture
async def test():
    async with AsyncSteppedGraph() as graph:
        yield graph


def start_filter(test, **parameters):
    return ScanToScanFilterChain(test.graph, NodeOptions(parameters=parameters))


def logged_texts(test, level):
    return [record.text for record in test.log if record.level.name == level]


def publish_scan(test, *ranges, frame="laser"):
    message = get_message("sensor_msgs/msg/LaserScan")()
    message.header.stamp = Time.from_nanoseconds(test.clock.now_ns())
    message.header.frame_id = frame
    message.angle_min, message.angle_increment = -0.2, 0.1
    message.angle_max = -0.2 + 0.1 * (len(ranges) - 1)
    message.range_min, message.range_max, message.scan_time = 0.1, 10.0, 0.2
    message.ranges = np.array(ranges, np.float32)
    return message


async def test_filter_chain_applies_in_order_and_keeps_input(test):
    start_filter(test, filter1=RANGE, filter2=BOUNDS)
    filtered = test.record("/scan_filtered")
    input_scan = publish_scan(test, 1.0, 2.0, 9.0, 3.0, 4.0)
    for _ in range(2):
        test.publish("/scan", input_scan)
        await test.settle()
    assert list(filtered.last.ranges) == pytest.approx([2.0, nan, 3.0], nan_ok=True)
    assert filtered.last.angle_min == pytest.approx(-0.1)
    assert filtered.last.scan_time == pytest.approx(0.2)
    assert filtered.last.header == input_scan.header
    assert list(input_scan.ranges) == [1.0, 2.0, 9.0, 3.0, 4.0]


async def test_empty_chain_passes_scan(test):
    start_filter(test)
    filtered = test.record("/scan_filtered")
    test.publish("/scan", publish_scan(test, 1.0))
    await test.settle()
    test.publish("/scan", publish_scan(test, 1.0))
    await test.settle()
    assert list(filtered.last.ranges) == [1.0]


async def test_box_filter_waits_for_transform_of_laser(test):
    start_filter(test, filter1=BOX)
    filtered = test.record("/scan_filtered")
    for _ in range(2):
        test.publish("/scan", publish_scan(test, 0.5, 0.5, 0.5))
        await test.settle()
    assert len(filtered) == 0
    (text,) = logged_texts(test, "WARN")
    assert text.startswith("Dropping Scan: Transform unavailable")
    pose = np.array([[0.8, 0.0, 0.0, *quaternion_from_rpy((0.0, 0.0, pi))]])
    batch = TransformBatch(("base_link",), ("laser",), test.clock.now_ns(), pose)
    test.publish("/tf_static", TFMessage(batch=batch), STATIC_TF_PUBLISHER_QOS)
    await test.settle()
    test.publish("/scan", publish_scan(test, 0.5, 2.5, 0.5))
    await test.settle()
    assert list(filtered.last.ranges) == pytest.approx([nan, 2.5, nan], nan_ok=True)


@pytest.mark.parametrize(
    ("parameters", "text"),
    [
        ({"type": "laser_filters/LaserScanRangFilter"}, "there is no filter 'laser_filters/LaserScanRangFilter'"),
        ({"name": "x"}, "parameter 'filter1.type' is not set"),
        ({**BOX, "params": {"box_frame": "base_link"}}, "parameter 'filter1.params.min_x' is not set"),
        ({**RANGE, "params": {"lower_threshold": "near"}}, "'filter1.params.lower_threshold' cannot be 'near'"),
    ],
)
async def test_invalid_filter_chain_is_rejected(test, parameters, text):
    with pytest.raises(LinkwrightError) as caught:
        start_filter(test, filter1=parameters)
    assert text in str(caught.value)
    assert test.graph.node_names() == []


async def test_unknown_parameters_and_filters_after_gap_are_reported(test):
    start_filter(test, filter1={**RANGE, "params": {"uper_threshold": 1.0}}, filter3=BOUNDS)
    *gaps, first = logged_texts(test, "WARN")
    assert first.startswith(
        "'filter1.params.uper_threshold' is not a parameter of laser_filters/LaserScanRangeFilter; did"
    )
    assert gaps == ["'filter3' is not used: the chain ends before 'filter2'"]


async def test_lazy_chain_subscribes_only_while_subscribed(test):
    running = start_filter(test, filter1=RANGE, lazy_subscription=True)
    assert test.graph.count_subscribers("/scan") == 0
    listener = test.graph.create_node("listener")
    listener.create_subscription("sensor_msgs/msg/LaserScan", "/scan_filtered", lambda _: None, 10)
    await test.settle()
    assert test.graph.count_subscribers("/scan") == 1
    listener.destroy_node()
    await test.settle()
    assert test.graph.count_subscribers("/scan") == 0
    running.close()
