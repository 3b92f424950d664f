"""A particle filter: guesses move as the robot does, and those that explain the scan survive."""

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
        self.random = np.random.default_rng(1)
        self.poses = random_poses(self.random, 3000)
        self.last = None

    def on_odometry(self, odometry):
        position, orientation = odometry.pose.pose.position, odometry.pose.pose.orientation
        self.odometry = position.x, position.y, 2.0 * math.atan2(orientation.z, orientation.w)

    def on_scan(self, scan):
        ranges = np.array(scan.ranges)
        self.wander(ranges)
        if self.odometry is not None:
            angles = scan.angle_min + scan.angle_increment * np.arange(len(ranges))
            self.localize(np.minimum(ranges[::15], scan.range_max), angles[::15])

    def wander(self, ranges):
        twist = Twist()
        if ranges[150:210].min() < 0.55:
            twist.angular.z = 0.8
        else:
            twist.linear.x = 0.25
        self.velocity.publish(twist)

    def localize(self, ranges, angles):
        if self.last is None:
            self.last = self.odometry
        x, y, yaw = self.last
        dx, dy = self.odometry[0] - x, self.odometry[1] - y
        forward, aside = dx * math.cos(yaw) + dy * math.sin(yaw), dy * math.cos(yaw) - dx * math.sin(yaw)
        turn = math.remainder(self.odometry[2] - yaw, math.tau)
        self.last = self.odometry
        self.move(forward, aside, turn)
        errors = np.abs(expected_ranges(self.poses, angles) - ranges)
        scores = -np.minimum(errors, 0.6).sum(axis=1) / 0.8
        weights = np.exp(scores - scores.max())
        weights /= weights.sum()
        best = self.poses[np.argsort(weights)[-20:]]
        self.publish(*np.median(best[:, :2], axis=0))
        # Fewer particles are enough once they agree; some random ones find the way back from a wrong place.
        count = 600 if self.poses[:, :2].std(axis=0).max() < 0.5 else 2500
        self.poses = self.poses[self.random.choice(len(self.poses), count, p=weights)]
        self.poses[:60] = random_poses(self.random, 60)

    def move(self, forward, aside, turn):
        """Move the particles as the robot moved, each a little differently."""
        noise = self.random.normal(size=self.poses.shape) * (0.015, 0.015, 0.02)
        cos, sin = np.cos(self.poses[:, 2]), np.sin(self.poses[:, 2])
        self.poses[:, 0] += forward * cos - aside * sin
        self.poses[:, 1] += forward * sin + aside * cos
        self.poses[:, 2] += turn
        self.poses += noise

    def publish(self, x, y):
        message = PoseStamped()
        message.header.frame_id = 'map'
        message.pose.position.x, message.pose.position.y = float(x), float(y)
        self.estimate.publish(message)


def expected_ranges(poses, angles):
    """Return the distances to the nearest wall, shape (poses, angles)."""
    directions = poses[:, 2:3] + angles
    cos, sin = np.cos(directions), np.sin(directions)
    x, y = poses[:, 0:1], poses[:, 1:2]
    x1, y1, x2, y2 = WALLS.T[:, :, np.newaxis, np.newaxis]
    dx, dy = x2 - x1, y2 - y1
    with np.errstate(divide='ignore', invalid='ignore'):
        cross = cos * dy - sin * dx
        distance = ((x1 - x) * dy - (y1 - y) * dx) / cross
        part = ((x1 - x) * sin - (y1 - y) * cos) / cross
    distance[~((distance > 0.0) & (part >= 0.0) & (part <= 1.0))] = 6.0
    return np.minimum(distance.min(axis=0) - 0.05, 6.0)  # walls are 0.1 m thick


def random_poses(random, count):
    return np.column_stack([random.uniform(0.2, 5.8, count), random.uniform(0.2, 4.8, count), random.uniform(-math.pi, math.pi, count)])


def main():
    rclpy.init()
    rclpy.spin(Localize())


if __name__ == '__main__':
    main()
