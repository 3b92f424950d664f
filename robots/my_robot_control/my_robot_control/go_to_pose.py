# SPDX-License-Identifier: Apache-2.0
"""Go to the pose that is clicked in RViz with "2D Goal Pose", in a straight line.

Nothing is planned and nothing is avoided: this is what a planner's path is followed with, at its simplest.
"""

import math

from geometry_msgs.msg import PoseStamped
from nav_msgs.msg import Odometry

from my_robot_control.driving_node import DrivingNode, heading, limited, run, wrapped

FACING = 0.3  # rad: beyond it the robot turns on the spot


class GoToPose(DrivingNode):
    """Parameters: speed (m/s), turn_speed (rad/s), tolerance (m), angle_tolerance (rad)."""

    def __init__(self):
        super().__init__('go_to_pose')
        self.speed = self.declare_parameter('speed', 0.3).value
        self.turn_speed = self.declare_parameter('turn_speed', 0.8).value
        self.tolerance = self.declare_parameter('tolerance', 0.05).value
        self.angle_tolerance = self.declare_parameter('angle_tolerance', 0.05).value
        self.goal = None
        self.there = False
        self.frame = 'odom'
        self.create_subscription(PoseStamped, 'goal_pose', self.on_goal, 10)
        self.create_subscription(Odometry, 'odom', self.on_odometry, 10)

    def on_goal(self, goal):
        """Take a new goal; one in another frame than that of odometry cannot be followed."""
        if goal.header.frame_id != self.frame:
            self.get_logger().error(
                f"the goal is in the frame '{goal.header.frame_id}'; set the Fixed Frame to '{self.frame}'"
            )
            return
        self.goal = goal.pose
        self.there = False
        self.get_logger().info(f'going to x {self.goal.position.x:.2f}, y {self.goal.position.y:.2f}')

    def on_odometry(self, odometry):
        """Go on towards the goal."""
        self.frame = odometry.header.frame_id
        if self.goal is None:
            return
        position = odometry.pose.pose.position
        yaw = heading(odometry.pose.pose.orientation)
        dx = self.goal.position.x - position.x
        dy = self.goal.position.y - position.y
        distance = math.hypot(dx, dy)
        bearing = wrapped(math.atan2(dy, dx) - yaw)

        # Once there it only turns: who is close is not sent round again by a small error.
        self.there = self.there or distance < self.tolerance
        if self.there:
            self.turn_to(wrapped(heading(self.goal.orientation) - yaw))
        elif abs(bearing) > FACING:
            self.drive(0.0, limited(2.0 * bearing, self.turn_speed))
        else:
            self.drive(min(self.speed, 0.05 + distance), limited(2.0 * bearing, self.turn_speed))

    def turn_to(self, error):
        """Turn on the spot by what is left, and be done."""
        if abs(error) > self.angle_tolerance:
            self.drive(0.0, limited(2.0 * error, self.turn_speed))
            return
        self.stop()
        self.goal = None
        self.get_logger().info('goal reached')


def main():
    """Run the node."""
    run(GoToPose)


if __name__ == '__main__':
    main()
