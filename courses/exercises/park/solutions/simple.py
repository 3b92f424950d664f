"""Look straight to the right while driving past; come back to the middle of the gap, and drive in."""

import math
import time

import rclpy
from geometry_msgs.msg import Twist
from nav_msgs.msg import Odometry
from rclpy.node import Node
from sensor_msgs.msg import LaserScan


class Park(Node):
    def __init__(self):
        super().__init__('park')
        self.velocity = self.create_publisher(Twist, 'cmd_vel', 10)
        self.create_subscription(Odometry, 'odom', self.on_odometry, 10)
        self.create_subscription(LaserScan, 'scan', self.on_scan, 10)
        self.x = 0.0
        self.right = 1.2

    def on_odometry(self, odometry):
        self.x = odometry.pose.pose.position.x

    def on_scan(self, scan):
        self.right = scan.ranges[90]

    def drive(self, linear, angular, seconds):
        twist = Twist()
        twist.linear.x, twist.angular.z = linear, angular
        self.velocity.publish(twist)
        end = time.time() + seconds
        while time.time() < end:
            rclpy.spin_once(self, timeout_sec=0.05)

    def drive_while(self, condition, speed=0.2):
        while condition():
            self.drive(speed, 0.0, 0.1)

    def run(self):
        self.drive_while(lambda: self.right > 0.9)
        self.drive_while(lambda: self.right < 0.9)
        first = self.x
        self.drive_while(lambda: self.right > 0.9)
        middle = (first + self.x) / 2
        self.drive_while(lambda: self.x > middle, -0.2)
        self.drive(0.0, 0.0, 1.0)
        self.drive(0.0, -math.pi / 6, 3.0)
        self.drive(0.2, 0.0, 3.6)
        self.drive(0.0, math.pi / 6, 3.0)
        self.drive(0.0, 0.0, 10.0)


def main():
    rclpy.init()
    Park().run()


if __name__ == '__main__':
    main()
