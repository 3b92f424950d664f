"""Type checkers see the exports of the stand-ins."""

from __future__ import annotations

import subprocess
import sys
import textwrap
from pathlib import Path

import pytest

import linkwright

pytest.importorskip("mypy")

SOURCES = Path(linkwright.__file__).parent.parent
STUBS = SOURCES.parent / "tools" / "standin_stubs.py"

PROGRAM = """\
    import rclpy
    from rclpy.action import ActionClient, ActionServer, CancelResponse, GoalResponse
    from rclpy.callback_groups import MutuallyExclusiveCallbackGroup, ReentrantCallbackGroup
    from rclpy.duration import Duration
    from rclpy.executors import ExternalShutdownException, MultiThreadedExecutor, SingleThreadedExecutor
    from rclpy.lifecycle import LifecycleNode, State, TransitionCallbackReturn
    from rclpy.node import Node
    from rclpy.parameter import Parameter
    from rclpy.publisher import Publisher
    from rclpy.qos import DurabilityPolicy, QoSProfile, QoSReliabilityPolicy, qos_profile_sensor_data
    from rclpy.task import Future
    from rclpy.time import Time
    from tf2_ros import Buffer, StaticTransformBroadcaster, TransformBroadcaster, TransformException, TransformListener
    from tf_transformations import euler_from_quaternion, quaternion_from_euler
    from linkwright.messages import String


    class Talker(Node):
        def __init__(self) -> None:
            super().__init__("talker", namespace="/ns", parameter_overrides=[Parameter("speed", value=1.0)])
            self.publisher_: Publisher[String] = self.create_publisher(String, "chatter", QoSProfile(depth=10))
            self.timer = self.create_timer(0.5, self.tick, callback_group=ReentrantCallbackGroup())
            self.speed: float = self.declare_parameter("speed", 1.0).value
            self.buffer = Buffer()
            self.listener = TransformListener(self.buffer, self)

        def tick(self) -> None:
            self.publisher_.publish(String(data="x"))
            self.get_logger().info(f"{self.get_clock().now().nanoseconds} {self.get_parameter('speed').type_}")


    def main() -> None:
        rclpy.init()
        node = Talker()
        executor = MultiThreadedExecutor(num_threads=2)
        executor.add_node(node)
        future: Future[str] = Future()
        executor.spin_until_future_complete(future, timeout_sec=60.0)
        roll, pitch, yaw = euler_from_quaternion(list(quaternion_from_euler(0.0, 0.0, 1.0)))
        reveal_type(yaw)
        rclpy.spin(node)
        node.no_such_method()
    """


@pytest.mark.slow
def test_type_checker_sees_names_types_and_errors_of_user_node(tmp_path):
    program = tmp_path / "my_node.py"
    program.write_text(textwrap.dedent(PROGRAM))
    stubs = tmp_path / "stubs"
    subprocess.run([sys.executable, STUBS, stubs], check=True, timeout=60)
    command = [sys.executable, "-m", "mypy", "--strict", "--config-file=", f"--cache-dir={tmp_path / 'cache'}"]
    checked = subprocess.run(
        [*command, "--follow-imports=silent", program],
        env={"MYPYPATH": f"{stubs}:{SOURCES}", "PATH": "/usr/bin:/bin"},
        cwd=tmp_path,
        check=False,
        capture_output=True,
        text=True,
        timeout=300,
    )
    lines = [line.partition(": ")[2] for line in checked.stdout.splitlines() if line.startswith(program.name)]
    assert lines == [
        'note: Revealed type is "float"',
        'error: "Talker" has no attribute "no_such_method"  [attr-defined]',
    ], checked.stdout + checked.stderr
