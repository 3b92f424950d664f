"""Keep the pole upright.

/joint_states has the cart (slider) and the pole (hinge), cmd_force pushes the cart.
"""

import rclpy
from rclpy.node import Node
from sensor_msgs.msg import JointState
from std_msgs.msg import Float64


class Balance(Node):
    def __init__(self):
        super().__init__("balance")
        self.force = self.create_publisher(Float64, "/model/cart/joint/slider/cmd_force", 10)
        self.create_subscription(JointState, "joint_states", self.on_joints, 10)

    def on_joints(self, joints):
        # joints.position and joints.velocity have the values of joints.name:
        # 'slider' in m, 'hinge' in rad
        self.force.publish(Float64(data=0.0))


def main():
    rclpy.init()
    rclpy.spin(Balance())


if __name__ == "__main__":
    main()
