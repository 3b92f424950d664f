"""Turn on the spot, and let the rays of each scan vote for walls and free floor."""

import math

import numpy as np
import rclpy
from geometry_msgs.msg import Twist
from nav_msgs.msg import OccupancyGrid, Odometry
from rclpy.node import Node
from sensor_msgs.msg import LaserScan

SIZE, CELL = 400, 0.05  # cells, m


class MapHouse(Node):
    def __init__(self):
        super().__init__('map_house')
        self.velocity = self.create_publisher(Twist, 'cmd_vel', 10)
        self.map = self.create_publisher(OccupancyGrid, 'map', 10)
        self.create_subscription(LaserScan, 'scan', self.on_scan, 10)
        self.create_subscription(Odometry, 'odom', self.on_odometry, 10)
        self.create_timer(2.0, self.publish_map)
        self.pose = None
        self.votes = np.zeros((SIZE, SIZE))

    def on_odometry(self, odometry):
        position, orientation = odometry.pose.pose.position, odometry.pose.pose.orientation
        self.pose = position.x, position.y, 2.0 * math.atan2(orientation.z, orientation.w)

    def on_scan(self, scan):
        if self.pose is None:
            return
        ranges = np.array(scan.ranges)
        twist = Twist()
        twist.angular.z = 0.3
        self.velocity.publish(twist)
        x, y, yaw = self.pose
        angles = yaw + scan.angle_min + scan.angle_increment * np.arange(len(ranges))
        hit = np.isfinite(ranges) & (ranges < scan.range_max - 0.1)
        ends = np.where(hit, ranges, scan.range_max)
        along = np.arange(0.1, 6.0, CELL)[:, np.newaxis]
        self.vote(x + along * np.cos(angles), y + along * np.sin(angles), along < ends - 0.1, -0.3)
        self.vote(x + ends * np.cos(angles), y + ends * np.sin(angles), hit, 1.0)

    def vote(self, x, y, counts, vote):
        """Let rays vote for cells: a positive vote for a wall, a negative one for free floor."""
        columns = (x[counts] / CELL + SIZE / 2).astype(int)
        rows = (y[counts] / CELL + SIZE / 2).astype(int)
        touched = np.zeros(self.votes.shape, bool)
        touched[rows, columns] = True
        self.votes[touched] = np.clip(self.votes[touched] + vote, -4.0, 6.0)

    def publish_map(self):
        grid = OccupancyGrid()
        grid.header.frame_id = 'map'
        grid.info.resolution = CELL
        grid.info.width = grid.info.height = SIZE
        grid.info.origin.position.x = grid.info.origin.position.y = -SIZE * CELL / 2
        cells = np.full((SIZE, SIZE), -1)
        cells[self.votes < -0.5] = 0
        cells[self.votes > 0.9] = 100
        grid.data = [int(cell) for cell in cells.ravel()]
        self.map.publish(grid)


def main():
    rclpy.init()
    rclpy.spin(MapHouse())


if __name__ == '__main__':
    main()
