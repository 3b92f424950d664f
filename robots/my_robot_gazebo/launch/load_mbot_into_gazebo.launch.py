# SPDX-License-Identifier: Apache-2.0
"""Load mbot into a world of Gazebo Classic, and show in RViz what it knows.

Another world with world:=/path/to/file.world; sensors with camera:=true, kinect:=true and laser:=true.
"""

from ament_index_python.packages import get_package_share_path
from launch import LaunchDescription
from launch.actions import DeclareLaunchArgument, IncludeLaunchDescription
from launch.conditions import IfCondition
from launch.launch_description_sources import PythonLaunchDescriptionSource
from launch.substitutions import Command, LaunchConfiguration, PathJoinSubstitution
from launch_ros.actions import Node
from launch_ros.parameter_descriptions import ParameterValue
from launch_ros.substitutions import FindPackageShare


def generate_launch_description():
    """Return the arguments of this launch file, the simulator, the robot and RViz."""
    package = get_package_share_path('my_robot_gazebo')

    arguments = [
        DeclareLaunchArgument(
            'world',
            default_value=str(package / 'worlds' / 'playground.world'),
            description='The world to load: path of a .world file',
        ),
        DeclareLaunchArgument('camera', default_value='false', choices=['true', 'false'], description='A camera'),
        DeclareLaunchArgument('kinect', default_value='false', choices=['true', 'false'], description='A Kinect'),
        DeclareLaunchArgument('laser', default_value='false', choices=['true', 'false'], description='A laser scanner'),
        DeclareLaunchArgument('x', default_value='0.0', description='Where the robot starts, meters'),
        DeclareLaunchArgument('y', default_value='0.0', description='Where the robot starts, meters'),
        DeclareLaunchArgument('yaw', default_value='0.0', description='Where the robot looks, radians from x'),
        DeclareLaunchArgument('gui', default_value='true', description="Whether to open Gazebo's window"),
        DeclareLaunchArgument('rviz', default_value='true', description='Whether to open RViz'),
        DeclareLaunchArgument(
            'rvizconfig',
            default_value=str(package / 'rviz' / 'mbot.rviz'),
            description='What RViz shows and from where: path of an .rviz file',
        ),
    ]

    model = PathJoinSubstitution([FindPackageShare('my_robot_description'), 'urdf', 'mbot_gazebo.xacro'])
    robot_description = Command([
        'xacro ', model,
        ' camera:=', LaunchConfiguration('camera'),
        ' kinect:=', LaunchConfiguration('kinect'),
        ' laser:=', LaunchConfiguration('laser'),
    ])

    gazebo = IncludeLaunchDescription(
        PythonLaunchDescriptionSource(
            PathJoinSubstitution([FindPackageShare('gazebo_ros'), 'launch', 'gazebo.launch.py'])
        ),
        launch_arguments={'world': LaunchConfiguration('world'), 'gui': LaunchConfiguration('gui')}.items(),
    )

    robot_state_publisher = Node(
        package='robot_state_publisher',
        executable='robot_state_publisher',
        parameters=[{'robot_description': ParameterValue(robot_description, value_type=str), 'use_sim_time': True}],
    )

    # The node waits for the simulator and for the description, puts the robot into the world and ends.
    spawn_entity = Node(
        package='gazebo_ros',
        executable='spawn_entity.py',
        output='screen',
        arguments=[
            '-topic', 'robot_description',
            '-entity', 'mbot',
            '-x', LaunchConfiguration('x'),
            '-y', LaunchConfiguration('y'),
            '-Y', LaunchConfiguration('yaw'),
        ],
    )

    rviz = Node(
        package='rviz2',
        executable='rviz2',
        name='rviz2',
        output='screen',
        arguments=['-d', LaunchConfiguration('rvizconfig')],
        parameters=[{'use_sim_time': True}],
        condition=IfCondition(LaunchConfiguration('rviz')),
    )

    return LaunchDescription([*arguments, gazebo, robot_state_publisher, spawn_entity, rviz])
