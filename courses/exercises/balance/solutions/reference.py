"""A linear controller of angle, position and both velocities."""

import rclpy
from rclpy.node import Node
from sensor_msgs.msg import JointState
from std_msgs.msg import Float64


class Balance(Node):
    def __init__(self):
        super().__init__('balance')
        self.force = self.create_publisher(Float64, '/model/cart/joint/slider/cmd_force', 10)
        self.create_subscription(JointState, 'joint_states', self.on_joints, 10)

    def on_joints(self, joints):
        position = dict(zip(joints.name, joints.position))
        velocity = dict(zip(joints.name, joints.velocity))
        force = 45.0 * position['hinge'] + 9.0 * velocity['hinge'] + 3.0 * position['slider'] + 6.0 * velocity['slider']
        self.force.publish(Float64(data=force))


def main():
    rclpy.init()
    rclpy.spin(Balance())


if __name__ == '__main__':
    main()
