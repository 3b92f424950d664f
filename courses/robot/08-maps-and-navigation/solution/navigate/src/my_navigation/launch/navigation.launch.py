from ament_index_python.packages import get_package_share_path
from launch import LaunchDescription
from launch.actions import IncludeLaunchDescription
from launch.launch_description_sources import PythonLaunchDescriptionSource
from launch_ros.actions import Node

LOCALIZATION = {'map_server': 'nav2_map_server', 'amcl': 'nav2_amcl'}
NAVIGATION = {
    'planner_server': 'nav2_planner',
    'controller_server': 'nav2_controller',
    'behavior_server': 'nav2_behaviors',
    'bt_navigator': 'nav2_bt_navigator',
}


def generate_launch_description():
    flat = get_package_share_path('my_flat') / 'launch' / 'flat.launch.py'
    package = get_package_share_path('my_navigation')
    config = package / 'config' / 'navigation.yaml'
    parameters = [str(config), {'use_sim_time': True,
                                'yaml_filename': str(package / 'maps' / 'flat.yaml')}]

    def server(name, package):
        return Node(package=package, executable=name, name=name, output='screen',
                    parameters=parameters)

    def manager(name, names):
        return Node(package='nav2_lifecycle_manager', executable='lifecycle_manager', name=name,
                    output='screen', parameters=[{'use_sim_time': True, 'autostart': True,
                                                  'node_names': list(names)}])

    return LaunchDescription([
        IncludeLaunchDescription(PythonLaunchDescriptionSource(str(flat))),
        *[server(name, package) for name, package in {**LOCALIZATION, **NAVIGATION}.items()],
        manager('lifecycle_manager_localization', LOCALIZATION),
        manager('lifecycle_manager_navigation', NAVIGATION),
    ])
