import math

import rclpy
from geometry_msgs.msg import PoseStamped
from rclpy.executors import ExternalShutdownException
from rclpy.node import Node
from std_msgs.msg import String

PLACES = {
    ('home', '家'): (0.0, 0.0, 0.0),
    ('kitchen', '厨房'): (2.8, -2.6, -1.57),
    ('bedroom', '卧室'): (-1.9, 1.6, 1.57),
}


class GoalSender(Node):
    def __init__(self):
        super().__init__('goal_sender')
        self.publisher = self.create_publisher(PoseStamped, 'goal_pose', 10)
        self.create_subscription(String, 'voice/text', self.on_text, 10)

    def on_text(self, message):
        for names, (x, y, yaw) in PLACES.items():
            if any(name in message.data.lower() for name in names):
                self.send(x, y, yaw)

    def send(self, x, y, yaw):
        goal = PoseStamped()
        goal.header.stamp = self.get_clock().now().to_msg()
        goal.header.frame_id = 'map'
        goal.pose.position.x = x
        goal.pose.position.y = y
        goal.pose.orientation.z = math.sin(yaw / 2)
        goal.pose.orientation.w = math.cos(yaw / 2)
        self.publisher.publish(goal)


def main():
    rclpy.init()
    try:
        rclpy.spin(GoalSender())
    except (KeyboardInterrupt, ExternalShutdownException):
        pass
    finally:
        rclpy.try_shutdown()
