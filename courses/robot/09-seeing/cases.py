from linkwright.learning import Edit, right, wrong

SIM = "src/my_robot_description/urdf/mbot_sim.xacro"
PACKAGE = "src/my_vision/"
RED, BALL, MARKER, WATCH = (
    f"{PACKAGE}my_vision/{name}.py" for name in ("red_mask", "ball_finder", "marker_finder", "watch_ball")
)
SETUP, LAUNCH = PACKAGE + "setup.py", PACKAGE + "launch/seeing.launch.py"

BOTH_ENDS = "low | high"

NUMPY_MASK = """import numpy as np
import rclpy
from rclpy.qos import qos_profile_sensor_data
from sensor_msgs.msg import Image


def main(args=None):
    rclpy.init(args=args)
    node = rclpy.create_node('mask')
    publisher = node.create_publisher(Image, '/red_mask', 1)

    def on_image(message):
        pixels = np.frombuffer(message.data, np.uint8).reshape(message.height, message.width, 3).astype(int)
        red, green, blue = np.moveaxis(pixels, 2, 0)
        if message.encoding == 'bgr8':
            red, blue = blue, red
        found = (red > 60) & (red > 2 * green) & (red > 2 * blue)
        mask = Image(header=message.header, height=message.height, width=message.width, step=message.width)
        mask.encoding = 'mono8'
        mask.data = (255 * found).astype(np.uint8).tobytes()
        publisher.publish(mask)

    node.create_subscription(Image, '/camera/image_raw', on_image, qos_profile_sensor_data)
    rclpy.spin(node)
"""

MOMENTS = """import cv2
import rclpy
from cv_bridge import CvBridge
from geometry_msgs.msg import PointStamped
from rclpy.node import Node
from sensor_msgs.msg import CameraInfo, Image


class Finder(Node):
    def __init__(self):
        super().__init__('finder')
        self.k = None
        self.point = self.create_publisher(PointStamped, '/ball', 1)
        self.create_subscription(CameraInfo, '/camera/camera_info', self.on_info, 1)
        self.create_subscription(Image, '/camera/image_raw', self.on_image, 1)

    def on_info(self, info):
        self.k = info.k

    def on_image(self, message):
        image = CvBridge().imgmsg_to_cv2(message, 'rgb8')
        mask = cv2.inRange(cv2.cvtColor(image, cv2.COLOR_RGB2HSV), (170, 100, 40), (179, 255, 255))
        mask += cv2.inRange(cv2.cvtColor(image, cv2.COLOR_RGB2HSV), (0, 100, 40), (9, 255, 255))
        contours, _ = cv2.findContours(mask, cv2.RETR_EXTERNAL, cv2.CHAIN_APPROX_SIMPLE)
        if not contours or self.k is None:
            return
        (u, v), radius = cv2.minEnclosingCircle(max(contours, key=cv2.contourArea))
        fx, cx, fy, cy = self.k[0], self.k[2], self.k[4], self.k[5]
        distance = fx * 0.15 / radius
        ball = PointStamped(header=message.header)
        ball.header.frame_id = 'camera_link'
        ball.point.x = distance
        ball.point.y = -(u - cx) / fx * distance
        ball.point.z = -(v - cy) / fy * distance
        self.point.publish(ball)


def main():
    rclpy.init()
    node = Finder()
    try:
        rclpy.spin(node)
    except KeyboardInterrupt:
        pass
"""

LOOP_WATCH = """import rclpy
from geometry_msgs.msg import Twist
from rclpy.node import Node
from vision_msgs.msg import Detection2DArray


class Watch(Node):
    def __init__(self):
        super().__init__('watch_ball')
        self.last = 0.0
        self.publisher = self.create_publisher(Twist, '/cmd_vel', 1)
        self.create_subscription(Detection2DArray, '/yolo/detections', self.look, 1)
        self.create_timer(0.05, self.move)

    def look(self, array):
        widest, self.last = 0.0, 0.0
        for each in array.detections:
            if each.results[0].hypothesis.class_id == 'ball' and each.bbox.size_x > widest:
                widest = each.bbox.size_x
                offset = each.bbox.center.position.x - 160
                self.last = 0.0 if abs(offset) < 10 else 0.5 if offset < 0 else -0.5

    def move(self):
        command = Twist()
        command.angular.z = self.last
        self.publisher.publish(command)


def main():
    rclpy.init()
    rclpy.spin(Watch())
"""

CASES = [
    wrong("ball", "down for up", Edit(BALL, "(middle_row - row)", "(row - middle_row)"), says="forward, left, up"),
    wrong("camera", "without colors", Edit(SIM, "R8G8B8", "L8"), says="which has no colors"),
    wrong("camera", "another name", Edit(SIM, "<camera_name>camera", "<camera_name>cam"), says="on /cam/image_raw"),
    wrong(
        "camera",
        "no optical rotation",
        Edit(SIM, 'rpy="${-pi/2} 0 ${-pi/2}"', 'rpy="0 0 0"'),
        says="z axis of camera_optical_frame points along 0 0 1",
    ),
    wrong(
        "camera",
        "the sensor at a link that is missing",
        Edit(SIM, '<gazebo reference="camera_link">', '<gazebo reference="camera">'),
        says="Nothing is published on /camera/image_raw",
    ),
    wrong(
        "camera",
        "another camera name",
        Edit(SIM, "<camera_name>camera<", "<camera_name>cam<"),
        says="Nothing is published on /camera/image_raw",
    ),
    wrong("camera", "another angle", Edit(SIM, "1.2</horizontal_fov>", "1.05</horizontal_fov>"), says="1.05 rad"),
    right(
        "camera",
        "the rotation as a number",
        Edit(SIM, 'rpy="${-pi/2} 0 ${-pi/2}"', 'rpy="-1.5708 0 -1.5708"'),
        Edit(SIM, "<far>20</far>", "<far>50</far>"),
    ),
    right("red", "numpy alone", {RED: NUMPY_MASK}),
    wrong(
        "red",
        "one end of the hues",
        Edit(RED, BOTH_ENDS, "low"),
        says="lacks crimson",
    ),
    wrong("red", "the red channel alone", Edit(RED, BOTH_ENDS, "cv2.inRange(image[:, :, 2], 90, 255)"), says="white"),
    wrong(
        "red",
        "hues in degrees",
        Edit(RED, "(172, 120, 50), (179, 255, 255)", "(240, 120, 50), (255, 255, 255)"),
        says="lacks crimson",
    ),
    wrong(
        "red",
        "no conversion",
        Edit(RED, "imgmsg_to_cv2(message, 'bgr8')", "imgmsg_to_cv2(message)"),
        says="channels are exchanged",
    ),
    wrong("red", "no header", Edit(RED, "        mask.header = message.header\n", ""), says="copy the header"),
    wrong("red", "no publishing", Edit(RED, "        self.publisher.publish(mask)\n", ""), says="nothing is published"),
    wrong("lens", "the radius", says="belongs to the radius", answer="17.5"),
    wrong("lens", "the width of the image", says="uses the width of the image", answer="48"),
    right("ball", "the enclosing circle", {BALL: MOMENTS}),
    wrong("ball", "the radius", Edit(BALL, "DIAMETER = 0.3", "DIAMETER = 0.15"), says="/ball says 0.9"),
    wrong(
        "ball", "left is right", Edit(BALL, "(middle_column - column)", "(column - middle_column)"), says="/ball says"
    ),
    wrong(
        "ball", "the frame of the image", Edit(BALL, "'camera_link'", "'camera_optical_frame'"), says="'camera_link'"
    ),
    wrong(
        "ball",
        "no look at the mask",
        Edit(BALL, "        if np.count_nonzero(mask) < LEAST_AREA:\n            return\n", ""),
        says="looks away from the ball",
    ),
    wrong("ball", "a misspelled field", Edit(BALL, "header.frame_id", "header.frame"), says="ball_finder.py, line"),
    wrong(
        "ball",
        "no executable",
        Edit(SETUP, "            'ball_finder = my_vision.ball_finder:main',\n", ""),
        says="'ball_finder'",
    ),
    wrong("markers", "the size of the paper", Edit(MARKER, "SIZE = 0.3", "SIZE = 0.4"), says="'marker_7' is at"),
    wrong("markers", "another dictionary", Edit(MARKER, "DICT_4X4_50", "DICT_6X6_50"), says="tf has no 'marker_7'"),
    wrong(
        "markers", "another name", Edit(MARKER, "f'marker_{number}'", "f'aruco_{number}'"), says="tf has no 'marker_7'"
    ),
    right(
        "markers",
        "the iterative solution",
        Edit(MARKER, ", flags=cv2.SOLVEPNP_IPPE_SQUARE", ""),
        Edit(MARKER, "imgmsg_to_cv2(message, 'mono8')", "imgmsg_to_cv2(message, 'bgr8')"),
    ),
    wrong("dataset", "mAP50", says="This is mAP50", answer="0.931"),
    wrong("dataset", "percent", says="not percent", answer="84"),
    right("detector", "a timer and two speeds", {WATCH: LOOP_WATCH}),
    wrong(
        "detector",
        "the wrong sign",
        Edit(WATCH, "self.turn(1.0 - nearest", "self.turn(-1.0 + nearest"),
        says="angular.z is",
    ),
    wrong(
        "detector",
        "any class",
        Edit(WATCH, "            if detection.results[0].hypothesis.class_id == 'ball'\n", ""),
        says="a cone at the left edge",
    ),
    wrong(
        "detector",
        "the first ball",
        Edit(WATCH, "max(balls, key=lambda box: box.size_x)", "balls[0]"),
        says="far ones on the right",
    ),
    wrong(
        "detector",
        "another image topic",
        Edit(LAUNCH, "'/camera/image_raw'", "'/camera/image'"),
        says="no message with the expected values arrived on '/yolo/detections'",
    ),
    wrong(
        "detector",
        "not in setup.py",
        Edit(SETUP, "            'watch_ball = my_vision.watch_ball:main',\n", ""),
        says="'watch_ball'",
    ),
    wrong("detector", "not installed", Edit(SETUP, "glob('launch/*')", "[]"), says="does not install"),
    wrong(
        "detector",
        "a missing dependency",
        Edit(PACKAGE + "package.xml", "  <exec_depend>my_robot_vision</exec_depend>\n", ""),
        says="'my_robot_vision'",
    ),
]
