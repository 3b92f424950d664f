# SPDX-License-Identifier: Apache-2.0
"""Follow a wall on the right, or on the left, by laser: out of a maze, too.

Two rays give the wall: one straight to the side, one 45 degrees further forward. From both follow the angle between the
robot and the wall, and how far the wall will be a little further on; that is held at the distance that is wanted.
"""

import math

from sensor_msgs.msg import LaserScan

from my_robot_control.driving_node import DrivingNode, limited, run

BETWEEN = math.radians(45.0)
AHEAD = math.radians(25.0)  # to both sides: what counts as in front


class FollowWall(DrivingNode):
    """Parameters: side ('right' or 'left'), distance (m), speed (m/s), gain, look_ahead (m)."""

    def __init__(self):
        super().__init__('follow_wall')
        self.sign = {'right': -1.0, 'left': 1.0}[self.declare_parameter('side', 'right').value]
        self.distance = self.declare_parameter('distance', 0.5).value
        self.speed = self.declare_parameter('speed', 0.25).value
        self.gain = self.declare_parameter('gain', 2.5).value
        self.look_ahead = self.declare_parameter('look_ahead', 0.3).value
        self.create_subscription(LaserScan, 'scan', self.on_scan, 10)

    def on_scan(self, scan):
        """Steer by the wall."""
        beside = ray(scan, self.sign * math.pi / 2)
        before = ray(scan, self.sign * (math.pi / 2 - BETWEEN))
        front = nearest(scan, -AHEAD, AHEAD)

        if front < self.distance:
            # A corner: turn away from the wall until there is room.
            self.drive(0.0, -self.sign * 1.0)
        elif min(beside, before) > 2.5 * self.distance:
            # The wall ends, or there is none yet: an arc towards it finds the other side of it.
            self.drive(self.speed, self.sign * self.speed / self.distance)
        else:
            error = wall_distance(beside, before, self.look_ahead) - self.distance
            turn = self.sign * limited(self.gain * error, 1.0)
            self.drive(self.speed * (1.0 - 0.6 * abs(turn)), turn)


def wall_distance(beside, before, look_ahead):
    """Return how far the wall will be after `look_ahead` meters straight on, from two rays BETWEEN apart."""
    angle = math.atan2(before * math.cos(BETWEEN) - beside, before * math.sin(BETWEEN))
    return beside * math.cos(angle) + look_ahead * math.sin(angle)


def ray(scan, angle):
    """Return the distance in a direction, radians to the left of forward; the far end of the scanner for nothing."""
    index = round((angle - scan.angle_min) / scan.angle_increment) % len(scan.ranges)
    return min(scan.ranges[index], scan.range_max)


def nearest(scan, start, end):
    """Return the least distance between two directions."""
    steps = round((end - start) / scan.angle_increment)
    return min(ray(scan, start + step * scan.angle_increment) for step in range(steps + 1))


def main():
    """Run the node."""
    run(FollowWall)


if __name__ == '__main__':
    main()
