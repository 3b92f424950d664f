import cv2
import rclpy
from cv_bridge import CvBridge
from rclpy.executors import ExternalShutdownException
from rclpy.node import Node
from sensor_msgs.msg import Image


def find_red(image):
    """Return a mask of an image in BGR: 255 where it is red, 0 elsewhere."""
    hsv = cv2.cvtColor(image, cv2.COLOR_BGR2HSV)
    low = cv2.inRange(hsv, (0, 120, 50), (8, 255, 255))
    high = cv2.inRange(hsv, (172, 120, 50), (179, 255, 255))
    return low | high


class RedMask(Node):
    def __init__(self):
        super().__init__('red_mask')
        self.bridge = CvBridge()
        self.publisher = self.create_publisher(Image, 'red_mask', 10)
        self.create_subscription(Image, 'camera/image_raw', self.on_image, 10)

    def on_image(self, message):
        image = self.bridge.imgmsg_to_cv2(message, 'bgr8')
        mask = self.bridge.cv2_to_imgmsg(find_red(image), 'mono8')
        mask.header = message.header
        self.publisher.publish(mask)


def main():
    rclpy.init()
    try:
        rclpy.spin(RedMask())
    except (KeyboardInterrupt, ExternalShutdownException):
        pass
    finally:
        rclpy.try_shutdown()
