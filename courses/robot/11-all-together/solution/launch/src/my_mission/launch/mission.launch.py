from ament_index_python.packages import get_package_share_path
from launch import LaunchDescription
from launch.actions import DeclareLaunchArgument, IncludeLaunchDescription
from launch.conditions import IfCondition
from launch.launch_description_sources import PythonLaunchDescriptionSource
from launch.substitutions import LaunchConfiguration
from launch_ros.actions import Node


def generate_launch_description():
    config = get_package_share_path('my_mission') / 'config' / 'mission.yaml'
    playroom = get_package_share_path('my_playroom') / 'launch' / 'playroom.launch.py'
    simulation = LaunchConfiguration('simulation')
    parameters = [str(config), {'use_sim_time': simulation}]

    return LaunchDescription([
        DeclareLaunchArgument('simulation', default_value='true',
                              description='Whether to start the simulated robot'),
        IncludeLaunchDescription(PythonLaunchDescriptionSource(str(playroom)),
                                 condition=IfCondition(simulation)),
        Node(package='my_senses', executable='command_listener', parameters=parameters),
        Node(package='my_senses', executable='color_finder', parameters=parameters),
        Node(package='my_mission', executable='go_to_ball', parameters=parameters),
    ])
