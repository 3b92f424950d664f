import math

import rclpy
from geometry_msgs.msg import Twist
from rclpy.executors import ExternalShutdownException
from rclpy.node import Node
from rclpy.signals import SignalHandlerOptions
from sensor_msgs.msg import LaserScan


class Wander(Node):
    def __init__(self):
        super().__init__('wander')
        self.turn = 0.0
        self.velocity = self.create_publisher(Twist, 'cmd_vel', 10)
        self.create_subscription(LaserScan, 'scan', self.on_scan, 10)

    def on_scan(self, scan):
        left = self.nearest(scan, 0.0, 1.0)
        right = self.nearest(scan, -1.0, 0.0)
        if min(left, right) > 0.7:
            self.turn = 0.0
            self.drive(0.3, 0.0)
        else:
            if self.turn == 0.0:
                self.turn = 0.8 if left > right else -0.8
            self.drive(0.0, self.turn)

    def nearest(self, scan, first, last):
        distances = [
            distance
            for index, distance in enumerate(scan.ranges)
            if first <= scan.angle_min + index * scan.angle_increment <= last
            and distance > scan.range_min
        ]
        return min(distances, default=math.inf)

    def drive(self, speed, turn=0.0):
        message = Twist()
        message.linear.x = speed
        message.angular.z = turn
        self.velocity.publish(message)


def main():
    rclpy.init(signal_handler_options=SignalHandlerOptions.NO)
    node = Wander()
    try:
        while rclpy.ok():
            rclpy.spin_once(node, timeout_sec=0.1)
    except (KeyboardInterrupt, ExternalShutdownException):
        pass
    finally:
        node.drive(0.0)
        rclpy.try_shutdown()
