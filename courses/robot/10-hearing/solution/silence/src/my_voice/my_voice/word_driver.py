import rclpy
from geometry_msgs.msg import Twist
from rclpy.executors import ExternalShutdownException
from rclpy.node import Node
from rclpy.signals import SignalHandlerOptions
from std_msgs.msg import String

COMMANDS = {
    (0.0, 0.0): ('stop', '停'),
    (0.2, 0.0): ('forward', '前进'),
    (-0.2, 0.0): ('back', '后退'),
    (0.0, 0.5): ('left', '左转'),
    (0.0, -0.5): ('right', '右转'),
}


def understand(text):
    """Return the speed and the turn rate of a command, or None."""
    text = text.lower()
    for velocity, words in COMMANDS.items():
        if any(word in text for word in words):
            return velocity
    return None


class WordDriver(Node):
    def __init__(self):
        super().__init__('word_driver')
        self.declare_parameter('timeout', 3.0)
        self.heard = self.get_clock().now()
        self.velocity = self.create_publisher(Twist, 'cmd_vel', 10)
        self.create_subscription(String, 'voice/text', self.on_text, 10)
        self.create_timer(0.1, self.check_silence)

    def on_text(self, message):
        velocity = understand(message.data)
        if velocity is None:
            self.get_logger().warning(f'I do not understand: {message.data}')
        else:
            self.heard = self.get_clock().now()
            self.drive(*velocity)

    def check_silence(self):
        silence = (self.get_clock().now() - self.heard).nanoseconds * 1e-9
        if silence > self.get_parameter('timeout').value:
            self.drive(0.0, 0.0)

    def drive(self, speed, turn):
        message = Twist()
        message.linear.x = speed
        message.angular.z = turn
        self.velocity.publish(message)


def main():
    rclpy.init(signal_handler_options=SignalHandlerOptions.NO)
    node = WordDriver()
    try:
        while rclpy.ok():
            rclpy.spin_once(node, timeout_sec=0.1)
    except (KeyboardInterrupt, ExternalShutdownException):
        pass
    finally:
        node.drive(0.0, 0.0)
        rclpy.try_shutdown()
