"""The record of a graph that other programs join during the observation."""

from __future__ import annotations

import asyncio
import time
from collections.abc import AsyncIterator
from dataclasses import replace

import pytest

from linkwright.doctor import Observation, observe
from linkwright.graph import DurabilityPolicy, EndpointInfo, EndpointKind, Graph, NodeIdentity, QoSProfile
from linkwright.graph.endpoints.bus import Transport
from linkwright.messages import get_message

TWIST, TWIST_STAMPED = "geometry_msgs/msg/Twist", "geometry_msgs/msg/TwistStamped"
TRANSFORMS = "tf2_msgs/msg/TFMessage"
Clock, TransformStamped = get_message("rosgraph_msgs/msg/Clock"), get_message("geometry_msgs/msg/TransformStamped")
TELEOP = EndpointInfo(EndpointKind.PUBLISHER, NodeIdentity("teleop", "/"), "/cmd_vel", TWIST, QoSProfile(10), bytes(16))
LATE_SUBSCRIPTION = EndpointInfo(EndpointKind.SUBSCRIPTION, None, "/cmd_vel", TWIST_STAMPED, QoSProfile(10), bytes(16))


class RemoteTransport(Transport):
    """A transport with the given endpoints of other processes."""

    def __init__(self, *endpoints: EndpointInfo) -> None:
        self.endpoints = list(endpoints)

    def start_discovery(self) -> None:
        pass

    def remote_nodes(self) -> list[NodeIdentity]:
        return list({endpoint.node for endpoint in self.endpoints if endpoint.node is not None})

    def remote_endpoints(self) -> list[EndpointInfo]:
        return self.endpoints

    def watch(self, changed: object) -> None:
        pass

    def close(self) -> None:
        pass

    def _mirror(self, entity: object) -> None:
        pass

    open_node = close_node = open_publisher = close_publisher = open_subscription = close_subscription = _mirror
    open_service = close_service = open_client = close_client = _mirror


@pytest.fixture
async def joined() -> AsyncIterator[Graph]:
    graph = Graph()
    yield graph
    await graph.close()


async def observe_graph(graph: Graph, transport: RemoteTransport, seconds: float = 0.05) -> Observation:
    graph.attach(transport)
    return await observe(graph, graph.create_node("_ros2cli_1"), seconds, environment={})


async def test_late_node_name_identifies_endpoint_of_command(joined: Graph) -> None:
    transport = RemoteTransport(TELEOP, LATE_SUBSCRIPTION)

    def name() -> None:
        transport.endpoints = [TELEOP, replace(LATE_SUBSCRIPTION, node=NodeIdentity("_ros2cli_2", "/"))]

    asyncio.get_running_loop().call_later(0.2, name)
    observation = await observe_graph(joined, transport)
    assert observation.endpoints == (TELEOP,)


async def test_unnamed_endpoint_is_waited_for_one_second_at_most(joined: Graph) -> None:
    start = time.monotonic()
    observation = await observe_graph(joined, RemoteTransport(TELEOP, LATE_SUBSCRIPTION))
    assert observation.endpoints == (TELEOP, LATE_SUBSCRIPTION)
    assert time.monotonic() - start > 0.9


async def test_contradictory_velocity_publishers_are_recorded(joined: Graph) -> None:
    """Silent publishers and publishers of equal commands do not contradict each other."""
    node, other, alike = (joined.create_node(name) for name in ("keys", "planner", "alike"))
    idle_node = joined.create_node("idle")
    idle_node.create_publisher(TWIST, "/cmd_vel", 10)
    publishers = [
        sender.create_publisher(kind, topic, 10)
        for sender, kind, topic in (
            (node, TWIST, "/cmd_vel"),
            (other, TWIST, "/cmd_vel"),
            (node, TWIST_STAMPED, "/arm/cmd_vel"),
            (other, TWIST_STAMPED, "/arm/cmd_vel"),
            (alike, TWIST, "/base/cmd_vel"),
            (node, TWIST, "/base/cmd_vel"),
            (node, TWIST, "/own/cmd_vel"),
        )
    ]
    watched = asyncio.ensure_future(observe_graph(joined, RemoteTransport(), seconds=2.0))
    while not watched.done():
        for number, publisher in enumerate(publishers):
            message = publisher.msg_type()
            driven = message.twist if publisher.type_name == TWIST_STAMPED else message
            driven.linear.x = 0.5 if publisher.topic_name.startswith("/base") else float(number)
            publisher.publish(message)
        await asyncio.sleep(0.01)
    assert [(dispute.topic, dispute.commanders) for dispute in watched.result().contradictory_velocities] == [
        ("/arm/cmd_vel", ("/keys", "/planner")),
        ("/cmd_vel", ("/keys", "/planner")),
    ]


async def test_velocities_but_no_stamps_of_commands_are_recorded(joined: Graph) -> None:
    first, second = joined.create_node("_ros2cli_7"), joined.create_node("_ros2cli_8")
    publishers = [node.create_publisher(TWIST, "/cmd_vel", 10) for node in (first, second)]
    publishers.append(first.create_publisher("sensor_msgs/msg/JointState", "/joint_states", 10))
    watched = asyncio.ensure_future(observe_graph(joined, RemoteTransport(), seconds=2.0))
    while not watched.done():
        for number, publisher in enumerate(publishers):
            message = publisher.msg_type()
            if publisher.type_name == TWIST:
                message.linear.x = float(number)
            publisher.publish(message)
        await asyncio.sleep(0.01)
    (disputed,) = watched.result().contradictory_velocities
    assert disputed.commanders == ("/_ros2cli_7", "/_ros2cli_8")
    assert not watched.result().stamps


async def test_bridged_transforms_have_one_sender_and_no_delay(joined: Graph) -> None:
    simulator, bridge = joined.create_node("gazebo"), joined.create_node("ros_gz_bridge")
    clock = simulator.create_publisher("rosgraph_msgs/msg/Clock", "/clock", 10)
    model_publisher = simulator.create_publisher(TRANSFORMS, "/model/vehicle/tf", 10)
    other = simulator.create_publisher(TRANSFORMS, "/robot1/tf", 10)
    handed_on = bridge.create_publisher(TRANSFORMS, "/tf", 10)
    watched = asyncio.ensure_future(observe_graph(joined, RemoteTransport(), seconds=0.5))
    message = model_publisher.msg_type()
    message.transforms = [TransformStamped(child_frame_id="base")]
    message.transforms[0].header.frame_id = "odom"
    message.transforms[0].header.stamp.sec = 5
    while not watched.done():
        clock.publish(Clock(clock=message.transforms[0].header.stamp))
        for publisher in (model_publisher, other, handed_on):
            publisher.publish(message)
        await asyncio.sleep(0.01)
    (transform,) = watched.result().transforms
    assert len(transform.senders) == 1
    assert {stamp.topic for stamp in watched.result().stamps} == {"/robot1/tf", "/tf"}
    assert {stamp.age_ns for stamp in watched.result().stamps} == {0}


async def test_simulator_stamps_have_no_delay_and_world_poses_are_not_frames(joined: Graph) -> None:
    """The simulator's stamps have no delay, and world poses are not frames.

    The simulator publishes the time of its stamps, and the world's poses on a topic of transforms.
    """
    simulator = joined.create_node("gazebo")
    clock = simulator.create_publisher("rosgraph_msgs/msg/Clock", "/clock", 10)
    poses, frames = (simulator.create_publisher(TRANSFORMS, topic, 10) for topic in ("/world_poses", "/robot1/tf"))
    watched = asyncio.ensure_future(observe_graph(joined, RemoteTransport(), seconds=0.5))
    message = frames.msg_type()
    message.transforms = [TransformStamped(child_frame_id="base")]
    message.transforms[0].header.frame_id = "odom"
    message.transforms[0].header.stamp.sec = 5
    while not watched.done():
        clock.publish(Clock(clock=message.transforms[0].header.stamp))
        for publisher in (poses, frames):
            publisher.publish(message)
        await asyncio.sleep(0.01)
    observation = watched.result()
    assert [(transform.parent, transform.child) for transform in observation.transforms] == [("odom", "base")]
    assert [(stamp.topic, stamp.age_ns) for stamp in observation.stamps] == [("/robot1/tf", 0)]


async def test_latched_and_bond_messages_have_no_recorded_stamps(joined: Graph) -> None:
    server = joined.create_node("map_server")
    latched = QoSProfile(depth=1, durability=DurabilityPolicy.TRANSIENT_LOCAL)
    old_map = server.create_publisher("nav_msgs/msg/OccupancyGrid", "/map", latched)
    unset = server.create_publisher("nav_msgs/msg/OccupancyGrid", "/unset", latched)
    bond = server.create_publisher("bond/msg/Status", "/bond", 10)
    scan = server.create_publisher("sensor_msgs/msg/LaserScan", "/scan", 10)
    watched = asyncio.ensure_future(observe_graph(joined, RemoteTransport(), seconds=0.5))
    while not watched.done():
        for publisher in (old_map, unset, bond, scan):
            message = publisher.msg_type()
            message.header.stamp.sec = 0 if publisher is unset else 17
            publisher.publish(message)
        await asyncio.sleep(0.01)
    assert [(stamp.topic, stamp.is_zero) for stamp in watched.result().stamps] == [("/scan", False), ("/unset", True)]


@pytest.mark.parametrize("topic", ["/tf", "/tf_static"])
async def test_late_transforms_of_known_publisher_are_waited_for(joined: Graph, topic: str) -> None:
    sender = joined.create_node("robot_state_publisher").create_publisher(TRANSFORMS, topic, 10)
    message = sender.msg_type(transforms=[TransformStamped(child_frame_id="base")])
    asyncio.get_running_loop().call_later(0.5, sender.publish, message)
    assert [transform.child for transform in (await observe_graph(joined, RemoteTransport())).transforms] == ["base"]


async def test_wait_for_missing_transforms_ends_after_timeout(joined: Graph, monkeypatch) -> None:
    monkeypatch.setattr("linkwright.doctor.watching._TRANSFORMS_TIMEOUT_S", 0.3)
    joined.create_node("robot_state_publisher").create_publisher(TRANSFORMS, "/tf", 10)
    assert not (await observe_graph(joined, RemoteTransport())).transforms
