"""Follow the wall on the right; fit each scan to the map, and let its rays vote for walls and free floor."""

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
        self.correction = 0.0, 0.0, 0.0  # from odometry to the map
        self.scans = 0
        self.follows = False

    def on_odometry(self, odometry):
        position, orientation = odometry.pose.pose.position, odometry.pose.pose.orientation
        self.pose = position.x, position.y, 2.0 * math.atan2(orientation.z, orientation.w)

    def on_scan(self, scan):
        if self.pose is None:
            return
        ranges = np.array(scan.ranges)
        ahead = ranges[165:195].min()
        right = ranges[60:135].min()
        twist = Twist()
        self.follows = self.follows or min(ahead, right) < 0.5
        if ahead < 0.5:
            twist.angular.z = 0.8
        elif not self.follows:
            twist.linear.x = 0.3  # to the first wall
        else:
            twist.linear.x = 0.24
            twist.angular.z = float(np.clip(2.5 * (0.45 - right), -0.55, 0.7))
        self.velocity.publish(twist)
        directions = scan.angle_min + scan.angle_increment * np.arange(len(ranges))
        hit = np.isfinite(ranges) & (ranges < scan.range_max - 0.1)
        self.scans += 1
        if self.scans > 10:
            self.fit(ranges[hit], directions[hit])
        x, y, yaw = self.corrected(self.correction)
        angles = yaw + directions
        ends = np.where(hit, ranges, scan.range_max)
        along = np.arange(0.1, 6.0, CELL)[:, np.newaxis]
        self.vote(x + along * np.cos(angles), y + along * np.sin(angles), along < ends - 0.1, -0.3)
        self.vote(x + ends * np.cos(angles), y + ends * np.sin(angles), hit, 1.0)

    def corrected(self, correction):
        """Return the pose in the map."""
        x, y, yaw = self.pose
        dx, dy, turn = correction
        cos, sin = math.cos(turn), math.sin(turn)
        return dx + cos * x - sin * y, dy + sin * x + cos * y, yaw + turn

    def fit(self, ranges, directions):
        """Move the scan a little so that it hits walls of the map, and remember by how much."""
        best, best_score = self.correction, -1.0
        walls = np.maximum(self.votes, 0.0)
        x0, y0, old = self.corrected(self.correction)
        for turn in (0.0, -0.01, 0.01, -0.003, 0.003):
            yaw = old + turn  # about the robot, not about the origin
            forward, left = ranges * np.cos(yaw + directions), ranges * np.sin(yaw + directions)
            for dx in (0.0, -0.03, 0.03, -0.01, 0.01):
                for dy in (0.0, -0.03, 0.03, -0.01, 0.01):
                    x, y = x0 + dx, y0 + dy
                    columns = ((x + forward) / CELL + SIZE / 2).astype(int)
                    rows = ((y + left) / CELL + SIZE / 2).astype(int)
                    score = walls[rows, columns].sum()
                    if score > best_score * 1.002:
                        best, best_score = (x, y, yaw), score
        x, y, yaw = best
        turn = yaw - self.pose[2]
        cos, sin = math.cos(turn), math.sin(turn)
        self.correction = x - cos * self.pose[0] + sin * self.pose[1], y - sin * self.pose[0] - cos * self.pose[1], turn

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
