import time
import unittest

import launch_testing.actions
import pytest
import rclpy
from ament_index_python.packages import get_package_share_path
from geometry_msgs.msg import PointStamped, Twist
from launch import LaunchDescription
from launch.actions import IncludeLaunchDescription
from launch.launch_description_sources import PythonLaunchDescriptionSource
from std_msgs.msg import String


@pytest.mark.launch_test
def generate_test_description():
    path = get_package_share_path('my_mission') / 'launch' / 'mission.launch.py'
    return LaunchDescription([
        IncludeLaunchDescription(PythonLaunchDescriptionSource(str(path)),
                                 launch_arguments={'simulation': 'false'}.items()),
        launch_testing.actions.ReadyToTest(),
    ])


class TestMission(unittest.TestCase):
    def setUp(self):
        rclpy.init()
        self.node = rclpy.create_node('test_mission')
        self.commands = self.node.create_publisher(String, 'command', 10)
        self.balls = self.node.create_publisher(PointStamped, 'ball', 10)
        self.node.create_subscription(Twist, 'cmd_vel', self.on_velocity, 10)
        self.velocity = None
        self.wait_for(lambda: self.velocity and self.commands.get_subscription_count()
                      and self.balls.get_subscription_count())

    def tearDown(self):
        self.node.destroy_node()
        rclpy.shutdown()

    def on_velocity(self, message):
        self.velocity = message

    def wait_for(self, condition, timeout=10.0):
        end = time.monotonic() + timeout
        while not condition():
            self.assertLess(time.monotonic(), end, 'it did not happen in time')
            rclpy.spin_once(self.node, timeout_sec=0.1)

    def command(self, text):
        self.commands.publish(String(data=text))

    def show_ball(self, forward, left):
        ball = PointStamped()
        ball.header.stamp = self.node.get_clock().now().to_msg()
        ball.point.x, ball.point.y = forward, left
        self.balls.publish(ball)

    def test_it_drives_to_the_ball_and_stops(self):
        self.command('去红球那里')

        def is_driving():
            self.show_ball(2.0, 0.5)
            return self.velocity.linear.x > 0.0 and self.velocity.angular.z > 0.0

        self.wait_for(is_driving)
        self.command('停')
        self.wait_for(lambda: self.velocity.linear.x == 0.0 and self.velocity.angular.z == 0.0)
