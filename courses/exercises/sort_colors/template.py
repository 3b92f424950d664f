"""Bring each block to the tile of its color.

The camera looks down, the joints turn the arm, /grip lifts.
"""

import rclpy
from rclpy.node import Node
from sensor_msgs.msg import Image, JointState
from std_msgs.msg import Bool, Float64


class SortColors(Node):
    def __init__(self):
        super().__init__("sort_colors")
        self.shoulder = self.create_publisher(Float64, "arm/shoulder", 10)
        self.elbow = self.create_publisher(Float64, "arm/elbow", 10)
        self.grip = self.create_publisher(Bool, "grip", 10)
        self.create_subscription(JointState, "joint_states", self.on_joints, 10)
        self.create_subscription(Image, "camera/image_raw", self.on_image, 10)

    def on_joints(self, joints):
        self.joints = dict(zip(joints.name, joints.position, strict=True))

    def on_image(self, image):
        pass  # pixel (160, 120) is x = 0.35 m, y = 0; a pixel is 3.5 mm; up is x, left is y


def main():
    rclpy.init()
    rclpy.spin(SortColors())


if __name__ == "__main__":
    main()
