import rclpy
from geometry_msgs.msg import Twist
from rclpy.node import Node


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


def main():
    rclpy.init()
    rclpy.spin(FirstMove())
