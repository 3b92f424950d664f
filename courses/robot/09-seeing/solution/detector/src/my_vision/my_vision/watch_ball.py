import rclpy
from geometry_msgs.msg import Twist
from rclpy.executors import ExternalShutdownException
from rclpy.node import Node
from rclpy.signals import SignalHandlerOptions
from vision_msgs.msg import Detection2DArray

IMAGE_WIDTH = 320


class WatchBall(Node):
    def __init__(self):
        super().__init__('watch_ball')
        self.velocity = self.create_publisher(Twist, 'cmd_vel', 10)
        self.create_subscription(Detection2DArray, 'yolo/detections', self.on_detections, 10)

    def on_detections(self, message):
        balls = [
            detection.bbox
            for detection in message.detections
            if detection.results[0].hypothesis.class_id == 'ball'
        ]
        if balls:
            nearest = max(balls, key=lambda box: box.size_x)
            self.turn(1.0 - nearest.center.position.x / (IMAGE_WIDTH / 2))
        else:
            self.turn(0.0)

    def turn(self, speed):
        message = Twist()
        message.angular.z = speed
        self.velocity.publish(message)


def main():
    rclpy.init(signal_handler_options=SignalHandlerOptions.NO)
    node = WatchBall()
    try:
        while rclpy.ok():
            rclpy.spin_once(node, timeout_sec=0.1)
    except (KeyboardInterrupt, ExternalShutdownException):
        pass
    finally:
        node.turn(0.0)
        rclpy.try_shutdown()
