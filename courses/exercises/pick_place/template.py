"""Pick the block of the color that is ordered, and place it where the order says.

/order has orders, the camera shows the blocks, move_group moves the arm.
"""

import rclpy
from control_msgs.action import GripperCommand
from moveit_msgs.action import MoveGroup
from rclpy.action import ActionClient
from rclpy.node import Node
from std_msgs.msg import String


class PickPlace(Node):
    def __init__(self):
        super().__init__("pick_place")
        self.motions = ActionClient(self, MoveGroup, "move_action")
        self.gripper = ActionClient(self, GripperCommand, "gripper_controller/gripper_cmd")
        self.create_subscription(String, "order", self.on_order, 10)

    def on_order(self, order):
        pass  # order.data is the color, x and y, such as 'red 0.620 0.300'


def main():
    rclpy.init()
    rclpy.spin(PickPlace())


if __name__ == "__main__":
    main()
