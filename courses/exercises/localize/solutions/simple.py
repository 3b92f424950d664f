"""Take the best of many random poses for the first scan, and count on odometry from then on."""

import math

import numpy as np
import rclpy
from geometry_msgs.msg import PoseStamped, Twist
from nav_msgs.msg import Odometry
from rclpy.node import Node
from sensor_msgs.msg import LaserScan

WALLS = np.array([
    (0, 0, 6, 0), (6, 0, 6, 5), (6, 5, 0, 5), (0, 5, 0, 0),
    (2.5, 0, 2.5, 1.5), (2.5, 2.7, 2.5, 5), (4.0, 3.0, 6, 3.0),
])  # x and y of both ends, in m


class Localize(Node):
    def __init__(self):
        super().__init__('localize')
        self.velocity = self.create_publisher(Twist, 'cmd_vel', 10)
        self.estimate = self.create_publisher(PoseStamped, 'estimate', 10)
        self.create_subscription(LaserScan, 'scan', self.on_scan, 10)
        self.create_subscription(Odometry, 'odom', self.on_odometry, 10)
        self.odometry = None
        self.start = None

    def on_odometry(self, odometry):
        position, orientation = odometry.pose.pose.position, odometry.pose.pose.orientation
        self.odometry = position.x, position.y, 2.0 * math.atan2(orientation.z, orientation.w)

    def on_scan(self, scan):
        ranges = np.array(scan.ranges)
        self.wander(ranges)
        if self.odometry is not None:
            angles = scan.angle_min + scan.angle_increment * np.arange(len(ranges))
            self.localize(np.minimum(ranges[::10], scan.range_max), angles[::10])

    def wander(self, ranges):
        twist = Twist()
        if ranges[150:210].min() < 0.55:
            twist.angular.z = 0.8
        else:
            twist.linear.x = 0.25
        self.velocity.publish(twist)

    def localize(self, ranges, angles):
        if self.start is None:
            poses = random_poses(np.random.default_rng(1), 3000)
            errors = np.minimum(np.abs(expected_ranges(poses, angles) - ranges), 1.0).sum(axis=1)
            self.start = poses[errors.argmin()]
            self.begin = self.odometry
        turn = self.start[2] - self.begin[2]
        dx, dy = self.odometry[0] - self.begin[0], self.odometry[1] - self.begin[1]
        x = self.start[0] + dx * math.cos(turn) - dy * math.sin(turn)
        y = self.start[1] + dx * math.sin(turn) + dy * math.cos(turn)
        self.publish(x, y)

    def publish(self, x, y):
        message = PoseStamped()
        message.header.frame_id = 'map'
        message.pose.position.x, message.pose.position.y = float(x), float(y)
        self.estimate.publish(message)


def expected_ranges(poses, angles):
    """Return the distances to the nearest wall, shape (poses, angles)."""
    directions = poses[:, 2:3] + angles
    cos, sin = np.cos(directions)[..., None], np.sin(directions)[..., None]
    x, y = poses[:, 0, None, None], poses[:, 1, None, None]
    x1, y1, x2, y2 = WALLS.T
    dx, dy = x2 - x1, y2 - y1
    with np.errstate(divide='ignore', invalid='ignore'):
        cross = cos * dy - sin * dx
        distance = ((x1 - x) * dy - (y1 - y) * dx) / cross
        part = ((x1 - x) * sin - (y1 - y) * cos) / cross
    distance[~((distance > 0.0) & (part >= 0.0) & (part <= 1.0))] = 6.0
    return np.minimum(distance.min(axis=2) - 0.05, 6.0)  # walls are 0.1 m thick


def random_poses(random, count):
    return np.column_stack([random.uniform(0.2, 5.8, count), random.uniform(0.2, 4.8, count), random.uniform(-math.pi, math.pi, count)])


def main():
    rclpy.init()
    rclpy.spin(Localize())


if __name__ == '__main__':
    main()
