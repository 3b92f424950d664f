import rclpy
from rclpy.executors import ExternalShutdownException
from rclpy.node import Node
from std_msgs.msg import String

COLORS = {
    '红': 'red', '绿': 'green', '蓝': 'blue',
    'red': 'red', 'green': 'green', 'blue': 'blue',
}
STOPS = ('停', 'stop')
GOES = ('去', '到', 'go to')


class CommandListener(Node):
    """Publish the color that a command names as the target, and no color to stop."""

    def __init__(self):
        super().__init__('command_listener')
        self.target = self.create_publisher(String, 'target', 10)
        self.create_subscription(String, 'command', self.on_command, 10)

    def on_command(self, message):
        target = target_of(message.data)
        if target is None:
            self.get_logger().warning(f'I do not understand: {message.data}')
            return
        self.get_logger().info(f'target: {target or "none"}')
        self.target.publish(String(data=target))


def target_of(text):
    """Return the color that a command names, '' for a command to stop, or None."""
    text = text.lower()
    if any(word in text for word in STOPS):
        return ''
    if any(word in text for word in GOES):
        return next((color for word, color in COLORS.items() if word in text), None)
    return None


def main():
    rclpy.init()
    try:
        rclpy.spin(CommandListener())
    except (KeyboardInterrupt, ExternalShutdownException):
        pass
    finally:
        rclpy.try_shutdown()
