from ament_index_python.packages import get_package_share_path
from launch import LaunchDescription
from launch.actions import IncludeLaunchDescription
from launch.launch_description_sources import PythonLaunchDescriptionSource
from launch_ros.actions import Node


def generate_launch_description():
    mbot = get_package_share_path('my_worlds') / 'launch' / 'load_mbot.launch.py'
    return LaunchDescription([
        IncludeLaunchDescription(PythonLaunchDescriptionSource(str(mbot))),
        Node(package='my_robot_vision', executable='detector', namespace='yolo', output='screen',
             parameters=[{'model': 'things', 'input_image_topic': '/camera/image_raw',
                          'use_sim_time': True}]),
        Node(package='my_vision', executable='watch_ball', parameters=[{'use_sim_time': True}]),
    ])
