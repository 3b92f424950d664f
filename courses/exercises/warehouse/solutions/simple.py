"""Find the legs, and do everything slowly."""

import math
import sys

import numpy as np
import rclpy
from geometry_msgs.msg import Twist
from nav_msgs.msg import Odometry
from rclpy.node import Node
from sensor_msgs.msg import LaserScan
from std_msgs.msg import Bool

GOAL = (6.2, 0.0)  # m from the start
SPEED, TURN = 0.16, 0.5


class Warehouse(Node):
    def __init__(self):
        super().__init__('warehouse')
        self.velocity = self.create_publisher(Twist, 'cmd_vel', 10)
        self.lift = self.create_publisher(Bool, 'lift', 10)
        self.create_subscription(Odometry, 'odom', self.on_odometry, 10)
        self.create_subscription(LaserScan, 'scan', self.on_scan, 10)
        self.x = self.y = self.yaw = 0.0
        self.points = None

    def on_odometry(self, odometry):
        position, orientation = odometry.pose.pose.position, odometry.pose.pose.orientation
        self.x, self.y = position.x, position.y
        self.yaw = 2.0 * math.atan2(orientation.z, orientation.w)
        self.is_current = True

    def on_scan(self, scan):
        ranges = np.array(scan.ranges)
        angles = self.yaw + scan.angle_min + scan.angle_increment * np.arange(len(ranges))
        seen = np.isfinite(ranges)
        self.points = np.column_stack([
            self.x + ranges[seen] * np.cos(angles[seen]), self.y + ranges[seen] * np.sin(angles[seen])
        ])

    def wait(self):
        self.is_current = False
        while self.points is None or not self.is_current:
            rclpy.spin_once(self, timeout_sec=0.1)

    def drive(self, linear, angular):
        twist = Twist()
        twist.linear.x, twist.angular.z = float(linear), float(angular)
        self.velocity.publish(twist)
        self.wait()

    def legs(self):
        """Return the places of the legs: what stands in the room, away from its walls."""
        x, y = self.points.T
        inside = self.points[(x > 0.8) & (x < 4.5) & (np.abs(y) < 2.1)]
        legs = []
        for point in inside:
            if all(math.dist(point, leg) > 0.25 for leg in legs):
                legs.append(point)
        return np.array(legs)

    def go(self, place, tolerance):
        while (distance := math.dist((self.x, self.y), place())) > tolerance:
            x, y = place()
            error = math.remainder(math.atan2(y - self.y, x - self.x) - self.yaw, math.tau)
            speed = min(SPEED, 0.06 + 1.2 * distance) * max(0.0, math.cos(error)) ** 4
            self.drive(speed, max(-TURN, min(TURN, 3.0 * error)))
        for _ in range(15):
            self.drive(0.0, 0.0)

    def find(self):
        """Return the middle of the shelf."""
        legs = self.legs()
        if len(legs) == 4:
            self.middle = tuple(legs.mean(axis=0))
        elif not hasattr(self, 'middle'):
            self.middle = (2.5, 0.0)
        return self.middle

    def entry(self):
        """Return a place before the side of the shelf that faces the robot, between two of its legs."""
        middle = np.array(self.find())
        legs = self.legs()
        near = legs[np.argsort(np.hypot(*(legs - (self.x, self.y)).T))[:3]]
        sides = [(near[i] + near[j]) / 2 - middle for i, j in ((0, 1), (0, 2), (1, 2))]
        # The middle of a diagonal is the middle of the shelf.
        sides = [side for side in sides if math.hypot(*side) > 0.25]
        side = min(sides, key=lambda side: math.dist(middle + side, (self.x, self.y)))
        return tuple(middle + 2.4 * side)

    def run(self):
        self.wait()
        while len(self.legs()) != 4:
            self.drive(0.05, 0.0)
        place = self.entry()
        self.go(lambda: place, 0.05)
        self.go(self.find, 0.03)
        self.lift.publish(Bool(data=True))
        self.wait()
        self.go(lambda: GOAL, 0.1)
        self.lift.publish(Bool(data=False))
        self.wait()
        sys.exit()


def main():
    rclpy.init()
    Warehouse().run()


if __name__ == '__main__':
    main()
