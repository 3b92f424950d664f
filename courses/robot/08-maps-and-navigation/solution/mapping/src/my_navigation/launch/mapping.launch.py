from ament_index_python.packages import get_package_share_path
from launch import LaunchDescription
from launch.actions import IncludeLaunchDescription
from launch.launch_description_sources import PythonLaunchDescriptionSource


def generate_launch_description():
    flat = get_package_share_path('my_flat') / 'launch' / 'flat.launch.py'
    slam = get_package_share_path('slam_toolbox') / 'launch' / 'online_async_launch.py'
    config = get_package_share_path('my_navigation') / 'config' / 'slam.yaml'

    return LaunchDescription([
        IncludeLaunchDescription(PythonLaunchDescriptionSource(str(flat))),
        IncludeLaunchDescription(
            PythonLaunchDescriptionSource(str(slam)),
            launch_arguments={'slam_params_file': str(config), 'use_sim_time': 'true'}.items(),
        ),
    ])
