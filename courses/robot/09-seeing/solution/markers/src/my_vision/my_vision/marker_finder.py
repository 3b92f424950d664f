import math

import cv2
import numpy as np
import rclpy
from cv_bridge import CvBridge
from geometry_msgs.msg import TransformStamped
from rclpy.executors import ExternalShutdownException
from rclpy.node import Node
from sensor_msgs.msg import CameraInfo, Image
from tf2_ros import TransformBroadcaster

SIZE = 0.3
HALF = SIZE / 2
CORNERS = np.array([(-HALF, HALF, 0), (HALF, HALF, 0), (HALF, -HALF, 0), (-HALF, -HALF, 0)])


class MarkerFinder(Node):
    def __init__(self):
        super().__init__('marker_finder')
        self.bridge = CvBridge()
        self.lens = None
        dictionary = cv2.aruco.getPredefinedDictionary(cv2.aruco.DICT_4X4_50)
        self.detector = cv2.aruco.ArucoDetector(dictionary)
        self.broadcaster = TransformBroadcaster(self)
        self.create_subscription(CameraInfo, 'camera/camera_info', self.on_lens, 10)
        self.create_subscription(Image, 'camera/image_raw', self.on_image, 10)

    def on_lens(self, message):
        self.lens = np.array(message.k).reshape(3, 3), np.array(message.d)

    def on_image(self, message):
        if self.lens is None:
            return
        image = self.bridge.imgmsg_to_cv2(message, 'mono8')
        found, numbers, _ = self.detector.detectMarkers(image)
        for corners, number in zip(found, [] if numbers is None else numbers.ravel()):
            _, rotation, position = cv2.solvePnP(
                CORNERS, corners, *self.lens, flags=cv2.SOLVEPNP_IPPE_SQUARE)
            transform = TransformStamped()
            transform.header = message.header
            transform.child_frame_id = f'marker_{number}'
            set_pose(transform.transform, rotation.ravel(), position.ravel())
            self.broadcaster.sendTransform(transform)


def set_pose(transform, rotation, position):
    """Set a transform to a position, and to a rotation around an axis by its length."""
    angle = float(np.linalg.norm(rotation))
    axis = rotation / angle if angle else rotation
    p, q = transform.translation, transform.rotation
    p.x, p.y, p.z = map(float, position)
    q.x, q.y, q.z = (float(value * math.sin(angle / 2)) for value in axis)
    q.w = math.cos(angle / 2)


def main():
    rclpy.init()
    try:
        rclpy.spin(MarkerFinder())
    except (KeyboardInterrupt, ExternalShutdownException):
        pass
    finally:
        rclpy.try_shutdown()
