import math

import rclpy
from nav_msgs.msg import Odometry
from rclpy.node import Node
from std_msgs.msg import Float64


class Odometer(Node):
    def __init__(self):
        super().__init__('odometer')
        self.distance = 0.0
        self.last = None
        self.publisher = self.create_publisher(Float64, 'distance', 10)
        self.create_subscription(Odometry, 'odom', self.on_odometry, 10)

    def on_odometry(self, message):
        position = message.pose.pose.position
        if self.last is not None:
            self.distance += math.hypot(position.x - self.last.x, position.y - self.last.y)
        self.last = position
        self.publisher.publish(Float64(data=self.distance))


def main():
    rclpy.init()
    rclpy.spin(Odometer())
