"""Turn left or right, at one slow speed, until the line is in the middle."""

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

    def on_image(self, image):
        rows = np.frombuffer(image.data, np.uint8).reshape(image.height, image.width, 3)
        dark = np.nonzero(rows[int(image.height * 0.85)].mean(axis=1) < 90)[0]
        twist = Twist()
        twist.linear.x = 0.19
        if len(dark):
            twist.angular.z = 0.5 if dark.mean() < image.width / 2 else -0.5
        self.velocity.publish(twist)


def main():
    rclpy.init()
    rclpy.spin(FollowLine())


if __name__ == '__main__':
    main()
