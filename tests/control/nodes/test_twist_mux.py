"""twist_mux: priorities, time-outs and locks."""

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


class Traffic:
    def __init__(self, stage, kind=TWIST):
        self.stage, self.kind = stage, kind
        self.out, self.diagnostics = [], []
        stage.node.create_subscription(kind, "/cmd_vel_out", self.out.append, 10)
        stage.node.create_subscription(
            "diagnostic_msgs/msg/DiagnosticArray", "/diagnostics", self.diagnostics.append, 10
        )
        self.publishers = {}

    async def send(self, topic, value):
        """What comes out for a velocity, or a lock, that goes in."""
        kind = BOOL if isinstance(value, bool) else self.kind
        publisher = self.publishers.setdefault(topic, self.stage.node.create_publisher(kind, topic, 10))
        message = kind()
        if isinstance(value, bool):
            message.data = value
        else:
            getattr(message, "twist", message).linear.x = value
        self.out.clear()
        publisher.publish(message)
        await self.stage.graph.settle()
        return [getattr(message, "twist", message).linear.x for message in self.out]

    async def status_values(self):
        await self.stage.clock.advance(1.0)
        (status,) = self.diagnostics[-1].status
        assert (status.name, status.message) == ("twist_mux: Twist mux status", "ok")
        return {pair.key: pair.value for pair in status.values}


@pytest.fixture
def traffic(stage):
    return Traffic(stage)


def mux(stage, **more):
    return TwistMux(stage.graph, NodeOptions(parameters={**PARAMETERS, **more}))


async def test_highest_priority_topic_is_forwarded_until_timeout(stage, traffic):
    mux(stage)
    assert await traffic.send("nav_vel", 1.0) == [1.0]
    assert await traffic.send("joy_vel", 2.0) == [2.0]
    assert await traffic.send("nav_vel", 1.0) == []
    await stage.clock.advance(0.6)
    assert await traffic.send("nav_vel", 1.0) == [1.0]


async def test_topic_without_timeout_stays_active_after_first_message(stage, traffic):
    mux(stage, topics={**PARAMETERS["topics"], "tablet": {"topic": "tab_vel", "timeout": 0.0, "priority": 20}})
    assert await traffic.send("nav_vel", 1.0) == [1.0]
    assert await traffic.send("tab_vel", 3.0) == [3.0]
    await stage.clock.advance(60.0)
    assert await traffic.send("nav_vel", 1.0) == []


async def test_lock_blocks_lower_priorities(stage, traffic):
    mux(stage)
    assert await traffic.send("pause", True) == []
    assert await traffic.send("nav_vel", 1.0) == []
    assert await traffic.send("joy_vel", 2.0) == [2.0]
    await traffic.send("pause", False)
    await stage.clock.advance(0.6)
    assert await traffic.send("nav_vel", 1.0) == [1.0]


async def test_silent_lock_with_timeout_blocks(stage, traffic):
    mux(stage, locks={"watchdog": {"topic": "alive", "timeout": 0.5, "priority": 255}})
    assert await traffic.send("joy_vel", 2.0) == []
    await traffic.send("alive", False)
    assert await traffic.send("joy_vel", 2.0) == [2.0]
    await stage.clock.advance(0.6)
    assert await traffic.send("joy_vel", 2.0) == []


async def test_stamped_velocities_are_supported(stage):
    traffic = Traffic(stage, get_message("geometry_msgs/msg/TwistStamped"))
    mux(stage, use_stamped=True)
    assert await traffic.send("nav_vel", 1.0) == [1.0]


async def test_diagnostics_report_masked_topics(stage, traffic):
    mux(stage)
    await traffic.send("pause", True)
    await traffic.send("joy_vel", 2.0)
    logged = await traffic.status_values()
    assert logged["velocity joystick"] == " masked (listening to joy_vel @ 0.500000s with priority #100)"
    assert logged["velocity navigation"].startswith(" masked (listening to nav_vel")
    assert logged["lock pause"] == " locked (listening to pause @ 0.000000s with priority #50)"
    assert logged["current priority"] == "50"


@pytest.mark.parametrize(
    ("topics", "named"),
    [
        ({"a": {"timeout": 0.5, "priority": 1}}, "topics.a.topic"),
        ({"a": {"topic": "a", "timeout": -1.0, "priority": 1}}, "topics.a.timeout"),
        ({"a": {"topic": "a", "timeout": 0.5}}, "topics.a.priority"),
    ],
)
async def test_incomplete_topic_parameters_are_rejected(stage, topics, named):
    with pytest.raises(LinkwrightError) as raised:
        TwistMux(stage.graph, NodeOptions(parameters={"topics": topics}))
    (diagnostic,) = raised.value.diagnostics
    assert diagnostic.code == "NODE904"
    assert f"'{named}'" in diagnostic.message


async def test_missing_topics_are_reported_and_node_runs(stage, logged):
    TwistMux(stage.graph, NodeOptions())
    assert logged("WARN") == ["no parameter topics.NAME.topic is set, so nothing is forwarded"]


async def test_two_publishers_on_one_input_topic_are_reported(traffic):
    mux(traffic.stage)
    transport = RemoteTransport(traffic.stage.graph)
    topics_and_nodes = (("/tab_vel", "tab"), ("/joy_vel", "joy"), ("/joy_vel", "pad"))
    tablet, joystick, other = (RemotePublisher(transport, topic, node) for topic, node in topics_and_nodes)

    async def drive(*sources):
        for _ in range(20):
            for speed, source in enumerate(sources):
                message = TWIST()
                message.linear.x = float(speed)
                source.send(message)
                await traffic.stage.clock.advance(0.1)

    def logged():
        return [record.text for record in traffic.stage.log if "several nodes drive the robot" in record.text]

    await drive(tablet, joystick)
    assert not logged()
    await drive(tablet, joystick, other)
    (text,) = logged()
    assert "'/joy', '/pad' send commands on '/joy_vel'" in text


async def test_lost_publisher_of_last_velocity_stops_robot(traffic):
    mux(traffic.stage)
    transport = RemoteTransport(traffic.stage.graph)
    tablet, joystick = (RemotePublisher(transport, topic, topic[1:]) for topic in ("/tab_vel", "/joy_vel"))
    for source, speed in ((tablet, 0.1), (joystick, 0.3)):
        message = TWIST()
        message.linear.x = speed
        source.send(message)
    await traffic.stage.graph.settle()
    tablet.disappear()
    await traffic.stage.graph.settle()
    assert [twist.linear.x for twist in traffic.out] == [0.1, 0.3]
    joystick.disappear()
    await traffic.stage.graph.settle()
    assert [twist.linear.x for twist in traffic.out] == [0.1, 0.3, 0.0]
    (logged,) = [record.text for record in traffic.stage.log if "was lost" in record.text]
    assert logged.endswith("a stop command is sent to '/cmd_vel_out'")
