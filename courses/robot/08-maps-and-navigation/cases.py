from linkwright.learning import Edit, right, wrong

PACKAGE = "src/my_navigation/"
SETUP, MANIFEST = PACKAGE + "setup.py", PACKAGE + "package.xml"
SLAM, MAPPING = PACKAGE + "config/slam.yaml", PACKAGE + "launch/mapping.launch.py"
MAP, CONFIG = PACKAGE + "maps/flat.yaml", PACKAGE + "config/navigation.yaml"
LAUNCH, NODE, ROOMS = (
    PACKAGE + "launch/navigation.launch.py",
    PACKAGE + "my_navigation/go_to_room.py",
    PACKAGE + "config/rooms.yaml",
)


BRINGUP = """from ament_index_python.packages import get_package_share_path
from launch import LaunchDescription
from launch.actions import IncludeLaunchDescription
from launch.launch_description_sources import PythonLaunchDescriptionSource


def generate_launch_description():
    share = get_package_share_path('my_navigation')
    flat = get_package_share_path('my_flat') / 'launch' / 'flat.launch.py'
    localization = get_package_share_path('nav2_bringup') / 'launch' / 'localization_launch.py'
    arguments = {'map': str(share / 'maps' / 'flat.yaml'), 'use_sim_time': 'true',
                 'params_file': str(share / 'config' / 'navigation.yaml')}
    return LaunchDescription([
        IncludeLaunchDescription(PythonLaunchDescriptionSource(str(flat))),
        IncludeLaunchDescription(PythonLaunchDescriptionSource(str(localization)),
                                 launch_arguments=arguments.items()),
    ])
"""

COMMANDER = """import math

import rclpy
from geometry_msgs.msg import PoseStamped
from nav2_simple_commander.robot_navigator import BasicNavigator, TaskResult


def main():
    rclpy.init()
    navigator = BasicNavigator('go_to_room')
    navigator.declare_parameter('room', 'hall')
    room = navigator.get_parameter('room').value
    navigator.declare_parameter(room, [0.0, 0.0, 0.0])
    x, y, yaw = navigator.get_parameter(room).value
    goal = PoseStamped()
    goal.header.frame_id = 'map'
    goal.pose.position.x, goal.pose.position.y = x, y
    goal.pose.orientation.z, goal.pose.orientation.w = math.sin(yaw / 2), math.cos(yaw / 2)
    navigator.goToPose(goal)
    while not navigator.isTaskComplete():
        pass
    print(room if navigator.getResult() == TaskResult.SUCCEEDED else 'no way')
    rclpy.shutdown()
"""

CALLBACKS = """import math

import rclpy
from geometry_msgs.msg import PoseStamped
from nav2_msgs.action import NavigateToPose
from rclpy.action import ActionClient
from rclpy.node import Node


class Driver(Node):
    def __init__(self):
        super().__init__('go_to_room', automatically_declare_parameters_from_overrides=True)
        self.is_done = False
        self.client = ActionClient(self, NavigateToPose, '/navigate_to_pose')
        self.timer = self.create_timer(0.5, self.start)

    def start(self):
        if not self.client.server_is_ready():
            return
        self.timer.cancel()
        x, y, yaw = self.get_parameter(self.get_parameter('room').value).value
        pose = PoseStamped()
        pose.header.frame_id = 'map'
        pose.pose.position.x, pose.pose.position.y = x, y
        pose.pose.orientation.z, pose.pose.orientation.w = math.sin(yaw / 2), math.cos(yaw / 2)
        self.client.send_goal_async(NavigateToPose.Goal(pose=pose)).add_done_callback(self.on_answer)

    def on_answer(self, future):
        future.result().get_result_async().add_done_callback(self.on_result)

    def on_result(self, future):
        self.is_done = True


def main():
    rclpy.init()
    node = Driver()
    while not node.is_done:
        rclpy.spin_once(node)
    rclpy.shutdown()
"""

CASES = [
    right(
        "mapping",
        "the node itself",
        Edit(
            MAPPING,
            "from launch.launch_description_sources",
            "from launch_ros.actions import Node\nfrom launch.launch_description_sources",
        ),
        Edit(
            MAPPING,
            "        IncludeLaunchDescription(\n            PythonLaunchDescriptionSource(str(slam)),\n"
            "            launch_arguments={'slam_params_file': str(config), 'use_sim_time': 'true'}.items(),\n        ),",
            "        Node(package='slam_toolbox', executable='sync_slam_toolbox_node', name='slam_toolbox',\n"
            "             parameters=[str(config), {'use_sim_time': True}]),",
        ),
        Edit(MAPPING, "    slam = get_package_share_path('slam_toolbox') / 'launch' / 'online_async_launch.py'\n", ""),
        Edit(MANIFEST, "<exec_depend>launch</exec_depend>", "<depend>launch_ros</depend>\n  <depend>launch</depend>"),
    ),
    wrong(
        "mapping", "another frame", Edit(SLAM, "base_frame: base_footprint", "base_frame: base"), says="base_footprint"
    ),
    wrong(
        "mapping",
        "no file",
        Edit(MAPPING, "'slam_params_file': str(config), ", ""),
        says="'minimum_travel_distance' of /slam_toolbox is 0.5",
    ),
    wrong("mapping", "another topic", Edit(SLAM, "scan_topic: /scan", "scan_topic: /laser"), says="mbot has 'scan'"),
    wrong("mapping", "another map frame", Edit(SLAM, "map_frame: map", "map_frame: world"), says="mbot has 'map'"),
    wrong("mapping", "large cells", Edit(SLAM, "resolution: 0.05", "resolution: 0.5"), says="should be 0.05 m wide"),
    wrong("mapping", "too short a range", Edit(SLAM, "range: 10.0", "range: 0.1"), says="draws no wall"),
    wrong("mapping", "another name", Edit(SLAM, "slam_toolbox:", "slam:"), says="it has: slam"),
    wrong("mapping", "the time of the computer", Edit(MAPPING, "'true'", "'false'"), says="use_sim_time"),
    wrong("mapping", "one underscore", Edit(SLAM, "ros__parameters", "ros_parameters"), says="two underscores"),
    wrong(
        "mapping",
        "no flat",
        Edit(MAPPING, "        IncludeLaunchDescription(PythonLaunchDescriptionSource(str(flat))),\n", ""),
        says="/gazebo",
    ),
    wrong(
        "mapping",
        "not installed",
        Edit(SETUP, "        ('share/' + package_name + '/config', glob('config/*')),\n", ""),
        says="config/slam.yaml",
    ),
    wrong(
        "mapping",
        "a forgotten dependency",
        Edit(MANIFEST, "  <exec_depend>slam_toolbox</exec_depend>\n", ""),
        says="slam_toolbox",
    ),
    right("save", "other thresholds", Edit(MAP, "occupied_thresh: 0.65", "occupied_thresh: 0.5")),
    wrong("save", "no image", {PACKAGE + "maps/flat.pgm": None}, says="flat.pgm"),
    wrong("save", "no map", {PACKAGE + "maps/flat.yaml": None}, says="maps/flat.yaml"),
    wrong("save", "another resolution", Edit(MAP, "resolution: 0.05", "resolution: 0.1"), says="0.1 m wide"),
    wrong(
        "save",
        "begun elsewhere",
        Edit(MAP, "origin: [-1.55, -1.55", "origin: [-2.55, -1.05"),
        says="The map shows only",
    ),
    wrong("save", "black and white exchanged", Edit(MAP, "negate: 0", "negate: 1"), says="0% of the hall"),
    wrong(
        "save",
        "not installed",
        Edit(SETUP, "        ('share/' + package_name + '/maps', glob('maps/*')),\n", ""),
        says="does not install",
    ),
    right("door", "measured with the mouse", answer="1.05"),
    wrong("door", "cells", says="number of cells", answer="22"),
    wrong("door", "centimeters", says="in cm", answer="110"),
    wrong("door", "the wall", says="the wall beside the door", answer="2.1"),
    right(
        "localize",
        "the launch file of nav2_bringup",
        {LAUNCH: BRINGUP},
        Edit(
            MANIFEST,
            "  <exec_depend>nav2_amcl</exec_depend>\n",
            "  <exec_depend>nav2_amcl</exec_depend>\n  <exec_depend>nav2_bringup</exec_depend>\n",
        ),
    ),
    right("localize", "another sensor model", Edit(CONFIG, "likelihood_field", "likelihood_field_prob")),
    wrong(
        "localize",
        "no manager",
        Edit(LAUNCH, "        manager('lifecycle_manager_localization', LOCALIZATION),\n", ""),
        says="lifecycle_manager",
    ),
    wrong("localize", "no pose", Edit(CONFIG, "set_initial_pose: true", "set_initial_pose: false"), says="'map'"),
    wrong("localize", "another frame", Edit(CONFIG, "odom_frame_id: odom", "odom_frame_id: odometry"), says="'map'"),
    wrong("localize", "not set", Edit(CONFIG, "    set_initial_pose: true\n", ""), says="set_initial_pose to true"),
    wrong(
        "localize", "another topic", Edit(CONFIG, "scan_topic: scan", "scan_topic: laser"), says="scan_topic of amcl"
    ),
    wrong(
        "localize",
        "a misspelled model",
        Edit(CONFIG, "likelihood_field", "likelyhood_field"),
        says="cannot be 'likelyhood_field'",
    ),
    wrong("localize", "degrees", Edit(CONFIG, "yaw: 0.0}", "yaw: 90.0}"), says="the pose of amcl is wrong"),
    wrong("localize", "another map", Edit(LAUNCH, "'flat.yaml'", "'house.yaml'"), says="yaml_filename"),
    right("navigate", "faster", Edit(CONFIG, "desired_linear_vel: 0.3", "desired_linear_vel: 0.4")),
    wrong(
        "navigate",
        "a diameter",
        Edit(
            CONFIG,
            "      track_unknown_space: true\n      resolution: 0.05\n      robot_radius: 0.2",
            "      track_unknown_space: true\n      resolution: 0.05\n      robot_radius: 0.6",
        ),
        says="robot_radius of global_costmap is 0.6",
    ),
    wrong(
        "navigate",
        "no number",
        Edit(
            CONFIG,
            "      rolling_window: true\n      width: 3\n      height: 3\n      resolution: 0.05\n      robot_radius: 0.2",
            "      rolling_window: true\n      width: 3\n      height: 3\n      resolution: 0.05\n      robot_radius: ...",
        ),
        says="robot_radius",
    ),
    right(
        "navigate",
        "a footprint instead of a radius",
        Edit(
            CONFIG,
            "      rolling_window: true\n      width: 3\n      height: 3\n      resolution: 0.05\n      robot_radius: 0.2",
            "      rolling_window: true\n      width: 3\n      height: 3\n      resolution: 0.05\n"
            "      footprint: '[[0.2, 0.2], [0.2, -0.2], [-0.2, -0.2], [-0.2, 0.2]]'",
        ),
    ),
    wrong(
        "navigate",
        "one level",
        Edit(CONFIG, "local_costmap:\n  local_costmap:\n    ros__parameters", "local_costmap:\n  ros__parameters"),
        says="local_costmap",
    ),
    wrong(
        "navigate",
        "no obstacles",
        Edit(CONFIG, "plugins: [obstacle_layer, inflation_layer]", "plugins: [inflation_layer]"),
        says="local_costmap has no ObstacleLayer",
    ),
    wrong(
        "navigate",
        "a misspelled layer",
        Edit(CONFIG, "plugins: [obstacle_layer, inflation_layer]", "plugins: [obstacle_layers, inflation_layer]"),
        says="list 'obstacle_layers'",
    ),
    wrong(
        "navigate",
        "another topic",
        Edit(
            CONFIG,
            "width: 3\n      height: 3\n      resolution: 0.05\n      robot_radius: 0.2\n      plugins: [obstacle_layer, "
            "inflation_layer]\n      obstacle_layer:\n        plugin: nav2_costmap_2d::ObstacleLayer\n"
            "        observation_sources: scan\n        scan: {topic: /scan",
            "width: 3\n      height: 3\n      resolution: 0.05\n      robot_radius: 0.2\n      plugins: [obstacle_layer, "
            "inflation_layer]\n      obstacle_layer:\n        plugin: nav2_costmap_2d::ObstacleLayer\n"
            "        observation_sources: scan\n        scan: {topic: /lidar",
        ),
        says="laser publishes /scan",
    ),
    wrong(
        "navigate",
        "the manager does not have the servers",
        Edit(LAUNCH, "        manager('lifecycle_manager_navigation', NAVIGATION),\n", ""),
        says="in node_names of a lifecycle_manager",
    ),
    wrong(
        "navigate",
        "a missing server",
        Edit(LAUNCH, "    'behavior_server': 'nav2_behaviors',\n", ""),
        says="/behavior_server",
    ),
    wrong(
        "navigate",
        "a forgotten dependency",
        Edit(MANIFEST, "  <exec_depend>nav2_planner</exec_depend>\n", ""),
        says="nav2_planner",
    ),
    right(
        "navigate",
        "another planner, as newer versions write it",
        Edit(CONFIG, "nav2_navfn_planner/NavfnPlanner", "nav2_smac_planner::SmacPlanner2D"),
    ),
    wrong(
        "navigate",
        "a misspelled planner",
        Edit(CONFIG, "NavfnPlanner", "NavfnPlaner"),
        says="'nav2_navfn_planner/NavfnPlaner', which nav2 does not have",
    ),
    right(
        "send",
        "nav2_simple_commander",
        {NODE: COMMANDER},
        Edit(MANIFEST, "<depend>rclpy</depend>", "<depend>rclpy</depend>\n  <depend>nav2_simple_commander</depend>"),
    ),
    right("send", "callbacks", {NODE: CALLBACKS}),
    wrong("send", "another action", Edit(NODE, "'navigate_to_pose'", "'go_to_pose'"), says="No goal arrives"),
    wrong("send", "degrees", Edit(ROOMS, "3.14", "180.0"), says="yaw = 3.1, but is at"),
    wrong("send", "half the angle forgotten", Edit(NODE, "math.sin(yaw / 2)", "math.sin(yaw)"), says="yaw = 3.1"),
    wrong("send", "x and y exchanged", Edit(NODE, "x, y, yaw = ", "y, x, yaw = "), says="x = 3.8, y = -0.8"),
    wrong(
        "send",
        "it does not wait",
        Edit(NODE, "        rclpy.spin_until_future_complete(self, result)\n", ""),
        says="go_to_room.py, line",
    ),
    wrong(
        "send",
        "another status",
        Edit(NODE, "STATUS_SUCCEEDED", "STATUS_ACCEPTED"),
        says="It logs 'the kitchen cannot be reached' when mbot has arrived",
    ),
    right(
        "send",
        "the number of the status, and words of one's own",
        Edit(NODE, "GoalStatus.STATUS_SUCCEEDED", "4"),
        Edit(NODE, "f'in the {room}' if arrived", "f'welcome to the {room}' if arrived"),
        Edit(NODE, "from action_msgs.msg import GoalStatus\n", ""),
        Edit(MANIFEST, "  <depend>action_msgs</depend>\n", ""),
    ),
    wrong("send", "another frame", Edit(NODE, "'map'", "'odom'"), says="header.frame_id of the goal is 'odom'"),
    wrong(
        "send",
        "the yaw for its sine",
        Edit(NODE, "orientation.z = math.sin(yaw / 2)", "orientation.z = yaw"),
        says="With hall:=[0.5, -0.4, 1.2], the goal is",
    ),
    wrong(
        "send",
        "the rooms in the code",
        Edit(
            NODE,
            "self.get_parameter(room).value\n        goal",
            "{'kitchen': (3.8, -0.8, 3.14), 'hall': (0.0, 0.0, 0.0)}[room]\n        goal",
        ),
        says="With hall:=[0.5, -0.4, 1.2], the goal is",
    ),
    wrong("send", "a misspelled room", Edit(ROOMS, "hall:", "Hall:"), says="rooms.yaml has no 'hall'"),
    wrong("send", "no rooms", {ROOMS: None}, says="config/rooms.yaml"),
]
