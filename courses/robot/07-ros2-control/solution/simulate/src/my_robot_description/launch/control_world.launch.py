from ament_index_python.packages import get_package_share_path
from launch import LaunchDescription
from launch.actions import IncludeLaunchDescription
from launch.launch_description_sources import PythonLaunchDescriptionSource
from launch.substitutions import Command
from launch_ros.actions import Node
from launch_ros.parameter_descriptions import ParameterValue


def generate_launch_description():
    model = get_package_share_path('my_robot_description') / 'urdf' / 'mbot_control.xacro'
    gazebo = get_package_share_path('gazebo_ros') / 'launch' / 'gazebo.launch.py'
    command = Command(['xacro ', str(model), ' hardware:=gazebo_ros2_control/GazeboSystem'])
    robot_description = ParameterValue(command, value_type=str)

    return LaunchDescription([
        IncludeLaunchDescription(PythonLaunchDescriptionSource(str(gazebo))),
        Node(package='robot_state_publisher', executable='robot_state_publisher',
             parameters=[{'robot_description': robot_description, 'use_sim_time': True}]),
        Node(package='gazebo_ros', executable='spawn_entity.py',
             arguments=['-topic', 'robot_description', '-entity', 'mbot']),
        Node(package='controller_manager', executable='spawner',
             arguments=['joint_state_broadcaster', 'base_controller']),
    ])
