"""Steer by where the dark pixels are, and brake for curves."""

import numpy as np
import rclpy
from geometry_msgs.msg import Twist
from rclpy.node import Node
from sensor_msgs.msg import Image


class FollowLine(Node):
    def __init__(self):
        super().__init__('follow_line')
        self.velocity = self.create_publisher(Twist, 'cmd_vel', 10)
        self.create_subscription(Image, 'camera/image_raw', self.on_image, 10)
        self.offset = 0.0

    def on_image(self, image):
        rows = np.frombuffer(image.data, np.uint8).reshape(image.height, image.width, 3)
        near = rows[int(image.height * 0.75):].mean(axis=2) < 90
        columns = near.sum(axis=0)
        twist = Twist()
        if columns.any():
            middle = np.average(np.arange(image.width), weights=columns)
            offset = 2.0 * middle / image.width - 1.0
            twist.linear.x = 0.48 * max(0.35, 1.0 - 0.8 * abs(offset))
            twist.angular.z = -2.2 * offset - 4.0 * (offset - self.offset)
            self.offset = offset
        else:
            twist.angular.z = -1.0 if self.offset > 0.0 else 1.0
        self.velocity.publish(twist)


def main():
    rclpy.init()
    rclpy.spin(FollowLine())


if __name__ == '__main__':
    main()
