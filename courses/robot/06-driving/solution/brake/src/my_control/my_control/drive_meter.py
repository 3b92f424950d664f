import math

import rclpy
from geometry_msgs.msg import Twist
from nav_msgs.msg import Odometry
from rclpy.executors import ExternalShutdownException
from rclpy.node import Node
from rclpy.signals import SignalHandlerOptions


class DriveMeter(Node):
    def __init__(self):
        super().__init__('drive_meter')
        self.start = None
        self.velocity = self.create_publisher(Twist, 'cmd_vel', 10)
        self.create_subscription(Odometry, 'odom', self.on_odometry, 10)

    def on_odometry(self, message):
        position = message.pose.pose.position
        if self.start is None:
            self.start = position
        driven = math.hypot(position.x - self.start.x, position.y - self.start.y)
        remaining = 1.0 - driven
        self.drive(max(0.0, min(0.3, remaining)))

    def drive(self, speed):
        message = Twist()
        message.linear.x = speed
        self.velocity.publish(message)


def main():
    rclpy.init(signal_handler_options=SignalHandlerOptions.NO)
    node = DriveMeter()
    try:
        while rclpy.ok():
            rclpy.spin_once(node, timeout_sec=0.1)
    except (KeyboardInterrupt, ExternalShutdownException):
        pass
    finally:
        node.drive(0.0)
        rclpy.try_shutdown()
