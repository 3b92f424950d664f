import math

import rclpy
from geometry_msgs.msg import Twist
from rclpy.executors import ExternalShutdownException
from rclpy.node import Node
from rclpy.signals import SignalHandlerOptions
from sensor_msgs.msg import LaserScan


class StopAtWall(Node):
    def __init__(self):
        super().__init__('stop_at_wall')
        self.velocity = self.create_publisher(Twist, 'cmd_vel', 10)
        self.create_subscription(LaserScan, 'scan', self.on_scan, 10)

    def on_scan(self, scan):
        nearest = math.inf
        for index, distance in enumerate(scan.ranges):
            angle = scan.angle_min + index * scan.angle_increment
            if abs(angle) < 0.5 and distance > scan.range_min:
                nearest = min(nearest, distance)
        self.drive(0.3 if nearest > 0.6 else 0.0)

    def drive(self, speed):
        message = Twist()
        message.linear.x = speed
        self.velocity.publish(message)


def main():
    rclpy.init(signal_handler_options=SignalHandlerOptions.NO)
    node = StopAtWall()
    try:
        while rclpy.ok():
            rclpy.spin_once(node, timeout_sec=0.1)
    except (KeyboardInterrupt, ExternalShutdownException):
        pass
    finally:
        node.drive(0.0)
        rclpy.try_shutdown()
