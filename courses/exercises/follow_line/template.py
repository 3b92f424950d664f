"""Follow the line: the camera shows it, /cmd_vel drives."""

import rclpy
from geometry_msgs.msg import Twist
from rclpy.node import Node
from sensor_msgs.msg import Image


class FollowLine(Node):
    def __init__(self):
        super().__init__("follow_line")
        self.velocity = self.create_publisher(Twist, "cmd_vel", 10)
        self.create_subscription(Image, "camera/image_raw", self.on_image, 10)

    def on_image(self, image):
        # image.data: image.height rows of image.width pixels, 3 bytes each (image.encoding)
        self.velocity.publish(Twist())


def main():
    rclpy.init()
    rclpy.spin(FollowLine())


if __name__ == "__main__":
    main()
