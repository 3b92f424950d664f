"""Drive to the other end of the hall (x = 11 m) without touching anything.

/scan has distances, /odom the pose.
"""

import rclpy
from geometry_msgs.msg import Twist
from rclpy.node import Node
from sensor_msgs.msg import LaserScan


class AvoidObstacles(Node):
    def __init__(self):
        super().__init__("avoid_obstacles")
        self.velocity = self.create_publisher(Twist, "cmd_vel", 10)
        self.create_subscription(LaserScan, "scan", self.on_scan, 10)

    def on_scan(self, scan):
        # scan.ranges[i] is the distance at the angle scan.angle_min + i * scan.angle_increment
        self.velocity.publish(Twist())


def main():
    rclpy.init()
    rclpy.spin(AvoidObstacles())


if __name__ == "__main__":
    main()
