"""Draw a map of the house on /map: /scan tells distances, /odom the pose."""

import rclpy
from geometry_msgs.msg import Twist
from nav_msgs.msg import OccupancyGrid
from rclpy.node import Node
from sensor_msgs.msg import LaserScan


class MapHouse(Node):
    def __init__(self):
        super().__init__("map_house")
        self.velocity = self.create_publisher(Twist, "cmd_vel", 10)
        self.map = self.create_publisher(OccupancyGrid, "map", 10)
        self.create_subscription(LaserScan, "scan", self.on_scan, 10)

    def on_scan(self, scan):
        # map.data: 0 for free, 100 for occupied, -1 for unknown, row by row from map.info.origin
        self.velocity.publish(Twist())


def main():
    rclpy.init()
    rclpy.spin(MapHouse())


if __name__ == "__main__":
    main()
