# SPDX-License-Identifier: Apache-2.0
"""Show one of mbot's URDF models in RViz; another one with model:=/path/to/model.urdf."""

from ament_index_python.packages import get_package_share_path
from launch import LaunchDescription
from launch.actions import DeclareLaunchArgument
from launch.conditions import IfCondition, UnlessCondition
from launch.substitutions import Command, LaunchConfiguration
from launch_ros.actions import Node
from launch_ros.parameter_descriptions import ParameterValue


def generate_launch_description():
    """Return the arguments of this launch file and the nodes that it starts."""
    package = get_package_share_path('my_robot_description')

    gui = LaunchConfiguration('gui')
    model = LaunchConfiguration('model')
    rvizconfig = LaunchConfiguration('rvizconfig')

    arguments = [
        DeclareLaunchArgument(
            'gui',
            default_value='false',
            choices=['true', 'false'],
            description='Whether to show a slider for every joint',
        ),
        DeclareLaunchArgument(
            'model',
            default_value=str(package / 'urdf' / 'mbot_base.urdf'),
            description='The robot to show: path of a URDF or xacro file',
        ),
        DeclareLaunchArgument(
            'rvizconfig',
            default_value=str(package / 'rviz' / 'urdf.rviz'),
            description='What RViz shows and from where: path of an .rviz file',
        ),
    ]

    # The blank after xacro separates the command from its argument. ParameterValue says that the result is text;
    # without it, launch would try to read the URDF as YAML.
    robot_description = ParameterValue(Command(['xacro ', model]), value_type=str)

    nodes = [
        # Joint positions come from one of these two: all at zero, or from the sliders.
        Node(
            package='joint_state_publisher',
            executable='joint_state_publisher',
            condition=UnlessCondition(gui),
        ),
        Node(
            package='joint_state_publisher_gui',
            executable='joint_state_publisher_gui',
            condition=IfCondition(gui),
        ),
        # Joint positions and the description together give the transform of every link.
        Node(
            package='robot_state_publisher',
            executable='robot_state_publisher',
            parameters=[{'robot_description': robot_description}],
        ),
        Node(
            package='rviz2',
            executable='rviz2',
            name='rviz2',
            output='screen',
            arguments=['-d', rvizconfig],
        ),
    ]

    return LaunchDescription([*arguments, *nodes])
