from ament_index_python.packages import get_package_share_path
from launch import LaunchDescription
from launch.actions import DeclareLaunchArgument, IncludeLaunchDescription
from launch.conditions import IfCondition
from launch.launch_description_sources import PythonLaunchDescriptionSource
from launch.substitutions import Command, LaunchConfiguration
from launch_ros.actions import Node
from launch_ros.parameter_descriptions import ParameterValue


def generate_launch_description():
    package = get_package_share_path('my_robot_bringup')
    mission = get_package_share_path('my_mission') / 'launch' / 'mission.launch.py'
    model = str(package / 'urdf' / 'mbot_hardware.xacro')
    hardware = LaunchConfiguration('hardware')
    description = Command(['xacro ', model, ' hardware:=', hardware])
    robot_description = {'robot_description': ParameterValue(description, value_type=str)}

    return LaunchDescription([
        DeclareLaunchArgument('hardware',
                              default_value='diffdrive_arduino/DiffDriveArduinoHardware',
                              description='The plugin of ros2_control that moves the wheels'),
        DeclareLaunchArgument('camera', default_value='true',
                              description='Whether to start the driver of the camera'),
        Node(package='robot_state_publisher', executable='robot_state_publisher',
             parameters=[robot_description]),
        Node(package='controller_manager', executable='ros2_control_node',
             parameters=[robot_description, str(package / 'config' / 'controllers.yaml')],
             remappings=[('/base_controller/cmd_vel_unstamped', '/cmd_vel')]),
        Node(package='controller_manager', executable='spawner',
             arguments=['joint_state_broadcaster', 'base_controller']),
        Node(package='usb_cam', executable='usb_cam_node_exe', namespace='camera',
             condition=IfCondition(LaunchConfiguration('camera'))),
        IncludeLaunchDescription(PythonLaunchDescriptionSource(str(mission)),
                                 launch_arguments={'simulation': 'false'}.items()),
    ])
