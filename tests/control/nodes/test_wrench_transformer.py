"""The node that publishes wrenches in other frames."""

from __future__ import annotations

from math import sqrt
from typing import Any

import pytest

from linkwright.control.nodes.wrench_transformer import WrenchTransformer
from linkwright.diagnostics import LinkwrightError
from linkwright.graph import DurabilityPolicy, QoSProfile
from linkwright.messages import get_message
from linkwright.nodes import NodeOptions

WRENCH = get_message("geometry_msgs/msg/WrenchStamped")
TF = get_message("tf2_msgs/msg/TFMessage")
TRANSFORM = get_message("geometry_msgs/msg/TransformStamped")


def wrench(frame: str = "tool") -> Any:
    message = WRENCH()
    message.header.frame_id, message.header.stamp.sec = frame, 7
    message.wrench.force.x, message.wrench.torque.z = 3.0, 2.0
    return message


async def transform(harness: Any, message: Any, topic: str, output: str, options: NodeOptions) -> list[Any]:
    """Return what the node publishes for a message, with the tool turned by 90 degrees about z of the base."""
    WrenchTransformer(harness.graph, options)
    received: list[Any] = []
    harness.node.create_subscription(WRENCH, output, received.append, 10)
    pose = TRANSFORM()
    pose.header.frame_id, pose.child_frame_id = "base", "tool"
    pose.transform.translation.x = 0.5
    pose.transform.rotation.z = pose.transform.rotation.w = sqrt(0.5)
    latched = QoSProfile(1, durability=DurabilityPolicy.TRANSIENT_LOCAL)
    harness.node.create_publisher(TF, "/tf_static", latched).publish(TF(transforms=[pose]))
    await harness.graph.settle()
    harness.node.create_publisher(WRENCH, topic, 10).publish(message)
    await harness.graph.settle()
    return received


@pytest.mark.parametrize(
    "options",
    [NodeOptions(parameters={"target_frames": ["base", "tool"]}), NodeOptions(arguments=["base", "tool"])],
    ids=["parameter", "arguments"],
)
async def test_wrench_is_rotated_into_other_frame(harness, options):
    topic = "/fts_wrench_transformer/wrench"
    (result,) = await transform(harness, wrench(), topic, "/fts_wrench_transformer/base/wrench", options)
    assert (result.header.frame_id, result.header.stamp.sec) == ("base", 7)
    assert (result.wrench.force.x, result.wrench.force.y) == pytest.approx((0.0, 3.0))
    assert (result.wrench.torque.y, result.wrench.torque.z) == pytest.approx((0.0, 2.0))


async def test_filtered_wrench_in_namespace_has_other_topic(harness):
    options = NodeOptions(
        parameters={"target_frames": ["base"]}, namespace="/arm", remappings=[("~/wrench", "/fts/wrench_filtered")]
    )
    received = await transform(harness, wrench(), "/fts/wrench_filtered", "/arm/base/wrench_filtered", options)
    assert len(received) == 1


@pytest.mark.parametrize(
    ("frame", "reason"),
    [("", "frame_id is empty"), ("hand", '"hand" passed to lookupTransform')],
    ids=["empty", "other"],
)
async def test_wrench_in_unknown_frame_is_reported_and_skipped(harness, logged, frame, reason):
    options = NodeOptions(arguments=["base"])
    topic = "/fts_wrench_transformer/wrench"
    assert not await transform(harness, wrench(frame), topic, "/fts_wrench_transformer/base/wrench", options)
    assert reason in logged("ERROR")[0]


async def test_node_without_frames_does_not_start(harness):
    with pytest.raises(LinkwrightError, match="'target_frames' names no frame"):
        WrenchTransformer(harness.graph, NodeOptions())
