"""A package as the tutorials about tf2 have their readers write it: one turtle follows another by their frames."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

import pytest

from tests.domains import own_domain
from tests.launch.launcher import Running

pytestmark = pytest.mark.slow

MANIFEST = "<package format='3'><name>turtle_hunt</name><version>1.0.0</version></package>"
SETUP = """\
from setuptools import setup

setup(
    name='turtle_hunt',
    packages=['turtle_hunt'],
    entry_points={'console_scripts': [
        'broadcaster = turtle_hunt.broadcaster:main',
        'follower = turtle_hunt.follower:main',
    ]},
)
"""
BROADCASTER = """\
from math import cos, sin

import rclpy
from geometry_msgs.msg import TransformStamped
from rclpy.node import Node
from tf2_ros import TransformBroadcaster
from turtlesim.msg import Pose


class Broadcaster(Node):
    def __init__(self):
        super().__init__('broadcaster')
        self.turtle = self.declare_parameter('turtlename', 'turtle').get_parameter_value().string_value
        self.tf = TransformBroadcaster(self)
        self.create_subscription(Pose, f'/{self.turtle}/pose', self.on_pose, 1)

    def on_pose(self, pose):
        transform = TransformStamped()
        transform.header.stamp = self.get_clock().now().to_msg()
        transform.header.frame_id = 'world'
        transform.child_frame_id = self.turtle
        transform.transform.translation.x = pose.x
        transform.transform.translation.y = pose.y
        transform.transform.rotation.z = sin(pose.theta / 2)
        transform.transform.rotation.w = cos(pose.theta / 2)
        self.tf.sendTransform(transform)


def main():
    rclpy.init()
    rclpy.spin(Broadcaster())
"""
FOLLOWER = """\
from math import atan2, hypot

import rclpy
from geometry_msgs.msg import Twist
from rclpy.node import Node
from tf2_ros import TransformException
from tf2_ros.buffer import Buffer
from tf2_ros.transform_listener import TransformListener
from turtlesim.srv import Spawn


class Follower(Node):
    def __init__(self):
        super().__init__('follower')
        self.buffer = Buffer()
        self.listener = TransformListener(self.buffer, self)
        self.publisher = self.create_publisher(Twist, 'turtle2/cmd_vel', 1)
        client = self.create_client(Spawn, 'spawn')
        client.wait_for_service()
        client.call_async(Spawn.Request(name='turtle2', x=4.0, y=2.0)).add_done_callback(self.on_spawned)
        self.create_timer(0.1, self.follow)

    def on_spawned(self, future):
        self.get_logger().info(f'hello {future.result().name}')

    def follow(self):
        try:
            goal = self.buffer.lookup_transform('turtle2', 'turtle1', rclpy.time.Time()).transform.translation
        except TransformException:
            return
        twist = Twist()
        twist.angular.z = 4.0 * atan2(goal.y, goal.x)
        twist.linear.x = hypot(goal.x, goal.y)
        self.publisher.publish(twist)
        if twist.linear.x < 0.5:
            self.get_logger().info('caught turtle1', once=True)


def main():
    rclpy.init()
    rclpy.spin(Follower())
"""
LAUNCH = """\
from launch import LaunchDescription
from launch_ros.actions import Node


def generate_launch_description():
    return LaunchDescription([
        Node(package='turtlesim', executable='turtlesim_node', name='sim'),
        *[
            Node(package='turtle_hunt', executable='broadcaster', name=f'of_{name}', parameters=[{'turtlename': name}])
            for name in ('turtle1', 'turtle2')
        ],
        Node(package='turtle_hunt', executable='follower', name='listener'),
    ])
"""


def test_turtle_follows_another_by_tf(
    start: Callable[..., Running], tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.delenv("LINKWRIGHT_DDS", raising=False)
    monkeypatch.setenv("ROS_DOMAIN_ID", str(own_domain()))
    package = tmp_path / "src" / "turtle_hunt"
    files = {
        "package.xml": MANIFEST,
        "setup.py": SETUP,
        "turtle_hunt/__init__.py": "",
        "turtle_hunt/broadcaster.py": BROADCASTER,
        "turtle_hunt/follower.py": FOLLOWER,
        "launch/hunt.launch.py": LAUNCH,
    }
    for name, text in files.items():
        path = package / name
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text(text)
    running = start("launch", package / "launch" / "hunt.launch.py")
    running.until("hello turtle2")
    running.until("caught turtle1")
