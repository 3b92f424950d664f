"""The nodes that send goals to controllers in turn."""

from __future__ import annotations

from typing import Any

import pytest

from linkwright.control.nodes.goal_publishers import ForwardPositionPublisher, JointTrajectoryPublisher
from linkwright.diagnostics import LinkwrightError
from linkwright.messages import get_message
from linkwright.nodes import NodeOptions

FLOATS, TRAJECTORY = "std_msgs/msg/Float64MultiArray", "trajectory_msgs/msg/JointTrajectory"
JOINT_STATE = get_message("sensor_msgs/msg/JointState")
ARM = {
    "controller_name": "arm",
    "joints": ["a", "b"],
    "goal_names": ["up", "down"],
    "wait_sec_between_publish": 2,
    "up": {"positions": [0.5, 1.0], "velocities": [0.1]},
    "down": {"positions": [0.0, 0.0]},
}


def start(harness: Any, node: type, topic_type: str, topic: str, **parameters: Any) -> list[Any]:
    """Start a node, and return the list of what it publishes."""
    received: list[Any] = []
    harness.node.create_subscription(topic_type, topic, received.append, 10)
    node(harness.graph, NodeOptions(parameters=parameters))
    return received


async def test_positions_are_published_in_turn(harness):
    goals = {"goal_names": ["pos1", "pos2"], "pos1": [0.5, 1.0], "pos2": [0.0, 0.0], "publish_topic": "/arm/commands"}
    received = start(harness, ForwardPositionPublisher, FLOATS, "/arm/commands", **goals)
    for _ in range(3):
        await harness.clock.advance(5.0)
    assert [list(message.data) for message in received] == [[0.5, 1.0], [0.0, 0.0], [0.5, 1.0]]


async def test_trajectories_have_values_for_all_joints(harness):
    received = start(harness, JointTrajectoryPublisher, TRAJECTORY, "/arm/joint_trajectory", **ARM)
    await harness.clock.advance(2.0)
    await harness.clock.advance(2.0)
    (first,), (second,) = (message.points for message in received)
    assert list(received[0].joint_names) == ["a", "b"]
    assert (list(first.positions), list(first.velocities), first.time_from_start.sec) == ([0.5, 1.0], [], 4)
    assert list(second.positions) == [0.0, 0.0]


@pytest.mark.parametrize(("position", "count"), [(0.05, 1), (0.5, 0)])
async def test_nothing_is_sent_unless_arm_starts_within_limits(harness, position, count):
    limits = {"check_starting_point": True, "starting_point_limits": {"a": [-0.1, 0.1], "b": [-0.1, 0.1]}}
    received = start(harness, JointTrajectoryPublisher, TRAJECTORY, "/arm/joint_trajectory", **ARM, **limits)
    await harness.clock.advance(2.0)
    assert received == []
    publisher = harness.node.create_publisher(JOINT_STATE, "/joint_states", 10)
    publisher.publish(JOINT_STATE(name=["a", "b"], position=[position, 0.0]))
    await harness.graph.settle()
    await harness.clock.advance(2.0)
    assert len(received) == count
    texts = [str(record.text) for record in harness.log]
    assert "no joint states have arrived yet, so no goal is sent" in texts
    assert ("the arm did not start within its starting_point_limits" in texts) == (count == 0)


async def test_goals_without_values_are_an_error(harness):
    parameters = {"joints": ["a"], "goal_names": ["up"], "up": {"positions": [1.0, 2.0]}}
    with pytest.raises(LinkwrightError, match="no goal of 'goal_names' has values: up"):
        JointTrajectoryPublisher(harness.graph, NodeOptions(parameters=parameters))
