import cv2
import numpy as np
import rclpy
from cv_bridge import CvBridge
from geometry_msgs.msg import PointStamped
from my_vision.red_mask import find_red
from rclpy.executors import ExternalShutdownException
from rclpy.node import Node
from sensor_msgs.msg import CameraInfo, Image

DIAMETER = 0.3
LEAST_AREA = 30


class BallFinder(Node):
    def __init__(self):
        super().__init__('ball_finder')
        self.bridge = CvBridge()
        self.lens = None
        self.publisher = self.create_publisher(PointStamped, 'ball', 10)
        self.create_subscription(CameraInfo, 'camera/camera_info', self.on_lens, 10)
        self.create_subscription(Image, 'camera/image_raw', self.on_image, 10)

    def on_lens(self, message):
        self.lens = message

    def on_image(self, message):
        if self.lens is None:
            return
        mask = find_red(self.bridge.imgmsg_to_cv2(message, 'bgr8'))
        if np.count_nonzero(mask) < LEAST_AREA:
            return
        left, top, width, height = cv2.boundingRect(mask)
        column, row = left + width / 2, top + height / 2
        focal_length, middle_column, middle_row = self.lens.k[0], self.lens.k[2], self.lens.k[5]
        ball = PointStamped()
        ball.header.stamp = message.header.stamp
        ball.header.frame_id = 'camera_link'
        ball.point.x = focal_length * DIAMETER / width
        ball.point.y = ball.point.x * (middle_column - column) / focal_length
        ball.point.z = ball.point.x * (middle_row - row) / focal_length
        self.publisher.publish(ball)


def main():
    rclpy.init()
    try:
        rclpy.spin(BallFinder())
    except (KeyboardInterrupt, ExternalShutdownException):
        pass
    finally:
        rclpy.try_shutdown()
