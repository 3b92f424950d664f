"""Drive from cell to cell by odometry, between the walls that the laser sees, always as far right as possible."""

import math

import numpy as np
import rclpy
from geometry_msgs.msg import Twist
from nav_msgs.msg import Odometry
from rclpy.node import Node
from sensor_msgs.msg import LaserScan

CELL = 1.2  # m


class Maze(Node):
    def __init__(self):
        super().__init__('maze')
        self.velocity = self.create_publisher(Twist, 'cmd_vel', 10)
        self.create_subscription(Odometry, 'odom', self.on_odometry, 10)
        self.create_subscription(LaserScan, 'scan', self.on_scan, 10)
        self.x = self.y = self.yaw = 0.0
        self.ranges = None

    def on_odometry(self, odometry):
        position, orientation = odometry.pose.pose.position, odometry.pose.pose.orientation
        self.x, self.y = position.x, position.y
        self.yaw = 2.0 * math.atan2(orientation.z, orientation.w)
        self.is_current = True

    def on_scan(self, scan):
        self.ranges = np.array(scan.ranges)

    def wait(self):
        self.is_current = False
        while self.ranges is None or not self.is_current:
            rclpy.spin_once(self, timeout_sec=0.1)

    def drive(self, linear, angular):
        twist = Twist()
        twist.linear.x, twist.angular.z = float(linear), float(angular)
        self.velocity.publish(twist)
        self.wait()

    def distance(self, degrees):
        """Return the distance in a direction of the robot, in m; 0 degrees is ahead, 90 left."""
        return float(np.median(np.roll(self.ranges, -(180 + degrees) + 4)[:9]))

    def new_scan(self):
        self.ranges = None
        self.wait()

    def turn(self, yaw):
        while abs(error := math.remainder(yaw - self.yaw, math.tau)) > 0.03:
            self.drive(0.0, max(-1.8, min(1.8, 4.0 * error)))
        self.drive(0.0, 0.0)

    def step(self, yaw):
        """Drive to the middle of the next cell."""
        x, y = self.x, self.y
        while True:
            driven = (self.x - x) * math.cos(yaw) + (self.y - y) * math.sin(yaw)
            # A wall ahead tells better than the wheels where the cell ends.
            ahead = self.distance(0) - CELL / 2 + 0.05
            left = CELL - driven
            if ahead < left + 0.4:
                left = min(left, ahead) if abs(left - ahead) > 0.3 else ahead
            if left < 0.03:
                return
            sides = [side - 0.55 for side in (self.distance(90), self.distance(-90))]
            aside = sum(sign * side for sign, side in zip((1, -1), sides) if abs(side) < 0.3)
            speed = min(0.5, 0.08 + 1.2 * left)
            error = math.remainder(yaw - self.yaw, math.tau) + max(-0.3, min(0.3, 1.2 * aside))
            self.drive(speed, max(-1.2, min(1.2, 2.5 * error)))

    def run(self):
        self.wait()
        yaw = 0.0
        while True:
            self.new_scan()
            turn = next((turn for turn in (-90, 0, 90) if self.distance(turn) > 0.9), 180)
            if turn:
                yaw += math.radians(turn)
                self.turn(yaw)
                self.new_scan()
            self.step(yaw)


def main():
    rclpy.init()
    Maze().run()


if __name__ == '__main__':
    main()
