import numpy as np
import rclpy
from geometry_msgs.msg import PointStamped
from rclpy.executors import ExternalShutdownException
from rclpy.node import Node
from rclpy.qos import qos_profile_sensor_data
from sensor_msgs.msg import CameraInfo, Image
from std_msgs.msg import String

COLORS = ('red', 'green', 'blue')
CHANNELS = {'rgb8': (0, 1, 2), 'bgr8': (2, 1, 0)}


class ColorFinder(Node):
    """Publish where the ball of the target's color is, in m: x forward, y left of camera_link."""

    def __init__(self):
        super().__init__('color_finder')
        self.declare_parameter('ball_diameter', 0.3)
        self.target = ''
        self.lens = None
        self.ball = self.create_publisher(PointStamped, 'ball', 10)
        self.create_subscription(String, 'target', self.on_target, 10)
        self.create_subscription(CameraInfo, 'camera/camera_info', self.on_lens,
                                 qos_profile_sensor_data)
        self.create_subscription(Image, 'camera/image_raw', self.on_image,
                                 qos_profile_sensor_data)

    def on_target(self, message):
        self.target = message.data

    def on_lens(self, message):
        self.lens = message

    def on_image(self, message):
        if self.lens is None or self.target not in COLORS:
            return
        if message.encoding not in CHANNELS:
            self.get_logger().error(f'no colors in {message.encoding}', throttle_duration_sec=5.0)
            return
        pixels = np.frombuffer(message.data, np.uint8).reshape(message.height, message.width, 3)
        found = find_color(pixels, CHANNELS[message.encoding][COLORS.index(self.target)])
        if found is None:
            return
        column, size = found
        focal_length, middle = self.lens.k[0], self.lens.k[2]
        ball = PointStamped()
        ball.header.stamp = message.header.stamp
        ball.header.frame_id = 'camera_link'
        ball.point.x = focal_length * self.get_parameter('ball_diameter').value / size
        ball.point.y = ball.point.x * (middle - column) / focal_length
        self.ball.publish(ball)


def find_color(pixels, channel):
    """Return the middle column and the size in pixels of the color of a channel, or None."""
    others = np.delete(pixels, channel, axis=2).max(axis=2)
    mask = (pixels[:, :, channel] > 50) & (pixels[:, :, channel] > 2.0 * others)
    if mask.sum() < 20:
        return None
    columns, rows = np.flatnonzero(mask.any(axis=0)), np.flatnonzero(mask.any(axis=1))
    size = max(columns[-1] - columns[0], rows[-1] - rows[0]) + 1
    return (columns[0] + columns[-1]) / 2, float(size)


def main():
    rclpy.init()
    try:
        rclpy.spin(ColorFinder())
    except (KeyboardInterrupt, ExternalShutdownException):
        pass
    finally:
        rclpy.try_shutdown()
