# SPDX-License-Identifier: Apache-2.0
"""Load mbot into a world of the newer Gazebo, and show in RViz what it knows.

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
        DeclareLaunchArgument('gz_options', default_value='', description='More options of gz sim, such as -s: no window'),
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
        ' simulator:=gz',
    ])

    # -r: the simulation runs at once instead of waiting for its start button.
    gazebo = IncludeLaunchDescription(
        PythonLaunchDescriptionSource(
            PathJoinSubstitution([FindPackageShare('ros_gz_sim'), 'launch', 'gz_sim.launch.py'])
        ),
        launch_arguments={
            'gz_args': ['-r ', LaunchConfiguration('gz_options'), ' ', LaunchConfiguration('world')],
            'on_exit_shutdown': 'true',
        }.items(),
    )

    robot_state_publisher = Node(
        package='robot_state_publisher',
        executable='robot_state_publisher',
        parameters=[{'robot_description': ParameterValue(robot_description, value_type=str), 'use_sim_time': True}],
    )

    # The node waits for the simulator and for the description, puts the robot into the world and ends.
    create = Node(
        package='ros_gz_sim',
        executable='create',
        output='screen',
        arguments=[
            '-topic', 'robot_description',
            '-name', 'mbot',
            '-x', LaunchConfiguration('x'),
            '-y', LaunchConfiguration('y'),
            '-Y', LaunchConfiguration('yaw'),
        ],
    )

    # Topics of Gazebo are not topics of ROS: the file says which ones to hand over, in which direction.
    bridge = Node(
        package='ros_gz_bridge',
        executable='parameter_bridge',
        output='screen',
        parameters=[{'config_file': str(package / 'config' / 'bridge.yaml')}],
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

    return LaunchDescription([*arguments, gazebo, robot_state_publisher, create, bridge, rviz])
