"""Of five directions, take the free one that is nearest to the goal, slowly."""

import math

import rclpy
from geometry_msgs.msg import Twist
from nav_msgs.msg import Odometry
from rclpy.node import Node
from sensor_msgs.msg import LaserScan


class AvoidObstacles(Node):
    def __init__(self):
        super().__init__('avoid_obstacles')
        self.velocity = self.create_publisher(Twist, 'cmd_vel', 10)
        self.create_subscription(Odometry, 'odom', self.on_odometry, 10)
        self.create_subscription(LaserScan, 'scan', self.on_scan, 10)
        self.yaw = 0.0

    def on_odometry(self, odometry):
        orientation = odometry.pose.pose.orientation
        self.yaw = 2.0 * math.atan2(orientation.z, orientation.w)

    def on_scan(self, scan):
        directions = sorted((-70, -35, 0, 35, 70), key=lambda degrees: abs(math.radians(degrees) + self.yaw))
        free = [degrees for degrees in directions if nearest(scan, degrees - 30, degrees + 30) > 0.75]
        twist = Twist()
        if not free:
            twist.angular.z = 0.6
        else:
            twist.angular.z = math.radians(free[0])
            twist.linear.x = 0.24 if free[0] == 0 else 0.08
        self.velocity.publish(twist)


def nearest(scan, first, last):
    """Return the smallest distance between two angles in degrees."""
    angles = (math.degrees(scan.angle_min + i * scan.angle_increment) for i in range(len(scan.ranges)))
    return min(distance for angle, distance in zip(angles, scan.ranges) if first <= angle <= last)


def main():
    rclpy.init()
    rclpy.spin(AvoidObstacles())


if __name__ == '__main__':
    main()
