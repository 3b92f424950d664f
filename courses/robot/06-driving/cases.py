from linkwright.learning import Edit, right, wrong

NODES = "src/my_control/my_control/"
METER, SQUARE, WALL, WANDER = (
    NODES + name for name in ("drive_meter.py", "drive_square.py", "stop_at_wall.py", "wander.py")
)

WAIT_LOOP = """import math

import rclpy
from geometry_msgs.msg import Twist
from nav_msgs.msg import Odometry


def main():
    rclpy.init()
    node = rclpy.create_node('drive_meter')
    publisher = node.create_publisher(Twist, '/cmd_vel', 1)
    positions = []
    node.create_subscription(Odometry, '/odom', lambda message: positions.append(message.pose.pose.position), 1)
    command = Twist()
    while rclpy.ok():
        rclpy.spin_once(node, timeout_sec=0.05)
        if positions:
            first, last = positions[0], positions[-1]
            left = 1.0 - math.dist((first.x, first.y), (last.x, last.y))
            command.linear.x = min(0.25, 0.9 * left) if left > 0.002 else 0.0
            publisher.publish(command)
"""

CASES = [
    right("meter", "a loop with spin_once", {METER: WAIT_LOOP}),
    right("brake", "a loop with spin_once", {METER: WAIT_LOOP}),
    wrong(
        "meter",
        "x alone",
        Edit(METER, "math.hypot(position.x - self.start.x, position.y - self.start.y)", "position.x"),
        says="does not move",
    ),
    wrong(
        "meter",
        "no start",
        Edit(
            METER,
            "math.hypot(position.x - self.start.x, position.y - self.start.y)",
            "math.hypot(position.x, position.y)",
        ),
        says="does not move",
    ),
    wrong(
        "meter",
        "by the time",
        Edit(METER, "import math\n", "import math\nimport time\n"),
        Edit(METER, "driven < 1.0", "time.time() - self.begin < 5"),
        Edit(METER, "self.start = None", "self.start, self.begin = None, time.time()"),
        says="not the time",
    ),
    wrong("brake", "no limit", Edit(METER, "min(0.3, remaining)", "remaining"), says="limits the speed"),
    wrong(
        "square",
        "a yaw of half of its size",
        Edit(SQUARE, "2 * math.atan2(orientation.z, orientation.w)", "orientation.z"),
        says="it turns on the spot",
    ),
    wrong("wall", "degrees", Edit(WALL, "abs(angle) < 0.5", "abs(angle) < 30"), says="beside a wall"),
    wrong("meter", "no stop", Edit(METER, "        else:\n            self.drive(0.0)\n", ""), says="still drives"),
    wrong(
        "meter",
        "the wrong topic",
        Edit(METER, "'odom'", "'odometry'"),
        says="messages of this type are published on /odom",
    ),
    wrong(
        "brake",
        "no braking",
        Edit(METER, "max(0.0, min(0.3, remaining))", "0.3 if remaining > 0 else 0.0"),
        says="instead of 1 m",
    ),
    right("brake", "a larger gain", Edit(METER, "min(0.3, remaining)", "min(0.3, 1.5 * remaining)")),
    wrong(
        "square",
        "to the right",
        Edit(SQUARE, "(1.0, 1.0), (0.0, 1.0)", "(1.0, -1.0), (0.0, -1.0)"),
        says="corner (1, 1)",
    ),
    wrong(
        "square",
        "the wrong sign of the turn",
        Edit(SQUARE, "math.copysign(0.6, error)", "-math.copysign(0.6, error)"),
        says="corner (1, 1)",
    ),
    wrong("square", "a division by a name", Edit(SQUARE, "math.tau)", "math.twopi)"), says="drive_square.py, line"),
    right("square", "degrees of the error", Edit(SQUARE, "abs(error) > 0.2", "math.degrees(abs(error)) > 10")),
    wrong("wall", "too late", Edit(WALL, "nearest > 0.6", "nearest > 0.1"), says="into the wall"),
    wrong(
        "wall",
        "the first value",
        Edit(WALL, "self.drive(0.3 if nearest > 0.6 else 0.0)", "self.drive(0.3 if scan.ranges[0] > 0.6 else 0.0)"),
        says="wall",
    ),
    wrong("wall", "too early", Edit(WALL, "nearest > 0.6", "nearest > 1.6"), says="before the wall"),
    right("wall", "a narrower cone", Edit(WALL, "abs(angle) < 0.5", "abs(angle) < 0.35")),
    wrong("wander", "straight ahead", Edit(WANDER, "min(left, right) > 0.7", "True"), says="touches something"),
    right("wander", "always to the left", Edit(WANDER, "0.8 if left > right else -0.8", "0.8")),
    wrong("drift", "the whole way", says="the difference", answer="10.5"),
]
