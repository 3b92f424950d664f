"""Navigation in another process instead of Linkwright's, as with real nav2.

It receives the simulation's data over the wire, and serves clients of nav2's topics and actions.
"""

from __future__ import annotations

from pathlib import Path

from tests.reliability.running import Machine

LAUNCH_FILE = Path(__file__).parents[2] / "robots/my_robot_gazebo/launch/load_mbot_laser_into_gazebo.launch.py"
NAVIGATION = """
import tf2_ros
from geometry_msgs.msg import PoseWithCovarianceStamped, Twist
from lifecycle_msgs.srv import GetState
from nav2_msgs.action import NavigateToPose
from nav_msgs.msg import OccupancyGrid, Odometry, Path
from rclpy.action import ActionServer
from rclpy.parameter import Parameter
from rclpy.qos import qos_profile_sensor_data
from rclpy.time import Time
from sensor_msgs.msg import LaserScan

KEPT = QoSProfile(depth=1, durability=DurabilityPolicy.TRANSIENT_LOCAL, reliability=ReliabilityPolicy.RELIABLE)


class Program(Node):
    def __init__(self):
        super().__init__("bt_navigator", parameter_overrides=[Parameter("use_sim_time", value=True)])
        self.heard, self.ready, self.goal, self.place, self.speed = set(), False, None, 0.0, 0.0
        self.buffer = tf2_ros.Buffer()
        self.listener = tf2_ros.TransformListener(self.buffer, self)
        self.create_subscription(LaserScan, "scan", self.on_scan, qos_profile_sensor_data)
        self.create_subscription(Odometry, "odom", self.on_odometry, 10)
        self.create_subscription(PoseWithCovarianceStamped, "initialpose", self.on_initial_pose, 10)
        self.estimate = self.create_publisher(PoseWithCovarianceStamped, "amcl_pose", KEPT)
        self.map = self.create_publisher(OccupancyGrid, "map", KEPT)
        self.plan = self.create_publisher(Path, "plan", 10)
        self.velocity = self.create_publisher(Twist, "cmd_vel", 10)
        for name in ("bt_navigator", "amcl"):
            self.create_service(GetState, f"{name}/get_state", self.on_state)
        self.server = ActionServer(
            self, NavigateToPose, "navigate_to_pose", self.on_reached, handle_accepted_callback=self.on_goal
        )
        self.map.publish(OccupancyGrid())
        self.create_timer(0.05, self.tick)

    def on_scan(self, scan):
        if len(scan.ranges) > 10 and self.buffer.can_transform("odom", scan.header.frame_id, Time()):
            self.heard.add("scan in odom")

    def on_odometry(self, odometry):
        self.heard.add("odometry")
        self.place, self.speed = odometry.pose.pose.position.x, odometry.twist.twist.linear.x

    def on_initial_pose(self, pose):
        self.estimate.publish(pose)

    def on_state(self, request, response):
        response.current_state.label = "active"
        return response

    def on_goal(self, handle):
        self.goal = handle
        self.plan.publish(Path())

    def on_reached(self, handle):
        handle.succeed()
        return NavigateToPose.Result()

    def tick(self):
        if not self.ready and len(self.heard) == 2 and self.get_clock().now().nanoseconds:
            self.ready = True
            say("it hears scan, odometry and time")
        if self.goal is None:
            return
        left = self.goal.request.pose.pose.position.x - self.place
        self.velocity.publish(Twist()) if left < 0.05 else self.drive(left)
        if left < 0.05 and abs(self.speed) < 0.02:
            say("reached", round(self.place, 1))
            handle, self.goal = self.goal, None
            handle.execute()

    def drive(self, left):
        twist = Twist()
        twist.linear.x = min(0.3, 0.1 + left)
        self.velocity.publish(twist)
        self.goal.publish_feedback(NavigateToPose.Feedback(distance_remaining=left))
"""
ASKING = """
from geometry_msgs.msg import PoseStamped
from nav2_simple_commander.robot_navigator import BasicNavigator


class Program(Node):
    def __init__(self):
        super().__init__("asking")
        navigator = BasicNavigator()
        begin, goal = PoseStamped(), PoseStamped()
        for pose in (begin, goal):
            pose.header.frame_id = "map"
            pose.pose.orientation.w = 1.0
        navigator.setInitialPose(begin)
        navigator.waitUntilNav2Active()
        goal.pose.position.x = 1.0
        navigator.goToPose(goal)
        way = []
        while not navigator.isTaskComplete():
            if navigator.getFeedback() is not None:
                way.append(navigator.getFeedback().distance_remaining)
        say("ended", navigator.getResult().name, len(way) > 3 and way[0] > way[-1])
"""


def test_external_navigation_replaces_built_in_navigation(machine: Machine) -> None:
    launch = machine.launch(LAUNCH_FILE)
    navigation = machine.program(NAVIGATION)
    navigation.wait_for("it hears scan, odometry and time")
    asking = machine.program(ASKING)
    asking.wait_for("ended SUCCEEDED True")
    navigation.wait_for("reached 1.0")
    assert "WARN" not in navigation.text, navigation.text
    assert launch.interrupt() == 130
