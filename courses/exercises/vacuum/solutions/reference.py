"""Drive lanes beside each other, along the wall on the right, and turn where a lane ends."""

import math

import numpy as np
import rclpy
from geometry_msgs.msg import Twist
from nav_msgs.msg import Odometry
from rclpy.node import Node
from sensor_msgs.msg import LaserScan

LANE = 0.4  # m


class Vacuum(Node):
    def __init__(self):
        super().__init__('vacuum')
        self.velocity = self.create_publisher(Twist, 'cmd_vel', 10)
        self.create_subscription(Odometry, 'odom', self.on_odometry, 10)
        self.create_subscription(LaserScan, 'scan', self.on_scan, 10)
        self.x = self.y = self.yaw = 0.0
        self.scan = None

    def on_odometry(self, odometry):
        position, orientation = odometry.pose.pose.position, odometry.pose.pose.orientation
        self.x, self.y = position.x, position.y
        self.yaw = 2.0 * math.atan2(orientation.z, orientation.w)
        self.is_current = True

    def on_scan(self, scan):
        angles = scan.angle_min + scan.angle_increment * np.arange(len(scan.ranges))
        ranges = np.array(scan.ranges)
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

    def room(self):
        """Return how far the robot could drive ahead, in m."""
        x, y = self.scan.T
        ahead = x[(x > 0.0) & (np.abs(y) < 0.24)]
        return ahead.min() if len(ahead) else 6.0

    def turn(self, yaw):
        while abs(error := math.remainder(yaw - self.yaw, math.tau)) > 0.03:
            self.drive(0.0, max(-1.8, min(1.8, 4.0 * error)))

    def go(self, yaw, distance):
        """Drive in a direction, for a distance or until something is near. Return how far."""
        x, y = self.x, self.y
        while (driven := math.hypot(self.x - x, self.y - y)) < distance - 0.02 and (room := self.room()) > 0.33:
            speed = min(0.45, 0.05 + 0.8 * (room - 0.3), 0.05 + 1.5 * (distance - driven))
            self.drive(speed, 2.0 * math.remainder(yaw - self.yaw, math.tau))
        self.drive(0.0, 0.0)
        return driven

    def run(self):
        self.wait()
        x, y = self.scan.T
        beside = (np.abs(x - 0.3) < 0.6) & (y < 0.0) & (y > -1.2)
        wall = self.yaw + math.atan(np.polyfit(x[beside], y[beside], 1)[0])
        direction, side = wall + math.pi, 1
        self.turn(direction)
        self.go(direction, 1.0)  # into the corner
        while True:
            self.turn(wall - math.pi / 2)
            self.go(wall - math.pi / 2, 0.6)
            side = 1
            direction = wall
            for _ in range(40):
                self.turn(direction)
                self.go(direction, 6.0)
                aside = wall + math.pi / 2 * side
                self.turn(aside)
                if self.go(aside, LANE) < 0.1:
                    side = -side  # the other end of the room: back in lanes
                direction += math.pi


def main():
    rclpy.init()
    Vacuum().run()


if __name__ == '__main__':
    main()
