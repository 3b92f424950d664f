"""A robot that another process drives.

It stops if the process is killed, and continues if the process leaves.
"""

from __future__ import annotations

from pathlib import Path

from tests.reliability.running import Machine

LAUNCH_FILE = Path(__file__).parents[2] / "robots/my_robot_gazebo/launch/load_mbot_into_gazebo.launch.py"
DRIVER = """
from geometry_msgs.msg import Twist

class Program(Node):
    def __init__(self):
        super().__init__("driver")
        self.publisher = self.create_publisher(Twist, "cmd_vel", 10)
        self.create_timer(0.05, self.tick)

    def tick(self):
        twist = Twist()
        twist.linear.x = 0.3
        self.publisher.publish(twist)
"""
LISTENER = """
from nav_msgs.msg import Odometry

class Program(Node):
    def __init__(self):
        super().__init__("listener")
        self.state, self.way = "", 0
        self.create_subscription(Odometry, "odom", self.hear, 10)

    def hear(self, message):
        speed = message.twist.twist.linear.x
        state = "stands" if speed < 0.01 else "moves" if speed > 0.25 else self.state
        if state != self.state:
            self.state = state
            say(state)
        way = int(message.pose.pose.position.x / 0.3)
        if way != self.way:
            self.way = way
            say("way", way)
"""


def test_robot_stops_when_driver_is_killed_but_not_when_it_exits(machine: Machine) -> None:
    launch = machine.launch(LAUNCH_FILE)
    listener = machine.program(LISTENER)
    listener.wait_for("stands")
    driver = machine.program(DRIVER)
    listener.wait_for("moves")
    driver.kill()
    listener.wait_for("stands", times=2)
    launch.wait_for("'/driver', which sent the commands on '/cmd_vel', was lost")
    machine.verb("topic", "pub", "--once", "/cmd_vel", "geometry_msgs/msg/Twist", "{linear: {x: 0.3}}")
    listener.wait_for("moves", times=2)
    listener.wait_for("way", times=listener.count("way") + 3)
    assert listener.count("stands") == 2, listener.text
    assert launch.count("was lost") == 1, launch.text
    assert launch.interrupt() == 130
