"""Drive straight on; at an obstacle turn by a random angle."""

import random

import rclpy
from geometry_msgs.msg import Twist
from rclpy.node import Node
from sensor_msgs.msg import LaserScan


class Vacuum(Node):
    def __init__(self):
        super().__init__('vacuum')
        self.velocity = self.create_publisher(Twist, 'cmd_vel', 10)
        self.create_subscription(LaserScan, 'scan', self.on_scan, 10)
        self.turns = 0

    def on_scan(self, scan):
        count = len(scan.ranges)
        ahead = min(scan.ranges[count // 2 - 40:count // 2 + 40])
        twist = Twist()
        if self.turns == 0 and ahead < 0.4:
            self.turns = random.randint(12, 30)
        if self.turns:
            self.turns -= 1
            twist.angular.z = 1.0
        else:
            twist.linear.x = 0.16
        self.velocity.publish(twist)


def main():
    rclpy.init()
    rclpy.spin(Vacuum())


if __name__ == '__main__':
    main()
