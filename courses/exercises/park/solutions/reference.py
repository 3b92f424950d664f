"""Measure the gap while driving past, in a frame along the kerb; come back, turn, drive in, and turn back."""

import math

import numpy as np
import rclpy
from geometry_msgs.msg import Twist
from nav_msgs.msg import Odometry
from rclpy.node import Node
from sensor_msgs.msg import LaserScan

DEPTH = 0.35  # m: the middle of the gap from the kerb


class Park(Node):
    def __init__(self):
        super().__init__('park')
        self.velocity = self.create_publisher(Twist, 'cmd_vel', 10)
        self.create_subscription(Odometry, 'odom', self.on_odometry, 10)
        self.create_subscription(LaserScan, 'scan', self.on_scan, 10)
        self.x = self.y = self.yaw = self.kerb_yaw = 0.0
        self.scan = None
        self.edges = []

    def on_odometry(self, odometry):
        position, orientation = odometry.pose.pose.position, odometry.pose.pose.orientation
        cos, sin = math.cos(self.kerb_yaw), math.sin(self.kerb_yaw)
        self.x, self.y = position.x * cos + position.y * sin, position.y * cos - position.x * sin
        self.yaw = 2.0 * math.atan2(orientation.z, orientation.w) - self.kerb_yaw
        self.is_current = True

    def on_scan(self, scan):
        angles = scan.angle_min + scan.angle_increment * np.arange(len(scan.ranges))
        ranges = np.array(scan.ranges)
        ranges[~np.isfinite(ranges)] = 9.0
        self.scan = np.column_stack([ranges * np.cos(angles), ranges * np.sin(angles)])

    def wait(self):
        self.is_current = False
        while self.scan is None or not self.is_current:
            rclpy.spin_once(self, timeout_sec=0.1)

    def drive(self, linear, angular):
        twist = Twist()
        twist.linear.x, twist.angular.z = float(linear), float(angular)
        self.velocity.publish(twist)
        self.wait()

    def turn(self, yaw):
        while abs(error := math.remainder(yaw - self.yaw, math.tau)) > 0.01:
            self.drive(0.0, max(-1.0, min(1.0, 3.0 * error)))
        self.stop()

    def go(self, yaw, distance, speed=0.3):
        """Drive in a direction, backwards if the distance is negative."""
        x, y = self.x, self.y
        while True:
            driven = (self.x - x) * math.cos(yaw) + (self.y - y) * math.sin(yaw)
            left = distance - driven
            if abs(left) < 0.005:
                return self.stop()
            self.drive(max(-speed, min(speed, 2.0 * left)), 2.0 * math.remainder(yaw - self.yaw, math.tau))

    def stop(self):
        for _ in range(25):
            self.drive(0.0, 0.0)

    def find_kerb(self):
        """Return the direction of the kerb in the frame of the robot, and its distance."""
        self.scan = None
        self.wait()
        x, y = self.scan.T
        beside = (np.abs(x) < 0.5) & (y < -0.9) & (y > -1.5)
        slope, offset = np.polyfit(x[beside], y[beside], 1)
        return math.atan(slope), -offset * math.cos(math.atan(slope))

    def run(self):
        self.wait()
        angle, kerb = self.find_kerb()
        self.kerb_yaw = angle
        self.wait()
        self.turn(0.0)
        points = []
        while self.x < 5.0:
            self.drive(0.3, -2.0 * self.yaw - 1.0 * self.y)
            x, y = self.scan.T
            near = x[(np.abs(x) < 0.6) & (y < -0.2) & (y > 0.5 - kerb)] + self.x
            points.extend(near)
            first, last = self.gap(points)
            if last is not None and self.x > last + 0.3:
                break
        self.stop()
        first, last = self.gap(points)
        self.go(0.0, (first + last) / 2 - self.x)
        self.turn(-math.pi / 2)
        self.go(-math.pi / 2, kerb + self.y - DEPTH, 0.2)
        self.turn(0.0)
        while rclpy.ok():
            self.drive(0.0, 0.0)

    def gap(self, points):
        """Return where the gap begins and ends along the kerb."""
        along = np.sort(points)
        if len(along) < 2 or (widths := np.diff(along)).max() < 0.8:
            return None, None
        number = widths.argmax()
        return along[number], along[number + 1]


def main():
    rclpy.init()
    Park().run()


if __name__ == '__main__':
    main()
