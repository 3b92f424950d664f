# SPDX-License-Identifier: Apache-2.0
"""Load mbot's bigger sister before a table, plan motions of its arm, and pick up a cube that its camera sees.

The cube with color:=red, green or blue goes to place_x:= and place_y:=, meters from the middle of the robot. Only the
robot, without the node that picks: pick:=false.
"""

from ament_index_python.packages import get_package_share_path
from launch import LaunchDescription
from launch.actions import DeclareLaunchArgument, IncludeLaunchDescription
from launch.conditions import IfCondition
from launch.launch_description_sources import PythonLaunchDescriptionSource
from launch.substitutions import LaunchConfiguration, PathJoinSubstitution
from launch_ros.actions import Node
from launch_ros.parameter_descriptions import ParameterValue
from launch_ros.substitutions import FindPackageShare
from moveit_configs_utils import MoveItConfigsBuilder

SIM_TIME = {'use_sim_time': True}


def generate_launch_description():
    """Return the arguments, the simulator, the robot, its controllers, move_group, RViz and the node that picks."""
    gazebo = get_package_share_path('my_robot_gazebo')
    arm = get_package_share_path('my_robot_arm')

    arguments = [
        DeclareLaunchArgument('color', default_value='red', choices=['red', 'green', 'blue'], description='The cube'),
        DeclareLaunchArgument('place_x', default_value='0.62', description='Where to put it, meters'),
        DeclareLaunchArgument('place_y', default_value='0.3', description='Where to put it, meters'),
        DeclareLaunchArgument('pick', default_value='true', choices=['true', 'false'], description='Whether to pick'),
        DeclareLaunchArgument(
            'world',
            default_value=str(gazebo / 'worlds' / 'table.world'),
            description='The world to load: path of a .world file',
        ),
        DeclareLaunchArgument('gz_options', default_value='', description='More options of gz sim: -s for no window'),
        DeclareLaunchArgument('rviz', default_value='true', description='Whether to open RViz'),
    ]

    moveit_config = (
        MoveItConfigsBuilder('mbot_arm', package_name='my_robot_arm')
        .robot_description(mappings={'simulator': 'gz', 'controllers': str(arm / 'config' / 'gz_controllers.yaml')})
        .to_moveit_configs()
    )

    # -r: the simulation runs at once instead of waiting for its start button.
    simulator = IncludeLaunchDescription(
        PythonLaunchDescriptionSource(
            PathJoinSubstitution([FindPackageShare('ros_gz_sim'), 'launch', 'gz_sim.launch.py'])
        ),
        launch_arguments={
            'gz_args': ['-r ', LaunchConfiguration('gz_options'), ' ', LaunchConfiguration('world')],
            'on_exit_shutdown': 'true',
        }.items(),
    )

    nodes = [
        Node(
            package='robot_state_publisher',
            executable='robot_state_publisher',
            parameters=[moveit_config.robot_description, SIM_TIME],
        ),
        # The node waits for the simulator and for the description, puts the robot into the world and ends.
        Node(
            package='ros_gz_sim',
            executable='create',
            output='screen',
            arguments=['-topic', 'robot_description', '-name', 'mbot_arm'],
        ),
        # Topics of Gazebo are not topics of ROS: the file says which ones to hand over, in which direction.
        Node(
            package='ros_gz_bridge',
            executable='parameter_bridge',
            output='screen',
            parameters=[{'config_file': str(gazebo / 'config' / 'bridge.yaml')}],
        ),
        # The spawner waits for the controller manager, which starts with the robot.
        Node(
            package='controller_manager',
            executable='spawner',
            output='screen',
            arguments=[
                'joint_state_broadcaster', 'arm_controller', 'gripper_controller', '--controller-manager-timeout', '60',
            ],
        ),
        Node(
            package='moveit_ros_move_group',
            executable='move_group',
            output='screen',
            parameters=[moveit_config.to_dict(), SIM_TIME],
        ),
        Node(
            package='rviz2',
            executable='rviz2',
            name='rviz2',
            output='screen',
            arguments=['-d', str(arm / 'config' / 'moveit.rviz')],
            parameters=[
                moveit_config.planning_pipelines,
                moveit_config.robot_description_kinematics,
                moveit_config.joint_limits,
                SIM_TIME,
            ],
            condition=IfCondition(LaunchConfiguration('rviz')),
        ),
        Node(
            package='my_robot_arm',
            executable='pick_and_place',
            output='screen',
            parameters=[{
                'color': LaunchConfiguration('color'),
                'place_x': ParameterValue(LaunchConfiguration('place_x'), value_type=float),
                'place_y': ParameterValue(LaunchConfiguration('place_y'), value_type=float),
                **SIM_TIME,
            }],
            condition=IfCondition(LaunchConfiguration('pick')),
        ),
    ]

    return LaunchDescription([*arguments, simulator, *nodes])
