"""Keep the same distance to the left and to the right, and stop while something is close ahead."""

import numpy as np
import rclpy
from geometry_msgs.msg import Twist
from rclpy.node import Node
from sensor_msgs.msg import LaserScan


class Race(Node):
    def __init__(self):
        super().__init__('race')
        self.velocity = self.create_publisher(Twist, 'cmd_vel', 10)
        self.create_subscription(LaserScan, 'scan', self.on_scan, 10)

    def on_scan(self, scan):
        ranges = np.array(scan.ranges)  # 90: to the right, 180: ahead, 270: to the left
        right, left = ranges[80:150].min(), ranges[210:280].min()
        twist = Twist()
        twist.angular.z = float(np.clip(1.2 * (left - right), -0.8, 0.8))
        if ranges[165:195].min() > 0.5:
            twist.linear.x = 0.4
        self.velocity.publish(twist)


def main():
    rclpy.init()
    rclpy.spin(Race())


if __name__ == '__main__':
    main()
