import math

import rclpy
from geometry_msgs.msg import Twist
from nav_msgs.msg import Odometry
from rclpy.executors import ExternalShutdownException
from rclpy.node import Node
from rclpy.signals import SignalHandlerOptions

CORNERS = [(1.0, 0.0), (1.0, 1.0), (0.0, 1.0), (0.0, 0.0)]


def yaw_of(orientation):
    return 2 * math.atan2(orientation.z, orientation.w)


class DriveSquare(Node):
    def __init__(self):
        super().__init__('drive_square')
        self.next_corner = 0
        self.velocity = self.create_publisher(Twist, 'cmd_vel', 10)
        self.create_subscription(Odometry, 'odom', self.on_odometry, 10)

    def on_odometry(self, message):
        if self.next_corner == len(CORNERS):
            self.drive(0.0)
            return
        position = message.pose.pose.position
        yaw = yaw_of(message.pose.pose.orientation)
        x, y = CORNERS[self.next_corner]
        distance = math.hypot(x - position.x, y - position.y)
        error = math.remainder(math.atan2(y - position.y, x - position.x) - yaw, math.tau)
        if distance < 0.05:
            self.next_corner += 1
        elif abs(error) > 0.2:
            self.drive(0.0, math.copysign(0.6, error))
        else:
            self.drive(min(0.3, distance), 1.5 * error)

    def drive(self, speed, turn=0.0):
        message = Twist()
        message.linear.x = speed
        message.angular.z = turn
        self.velocity.publish(message)


def main():
    rclpy.init(signal_handler_options=SignalHandlerOptions.NO)
    node = DriveSquare()
    try:
        while rclpy.ok():
            rclpy.spin_once(node, timeout_sec=0.1)
    except (KeyboardInterrupt, ExternalShutdownException):
        pass
    finally:
        node.drive(0.0)
        rclpy.try_shutdown()
