# SPDX-License-Identifier: Apache-2.0
"""Drive a square by odometry: to each corner in turn, and back to where it began.

Odometry counts the turns of the wheels. It tells where the robot is since it started, and errs a little with each turn.
"""

import math

from nav_msgs.msg import Odometry

from my_robot_control.driving_node import DrivingNode, heading, limited, run, wrapped

FACING = 0.05  # rad: so well the robot looks at a corner before it drives there


class DriveSquare(DrivingNode):
    """Parameters: side (m), speed (m/s), turn_speed (rad/s), tolerance (m from a corner)."""

    # Gently: wheels that are jerked slip, and odometry does not see that.
    acceleration = 0.3
    turn_acceleration = 0.6

    def __init__(self):
        super().__init__('drive_square')
        self.side = self.declare_parameter('side', 1.0).value
        self.speed = self.declare_parameter('speed', 0.3).value
        self.turn_speed = self.declare_parameter('turn_speed', 0.6).value
        self.tolerance = self.declare_parameter('tolerance', 0.03).value
        self.corners = None
        self.turning = True
        self.create_subscription(Odometry, 'odom', self.on_odometry, 10)

    def on_odometry(self, odometry):
        """Go on towards the next corner."""
        position = odometry.pose.pose.position
        yaw = heading(odometry.pose.pose.orientation)
        if self.corners is None:
            self.corners = square(position.x, position.y, yaw, self.side)
        if not self.corners:
            return

        x, y = self.corners[0]
        distance = math.hypot(x - position.x, y - position.y)
        bearing = wrapped(math.atan2(y - position.y, x - position.x) - yaw)
        if distance < self.tolerance:
            self.arrive()
        elif self.turning and abs(bearing) > FACING:
            self.drive(0.0, limited(bearing, self.turn_speed))
        else:
            self.turning = False
            # Slower as it comes closer, and steered a little all the way.
            self.drive(min(self.speed, 0.05 + distance), limited(bearing, self.turn_speed))

    def arrive(self):
        """A corner is reached: take the next one, or stop at the last."""
        self.corners.pop(0)
        self.turning = True
        if self.corners:
            self.get_logger().info(f'corner reached, {len(self.corners)} to go')
        else:
            self.get_logger().info('the square is closed')
            self.stop()


def square(x, y, yaw, side):
    """Return the corners of a square that begins here and turns left, in the order in which they are reached."""
    corners = []
    for turns in range(4):
        x += side * math.cos(yaw + turns * math.pi / 2)
        y += side * math.sin(yaw + turns * math.pi / 2)
        corners.append((x, y))
    return corners


def main():
    """Run the node."""
    run(DriveSquare)


if __name__ == '__main__':
    main()
