"""Graphs with stepped time."""

import asyncio
import doctest
import threading
import time

import pytest

import linkwright.testing.stepped_sync
from linkwright.graph import DESCRIPTION_QOS, Parameter
from linkwright.messages import JointState, String, TFMessage, get_message, get_service
from linkwright.nodes import NodeOptions
from linkwright.nodes.robot_state_publisher import RobotStatePublisher
from linkwright.testing import AsyncSteppedGraph, SteppedGraph

AddTwoInts = get_service("example_interfaces/srv/AddTwoInts")
ROBOT = (
    "<robot name='r'><link name='base'/><link name='arm'/><joint name='j' type='continuous'>"
    "<parent link='base'/><child link='arm'/></joint></robot>"
)


def test_documentation_example_runs():
    results = doctest.testmod(linkwright.testing.stepped_sync)
    assert results.attempted == 2
    assert results.failed == 0


async def test_one_hour_of_timers_runs_quickly():
    begin = time.perf_counter()
    async with AsyncSteppedGraph() as test:
        beats = []
        for period in (0.1, 1.0, 60.0):
            test.create_node(f"node_{int(period)}").create_timer(period, lambda period=period: beats.append(period))
        await test.advance(3600.0)
        assert [beats.count(period) for period in (0.1, 1.0, 60.0)] == [36_000, 3600, 60]
        assert test.now == 3600.0
    assert time.perf_counter() - begin < 60.0, "an hour of stepped time takes less than a minute"


def test_built_in_node_runs_in_stepped_graph():
    with SteppedGraph() as test:
        test.record("/tf_static", TFMessage)
        description, transforms = test.record("/robot_description"), test.record("/tf")
        RobotStatePublisher(test.graph, NodeOptions(parameters={"robot_description": ROBOT, "publish_frequency": 10.0}))
        test.settle()
        assert description.last.data == ROBOT
        for number in range(95):
            stamp = test.node.get_clock().now().to_msg()
            message = JointState(name=["j"], position=[number / 100])
            message.header.stamp = stamp
            test.publish("joint_states", message)
            test.advance(0.01)
        assert len(transforms) == 10, "the throttle passes ten messages a second"
        assert transforms.times == pytest.approx([number / 10 for number in range(10)], abs=0.011)


def test_rclpy_node_runs_in_stepped_graph():
    from linkwright.standins.rclpy_api.node import Node

    class Talker(Node):
        def __init__(self):
            super().__init__("talker")
            self.publisher = self.create_publisher(String, "topic", 10)
            self.count = 0
            self.timer = self.create_timer(0.5, self.talk)
            self.create_service(AddTwoInts, "add", self.add)

        def talk(self):
            self.publisher.publish(String(data=f"Hello World: {self.count}"))
            self.get_logger().info("said", throttle_duration_sec=60.0)
            self.count += 1

        def add(self, request, response):
            response.sum = request.a + request.b
            return response

    with SteppedGraph() as test:
        test.init_rclpy(["--ros-args", "-r", "topic:=chatter"])
        chatter = test.record("/chatter")
        talker = Talker()
        test.advance(3600.0)
        assert len(chatter) == 7200
        assert chatter[0].data == "Hello World: 0"
        assert test.call("/add", AddTwoInts.Request(a=40, b=2)).sum == 42
        assert [record.text for record in test.log].count("said") == 60
        talker.destroy_node()
        before = len(chatter)
        test.advance(1.0)
        assert len(chatter) == before


def test_rclpy_can_be_initialized_in_successive_tests():
    from linkwright.standins.rclpy_api.node import Node

    for _ in range(2):
        with SteppedGraph() as test:
            test.init_rclpy()
            Node("node")
            assert test.graph.node_names() == ["/node"]


async def test_recordings_keep_messages_with_receive_time():
    async with AsyncSteppedGraph() as test:
        latched = test.create_node("node").create_publisher(String, "description", DESCRIPTION_QOS)
        latched.publish(String(data="kept"))
        recording = test.record("description")
        with pytest.raises(AssertionError, match="nothing was published on '/description'"):
            _ = recording.last
        await test.advance(2.0)
        latched.publish(String(data="new"))
        await test.settle()
        assert [message.data for message in recording] == ["kept", "new"]
        assert recording.times == [0.0, 2.0]
        assert repr(recording) == "<2 messages of /description>"
        recording.clear()
        assert len(recording) == 0


async def test_slow_services_complete_or_time_out():
    async with AsyncSteppedGraph() as test:
        node = test.create_node("server")
        rate = node.create_rate(1.0)

        async def slow(request, response):
            await rate.wait()
            response.sum = request.a
            return response

        node.create_service(AddTwoInts, "slow", slow)
        with pytest.raises(TimeoutError, match=r"service '/slow' has not responded within 0\.5 s"):
            await test.call("slow", AddTwoInts.Request(a=1), timeout=0.5)
        assert (await test.call("slow", AddTwoInts.Request(a=7), timeout=5.0)).sum == 7
        with pytest.raises(LookupError, match="there is no service '/none'"):
            await test.call("none", AddTwoInts.Request())


async def test_callback_error_is_raised_by_advance():
    async with AsyncSteppedGraph() as test:
        test.create_node("node").create_timer(1.0, lambda: 1 / 0)
        with pytest.raises(ZeroDivisionError):
            await test.advance(1.0)
        assert "timer callback failed" in test.log[0].text


def test_callback_errors_are_only_logged_if_not_strict():
    with SteppedGraph(strict=False) as test:

        async def fail(_message):
            raise KeyError("x")

        test.node.create_subscription(String, "topic", fail, 1)
        test.publish("topic", String())
        test.spin()
        assert [type(error) for error in test.errors] == [KeyError]


def test_simulated_time_and_clock_jumps():
    clock_message = get_message("rosgraph_msgs/msg/Clock")
    with SteppedGraph() as test:
        node = test.create_node("node")
        node.set_parameters([Parameter("use_sim_time", value=True)])
        message = clock_message()
        message.clock.sec = 5
        test.publish("/clock", message)
        assert node.get_clock().now_ns() == 5_000_000_000
        before = test.clock.now_ns()
        test.clock.jump(-10.0)
        assert test.clock.now_ns() == before - 10_000_000_000
        assert test.now == 0.0


def test_closed_graph_leaves_no_threads():
    threads = set(threading.enumerate())
    with SteppedGraph() as test:
        test.node.create_timer(1.0, print)

        async def wait():
            await asyncio.sleep(0)
            return 3

        assert test.run(wait()) == 3
    assert set(threading.enumerate()) == threads
    with pytest.raises(RuntimeError, match="context manager"):
        test.advance(1.0)
    with pytest.raises(RuntimeError, match="context manager"):
        _ = SteppedGraph().graph
