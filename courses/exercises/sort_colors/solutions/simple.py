"""See the blocks once, and carry one after the other, with long pauses."""

import math

import numpy as np
import rclpy
from rclpy.node import Node
from sensor_msgs.msg import Image, JointState
from std_msgs.msg import Bool, Float64

UPPER_ARM, FOREARM = 0.35, 0.30  # m
PIXEL = 2 * 1.175 * math.tan(0.45) / 320  # m, at half the height of a block
TILES = {'red': (0.15, 0.45), 'green': (-0.3, 0.4), 'blue': (0.15, -0.45)}
PAUSE = 6.5  # s


class SortColors(Node):
    def __init__(self):
        super().__init__('sort_colors')
        self.shoulder = self.create_publisher(Float64, 'arm/shoulder', 10)
        self.elbow = self.create_publisher(Float64, 'arm/elbow', 10)
        self.grip = self.create_publisher(Bool, 'grip', 10)
        self.create_subscription(JointState, 'joint_states', self.on_joints, 10)
        self.create_subscription(Image, 'camera/image_raw', self.on_image, 10)
        self.joints = self.pixels = None

    def on_joints(self, joints):
        positions = dict(zip(joints.name, joints.position))
        self.joints = positions['shoulder'], positions['elbow']

    def on_image(self, image):
        self.pixels = np.frombuffer(image.data, np.uint8).reshape(image.height, image.width, 3).astype(int)

    def wait(self, seconds):
        end = self.get_clock().now().nanoseconds + seconds * 1e9
        while self.get_clock().now().nanoseconds < end:
            rclpy.spin_once(self, timeout_sec=0.02)

    def blocks(self):
        """Return the places of the blocks with their colors."""
        places = []
        for channel, color in enumerate(TILES):
            own = self.pixels[..., channel]
            others = np.max(np.delete(self.pixels, channel, axis=2), axis=2)
            rows, columns = np.nonzero((own > 60) & (own > 2.0 * others))
            points = np.column_stack([0.35 + (119.5 - rows) * PIXEL, (159.5 - columns) * PIXEL])
            while len(points) > 20:
                # What lies within a block's size of the first pixel belongs to it.
                middle = points[0]
                for _ in range(5):
                    middle = points[np.abs(points - middle).max(axis=1) < 0.035].mean(axis=0)
                places.append((tuple(middle), color))
                points = points[np.abs(points - middle).max(axis=1) > 0.035]
        return places

    def reach(self, x, y):
        """Move the gripper to a place."""
        cos = (x * x + y * y - UPPER_ARM**2 - FOREARM**2) / (2 * UPPER_ARM * FOREARM)
        elbow = math.acos(max(-1.0, min(1.0, cos)))
        shoulder = math.atan2(y, x) - math.atan2(FOREARM * math.sin(elbow), UPPER_ARM + FOREARM * math.cos(elbow))
        target = math.remainder(shoulder, math.tau), elbow
        while max(abs(now - then) for now, then in zip(self.joints, target)) > 0.015:
            self.shoulder.publish(Float64(data=target[0]))
            self.elbow.publish(Float64(data=target[1]))
            self.wait(0.05)
        self.wait(PAUSE)

    def run(self):
        while self.joints is None or self.pixels is None:
            rclpy.spin_once(self)
        self.wait(0.5)
        for place, color in self.blocks():
            self.reach(*place)
            self.grip.publish(Bool(data=True))
            self.wait(0.1)
            self.reach(*TILES[color])
            self.grip.publish(Bool(data=False))
            self.wait(0.1)


def main():
    rclpy.init()
    SortColors().run()


if __name__ == '__main__':
    main()
