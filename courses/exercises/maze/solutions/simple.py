"""Follow the wall on the right: towards it if it is far, away if it is near, and turn left before a wall ahead."""

import numpy as np
import rclpy
from geometry_msgs.msg import Twist
from rclpy.node import Node
from sensor_msgs.msg import LaserScan


class Maze(Node):
    def __init__(self):
        super().__init__('maze')
        self.velocity = self.create_publisher(Twist, 'cmd_vel', 10)
        self.create_subscription(LaserScan, 'scan', self.on_scan, 10)

    def on_scan(self, scan):
        ranges = np.array(scan.ranges)  # 90: to the right, 180: ahead, 270: to the left
        ahead = ranges[165:195].min()
        right = ranges[60:135].min()
        twist = Twist()
        if ahead < 0.5:
            twist.angular.z = 0.7
        else:
            twist.linear.x = 0.17
            twist.angular.z = float(np.clip(2.5 * (0.42 - right), -0.45, 0.7))
        self.velocity.publish(twist)


def main():
    rclpy.init()
    rclpy.spin(Maze())


if __name__ == '__main__':
    main()
