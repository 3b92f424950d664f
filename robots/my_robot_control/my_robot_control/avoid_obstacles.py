# SPDX-License-Identifier: Apache-2.0
"""Drive on, stop before obstacles, and turn to where there is more room.

With the parameter wander set to false it only stops, which is what a robot does that somebody else steers.
"""

import math

from sensor_msgs.msg import LaserScan

from my_robot_control.driving_node import DrivingNode, run
from my_robot_control.follow_wall import nearest

AHEAD = math.radians(40.0)
BESIDE = math.radians(100.0)


class AvoidObstacles(DrivingNode):
    """Parameters: speed (m/s), turn_speed (rad/s), stop_distance (m), clear_distance (m), wander."""

    def __init__(self):
        super().__init__('avoid_obstacles')
        self.speed = self.declare_parameter('speed', 0.3).value
        self.turn_speed = self.declare_parameter('turn_speed', 0.8).value
        self.stop_distance = self.declare_parameter('stop_distance', 0.5).value
        self.clear_distance = self.declare_parameter('clear_distance', 0.8).value
        self.wander = self.declare_parameter('wander', True).value
        self.turning = 0.0
        self.create_subscription(LaserScan, 'scan', self.on_scan, 10)

    def on_scan(self, scan):
        """Drive, or turn away."""
        front = nearest(scan, -AHEAD, AHEAD)
        if self.turning == 0.0 and front < self.stop_distance:
            left, right = nearest(scan, AHEAD, BESIDE), nearest(scan, -BESIDE, -AHEAD)
            self.turning = 1.0 if left > right else -1.0
            self.get_logger().info(f'something is {front:.2f} m ahead')
        elif front > self.clear_distance:
            self.turning = 0.0

        if self.turning == 0.0:
            # Slower before it has to stop, so that it does not shoot past.
            self.drive(self.speed * min(1.0, front / self.clear_distance), 0.0)
        elif self.wander:
            self.drive(0.0, self.turning * self.turn_speed)
        else:
            self.stop()


def main():
    """Run the node."""
    run(AvoidObstacles)


if __name__ == '__main__':
    main()
