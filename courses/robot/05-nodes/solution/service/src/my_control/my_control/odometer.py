import math

import rclpy
from nav_msgs.msg import Odometry
from rclpy.node import Node
from std_msgs.msg import Float64
from std_srvs.srv import Trigger


class Odometer(Node):
    def __init__(self):
        super().__init__('odometer')
        self.distance = 0.0
        self.last = None
        self.publisher = self.create_publisher(Float64, 'distance', 10)
        self.create_service(Trigger, 'reset_distance', self.on_reset)
        self.create_subscription(Odometry, 'odom', self.on_odometry, 10)

    def on_odometry(self, message):
        position = message.pose.pose.position
        if self.last is not None:
            self.distance += math.hypot(position.x - self.last.x, position.y - self.last.y)
        self.last = position
        self.publisher.publish(Float64(data=self.distance))

    def on_reset(self, request, response):
        response.success = True
        response.message = f'the distance was {self.distance:.2f} m'
        self.distance = 0.0
        return response


def main():
    rclpy.init()
    rclpy.spin(Odometer())
