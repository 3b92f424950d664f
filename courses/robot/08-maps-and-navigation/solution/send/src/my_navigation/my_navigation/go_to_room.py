import math

import rclpy
from action_msgs.msg import GoalStatus
from nav2_msgs.action import NavigateToPose
from rclpy.action import ActionClient
from rclpy.executors import ExternalShutdownException
from rclpy.node import Node


class GoToRoom(Node):
    def __init__(self):
        super().__init__('go_to_room')
        self.declare_parameter('room', 'kitchen')
        self.declare_parameter('hall', [0.0, 0.0, 0.0])
        self.declare_parameter('kitchen', [0.0, 0.0, 0.0])
        self.client = ActionClient(self, NavigateToPose, 'navigate_to_pose')

    def goal(self, room):
        x, y, yaw = self.get_parameter(room).value
        goal = NavigateToPose.Goal()
        goal.pose.header.frame_id = 'map'
        goal.pose.pose.position.x = x
        goal.pose.pose.position.y = y
        goal.pose.pose.orientation.z = math.sin(yaw / 2)
        goal.pose.pose.orientation.w = math.cos(yaw / 2)
        return goal

    def go(self):
        room = self.get_parameter('room').value
        if not self.client.wait_for_server(timeout_sec=20.0):
            self.get_logger().error('there is no action navigate_to_pose')
            return
        sent = self.client.send_goal_async(self.goal(room))
        rclpy.spin_until_future_complete(self, sent)
        if not sent.result().accepted:
            self.get_logger().error(f'the goal {room} was refused')
            return
        result = sent.result().get_result_async()
        rclpy.spin_until_future_complete(self, result)
        arrived = result.result().status == GoalStatus.STATUS_SUCCEEDED
        self.get_logger().info(f'in the {room}' if arrived else f'the {room} cannot be reached')


def main():
    rclpy.init()
    try:
        GoToRoom().go()
    except (KeyboardInterrupt, ExternalShutdownException):
        pass
    finally:
        rclpy.try_shutdown()
