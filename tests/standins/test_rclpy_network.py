"""Users' nodes in separate processes, which communicate over DDS."""

from __future__ import annotations

import os
import signal
import subprocess
import sys
import textwrap

import pytest

from linkwright.standins import process
from linkwright.wire import dds
from tests.domains import own_domain

pytestmark = [
    pytest.mark.slow,
    pytest.mark.skipif(not dds.is_available(), reason="cyclonedds is not installed"),
]

SERVER = """\
    import rclpy
    from example_interfaces.action import Fibonacci
    from example_interfaces.srv import AddTwoInts
    from geometry_msgs.msg import TransformStamped
    from rclpy.action import ActionServer
    from rclpy.node import Node
    from rclpy.qos import QoSDurabilityPolicy, QoSProfile
    from std_msgs.msg import String
    from tf2_ros import StaticTransformBroadcaster

    class Server(Node):
        def __init__(self):
            super().__init__("server")
            self.declare_parameter("speed", 1.5)
            self.number = 0
            self.publisher_ = self.create_publisher(String, "chatter", 10)
            self.create_timer(0.05, self.tick)
            self.create_service(AddTwoInts, "add", self.add)
            self.action = ActionServer(self, Fibonacci, "fibonacci", self.execute)
            latched = QoSProfile(depth=1, durability=QoSDurabilityPolicy.TRANSIENT_LOCAL)
            self.latched = self.create_publisher(String, "latched", latched)
            self.latched.publish(String(data="kept"))
            self.broadcaster = StaticTransformBroadcaster(self)
            transform = TransformStamped()
            transform.header.frame_id, transform.child_frame_id = "base", "laser"
            transform.transform.translation.x = 0.5
            self.broadcaster.sendTransform(transform)

        def tick(self):
            self.number += 1
            self.publisher_.publish(String(data=str(self.number)))

        def add(self, request, response):
            response.sum = request.a + request.b
            return response

        def execute(self, goal):
            feedback = Fibonacci.Feedback(sequence=[0, 1])
            goal.publish_feedback(feedback)
            goal.succeed()
            return Fibonacci.Result(sequence=list(range(goal.request.order)))

    rclpy.init()
    node = Server()
    print("ready", flush=True)
    try:
        rclpy.spin(node)
    except KeyboardInterrupt:
        pass
    finally:
        node.destroy_node()
        rclpy.try_shutdown()
        print("ended", flush=True)
    """

CLIENT = """\
    import rclpy
    from example_interfaces.action import Fibonacci
    from example_interfaces.srv import AddTwoInts
    from rclpy.action import ActionClient
    from rclpy.parameter_client import AsyncParameterClient
    from rclpy.qos import QoSDurabilityPolicy, QoSProfile
    from rclpy.time import Time
    from std_msgs.msg import String
    from tf2_ros import Buffer, TransformListener

    rclpy.init()
    node = rclpy.create_node("client")
    heard, kept, feedback = [], [], []
    node.create_subscription(String, "chatter", lambda msg: heard.append(int(msg.data)), 10)
    latched = QoSProfile(depth=1, durability=QoSDurabilityPolicy.TRANSIENT_LOCAL)
    node.create_subscription(String, "latched", lambda msg: kept.append(msg.data), latched)
    buffer = Buffer()
    listener = TransformListener(buffer, node)
    while len(heard) < 5 or not kept or not buffer.can_transform("base", "laser", Time()):
        rclpy.spin_once(node, timeout_sec=60.0)
    print("heard in order", heard == list(range(heard[0], heard[0] + len(heard))), kept)
    print("transform", buffer.lookup_transform("base", "laser", Time()).transform.translation.x)

    def wait(future):
        rclpy.spin_until_future_complete(node, future, timeout_sec=60.0)
        return future.result()

    add = node.create_client(AddTwoInts, "add")
    assert add.wait_for_service(60.0)
    print("sum", wait(add.call_async(AddTwoInts.Request(a=1, b=2))).sum)
    action = ActionClient(node, Fibonacci, "fibonacci")
    assert action.wait_for_server(60.0)
    goal = wait(action.send_goal_async(Fibonacci.Goal(order=3), feedback_callback=feedback.append))
    print("result", wait(goal.get_result_async()).result.sequence.tolist(), len(feedback))
    parameters = AsyncParameterClient(node, "server")
    assert parameters.wait_for_services(10.0)
    print("speed", wait(parameters.get_parameters(["speed"])).values[0].double_value)
    print("nodes", sorted(node.get_node_names()))
    node.destroy_node()
    rclpy.shutdown()
    """


@pytest.fixture
def surroundings(tmp_path):
    environment = {key: value for key, value in os.environ.items() if not key.startswith(("ROS_", "LINKWRIGHT_"))}
    return process.create_environment(
        {**environment, "ROS_DOMAIN_ID": str(own_domain()), "ROS_LOG_DIR": str(tmp_path / "log")}
    )


def start_program(folder, name, program, surroundings):
    file = folder / f"{name}.py"
    file.write_text(textwrap.dedent(program))
    return subprocess.Popen(
        [sys.executable, file], env=surroundings, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True
    )


def test_all_interfaces_work_between_two_processes(tmp_path, surroundings):
    server = start_program(tmp_path, "server", SERVER, surroundings)
    with server:
        printed = server.stdout.readline()
        assert printed == "ready\n", server.communicate(timeout=60)[1]
        client = start_program(tmp_path, "client", CLIENT, surroundings)
        output, errors = client.communicate(timeout=60)
        server.send_signal(signal.SIGINT)
        ended, server_errors = server.communicate(timeout=60)
    assert (client.returncode, errors) == (0, "")
    assert output.splitlines() == [
        "heard in order True ['kept']",
        "transform 0.5",
        "sum 3",
        "result [0, 1, 2] 1",
        "speed 1.5",
        "nodes ['client', 'server']",
    ]
    assert (server.returncode, ended, server_errors) == (0, "ended\n", "")


def test_message_published_right_after_match_arrives(tmp_path, surroundings):
    """A reliable reader gets all messages that are published after the match."""
    listener = start_program(
        tmp_path,
        "listener",
        """\
        import rclpy
        from std_msgs.msg import String
        rclpy.init()
        node = rclpy.create_node("listener")
        got = []
        node.create_subscription(String, "news", got.append, 10)
        print("ready", flush=True)
        while not got:
            rclpy.spin_once(node, timeout_sec=60.0)
        print(got[0].data, flush=True)
        rclpy.shutdown()
        """,
        surroundings,
    )
    with listener:
        assert listener.stdout.readline() == "ready\n"
        talker = start_program(
            tmp_path,
            "talker",
            """\
            import rclpy, time
            from std_msgs.msg import String
            rclpy.init()
            node = rclpy.create_node("talker")
            publisher = node.create_publisher(String, "news", 10)
            end = time.monotonic() + 60
            while not publisher.get_subscription_count() and time.monotonic() < end:
                time.sleep(0.01)
            publisher.publish(String(data="first"))
            node.destroy_node()
            rclpy.shutdown()
            """,
            surroundings,
        )
        _, errors = talker.communicate(timeout=60)
        assert (talker.returncode, errors) == (0, "")
        output, errors = listener.communicate(timeout=60)
    assert (output, errors) == ("first\n", "")
