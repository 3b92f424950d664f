import rclpy
from geometry_msgs.msg import PointStamped, Twist
from my_mission.decisions import velocity
from rclpy.duration import Duration
from rclpy.executors import ExternalShutdownException
from rclpy.node import Node
from rclpy.signals import SignalHandlerOptions
from std_msgs.msg import String

FRESH = Duration(seconds=0.5)


class GoToBall(Node):
    def __init__(self):
        super().__init__('go_to_ball')
        self.declare_parameter('stop_distance', 0.5)
        self.declare_parameter('speed', 0.3)
        self.declare_parameter('turn_speed', 1.0)
        self.declare_parameter('search_speed', 0.6)
        self.declare_parameter('search_time', 20.0)
        self.state = 'waiting'
        self.ball = None
        self.seen = None
        self.search_start = None
        self.velocity = self.create_publisher(Twist, 'cmd_vel', 10)
        self.states = self.create_publisher(String, 'state', 10)
        self.create_subscription(String, 'target', self.on_target, 10)
        self.create_subscription(PointStamped, 'ball', self.on_ball, 10)
        self.create_timer(0.1, self.decide)

    def on_target(self, message):
        self.state = 'waiting'
        self.ball = None
        if message.data:
            self.search()

    def on_ball(self, message):
        self.ball = message.point
        self.seen = self.get_clock().now()

    def value(self, name):
        return self.get_parameter(name).value

    def decide(self):
        if self.state in ('searching', 'driving'):
            self.go()
        else:
            self.drive(0.0, 0.0)
        self.states.publish(String(data=self.state))

    def go(self):
        now = self.get_clock().now()
        if self.ball is None or now - self.seen > FRESH:
            if self.state == 'driving':
                self.search()
            if now - self.search_start > Duration(seconds=self.value('search_time')):
                self.get_logger().warning('I do not find the ball')
                self.state = 'waiting'
                self.drive(0.0, 0.0)
            else:
                self.drive(0.0, self.value('search_speed'))
            return
        speed, turn = velocity(self.ball.x, self.ball.y, self.value('stop_distance'),
                               self.value('speed'), self.value('turn_speed'))
        self.state = 'driving' if speed else 'arrived'
        self.drive(speed, turn)

    def search(self):
        self.state = 'searching'
        self.search_start = self.get_clock().now()

    def drive(self, speed, turn):
        message = Twist()
        message.linear.x = speed
        message.angular.z = turn
        self.velocity.publish(message)


def main():
    rclpy.init(signal_handler_options=SignalHandlerOptions.NO)
    node = GoToBall()
    try:
        rclpy.spin(node)
    except (KeyboardInterrupt, ExternalShutdownException):
        pass
    finally:
        node.drive(0.0, 0.0)
        rclpy.try_shutdown()
