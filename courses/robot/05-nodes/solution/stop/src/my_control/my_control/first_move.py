import rclpy
from geometry_msgs.msg import Twist
from rclpy.executors import ExternalShutdownException
from rclpy.node import Node
from rclpy.signals import SignalHandlerOptions


class FirstMove(Node):
    def __init__(self):
        super().__init__('first_move')
        self.velocity = self.create_publisher(Twist, 'cmd_vel', 10)
        self.create_timer(0.1, self.move)

    def move(self):
        message = Twist()
        message.linear.x = 0.2
        message.angular.z = 0.5
        self.velocity.publish(message)

    def stop(self):
        self.velocity.publish(Twist())


def main():
    rclpy.init(signal_handler_options=SignalHandlerOptions.NO)
    node = FirstMove()
    try:
        rclpy.spin(node)
    except (KeyboardInterrupt, ExternalShutdownException):
        pass
    finally:
        node.stop()
        rclpy.try_shutdown()
