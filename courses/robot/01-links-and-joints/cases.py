from linkwright.learning import Edit, right, wrong

URDF = "src/my_robot_description/urdf/mbot_base.urdf"
LEFT_ORIGIN = '<origin xyz="0 0.19 -0.05" rpy="0 0 0"/>'
RIGHT_ORIGIN = '<origin xyz="0 -0.19 -0.05" rpy="0 0 0"/>'

XACRO_PREFIX = '<robot name="mbot" xmlns:xacro="http://www.ros.org/wiki/xacro"><xacro:property name="r" value="0.2"/>'

LEFT_JOINT = '<joint name="left_wheel_joint" type="continuous">'
BESIDE = '<box size="0.03 0.04 0.04"/>\n      </geometry>\n      <origin xyz="0 0 0.5"/>'
BODY_END = """      <material name="orange"/>
    </visual>
  </link>
"""
TURNED = (
    Edit(URDF, LEFT_ORIGIN, '<origin xyz="0 0.19 -0.05" rpy="-1.5708 0 0"/>'),
    Edit(URDF, '<axis xyz="0 1 0"/>', '<axis xyz="0 0 1"/>'),
    Edit(URDF, '<origin xyz="0 0 0" rpy="1.5707 0 0"/>', ""),
)

PROGRAM = "first_drive.py"

TIMER = """import rclpy
from geometry_msgs.msg import Twist
from rclpy.node import Node


class Drive(Node):
    def __init__(self):
        super().__init__('drive')
        self.publisher = self.create_publisher(Twist, 'cmd_vel', 10)
        self.count = 0
        self.create_timer(0.05, self.move)

    def move(self):
        self.count += 1
        twist = Twist()
        if self.count < 60:
            twist.linear.x, twist.angular.z = -0.3, 0.4
        self.publisher.publish(twist)


if __name__ == '__main__':
    rclpy.init()
    rclpy.spin(Drive())
"""

FUNCTION = """import rclpy
from geometry_msgs.msg import Twist


def drive(node, publisher, speed, seconds):
    command = Twist()
    command.linear.x = speed
    begin = node.get_clock().now()
    while (node.get_clock().now() - begin).nanoseconds < seconds * 1e9:
        publisher.publish(command)
        rclpy.spin_once(node, timeout_sec=0.05)


def main():
    rclpy.init()
    node = rclpy.create_node('there_and_back')
    publisher = node.create_publisher(Twist, '/cmd_vel', 1)
    drive(node, publisher, 0.4, 2.0)
    drive(node, publisher, -0.4, 2.0)
    drive(node, publisher, 0.0, 0.2)
    node.destroy_node()
    rclpy.shutdown()


main()
"""

CLOCK = """import time
import rclpy
from geometry_msgs.msg import Twist
rclpy.init()
pub = rclpy.create_node('n').create_publisher(Twist, '/cmd_vel', 10)
t = Twist()
t.linear.x = 0.5
end = time.time() + 5
while time.time() < end:
    pub.publish(t)
    time.sleep(0.02)
t.linear.x = 0.0
pub.publish(t)
"""

STOP = "publisher.publish(Twist())\n"
SLEEP = "    time.sleep(0.1)\n"

CASES = [
    wrong("teleop", "a released key", says="after a key is released", answer="0"),
    wrong("teleop", "the turn rate", says="is angular.z", answer="1.0"),
    wrong("teleop", "with the unit", says="without a unit", answer="0.5 m/s"),
    wrong("teleop", "centimeters", says="not the unit", answer="50"),
    wrong("teleop", "backward", says="has the wrong sign", answer="-0.5"),
    right("teleop", "with a comma", answer="0,5"),
    right("program", "a node with a timer, that is never ended", {PROGRAM: TIMER}),
    right("program", "functions, there and back", {PROGRAM: FUNCTION}),
    right("program", "by the clock of the computer", {PROGRAM: CLOCK}),
    wrong("program", "no stop", Edit(PROGRAM, STOP, ""), says="the robot drives on"),
    wrong("program", "another topic", Edit(PROGRAM, "'/cmd_vel'", "'/cmd_val'"), says="publishes /cmd_val"),
    wrong("program", "no init", Edit(PROGRAM, "rclpy.init()\n", ""), says="first_drive.py, line 6"),
    wrong("program", "an integer", Edit(PROGRAM, "= 0.2", "= 1"), says="write the number with a point"),
    wrong("program", "upward", Edit(PROGRAM, "linear.x", "linear.z"), says="is always 0"),
    wrong("program", "only once", Edit(PROGRAM, "range(40)", "range(1)"), says="again and again"),
    wrong("program", "no sleep", Edit(PROGRAM, SLEEP, ""), says="again and again"),
    wrong(
        "program",
        "no sleep, without an end",
        Edit(PROGRAM, "for _ in range(40):", "while True:"),
        Edit(PROGRAM, SLEEP, ""),
        says="a loop runs without waiting",
    ),
    wrong("program", "without an end", Edit(PROGRAM, "for _ in range(40):", "while True:"), says="still drives"),
    wrong("program", "millimeters", Edit(PROGRAM, "= 0.2", "= 200.0"), says="meters in a second"),
    wrong(
        "program",
        "a class in place of a message",
        Edit(PROGRAM, STOP, "publisher.publish(Twist)\n"),
        says="write Twist()",
    ),
    wrong(
        "program",
        "a function that is not called",
        {PROGRAM: FUNCTION.replace("\n\nmain()\n", "\n")},
        says="runs only if",
    ),
    wrong(
        "program", "an indentation", Edit(PROGRAM, SLEEP, SLEEP.replace("    ", "   ")), says="first_drive.py, line 14"
    ),
    wrong(
        "program", "a misspelled import", Edit(PROGRAM, "import Twist", "import twist"), says="first_drive.py, line 4"
    ),
    wrong(
        "package",
        "an ampersand in the description",
        Edit("src/my_robot_description/package.xml", "<description>", "<description>wheels & "),
        says="write '&amp;'",
    ),
    wrong("body", "curved quotes", Edit(URDF, '"base_link"', '"base_link”'), says="replace '”'"),
    wrong("body", "full-width digits", Edit(URDF, '"0.20"', '"０.２０"'), says="ASCII characters: '0.20'"),
    wrong("body", "a body above its frame", Edit(URDF, "<visual>", '<visual><origin xyz="0 0 0.08"/>'), says="center"),
    right("left-wheel", "a frame that is turned with its axis", *TURNED),
    wrong("left-wheel", "a frame that is turned alone", TURNED[0], says="the rpy of a joint's <origin> turns it"),
    wrong("left-wheel", "behind the end", Edit(URDF, LEFT_JOINT, "</robot>" + LEFT_JOINT), says="after the end"),
    wrong(
        "left-wheel",
        "a link that is not closed until the end",
        Edit(URDF, BODY_END, BODY_END.replace("  </link>\n", "")),
        Edit(URDF, "</robot>", "</link></robot>"),
        says="it is inside <link>, but must be directly inside <robot>",
    ),
    wrong(
        "casters",
        "a material without a definition",
        Edit(URDF, '<material name="black">', '<material name="blak">'),
        says="did you mean 'blak'",
    ),
    wrong(
        "camera",
        "turned to the left",
        Edit(URDF, 'xyz="0.17 0 0.10" rpy="0 0 0"', 'xyz="0.17 0 0.10" rpy="0 0 0.5"'),
        says="has the wrong orientation",
    ),
    right("body", "with another color", Edit(URDF, "1 0.4 0 1", "0 0 1 1")),
    right("body", "with numbers written differently", Edit(URDF, 'radius="0.20"', 'radius="2e-1"')),
    right(
        "body",
        "with a property of xacro",
        Edit(URDF, '<robot name="mbot">', XACRO_PREFIX),
        Edit(URDF, '"0.20"', '"${r}"'),
    ),
    wrong("body", "a misspelled name", Edit(URDF, "base_link", "base_lnk"), says="there is 'base_lnk'"),
    wrong("body", "the diameter as radius", Edit(URDF, '"0.20"', '"0.40"'), says="radius is 0.4 m"),
    wrong("body", "a misspelled attribute", Edit(URDF, "length=", "lenght="), says="has no 'length'"),
    wrong("body", "millimeters", Edit(URDF, '"0.20" length="0.16"', '"200" length="160"'), says="radius is 200 m"),
    wrong("body", "no closing tag", Edit(URDF, "</robot>", ""), says="mbot_base.urdf, line"),
    right("left-wheel", "turned the other way", Edit(URDF, "1.5707 0 0", "-1.5708 0 0")),
    right("left-wheel", "an axis of length 2", Edit(URDF, '<axis xyz="0 1 0"/>', '<axis xyz="0 2 0"/>')),
    wrong("left-wheel", "flat on the ground", Edit(URDF, "1.5707 0 0", "0 0 0"), says="points along 0 0 1"),
    wrong("left-wheel", "degrees", Edit(URDF, "1.5707 0 0", "90 0 0"), says="angles are in radians"),
    wrong("left-wheel", "on the right", Edit(URDF, "0 0.19 -0.05", "0 -0.19 -0.05"), says="should be at 0 0.19 -0.05"),
    wrong("left-wheel", "a fixed wheel", Edit(URDF, 'type="continuous"', 'type="fixed"'), says="has the type 'fixed'"),
    wrong("left-wheel", "the default axis", Edit(URDF, '    <axis xyz="0 1 0"/>\n', ""), says="is 1 0 0"),
    wrong("right-wheel", "on the left wheel", Edit(URDF, RIGHT_ORIGIN, LEFT_ORIGIN), says="is at 0 0.19 -0.05"),
    wrong(
        "right-wheel",
        "no joint",
        Edit(URDF, "right_wheel_joint", "rigth_wheel_joint"),
        says="there is 'rigth_wheel_joint'",
    ),
    wrong("casters", "both at the front", Edit(URDF, "-0.18 0", "0.18 0"), says="should be at -0.18 0 -0.095"),
    wrong(
        "right-wheel",
        "the link of the left wheel",
        Edit(URDF, '<child link="right_wheel_link"/>', '<child link="left_wheel_link"/>'),
        says="is the child of two joints",
    ),
    wrong(
        "casters",
        "a fixed caster",
        Edit(URDF, 'name="front_caster_joint" type="continuous"', 'name="front_caster_joint" type="fixed"'),
        says="should be 'continuous'",
    ),
    wrong(
        "camera",
        "a visual beside its frame",
        Edit(URDF, '<box size="0.03 0.04 0.04"/>\n      </geometry>', BESIDE),
        says="its center is at 0 0 0.5",
    ),
    wrong(
        "program",
        "the loop below spin",
        Edit(PROGRAM, "for _ in", "rclpy.spin(node)\nfor _ in"),
        says="The lines below rclpy.spin() do not run",
    ),
    wrong(
        "program",
        "shutdown before the stop",
        Edit(PROGRAM, STOP + "rclpy.shutdown()", "rclpy.shutdown()\n" + STOP),
        says="was called before this line",
    ),
    wrong("program", "init without parentheses", Edit(PROGRAM, "rclpy.init()", "rclpy.init"), says="with parentheses"),
    wrong(
        "program", "no queue", Edit(PROGRAM, "'/cmd_vel', 10", "'/cmd_vel'"), says="as the last argument, such as 10"
    ),
    wrong(
        "camera",
        "a sphere",
        Edit(URDF, '<box size="0.03 0.04 0.04"/>', '<sphere radius="0.02"/>'),
        says="should be a box",
    ),
]
