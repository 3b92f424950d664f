"""Turn to the red pixels, and keep the distance that the laser measures in their direction."""

import math

import numpy as np
import rclpy
from geometry_msgs.msg import Twist
from rclpy.node import Node
from sensor_msgs.msg import Image, LaserScan

FIELD_OF_VIEW = 1.3963  # rad


class FollowPerson(Node):
    def __init__(self):
        super().__init__('follow_person')
        self.velocity = self.create_publisher(Twist, 'cmd_vel', 10)
        self.create_subscription(LaserScan, 'scan', self.on_scan, 10)
        self.create_subscription(Image, 'camera/image_raw', self.on_image, 10)
        self.ranges = None
        self.angle = 0.0

    def on_scan(self, scan):
        self.ranges = np.array(scan.ranges)

    def on_image(self, image):
        pixels = np.frombuffer(image.data, np.uint8).reshape(image.height, image.width, 3)[::4, ::2].astype(int)
        red = (pixels[..., 0] > 60) & (pixels[..., 0] > 2 * pixels[..., 1]) & (pixels[..., 0] > 2 * pixels[..., 2])
        twist = Twist()
        columns = np.nonzero(red.any(axis=0))[0]
        if len(columns) and self.ranges is not None:
            offset = 1.0 - 2.0 * columns.mean() / pixels.shape[1]
            self.angle = math.atan(offset * math.tan(FIELD_OF_VIEW / 2))
            middle = 180 + round(math.degrees(self.angle))
            distance = self.ranges[middle - 6:middle + 7].min()
            twist.linear.x = float(np.clip(1.5 * (distance - 1.05), -0.3, 0.6)) * max(0.0, math.cos(1.5 * self.angle))
            twist.angular.z = 2.5 * self.angle
        else:
            twist.angular.z = math.copysign(1.0, self.angle)
        self.velocity.publish(twist)


def main():
    rclpy.init()
    rclpy.spin(FollowPerson())


if __name__ == '__main__':
    main()
