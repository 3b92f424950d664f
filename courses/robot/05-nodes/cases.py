from linkwright.learning import Edit, right, wrong

PACKAGE = "src/my_control/"
MOVE, ODOMETER, SETUP = PACKAGE + "my_control/first_move.py", PACKAGE + "my_control/odometer.py", PACKAGE + "setup.py"

LOOP = """import time

import rclpy
from geometry_msgs.msg import Twist


def main():
    rclpy.init()
    node = rclpy.create_node('first_move')
    publisher = node.create_publisher(Twist, '/cmd_vel', 10)
    while rclpy.ok():
        twist = Twist()
        twist.linear.x, twist.angular.z = 0.2, 0.5
        publisher.publish(twist)
        time.sleep(0.1)
"""

RATE = """import rclpy
from geometry_msgs.msg import Twist


def main(args=None):
    rclpy.init(args=args)
    node = rclpy.create_node('mover')
    publisher = node.create_publisher(Twist, 'cmd_vel', 1)
    command = Twist()
    command.linear.x = 0.2
    command.angular.z = 0.5
    while rclpy.ok():
        publisher.publish(command)
        rclpy.spin_once(node, timeout_sec=0.1)
"""

OFFER = "        self.create_service(Trigger, 'reset_distance', self.on_reset)\n"
TICK = "        self.create_timer(0.1, self.move)\n"
SPEED, SPEED_ONCE = "self.get_parameter('speed').value", "self.declare_parameter('speed', 0.2)"

MAIN = """def main():
    rclpy.init()
    rclpy.spin(FirstMove())
"""
IN_CLASS = "    def main():\n        rclpy.init()\n        rclpy.spin(FirstMove())\n"
CLIENT = "        self.create_client(Trigger, 'reset_distance')\n"
START = "self.start = self.get_clock().now()"
VALUE = "self.get_parameter('speed').value"
SUBSCRIPTION = "Odometry, 'odom', self.on_odometry"
FIRST_CALL = """        if self.start is None:
            self.start = now
"""

CASES = [
    wrong("publish", "main in the class", Edit(MOVE, MAIN, IN_CLASS), says="is inside the class 'FirstMove'"),
    wrong(
        "publish", "another attribute", Edit(MOVE, "self.velocity = ", "self.publisher = "), says="set self.velocity in"
    ),
    wrong(
        "stop", "self in main", Edit(MOVE, "        node.stop()", "        self.stop()"), says="'self' exists only in"
    ),
    wrong("parameter", "no value", Edit(MOVE, VALUE, VALUE.removesuffix(".value")), says="write .value after"),
    wrong("parameter", "a default without a point", Edit(MOVE, "'speed', 0.2", "'speed', 1"), says="such as 0.2"),
    wrong(
        "parameter",
        "declared at each call",
        Edit(MOVE, "        self.declare_parameter('speed', 0.2)\n", ""),
        Edit(
            MOVE, "        message.linear.x", "        self.declare_parameter('speed', 0.2)\n        message.linear.x"
        ),
        says="once, in __init__",
    ),
    wrong(
        "parameter",
        "another name",
        Edit(MOVE, "declare_parameter('speed'", "declare_parameter('velocity'"),
        Edit(MOVE, "get_parameter('speed'", "get_parameter('velocity'"),
        says="a parameter with the name speed",
    ),
    wrong(
        "subscribe",
        "a callback without a message",
        Edit(ODOMETER, "on_odometry(self, message)", "on_odometry(self)"),
        says="a parameter for the message",
    ),
    wrong(
        "subscribe",
        "the function before the name",
        Edit(ODOMETER, SUBSCRIPTION, "Odometry, self.on_odometry, 'odom'"),
        says="pass the type, the name, the function and the queue",
    ),
    wrong(
        "subscribe",
        "the type of another topic",
        Edit(ODOMETER, SUBSCRIPTION, SUBSCRIPTION.replace("Odometry", "Float64")),
        says="its messages have the type nav_msgs/msg/Odometry",
    ),
    wrong(
        "subscribe",
        "a number in place of a message",
        Edit(ODOMETER, "Float64(data=self.distance)", "self.distance"),
        says="Float64(data=...)",
    ),
    wrong("subscribe", "no field", Edit(ODOMETER, "data=self", "self"), says="name the field of the message"),
    wrong("subscribe", "no self", Edit(ODOMETER, "if self.last", "if last"), says="write self.last"),
    wrong("subscribe", "no value at first", Edit(ODOMETER, "        self.last = None\n", ""), says="set self.last in"),
    wrong(
        "service",
        "no response",
        Edit(ODOMETER, "(self, request, response)", "(self, request)"),
        says="is called with 2 arguments besides self",
    ),
    wrong(
        "service",
        "a message in place of a service",
        Edit(ODOMETER, "std_srvs.srv", "std_srvs.msg"),
        says="import it from 'std_srvs.srv'",
    ),
    wrong("service", "a client", Edit(ODOMETER, OFFER, CLIENT), says="does the program call create_service"),
    wrong("time", "seconds", Edit(MOVE, ".nanoseconds * 1e-9", ".seconds"), says="has nanoseconds"),
    wrong(
        "time",
        "no first call",
        Edit(MOVE, "(now - self.start).nanoseconds", "now.nanoseconds"),
        says="subtract it",
    ),
    wrong(
        "time", "the time of the start", Edit(MOVE, "self.start = None", START), says="is called first, and subtract it"
    ),
    wrong("time", "the time of each call", Edit(MOVE, FIRST_CALL, "        self.start = now\n"), says="only once"),
    wrong("package", "another name of the function", Edit(MOVE, "def main", "def man"), says="it has 'man'"),
    wrong(
        "publish", "no name of the node", Edit(MOVE, "__init__('first_move')", "__init__()"), says="super().__init__('N"
    ),
    wrong("publish", "single underscores", Edit(MOVE, "def __init__", "def _init_"), says="with two underscores"),
    wrong("publish", "the period last", Edit(MOVE, "(0.1, self.move)", "(self.move, 0.1)"), says="before the function"),
    wrong("package", "no function", Edit(SETUP, "first_move:main", "first_move"), says="the entry names no function"),
    wrong(
        "package",
        "a function that is missing",
        Edit(SETUP, "first_move:main", "first_move:start"),
        says="it has 'main'",
    ),
    wrong(
        "publish",
        "another type",
        Edit(MOVE, "create_publisher(Twist,", "create_publisher(String,"),
        Edit(MOVE, "import Twist\n", "import Twist\nfrom std_msgs.msg import String\n"),
        Edit(MOVE, "publish(message)", "publish(String())"),
        says="the program publishes std_msgs/msg/String there",
    ),
    wrong("publish", "no timer", Edit(MOVE, TICK, ""), says="is there a timer"),
    wrong(
        "publish",
        "a class in place of a message",
        Edit(MOVE, "publish(message)", "publish(Twist)"),
        says="write Twist()",
    ),
    wrong(
        "stop",
        "signals are left to rclpy",
        Edit(MOVE, "signal_handler_options=SignalHandlerOptions.NO", ""),
        says="Ctrl-C shuts rclpy down",
    ),
    wrong(
        "parameter",
        "read only once",
        Edit(MOVE, SPEED_ONCE, "self.speed = " + SPEED_ONCE + ".value"),
        Edit(MOVE, "message.linear.x = " + SPEED, "message.linear.x = self.speed"),
        says="read the parameter in move()",
    ),
    wrong(
        "time",
        "the clock of the computer",
        Edit(MOVE, "self.get_clock().now()", "time.time()"),
        Edit(MOVE, "(now - self.start).nanoseconds * 1e-9", "now - self.start"),
        Edit(MOVE, "import rclpy\n", "import time\n\nimport rclpy\n"),
        says="at half speed",
    ),
    wrong(
        "package",
        "no executable",
        Edit(SETUP, "'first_move = my_control.first_move:main',", ""),
        says="declares no executable 'first_move'",
    ),
    wrong(
        "package",
        "a misspelled module",
        Edit(SETUP, "my_control.first_move:main", "my_control.frist_move:main"),
        says="is missing",
    ),
    right("publish", "a loop with time.sleep", {MOVE: LOOP}),
    right("publish", "a loop with spin_once", {MOVE: RATE}),
    wrong(
        "publish",
        "no spin",
        Edit(MOVE, "rclpy.spin(FirstMove())", "FirstMove()"),
        says="does main() create one and spin it",
    ),
    wrong("publish", "another topic", Edit(MOVE, "'cmd_vel'", "'cmd_val'"), says="publishes /cmd_val"),
    wrong(
        "publish",
        "a misspelled method",
        Edit(MOVE, "create_publisher", "create_publihser"),
        says="first_move.py, line 9",
    ),
    wrong("publish", "to the right", Edit(MOVE, "angular.z = 0.5", "angular.z = -0.5"), says="angular.z is -0.5"),
    wrong("publish", "once a second", Edit(MOVE, "create_timer(0.1", "create_timer(1.0"), says="messages in 2 s"),
    wrong("publish", "an integer", Edit(MOVE, "linear.x = 0.2", "linear.x = 2"), says="first_move.py, line"),
    wrong(
        "publish",
        "an indentation",
        Edit(MOVE, "        message = Twist()", "      message = Twist()"),
        says="first_move.py, line",
    ),
    wrong("circle", "the diameter", says="diameter", answer="0.8"),
    wrong(
        "stop",
        "after the shutdown",
        Edit(
            MOVE,
            "        node.stop()\n        rclpy.try_shutdown()",
            "        rclpy.try_shutdown()\n        node.stop()",
        ),
        says="first_move.py, line 21: InvalidHandle",
    ),
    wrong("stop", "no stop", Edit(MOVE, "        node.stop()\n", ""), says="still has a velocity"),
    right(
        "stop",
        "with contextlib",
        Edit(MOVE, "from rclpy.node import Node\n", "from rclpy.node import Node\nfrom contextlib import suppress\n"),
        Edit(
            MOVE,
            "    try:\n        rclpy.spin(node)\n    except (KeyboardInterrupt, ExternalShutdownException):\n        pass\n    finally:\n        node.stop()\n        rclpy.try_shutdown()",
            "    with suppress(KeyboardInterrupt, ExternalShutdownException):\n        rclpy.spin(node)\n    node.stop()\n    rclpy.try_shutdown()",
        ),
    ),
    wrong("parameter", "not declared", Edit(MOVE, "        self.declare_parameter('speed', 0.2)\n", ""), says="speed"),
    wrong(
        "parameter",
        "declared but not used",
        Edit(MOVE, "self.get_parameter('speed').value", "0.2"),
        says="the speed is 0.2 m/s, but should be 0.4",
    ),
    wrong(
        "subscribe",
        "the distance from the start",
        Edit(
            ODOMETER,
            "self.distance += math.hypot(position.x - self.last.x, position.y - self.last.y)",
            "self.distance = math.hypot(position.x, position.y)",
        ),
        says="forward and back",
    ),
    wrong(
        "subscribe",
        "not in setup.py",
        Edit(SETUP, "            'odometer = my_control.odometer:main',\n", ""),
        says="declares no executable 'odometer'",
    ),
    wrong("subscribe", "the wrong topic", Edit(ODOMETER, "'odom'", "'odometry'"), says="subscribes to /odometry"),
    wrong("service", "no return", Edit(ODOMETER, "        return response\n", ""), says="odometer.py"),
    wrong(
        "service",
        "no reset",
        Edit(ODOMETER, "        self.distance = 0.0\n        return", "        return"),
        says="is still",
    ),
    wrong("service", "another name", Edit(ODOMETER, "'reset_distance'", "'reset'"), says="the program offers /reset."),
    wrong("service", "no service", Edit(ODOMETER, OFFER, ""), says="call create_service"),
    wrong("time", "milliseconds", Edit(MOVE, "nanoseconds * 1e-9", "nanoseconds * 1e-6"), says="After 3 s"),
    wrong("time", "never", Edit(MOVE, "> self.get_parameter('duration').value", "< 0"), says="After 6 s"),
]
