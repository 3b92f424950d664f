from linkwright.learning import Edit, right, wrong

PACKAGE = "src/my_mission/"
DECISIONS, NODE = PACKAGE + "my_mission/decisions.py", PACKAGE + "my_mission/go_to_ball.py"
SETUP, MANIFEST = PACKAGE + "setup.py", PACKAGE + "package.xml"
CONFIG, LAUNCH = PACKAGE + "config/mission.yaml", PACKAGE + "launch/mission.launch.py"
UNIT_TEST, SYSTEM_TEST = PACKAGE + "test/test_decisions.py", PACKAGE + "test/test_mission.py"

NUMPY_DECISIONS = """import numpy as np


def velocity(forward, left, stop_distance=0.5, speed=0.3, turn_speed=1.0):
    remaining = forward - stop_distance
    if remaining <= 0:
        return [0.0, 0.0]
    turn = np.clip(2.0 * left / forward, -turn_speed, turn_speed)
    return np.array([np.clip(remaining, 0.05, speed) * (1.0 - 0.5 * abs(turn)), turn])
"""

LOOP = """import time

import rclpy
from geometry_msgs.msg import PointStamped, Twist
from my_mission.decisions import velocity
from std_msgs.msg import String


def main():
    rclpy.init()
    node = rclpy.create_node('driver')
    for name, default in (('stop_distance', 0.5), ('speed', 0.3), ('turn_speed', 1.0), ('search_speed', 0.6)):
        node.declare_parameter(name, default)
    memory = {'state': 'waiting', 'age': 100, 'ball': None}

    def on_target(message):
        memory.update(state='searching' if message.data else 'waiting', age=100)

    def on_ball(message):
        memory.update(ball=message.point, age=0)

    node.create_subscription(String, '/target', on_target, 1)
    node.create_subscription(PointStamped, '/ball', on_ball, 1)
    wheels = node.create_publisher(Twist, '/cmd_vel', 1)
    states = node.create_publisher(String, '/state', 1)

    def tick():
        memory['age'] += 1
        command = Twist()
        if memory['state'] in ('searching', 'driving'):
            if memory['age'] > 5:
                memory['state'] = 'searching'
                command.angular.z = -node.get_parameter('search_speed').value
            else:
                values = [node.get_parameter(name).value for name in ('stop_distance', 'speed', 'turn_speed')]
                command.linear.x, command.angular.z = velocity(memory['ball'].x, memory['ball'].y, *values)
                memory['state'] = 'driving' if command.linear.x else 'arrived'
        wheels.publish(command)
        states.publish(String(data=memory['state']))

    node.create_timer(0.1, tick)
    rclpy.spin(node)
"""

UNITTEST = """import unittest

from my_mission import decisions


class TestVelocity(unittest.TestCase):
    def test_directions_and_limits(self):
        for left in (-1.0, -0.2, 0.2, 1.0):
            speed, turn = decisions.velocity(3.0, left)
            self.assertGreater(turn * left, 0.0)
            self.assertLessEqual(speed, 0.3)

    def test_a_near_ball(self):
        self.assertFalse(any(decisions.velocity(0.3, 0.0)))
"""

XML_LAUNCH_NODE = "Node(package='my_mission', executable='go_to_ball', parameters=parameters),"

TWO_PARAMETERS = "(forward, left):\n    stop_distance, speed, turn_speed = 0.5, 0.3, 1.0"
SIGNATURE = "(forward, left, stop_distance=0.5, speed=0.3, turn_speed=1.0):"
LIMITED = "max(-turn_speed, min(turn_speed, 1.5 * direction))"

CASES = [
    wrong(
        "decide",
        "degrees",
        Edit(DECISIONS, "1.5 * direction", "1.5 * math.degrees(direction)"),
        says="the direction, 0.05 rad",
    ),
    wrong("decide", "no limit", Edit(DECISIONS, LIMITED, "1.5 * direction"), says="turn_speed, the limit"),
    wrong("decide", "two parameters", Edit(DECISIONS, SIGNATURE, TWO_PARAMETERS), says="needs five parameters"),
    right("decide", "an array of numpy", {DECISIONS: NUMPY_DECISIONS}),
    right(
        "decide",
        "it slows down for turns",
        Edit(DECISIONS, "return min(speed", "return (1 - 0.5 * abs(turn)) * min(speed"),
    ),
    wrong(
        "decide",
        "to the wrong side",
        Edit(DECISIONS, "1.5 * direction", "-1.5 * direction"),
        says="positive is to the left",
    ),
    wrong(
        "decide",
        "degrees",
        Edit(DECISIONS, "turn = max(-turn_speed, min(turn_speed, 1.5 * direction))", "turn = math.degrees(direction)"),
        says="and 1 the limit",
    ),
    wrong(
        "decide",
        "no stop",
        Edit(DECISIONS, "forward <= stop_distance", "forward <= 0.0"),
        says="stop distance of 0.5 m",
    ),
    wrong(
        "decide",
        "no limit",
        Edit(DECISIONS, "min(speed, forward - stop_distance + 0.05)", "forward - stop_distance + 0.05"),
        says="at most 0.3",
    ),
    wrong(
        "decide",
        "exchanged results",
        Edit(
            DECISIONS,
            "return min(speed, forward - stop_distance + 0.05), turn",
            "return turn, min(speed, forward - stop_distance + 0.05)",
        ),
        says="straight ahead",
    ),
    wrong("decide", "no import", Edit(DECISIONS, "import math\n", ""), says="decisions.py, line"),
    wrong(
        "decide",
        "no return",
        Edit(DECISIONS, "    return min(speed, forward - stop_distance + 0.05), turn\n", ""),
        says="returns None",
    ),
    right("unit-test", "a class of unittest", {UNIT_TEST: UNITTEST}),
    wrong(
        "unit-test",
        "one direction only",
        Edit(UNIT_TEST, "assert velocity(2.0, 0.5)[1] > 0.0", "assert True"),
        Edit(UNIT_TEST, "assert velocity(2.0, -0.5)[1] < 0.0", "assert True"),
        says="turns away",
    ),
    wrong(
        "unit-test",
        "not collected",
        Edit(UNIT_TEST, "def test_it_stops_near_the_ball", "def it_stops_near_the_ball"),
        says="does not stop",
    ),
    wrong(
        "unit-test",
        "a wrong fact",
        Edit(UNIT_TEST, "velocity(0.4, 0.1) == (0.0, 0.0)", "velocity(0.4, 0.1) == (0.1, 0.0)"),
        says="The tests fail: assert",
    ),
    wrong("unit-test", "no test", {UNIT_TEST: "from my_mission.decisions import velocity\n"}, says="has no test"),
    wrong(
        "unit-test",
        "a misspelled import",
        Edit(UNIT_TEST, "my_mission.decisions", "my_mission.decision"),
        says="ModuleNotFoundError",
    ),
    right("node", "one function", {NODE: LOOP}),
    wrong("node", "another topic", Edit(NODE, "'ball', self.on_ball", "'balls', self.on_ball"), says="linear.x = 0"),
    wrong("node", "no timer", Edit(NODE, "        self.create_timer(0.1, self.decide)\n", ""), says="is there a timer"),
    wrong(
        "node",
        "x and y exchanged",
        Edit(NODE, "velocity(self.ball.x, self.ball.y", "velocity(self.ball.y, self.ball.x"),
        says="For the ball at x = 2",
    ),
    wrong(
        "node",
        "the target is ignored",
        Edit(NODE, "if self.target and self.ball", "if self.ball"),
        says="before it has a target",
    ),
    wrong(
        "node",
        "an old ball",
        Edit(NODE, " and self.get_clock().now() - self.seen < FRESH", ""),
        says="after the last ball",
    ),
    wrong("node", "a constant", Edit(NODE, "self.value('stop_distance'),", "0.5,"), says="With stop_distance:=1.5"),
    wrong(
        "node",
        "a misspelled name",
        Edit(NODE, "self.ball = message.point", "self.ball = message.pont"),
        says="go_to_ball.py, line",
    ),
    right("search", "one function, to the right", {NODE: LOOP}),
    right(
        "search",
        "a lambda for a method",
        Edit(NODE, "create_timer(0.1, self.decide)", "create_timer(0.1, lambda: self.decide())"),
    ),
    wrong(
        "search",
        "backwards",
        Edit(NODE, "self.drive(0.0, self.value('search_speed'))", "self.drive(-0.1, self.value('search_speed'))"),
        says="the velocity is -0.1",
    ),
    wrong(
        "search",
        "a fixed search",
        Edit(NODE, "self.drive(0.0, self.value('search_speed'))", "self.drive(0.0, 0.6)"),
        says="With search_speed:=0.4",
    ),
    wrong(
        "search",
        "another word",
        Edit(NODE, "'driving' if speed else 'arrived'", "'driving' if speed else 'done'"),
        says="/state is 'done'",
    ),
    wrong(
        "search",
        "an old ball",
        Edit(NODE, "Duration(seconds=0.5)", "Duration(seconds=5)"),
        says="1 s after the last ball",
    ),
    wrong(
        "search",
        "the empty target starts a search",
        Edit(NODE, "'searching' if message.data else 'waiting'", "'searching'"),
        says="in 'searching'",
    ),
    wrong(
        "search",
        "the empty target is ignored",
        Edit(
            NODE,
            "        self.state = 'searching' if message.data else 'waiting'\n",
            "        if message.data:\n            self.state = 'searching'\n",
        ),
        says="which came in 'searching'",
    ),
    wrong(
        "search",
        "the ball of the last target",
        Edit(NODE, "'waiting'\n        self.ball = None\n\n    def on_ball", "'waiting'\n\n    def on_ball"),
        says="does on_target forget the ball",
    ),
    wrong(
        "search",
        "it follows the ball",
        Edit(NODE, "self.state in ('searching', 'driving')", "self.state != 'waiting'"),
        says="it moves again",
    ),
    right(
        "launch",
        "parameters in a loop",
        Edit(
            LAUNCH,
            "        Node(package='my_senses', executable='command_listener', parameters=parameters),\n        Node(package='my_senses', executable='color_finder', parameters=parameters),\n        Node(package='my_mission', executable='go_to_ball', parameters=parameters),\n    ])",
            "    ] + [Node(package=package, executable=name, parameters=parameters) for package, name in (\n        ('my_senses', 'command_listener'), ('my_senses', 'color_finder'), ('my_mission', 'go_to_ball'))])",
        ),
    ),
    right(
        "launch",
        "a wildcard in the file",
        Edit(
            CONFIG,
            "color_finder:\n  ros__parameters:\n    ball_diameter: 0.3\n",
            "/**:\n  ros__parameters:\n    ball_diameter: 0.3\n",
        ),
    ),
    wrong(
        "launch",
        "no parameters",
        Edit(LAUNCH, "executable='go_to_ball', parameters=parameters", "executable='go_to_ball'"),
        says="use_sim_time is false",
    ),
    wrong(
        "launch",
        "no file",
        Edit(LAUNCH, "parameters = [str(config), {", "parameters = [{"),
        says="does not hand mission.yaml to the node",
    ),
    wrong(
        "launch",
        "a text for a number",
        Edit(CONFIG, "stop_distance: 0.6", "stop_distance: '0.6'"),
        says="to '0.6' of type 'STRING'",
    ),
    wrong(
        "launch",
        "one underscore",
        Edit(CONFIG, "go_to_ball:\n  ros__parameters", "go_to_ball:\n  ros_parameters"),
        says="ros__parameters",
    ),
    wrong(
        "launch",
        "always simulated",
        Edit(LAUNCH, "{'use_sim_time': simulation}", "{'use_sim_time': True}"),
        says="use_sim_time is still true",
    ),
    wrong(
        "launch",
        "a missing node",
        Edit(LAUNCH, "        Node(package='my_senses', executable='color_finder', parameters=parameters),\n", ""),
        says="there is no node '/color_finder'",
    ),
    wrong(
        "launch",
        "not installed",
        Edit(SETUP, "        ('share/' + package_name + '/config', glob('config/*')),\n", ""),
        says="does not install",
    ),
    wrong(
        "launch",
        "a forgotten dependency",
        Edit(MANIFEST, "  <exec_depend>my_senses</exec_depend>\n", ""),
        says="my_senses",
    ),
    wrong("system-test", "no method", Edit(SYSTEM_TEST, "def test_it_drives", "def it_drives"), says="has no test"),
    wrong(
        "system-test",
        "nothing is awaited",
        Edit(SYSTEM_TEST, "        self.wait_for(is_driving)\n", ""),
        says="that never drives",
    ),
    wrong(
        "system-test",
        "too much is expected",
        Edit(
            SYSTEM_TEST,
            "self.velocity.linear.x > 0.0 and self.velocity.angular.z > 0.0",
            "self.velocity.linear.x > 1.0",
        ),
        Edit(SYSTEM_TEST, "timeout=10.0", "timeout=3.0"),
        says="it did not happen in time",
    ),
    wrong(
        "system-test",
        "the stop is not awaited",
        Edit(
            SYSTEM_TEST,
            "        self.wait_for(lambda: self.velocity.linear.x == 0.0 and self.velocity.angular.z == 0.0)\n",
            "",
        ),
        says="that never stops",
    ),
    wrong(
        "system-test",
        "not declared",
        Edit(MANIFEST, "  <test_depend>launch_testing</test_depend>\n", ""),
        says="launch_testing",
    ),
    wrong("record", "the whole recording", says="the whole recording", answer="19.3"),
    wrong("record", "the time of the arrival", says="subtract the time of the command", answer="15.6"),
    wrong("record", "no recording", {"run/metadata.yaml": None, "run/run_0.mcap": None}, says="run"),
]
