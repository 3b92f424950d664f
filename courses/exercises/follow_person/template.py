"""Stay a meter behind the person in red: the camera sees the coat, /scan tells distances."""

import rclpy
from geometry_msgs.msg import Twist
from rclpy.node import Node
from sensor_msgs.msg import Image, LaserScan


class FollowPerson(Node):
    def __init__(self):
        super().__init__("follow_person")
        self.velocity = self.create_publisher(Twist, "cmd_vel", 10)
        self.create_subscription(LaserScan, "scan", self.on_scan, 10)
        self.create_subscription(Image, "camera/image_raw", self.on_image, 10)

    def on_scan(self, scan):
        self.scan = scan  # scan.ranges[180] is the distance straight ahead

    def on_image(self, image):
        # image.data: image.height rows of image.width pixels, 3 bytes each: red, green, blue
        self.velocity.publish(Twist())


def main():
    rclpy.init()
    rclpy.spin(FollowPerson())


if __name__ == "__main__":
    main()
