"""Turn slowly to the red, and drive on while it looks narrow."""

import numpy as np
import rclpy
from geometry_msgs.msg import Twist
from rclpy.node import Node
from sensor_msgs.msg import Image


class FollowPerson(Node):
    def __init__(self):
        super().__init__('follow_person')
        self.velocity = self.create_publisher(Twist, 'cmd_vel', 10)
        self.create_subscription(Image, 'camera/image_raw', self.on_image, 10)

    def on_image(self, image):
        pixels = np.frombuffer(image.data, np.uint8).reshape(image.height, image.width, 3)[::8].astype(int)
        red = np.nonzero(((pixels[..., 0] > 60) & (pixels[..., 0] > 2 * pixels[..., 1])).any(axis=0))[0]
        twist = Twist()
        if len(red) == 0:
            twist.angular.z = 0.5
        else:
            twist.angular.z = 0.9 * (1.0 - 2.0 * red.mean() / image.width)
            if len(red) < 120:
                twist.linear.x = 0.3
        self.velocity.publish(twist)


def main():
    rclpy.init()
    rclpy.spin(FollowPerson())


if __name__ == '__main__':
    main()
