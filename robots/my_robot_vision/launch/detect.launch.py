# SPDX-License-Identifier: Apache-2.0
"""mbot in a world with things, and what it sees there: boxes in the picture, ids, places, and a node that goes there.

Say what it is to go to with: ros2 topic pub --once /vision/go_to std_msgs/msg/String "{data: red ball}"
"""

from ament_index_python.packages import get_package_share_path
from launch import LaunchDescription
from launch.actions import DeclareLaunchArgument, IncludeLaunchDescription
from launch.conditions import IfCondition
from launch.launch_description_sources import PythonLaunchDescriptionSource
from launch.substitutions import LaunchConfiguration, PathJoinSubstitution, PythonExpression
from launch_ros.actions import Node
from launch_ros.substitutions import FindPackageShare

MODEL = 'things'  # what the detector finds things with, unless model:= says otherwise
SWITCH = ['true', 'false']


def generate_launch_description():
    """Return the simulation and the nodes; arguments of the simulation can be given here, too."""
    gazebo = get_package_share_path('my_robot_gazebo')
    vision = get_package_share_path('my_robot_vision')
    depth, language = LaunchConfiguration('depth'), LaunchConfiguration('language')
    camera = ['/', PythonExpression(["'kinect' if '", depth, "' == 'true' else 'camera'"])]

    def node(executable, parameters, remappings=(), **more):
        return Node(
            package='my_robot_vision',
            executable=executable,
            output='screen',
            parameters=[{**parameters, 'use_sim_time': True}],
            remappings=list(remappings),
            **more,
        )

    return LaunchDescription([
        DeclareLaunchArgument(
            'world',
            default_value=str(gazebo / 'worlds' / 'playground.world'),
            description='The world: path of a .world file',
        ),
        DeclareLaunchArgument(
            'model', default_value=MODEL, description='What the detector finds things with: a name, or an ONNX file'
        ),
        DeclareLaunchArgument('threshold', default_value='0.5', description='The least score of a detection'),
        DeclareLaunchArgument('depth', default_value='false', choices=SWITCH, description='A Kinect for a camera'),
        DeclareLaunchArgument('laser', default_value='true', choices=SWITCH, description='A laser for obstacles'),
        DeclareLaunchArgument('voice', default_value='false', choices=SWITCH, description='Commands by voice'),
        DeclareLaunchArgument(
            'engine', default_value='enrolled', description='What recognizes speech: enrolled, vosk, pocketsphinx'
        ),
        DeclareLaunchArgument(
            'language', default_value='en', choices=['en', 'zh'], description='What is spoken, by the robot, too'
        ),
        DeclareLaunchArgument(
            'rvizconfig',
            default_value=str(vision / 'rviz' / 'vision.rviz'),
            description='What RViz shows: path of an .rviz file',
        ),
        IncludeLaunchDescription(
            PythonLaunchDescriptionSource(str(gazebo / 'launch' / 'load_mbot_into_gazebo.launch.py')),
            launch_arguments={
                'world': LaunchConfiguration('world'),
                'camera': PythonExpression(["'false' if '", depth, "' == 'true' else 'true'"]),
                'kinect': depth,
                'laser': LaunchConfiguration('laser'),
                'rvizconfig': LaunchConfiguration('rvizconfig'),
            }.items(),
        ),
        node(
            'detector',
            {
                'model': LaunchConfiguration('model'),
                'threshold': LaunchConfiguration('threshold'),
                'input_image_topic': [*camera, '/image_raw'],
            },
            namespace='yolo',
        ),
        node('tracking_node', {}, namespace='yolo'),
        node(
            'detect_3d_node',
            {'target_frame': 'odom', 'ground_frame': 'base_footprint'},
            [
                ('detections', 'tracking'),
                ('camera_info', [*camera, '/camera_info']),
                ('depth_image', [*camera, '/depth/image_raw']),
                ('depth_info', [*camera, '/depth/camera_info']),
            ],
            namespace='yolo',
        ),
        node(
            'object_seeker',
            {'language': language},
            [
                ('tracking', '/yolo/tracking'),
                ('detections_3d', '/yolo/detections_3d'),
                ('image_raw', [*camera, '/image_raw']),
            ],
        ),
        Node(
            package='my_robot_voice',
            executable='voice_commander',
            output='screen',
            parameters=[{
                'use_sim_time': True,
                'engine': LaunchConfiguration('engine'),
                'language': language,
                'commands_file': PathJoinSubstitution([FindPackageShare('my_robot_voice'), 'config', 'commands.yaml']),
            }],
            condition=IfCondition(LaunchConfiguration('voice')),
        ),
    ])
