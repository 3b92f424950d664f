"""A clock that jumps back, between processes."""

from __future__ import annotations

from tests.reliability.running import Machine
from tests.waiting import wait_until

FOLLOWER = """
from geometry_msgs.msg import TransformStamped
from rclpy.duration import Duration
from rclpy.parameter import Parameter
from rclpy.time import Time
from tf2_ros import Buffer, TransformListener

class Program(Node):
    def __init__(self):
        super().__init__("follower", parameter_overrides=[Parameter("use_sim_time", value=True)])
        self.buffer = Buffer(node=self)
        self.listener = TransformListener(self.buffer, self)
        self.create_timer(0.1, self.tick)
        from rclpy.clock import Clock, ClockType
        self.create_timer(0.05, self.look, clock=Clock(clock_type=ClockType.STEADY_TIME))
        say("up")

    def tick(self):
        say("tick", int(self.get_clock().now().nanoseconds / 1e6))

    def look(self):
        known = self.buffer.can_transform("world", "base", Time())
        late = self.buffer.can_transform("world", "base", Time(seconds=104))
        say("tf", int(known), int(late))
"""
CONDUCTOR = """
from geometry_msgs.msg import TransformStamped
from rosgraph_msgs.msg import Clock
from tf2_ros import TransformBroadcaster

class Program(Node):
    '''Four seconds from 100 on, then four from 10 on, each tenth of a second ten times as fast.'''

    def __init__(self):
        super().__init__("conductor")
        self.clock_ = self.create_publisher(Clock, "/clock", 10)
        self.broadcaster = TransformBroadcaster(self)
        self.sent = 0
        self.begin = 100.0
        self.create_timer(0.02, self.tick)

    def tick(self):
        if not self.clock_.get_subscription_count() or not self.broadcaster.pub_tf.get_subscription_count():
            return
        self.sent += 1
        if self.sent == 150:
            self.begin = 10.0 - 0.03 * self.sent
            say("back")
        now = self.begin + 0.03 * self.sent
        message = Clock()
        message.clock.sec = int(now)
        message.clock.nanosec = int((now % 1.0) * 1e9)
        self.clock_.publish(message)
        if self.sent < 150:
            transform = TransformStamped()
            transform.header.stamp = message.clock
            transform.header.frame_id, transform.child_frame_id = "world", "base"
            self.broadcaster.sendTransform(transform)
"""


def test_clock_jump_back_keeps_timers_and_clears_tf_buffer(machine: Machine) -> None:
    follower = machine.program(FOLLOWER)
    follower.wait_for("up")
    conductor = machine.program(CONDUCTOR)
    follower.wait_for("tf 1 1")
    conductor.wait_for("back")
    wait_until(lambda: 10_000 <= follower.last_number("tick") < 20_000, what=lambda: follower.text)
    wait_until(lambda: "tf 0 0" in _output_after_jump(follower.lines), what=lambda: follower.text)
    before = follower.last_number("tick")
    wait_until(lambda: follower.last_number("tick") > before + 1000, what=lambda: follower.text)
    assert follower.interrupt() == 0
    assert "Traceback" not in follower.text


def _output_after_jump(lines: list[str]) -> str:
    """Return the output since the clock jumped back."""
    lines = list(lines)
    ticks = [number for number, line in enumerate(lines) if line.startswith("tick") and int(line.split()[1]) >= 100_000]
    return "".join(lines[ticks[-1] :]) if ticks else ""
