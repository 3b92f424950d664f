from linkwright.learning import Edit, right, wrong

PACKAGE = "src/my_voice/"
DRIVER, METER, SENDER = (f"{PACKAGE}my_voice/{name}.py" for name in ("word_driver", "level_meter", "goal_sender"))
SETUP, COMMANDS, LAUNCH = PACKAGE + "setup.py", PACKAGE + "config/commands.yaml", PACKAGE + "launch/hearing.launch.py"

FUNCTIONS = """import re

import rclpy
from geometry_msgs.msg import Twist
from std_msgs.msg import String

RULES = [
    (re.compile(r'stop|停', re.IGNORECASE), 0.0, 0.0),
    (re.compile(r'forward|前进', re.IGNORECASE), 0.2, 0.0),
    (re.compile(r'back|后退', re.IGNORECASE), -0.2, 0.0),
    (re.compile(r'left|左转', re.IGNORECASE), 0.0, 0.5),
    (re.compile(r'right|右转', re.IGNORECASE), 0.0, -0.5),
]


def main(args=None):
    rclpy.init(args=args)
    node = rclpy.create_node('driver')
    timeout = node.declare_parameter('timeout', 3.0)
    publisher = node.create_publisher(Twist, '/cmd_vel', 1)
    command = Twist()
    last = node.get_clock().now()

    def listen(message):
        nonlocal last
        for pattern, speed, turn in RULES:
            if pattern.search(message.data):
                command.linear.x, command.angular.z = speed, turn
                last = node.get_clock().now()
                return

    node.create_subscription(String, '/voice/text', listen, 1)
    while rclpy.ok():
        rclpy.spin_once(node, timeout_sec=0.1)
        if (node.get_clock().now() - last).nanoseconds > timeout.value * 1e9:
            command.linear.x = command.angular.z = 0.0
        publisher.publish(command)
"""

STANDARD_DEVIATION = """import array

import rclpy
from audio_common_msgs.msg import AudioDataStamped
from std_msgs.msg import Float32


def main():
    rclpy.init()
    node = rclpy.create_node('meter')
    publisher = node.create_publisher(Float32, '/level', 1)

    def on_audio(message):
        samples = array.array('h', bytes(message.audio.data))
        mean = sum(sample * sample for sample in samples) / len(samples)
        publisher.publish(Float32(data=mean ** 0.5 / 32768))

    node.create_subscription(AudioDataStamped, '/audio/audio_stamped', on_audio, 1)
    rclpy.spin(node)
"""

OTHER_GRAMMAR = """objects:
  red: {en: [the red ball], zh: [红球, 红色的球]}
  green: {en: [the green ball], zh: [绿球, 绿色的球]}
  blue: {en: [the blue ball], zh: [蓝球, 蓝色的球]}
commands:
  halt:
    phrases:
      en: [stop]
      zh: [停]
    stop: true
  ahead:
    phrases: {en: ["[please] [go|drive] forward"], zh: ["[请]前进"]}
    drive: {x: 0.5}
  ahead_for:
    phrases: {en: ["[please] [go|drive] forward {distance}"], zh: ["[请]前进{distance}"]}
    drive: {x: 0.5, distance: "{distance}"}
  turn_left: {phrases: {en: ["turn left"], zh: [左转]}, drive: {turn: 2}}
  turn_left_by: {phrases: {en: ["turn left {angle}"], zh: ["左转{angle}"]}, drive: {turn: 2, angle: "{angle}"}}
  turn_right: {phrases: {en: ["turn right"], zh: [右转]}, drive: {turn: -2}}
  turn_right_by: {phrases: {en: ["turn right {angle}"], zh: ["右转{angle}"]}, drive: {turn: -2, angle: "{angle}"}}
  seek:
    phrases: {en: ["go to {object}", "find {object}"], zh: ["去{object}[那里]", "找{object}"]}
    publish: {topic: target, type: std_msgs/msg/String, message: {data: "{object}"}}
"""

CASES = [
    wrong(
        "words", "a text in place of a tuple", Edit(DRIVER, "('back', '后退')", "('back')"), says="('back',) is a tuple"
    ),
    wrong("words", "a key twice", Edit(DRIVER, "(0.0, -0.5)", "(0.0, 0.5)"), says="(0.0, 0.5) twice"),
    right("words", "regular expressions in a loop", {DRIVER: FUNCTIONS}),
    wrong("words", "capital letters", Edit(DRIVER, "    text = text.lower()\n", ""), says="After 'Turn LEFT, please'"),
    wrong("words", "equal texts only", Edit(DRIVER, "word in text for", "word == text for"), says="After 'Go back!'"),
    wrong(
        "words",
        "left is right",
        Edit(DRIVER, "(0.0, 0.5): ('left', '左转')", "(0.0, -0.5): ('left', '左转')"),
        Edit(DRIVER, "(0.0, -0.5): ('right', '右转')", "(0.0, 0.5): ('right', '右转')"),
        says="angular.z is -0.5",
    ),
    wrong(
        "words",
        "stop comes last",
        Edit(DRIVER, "    (0.0, 0.0): ('stop', '停'),\n", ""),
        Edit(DRIVER, "('right', '右转'),\n", "('right', '右转'),\n    (0.0, 0.0): ('stop', '停'),\n"),
        says="After 'stop, do not go forward', the robot still drives",
    ),
    wrong(
        "words",
        "another topic",
        Edit(DRIVER, "'voice/text'", "'text'"),
        says="messages of this type are published on /voice/text",
    ),
    wrong(
        "words",
        "everything else stops",
        Edit(DRIVER, "    return None\n", "    return 0.0, 0.0\n"),
        says="is no command",
    ),
    wrong("words", "no Chinese", Edit(DRIVER, "'forward', '前进'", "'forward',"), says="After '前进'"),
    wrong("words", "no comma", Edit(DRIVER, "('back', '后退'),\n", "('back', '后退')\n"), says="word_driver.py, line"),
    right("silence", "regular expressions in a loop", {DRIVER: FUNCTIONS}),
    wrong(
        "silence",
        "any text counts",
        Edit(DRIVER, "            self.heard = self.get_clock().now()\n", ""),
        Edit(
            DRIVER,
            "        velocity = understand(message.data)\n",
            "        self.heard = self.get_clock().now()\n        velocity = understand(message.data)\n",
        ),
        says="keeps the robot driving",
    ),
    wrong(
        "silence",
        "only once",
        Edit(DRIVER, "            self.heard = self.get_clock().now()\n", ""),
        says="after a second command",
    ),
    wrong("silence", "nanoseconds", Edit(DRIVER, "nanoseconds * 1e-9", "nanoseconds"), says="2.5 s after 'forward'"),
    wrong("silence", "milliseconds", Edit(DRIVER, "nanoseconds * 1e-9", "nanoseconds * 1e-12"), says="still drives"),
    wrong(
        "silence",
        "a number instead of the parameter",
        Edit(DRIVER, "self.get_parameter('timeout').value", "3.0"),
        says="With timeout:=1.0",
    ),
    right("sound", "plain Python", {METER: STANDARD_DEVIATION}),
    wrong("sound", "bytes", Edit(METER, "np.int16", "np.uint8"), says="/level says"),
    wrong("sound", "squares of 16 bits", Edit(METER, ".astype(float)", ""), says="A tone"),
    wrong("sound", "the mean", Edit(METER, "np.sqrt(np.mean(samples * samples))", "np.mean(samples)"), says="A tone"),
    wrong("sound", "no division", Edit(METER, " / 32768", ""), says="/level says"),
    wrong("sound", "the first word", says="the first word", answer="1.2"),
    wrong("sound", "the pause", says="count from the beginning", answer="1.7"),
    right(
        "goals",
        "both halves by complex numbers",
        Edit(SENDER, "import math\n", "import cmath\n"),
        Edit(SENDER, "goal.pose.orientation.z = math.sin(yaw / 2)", "half = cmath.rect(-1.0, yaw / 2)"),
        Edit(
            SENDER,
            "goal.pose.orientation.w = math.cos(yaw / 2)",
            "goal.pose.orientation.z, goal.pose.orientation.w = half.imag, half.real",
        ),
    ),
    wrong("goals", "the yaw as z", Edit(SENDER, "math.sin(yaw / 2)", "yaw"), says="has the length"),
    wrong(
        "goals",
        "the whole angle",
        Edit(SENDER, "math.sin(yaw / 2)", "math.sin(yaw)"),
        Edit(SENDER, "math.cos(yaw / 2)", "math.cos(yaw)"),
        says="has the yaw",
    ),
    wrong("goals", "the frame of odometry", Edit(SENDER, "'map'", "'odom'"), says="'odom', but should be 'map'"),
    wrong("goals", "integers", Edit(SENDER, "'家'): (0.0, 0.0, 0.0)", "'家'): (0, 0, 0)"), says="goal_sender.py, line"),
    wrong(
        "goals",
        "no executable",
        Edit(SETUP, "            'goal_sender = my_voice.goal_sender:main',\n", ""),
        says="'goal_sender'",
    ),
    right("grammar", "other names and words", {COMMANDS: OTHER_GRAMMAR}),
    wrong(
        "grammar",
        "a misspelled slot",
        Edit(COMMANDS, 'zh: ["前进{distance}"]', 'zh: ["前进{distanse}"]'),
        says="distanse",
    ),
    wrong(
        "grammar", "no turn without an angle", Edit(COMMANDS, "zh: [左转]", "zh: []"), says="'左转' is not understood"
    ),
    wrong("grammar", "no Chinese", Edit(COMMANDS, ', zh: ["左转{angle}"]', ""), says="'左转九十度' is not understood"),
    wrong(
        "grammar",
        "left is right",
        Edit(COMMANDS, 'drive: {turn: -1, angle: "{angle}"}', 'drive: {turn: 1, angle: "{angle}"}'),
        says="'turn right 45 degrees' drives with",
    ),
    wrong(
        "grammar",
        "another topic",
        Edit(COMMANDS, "topic: /target", "topic: /ball"),
        says="publishes nothing on /target",
    ),
    wrong("grammar", "not installed", Edit(SETUP, "glob('config/*')", "[]"), says="does not install"),
    wrong("grammar", "an indentation", Edit(COMMANDS, "  stop:\n", " stop:\n"), says="commands.yaml, line"),
    right(
        "listen",
        "an engine by its parameter alone",
        Edit(LAUNCH, "'use_sim_time': True, 'engine': 'enrolled', 'open_listening': True", "'open_listening': True"),
    ),
    wrong("listen", "only while a button is held", Edit(LAUNCH, ", 'open_listening': True", ""), says="/voice/text"),
    wrong(
        "listen",
        "no recording",
        Edit(LAUNCH, "'file': ParameterValue(wav, value_type=str)", "'device': ''"),
        says="/voice/text",
    ),
    wrong("listen", "another file of commands", Edit(LAUNCH, "'commands.yaml'", "'command.yaml'"), says="command.yaml"),
    wrong(
        "listen",
        "a missing dependency",
        Edit(
            PACKAGE + "package.xml",
            "  <exec_depend>my_worlds</exec_depend>\n",
            "  <exec_depend>my_world</exec_depend>\n",
        ),
        says="'my_worlds'",
    ),
]
