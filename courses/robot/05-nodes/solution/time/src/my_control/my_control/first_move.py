import rclpy
from geometry_msgs.msg import Twist
from rclpy.executors import ExternalShutdownException
from rclpy.node import Node
from rclpy.signals import SignalHandlerOptions


class FirstMove(Node):
    def __init__(self):
        super().__init__('first_move')
        self.velocity = self.create_publisher(Twist, 'cmd_vel', 10)
        self.declare_parameter('speed', 0.2)
        self.declare_parameter('duration', 4.0)
        self.start = None
        self.create_timer(0.1, self.move)

    def move(self):
        now = self.get_clock().now()
        if self.start is None:
            self.start = now
        if (now - self.start).nanoseconds * 1e-9 > self.get_parameter('duration').value:
            self.stop()
            return
        message = Twist()
        message.linear.x = self.get_parameter('speed').value
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
