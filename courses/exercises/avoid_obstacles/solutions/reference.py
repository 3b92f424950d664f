"""Of the directions in which the robot has room, take the one that is nearest to the goal."""

import math

import numpy as np
import rclpy
from geometry_msgs.msg import Twist
from nav_msgs.msg import Odometry
from rclpy.node import Node
from sensor_msgs.msg import LaserScan

HALF_WIDTH = 0.33  # m: of the robot, with a margin
FAR = 1.6  # m
DIRECTIONS = np.radians(np.arange(-90.0, 91.0, 5.0))


class AvoidObstacles(Node):
    def __init__(self):
        super().__init__('avoid_obstacles')
        self.velocity = self.create_publisher(Twist, 'cmd_vel', 10)
        self.create_subscription(Odometry, 'odom', self.on_odometry, 10)
        self.create_subscription(LaserScan, 'scan', self.on_scan, 10)
        self.yaw = 0.0
        self.arrived = False
        self.direction = 0.0

    def on_odometry(self, odometry):
        orientation = odometry.pose.pose.orientation
        self.yaw = 2.0 * math.atan2(orientation.z, orientation.w)

    def on_scan(self, scan):
        ranges = np.array(scan.ranges)
        angles = scan.angle_min + scan.angle_increment * np.arange(len(ranges))
        seen = np.isfinite(ranges)
        x, y = ranges[seen] * np.cos(angles[seen]), ranges[seen] * np.sin(angles[seen])
        rooms = np.array([room(x, y, direction) for direction in DIRECTIONS])
        errors = np.abs(DIRECTIONS + self.yaw) + 0.3 * np.abs(DIRECTIONS - self.direction)
        best = np.argmax(2.5 * rooms - errors)
        self.direction = DIRECTIONS[best]
        twist = Twist()
        twist.angular.z = float(np.clip(2.0 * self.direction, -1.5, 1.5))
        ahead = room(x, y, 0.0)
        twist.linear.x = float(np.clip(0.8 * (ahead - 0.3), 0.0, 0.5) * max(0.15, math.cos(self.direction)))
        self.velocity.publish(twist)


def room(x, y, direction):
    """Return how far the robot can drive in a direction, in m."""
    forward = x * math.cos(direction) + y * math.sin(direction)
    aside = y * math.cos(direction) - x * math.sin(direction)
    blocking = forward[(forward > 0.0) & (np.abs(aside) < HALF_WIDTH)]
    return min(FAR, blocking.min()) if len(blocking) else FAR


def main():
    rclpy.init()
    rclpy.spin(AvoidObstacles())


if __name__ == '__main__':
    main()
