"""Drive at up to 0.36 m/s where there is room, weave, and give way to a robot at the side."""

import math
import random
from contextlib import suppress

import numpy as np
import rclpy
from geometry_msgs.msg import Twist
from rclpy.executors import ExternalShutdownException
from rclpy.node import Node
from sensor_msgs.msg import LaserScan

SPEED = 0.36  # m/s
WEAVING, PERIOD = 0.3, 16.0  # rad, s
HALF_WIDTH = 0.38  # m: of the robot, with a margin
FAR = 1.5  # m
BESIDE = -0.4  # m: what is not further behind counts, too
DIRECTIONS = np.radians(np.arange(-80.0, 81.0, 4.0))


class Rival(Node):
    def __init__(self):
        super().__init__('race')
        self.phase = random.uniform(0.0, math.tau)
        self.velocity = self.create_publisher(Twist, 'cmd_vel', 10)
        self.create_subscription(LaserScan, 'scan', self.on_scan, 10)

    def on_scan(self, scan):
        ranges = np.array(scan.ranges)
        angles = scan.angle_min + scan.angle_increment * np.arange(len(ranges))
        seen = np.isfinite(ranges)
        x, y = ranges[seen] * np.cos(angles[seen]), ranges[seen] * np.sin(angles[seen])
        seconds = self.get_clock().now().nanoseconds / 1e9
        wanted = WEAVING * math.sin(math.tau * seconds / PERIOD + self.phase)
        rooms = np.array([room(x, y, direction) for direction in DIRECTIONS])
        direction = DIRECTIONS[np.argmax(rooms - 0.4 * np.abs(DIRECTIONS - wanted))]
        twist = Twist()
        twist.angular.z = float(np.clip(1.5 * direction, -0.8, 0.8))
        twist.linear.x = float(np.clip(0.9 * (room(x, y, 0.0) - 0.35), -0.1, SPEED))
        self.velocity.publish(twist)


def room(x, y, direction):
    """Return how far the robot can drive in a direction, in m."""
    forward = x * math.cos(direction) + y * math.sin(direction)
    aside = y * math.cos(direction) - x * math.sin(direction)
    blocking = forward[(forward > BESIDE) & (np.abs(aside) < HALF_WIDTH)]
    return min(FAR, blocking.min()) if len(blocking) else FAR


def main():
    rclpy.init()
    with suppress(KeyboardInterrupt, ExternalShutdownException):
        rclpy.spin(Rival())


if __name__ == '__main__':
    main()
