"""Drive where there is most room for the whole robot, and fast where it is far."""

import math

import numpy as np
import rclpy
from geometry_msgs.msg import Twist
from rclpy.node import Node
from sensor_msgs.msg import LaserScan

HALF_WIDTH = 0.36  # m: of the robot, with a margin
FAR = 2.2  # m
DIRECTIONS = np.radians(np.arange(-80.0, 81.0, 4.0))


class Race(Node):
    def __init__(self):
        super().__init__('race')
        self.velocity = self.create_publisher(Twist, 'cmd_vel', 10)
        self.create_subscription(LaserScan, 'scan', self.on_scan, 10)
        self.direction = 0.0

    def on_scan(self, scan):
        ranges = np.array(scan.ranges)
        angles = scan.angle_min + scan.angle_increment * np.arange(len(ranges))
        seen = np.isfinite(ranges)
        x, y = ranges[seen] * np.cos(angles[seen]), ranges[seen] * np.sin(angles[seen])
        rooms = np.array([room(x, y, direction) for direction in DIRECTIONS])
        best = np.argmax(rooms - 0.25 * np.abs(DIRECTIONS) - 0.3 * np.abs(DIRECTIONS - self.direction))
        self.direction = DIRECTIONS[best]
        twist = Twist()
        twist.angular.z = float(np.clip(2.2 * self.direction, -1.5, 1.5))
        ahead = min(room(x, y, 0.0), room(x, y, self.direction / 2))
        twist.linear.x = float(np.clip(0.9 * (ahead - 0.35), -0.1, 0.6) * max(0.2, math.cos(self.direction)))
        self.velocity.publish(twist)


def room(x, y, direction):
    """Return how far the robot can drive in a direction, in m."""
    forward = x * math.cos(direction) + y * math.sin(direction)
    aside = y * math.cos(direction) - x * math.sin(direction)
    blocking = forward[(forward > 0.0) & (np.abs(aside) < HALF_WIDTH)]
    return min(FAR, blocking.min()) if len(blocking) else FAR


def main():
    rclpy.init()
    rclpy.spin(Race())


if __name__ == '__main__':
    main()
