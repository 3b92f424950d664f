"""`wait_for_robot_description` of ur_robot_driver."""

from __future__ import annotations

from linkwright.nodes import NodeOptions
from linkwright.nodes.wait_for_robot_description import WaitForRobotDescription


async def test_program_ends_with_status_0_when_description_arrives(harness, logged):
    running = WaitForRobotDescription(harness.graph, NodeOptions())
    await harness.clock.advance(5.0)
    assert logged("INFO") == ["Waiting for message on /robot_description."]
    assert not running.finished.done()
    await harness.describe("<robot name='arm'><link name='base'/></robot>")
    await harness.describe("<robot name='arm'><link name='base'/></robot>")
    assert running.finished.result() == 0
    assert logged("INFO")[1:] == ["Received message on /robot_description. Shutting down."]


async def test_program_ends_when_description_was_published_before_its_start(harness):
    await harness.describe("<robot name='arm'><link name='base'/></robot>")
    running = WaitForRobotDescription(harness.graph, NodeOptions())
    await harness.graph.settle()
    assert running.finished.result() == 0


async def test_topic_is_in_the_namespace_and_remappable(harness, logged):
    WaitForRobotDescription(harness.graph, NodeOptions(namespace="/left"))
    WaitForRobotDescription(harness.graph, NodeOptions(remappings=[("robot_description", "arm_description")]))
    await harness.graph.settle()
    assert logged("INFO") == [
        "Waiting for message on /left/robot_description.",
        "Waiting for message on /arm_description.",
    ]
