"""Drive two laps between the walls faster than the other robot, and touch nothing.

/scan has distances.
"""

import rclpy
from geometry_msgs.msg import Twist
from rclpy.node import Node
from sensor_msgs.msg import LaserScan


class Race(Node):
    def __init__(self):
        super().__init__("race")
        self.velocity = self.create_publisher(Twist, "cmd_vel", 10)
        self.create_subscription(LaserScan, "scan", self.on_scan, 10)

    def on_scan(self, scan):
        # scan.ranges[i] is the distance at the angle scan.angle_min + i * scan.angle_increment
        self.velocity.publish(Twist())


def main():
    rclpy.init()
    rclpy.spin(Race())


if __name__ == "__main__":
    main()
