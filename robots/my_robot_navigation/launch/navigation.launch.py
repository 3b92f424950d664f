# SPDX-License-Identifier: Apache-2.0
"""mbot goes to poses in the house: the simulation, a map, where mbot is on it, and nav2.

Click "2D Goal Pose" in RViz, or send a goal to the action navigate_to_pose. With slam:=true mbot has no map and draws
one while it drives.
"""

from ament_index_python.packages import get_package_share_path
from launch import LaunchDescription
from launch.actions import DeclareLaunchArgument, IncludeLaunchDescription
from launch.conditions import IfCondition, UnlessCondition
from launch.launch_description_sources import PythonLaunchDescriptionSource
from launch.substitutions import LaunchConfiguration
from launch_ros.actions import Node

NAVIGATION = {
    'nav2_controller': 'controller_server',
    'nav2_planner': 'planner_server',
    'nav2_behaviors': 'behavior_server',
    'nav2_bt_navigator': 'bt_navigator',
    'nav2_waypoint_follower': 'waypoint_follower',
}
LOCALIZATION = {'nav2_map_server': 'map_server', 'nav2_amcl': 'amcl'}


def generate_launch_description():
    """Return the simulation, nav2's servers and who brings them up; arguments of the simulation can be given, too."""
    gazebo = get_package_share_path('my_robot_gazebo')
    navigation = get_package_share_path('my_robot_navigation')
    slam = LaunchConfiguration('slam')
    parameters = [LaunchConfiguration('nav2_params_file'), {'use_sim_time': True}]

    def server(package, executable, **more):
        given = [*parameters, *more.pop('parameters', [])]
        return Node(package=package, executable=executable, name=executable, output='screen', parameters=given, **more)

    def manager(name, nodes, **more):
        managed = [{'use_sim_time': True, 'autostart': True, 'node_names': list(nodes)}]
        return Node(
            package='nav2_lifecycle_manager',
            executable='lifecycle_manager',
            name=name,
            output='screen',
            parameters=managed,
            **more,
        )

    return LaunchDescription(
        [
            DeclareLaunchArgument(
                'world',
                default_value=str(gazebo / 'worlds' / 'house.world'),
                description='The world: path of a .world file',
            ),
            DeclareLaunchArgument(
                'map', default_value=str(gazebo / 'maps' / 'house.yaml'), description='The map: path of a YAML file'
            ),
            DeclareLaunchArgument(
                'nav2_params_file',
                default_value=str(navigation / 'config' / 'nav2_params.yaml'),
                description="Parameters of nav2's nodes: path of a YAML file",
            ),
            DeclareLaunchArgument(
                'slam',
                default_value='false',
                choices=['true', 'false'],
                description='Draw a map instead of reading one',
            ),
            DeclareLaunchArgument(
                'rvizconfig',
                default_value=str(navigation / 'rviz' / 'navigation.rviz'),
                description='What RViz shows: path of an .rviz file',
            ),
            IncludeLaunchDescription(
                PythonLaunchDescriptionSource(str(gazebo / 'launch' / 'load_mbot_into_gazebo.launch.py')),
                launch_arguments={
                    'world': LaunchConfiguration('world'),
                    'laser': 'true',
                    'rvizconfig': LaunchConfiguration('rvizconfig'),
                }.items(),
            ),
            server(
                'nav2_map_server',
                'map_server',
                parameters=[{'yaml_filename': LaunchConfiguration('map')}],
                condition=UnlessCondition(slam),
            ),
            server('nav2_amcl', 'amcl', condition=UnlessCondition(slam)),
            manager('lifecycle_manager_localization', LOCALIZATION.values(), condition=UnlessCondition(slam)),
            Node(
                package='slam_toolbox',
                executable='async_slam_toolbox_node',
                name='slam_toolbox',
                output='screen',
                parameters=[{'use_sim_time': True, 'base_frame': 'base_footprint', 'max_laser_range': 6.0}],
                condition=IfCondition(slam),
            ),
            *[server(package, executable) for package, executable in NAVIGATION.items()],
            manager('lifecycle_manager_navigation', NAVIGATION.values()),
        ]
    )
