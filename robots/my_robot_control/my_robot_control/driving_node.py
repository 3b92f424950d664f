# SPDX-License-Identifier: Apache-2.0
"""What all nodes of this package have in common: they drive, and they stop when their sensor falls silent."""

import math

import rclpy
from geometry_msgs.msg import Twist
from rclpy.node import Node
from rclpy.signals import SignalHandlerOptions

SILENCE = 0.5  # s
LONGEST_STEP = 0.1  # s


class DrivingNode(Node):
    """A node that publishes velocities on cmd_vel, and a stop when `drive` was not called for SILENCE seconds."""

    acceleration = 1.0  # m/s2: by how much `drive` may change the speed in a second
    turn_acceleration = 4.0  # rad/s2

    def __init__(self, name):
        super().__init__(name)
        self.velocity = self.create_publisher(Twist, 'cmd_vel', 10)
        self.linear = 0.0
        self.angular = 0.0
        self.driven_at = self.get_clock().now()
        self.watchdog = self.create_timer(SILENCE, self.stop)

    def drive(self, linear, angular):
        """Move at `linear` m/s forward while turning at `angular` rad/s to the left, or come closer to that."""
        now = self.get_clock().now()
        seconds = min((now - self.driven_at).nanoseconds / 1e9, LONGEST_STEP)
        self.driven_at = now
        self.publish(
            self.linear + limited(linear - self.linear, self.acceleration * seconds),
            self.angular + limited(angular - self.angular, self.turn_acceleration * seconds),
        )
        self.watchdog.reset()

    def stop(self):
        """Stand still at once."""
        if self.linear != 0.0 or self.angular != 0.0:
            self.publish(0.0, 0.0)

    def publish(self, linear, angular):
        """Publish a velocity, in m/s and rad/s."""
        self.linear, self.angular = float(linear), float(angular)
        message = Twist()
        message.linear.x = self.linear
        message.angular.z = self.angular
        self.velocity.publish(message)


def run(node_class):
    """Run a node until Ctrl-C, and leave the robot standing."""
    # Ctrl-C is ours, so that the last velocity can still be published.
    rclpy.init(signal_handler_options=SignalHandlerOptions.NO)
    node = node_class()
    try:
        rclpy.spin(node)
    except KeyboardInterrupt:
        pass
    finally:
        node.stop()
        node.destroy_node()
        rclpy.shutdown()


def limited(value, most):
    """Return the value, between -most and most."""
    return max(-most, min(most, value))


def wrapped(angle):
    """Return the same angle in radians, between -pi and pi."""
    return math.atan2(math.sin(angle), math.cos(angle))


def heading(orientation):
    """Return where a quaternion looks in the plane, in radians to the left of x."""
    x, y, z, w = orientation.x, orientation.y, orientation.z, orientation.w
    return math.atan2(2.0 * (w * z + x * y), 1.0 - 2.0 * (y * y + z * z))
