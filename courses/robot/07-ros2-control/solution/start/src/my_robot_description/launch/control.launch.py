from ament_index_python.packages import get_package_share_path
from launch import LaunchDescription
from launch.substitutions import Command
from launch_ros.actions import Node
from launch_ros.parameter_descriptions import ParameterValue


def generate_launch_description():
    package = get_package_share_path('my_robot_description')
    model = package / 'urdf' / 'mbot_control.xacro'
    controllers = package / 'config' / 'controllers.yaml'
    robot_description = ParameterValue(Command(['xacro ', str(model)]), value_type=str)

    return LaunchDescription([
        Node(package='robot_state_publisher', executable='robot_state_publisher',
             parameters=[{'robot_description': robot_description}]),
        Node(package='controller_manager', executable='ros2_control_node',
             parameters=[str(controllers)]),
        Node(package='controller_manager', executable='spawner',
             arguments=['joint_state_broadcaster', 'base_controller']),
    ])
