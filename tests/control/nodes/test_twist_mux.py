"""twist_mux: priorities, timeouts and locks."""

from __future__ import annotations

import pytest

from linkwright.control.nodes.teleop.twist_mux import TwistMux
from linkwright.diagnostics import LinkwrightError
from linkwright.messages import get_message
from linkwright.nodes import NodeOptions
from tests.remote_publishers import RemotePublisher, RemoteTransport

TWIST, BOOL = get_message("geometry_msgs/msg/Twist"), get_message("std_msgs/msg/Bool")
PARAMETERS = {
    "topics": {
        "navigation": {"topic": "nav_vel", "timeout": 0.5, "priority": 10},
        "joystick": {"topic": "joy_vel", "timeout": 0.5, "priority": 100},
        "tablet": {"topic": "tab_vel", "timeout": 0.0, "priority": 5},
    },
    "locks": {"pause": {"topic": "pause", "timeout": 0.0, "priority": 50}},
}


class MuxHarness:
    """The inputs, outputs and diagnostics of a twist_mux."""

    def __init__(self, harness, message_type=TWIST):
        self.harness, self.velocity_type = harness, message_type
        self.forwarded, self.diagnostics = [], []
        harness.node.create_subscription(message_type, "/cmd_vel_out", self.forwarded.append, 10)
        harness.node.create_subscription(
            "diagnostic_msgs/msg/DiagnosticArray", "/diagnostics", self.diagnostics.append, 10
        )
        self.publishers = {}

    async def send(self, topic, value):
        """Publish a velocity or a lock, and return the forwarded velocities."""
        message_type = BOOL if isinstance(value, bool) else self.velocity_type
        publisher = self.publishers.setdefault(topic, self.harness.node.create_publisher(message_type, topic, 10))
        message = message_type()
        if isinstance(value, bool):
            message.data = value
        else:
            getattr(message, "twist", message).linear.x = value
        self.forwarded.clear()
        publisher.publish(message)
        await self.harness.graph.settle()
        return [getattr(message, "twist", message).linear.x for message in self.forwarded]

    async def status_values(self):
        await self.harness.clock.advance(1.0)
        (status,) = self.diagnostics[-1].status
        assert (status.name, status.message) == ("twist_mux: Twist mux status", "ok")
        return {pair.key: pair.value for pair in status.values}


@pytest.fixture
def mux_harness(harness):
    return MuxHarness(harness)


def start_mux(harness, **parameters):
    return TwistMux(harness.graph, NodeOptions(parameters={**PARAMETERS, **parameters}))


async def test_highest_priority_topic_is_forwarded_until_timeout(harness, mux_harness):
    start_mux(harness)
    assert await mux_harness.send("nav_vel", 1.0) == [1.0]
    assert await mux_harness.send("joy_vel", 2.0) == [2.0]
    assert await mux_harness.send("nav_vel", 1.0) == []
    await harness.clock.advance(0.6)
    assert await mux_harness.send("nav_vel", 1.0) == [1.0]


async def test_topic_without_timeout_stays_active_after_first_message(harness, mux_harness):
    start_mux(harness, topics={**PARAMETERS["topics"], "tablet": {"topic": "tab_vel", "timeout": 0.0, "priority": 20}})
    assert await mux_harness.send("nav_vel", 1.0) == [1.0]
    assert await mux_harness.send("tab_vel", 3.0) == [3.0]
    await harness.clock.advance(60.0)
    assert await mux_harness.send("nav_vel", 1.0) == []


async def test_lock_blocks_lower_priorities(harness, mux_harness):
    start_mux(harness)
    assert await mux_harness.send("pause", True) == []
    assert await mux_harness.send("nav_vel", 1.0) == []
    assert await mux_harness.send("joy_vel", 2.0) == [2.0]
    await mux_harness.send("pause", False)
    await harness.clock.advance(0.6)
    assert await mux_harness.send("nav_vel", 1.0) == [1.0]


async def test_silent_lock_with_timeout_blocks(harness, mux_harness):
    start_mux(harness, locks={"watchdog": {"topic": "alive", "timeout": 0.5, "priority": 255}})
    assert await mux_harness.send("joy_vel", 2.0) == []
    await mux_harness.send("alive", False)
    assert await mux_harness.send("joy_vel", 2.0) == [2.0]
    await harness.clock.advance(0.6)
    assert await mux_harness.send("joy_vel", 2.0) == []


async def test_stamped_velocities_are_supported(harness):
    mux_harness = MuxHarness(harness, get_message("geometry_msgs/msg/TwistStamped"))
    start_mux(harness, use_stamped=True)
    assert await mux_harness.send("nav_vel", 1.0) == [1.0]


async def test_diagnostics_report_masked_topics(harness, mux_harness):
    start_mux(harness)
    await mux_harness.send("pause", True)
    await mux_harness.send("joy_vel", 2.0)
    values = await mux_harness.status_values()
    assert values["velocity joystick"] == " masked (listening to joy_vel @ 0.500000s with priority #100)"
    assert values["velocity navigation"].startswith(" masked (listening to nav_vel")
    assert values["lock pause"] == " locked (listening to pause @ 0.000000s with priority #50)"
    assert values["current priority"] == "50"


@pytest.mark.parametrize(
    ("topics", "parameter"),
    [
        ({"a": {"timeout": 0.5, "priority": 1}}, "topics.a.topic"),
        ({"a": {"topic": "a", "timeout": -1.0, "priority": 1}}, "topics.a.timeout"),
        ({"a": {"topic": "a", "timeout": 0.5}}, "topics.a.priority"),
    ],
)
async def test_incomplete_topic_parameters_are_rejected(harness, topics, parameter):
    with pytest.raises(LinkwrightError) as error:
        TwistMux(harness.graph, NodeOptions(parameters={"topics": topics}))
    (diagnostic,) = error.value.diagnostics
    assert diagnostic.code == "NODE904"
    assert f"'{parameter}'" in diagnostic.message


async def test_missing_topics_are_reported_and_node_runs(harness, logged):
    TwistMux(harness.graph, NodeOptions())
    assert logged("WARN") == ["no parameter topics.NAME.topic is set, so nothing is forwarded"]


async def test_two_publishers_on_one_input_topic_are_reported(mux_harness):
    start_mux(mux_harness.harness)
    transport = RemoteTransport(mux_harness.harness.graph)
    topics_and_nodes = (("/tab_vel", "tab"), ("/joy_vel", "joy"), ("/joy_vel", "pad"))
    tablet, joystick, second_joystick = (RemotePublisher(transport, topic, node) for topic, node in topics_and_nodes)

    async def drive(*sources):
        for _ in range(20):
            for speed, source in enumerate(sources):
                message = TWIST()
                message.linear.x = float(speed)
                source.send(message)
                await mux_harness.harness.clock.advance(0.1)

    def conflict_warnings():
        return [record.text for record in mux_harness.harness.log if "several nodes drive the robot" in record.text]

    await drive(tablet, joystick)
    assert not conflict_warnings()
    await drive(tablet, joystick, second_joystick)
    (text,) = conflict_warnings()
    assert "'/joy', '/pad' send commands on '/joy_vel'" in text


async def test_lost_publisher_of_last_velocity_stops_robot(mux_harness):
    start_mux(mux_harness.harness)
    transport = RemoteTransport(mux_harness.harness.graph)
    tablet, joystick = (RemotePublisher(transport, topic, topic[1:]) for topic in ("/tab_vel", "/joy_vel"))
    for source, speed in ((tablet, 0.1), (joystick, 0.3)):
        message = TWIST()
        message.linear.x = speed
        source.send(message)
    await mux_harness.harness.graph.settle()
    tablet.disappear()
    await mux_harness.harness.graph.settle()
    assert [twist.linear.x for twist in mux_harness.forwarded] == [0.1, 0.3]
    joystick.disappear()
    await mux_harness.harness.graph.settle()
    assert [twist.linear.x for twist in mux_harness.forwarded] == [0.1, 0.3, 0.0]
    (text,) = [record.text for record in mux_harness.harness.log if "was lost" in record.text]
    assert text.endswith("a stop command is sent to '/cmd_vel_out'")
