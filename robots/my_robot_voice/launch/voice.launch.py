# SPDX-License-Identifier: Apache-2.0
"""mbot does what it is told: a world, mbot in it, and the node that hears commands.

Hold the button of the Voice panel in the page and speak. With wav:=FILE a recording is heard in place of a microphone,
and with navigation:=true mbot is in the house and goes to its rooms.
"""

from ament_index_python.packages import get_package_share_path
from launch import LaunchDescription
from launch.actions import DeclareLaunchArgument, IncludeLaunchDescription
from launch.conditions import IfCondition, UnlessCondition
from launch.launch_description_sources import PythonLaunchDescriptionSource
from launch.substitutions import LaunchConfiguration, PythonExpression
from launch_ros.actions import Node
from launch_ros.parameter_descriptions import ParameterValue


def generate_launch_description():
    """Return the simulation and the node; arguments of the simulation can be given here, too."""
    gazebo = get_package_share_path('my_robot_gazebo')
    navigation = get_package_share_path('my_robot_navigation')
    voice = get_package_share_path('my_robot_voice')
    wav, in_house = LaunchConfiguration('wav'), LaunchConfiguration('navigation')
    has_wav = PythonExpression(["'", wav, "' != ''"])

    def text(name):
        return ParameterValue(LaunchConfiguration(name), value_type=str)

    def included(path, **more):
        return IncludeLaunchDescription(PythonLaunchDescriptionSource(str(path)), **more)

    return LaunchDescription(
        [
            DeclareLaunchArgument(
                'engine',
                default_value='enrolled',
                description='What recognizes speech: enrolled (words that you have said), vosk, pocketsphinx',
            ),
            DeclareLaunchArgument('language', default_value='en', description='The language that is spoken: en or zh'),
            DeclareLaunchArgument(
                'model', default_value='', description='Model of the engine: path of a folder or file; its own if empty'
            ),
            DeclareLaunchArgument(
                'words_file', default_value='', description='Enrolled words: path of a file; your own if empty'
            ),
            DeclareLaunchArgument(
                'commands_file',
                default_value=str(voice / 'config' / 'commands.yaml'),
                description='What mbot can be told: path of a YAML file',
            ),
            DeclareLaunchArgument(
                'open_listening',
                default_value='false',
                choices=['true', 'false'],
                description='Listen all the time, not only while the button is held',
            ),
            DeclareLaunchArgument(
                'wav', default_value='', description='A recording that is heard: path of a .wav file'
            ),
            DeclareLaunchArgument(
                'navigation',
                default_value='false',
                choices=['true', 'false'],
                description='Be in the house, with nav2, to go to places',
            ),
            included(
                gazebo / 'launch' / 'load_mbot_into_gazebo.launch.py', condition=UnlessCondition(in_house)
            ),
            included(navigation / 'launch' / 'navigation.launch.py', condition=IfCondition(in_house)),
            Node(
                package='my_robot_voice',
                executable='voice_commander',
                output='screen',
                parameters=[
                    {
                        'use_sim_time': True,
                        'engine': text('engine'),
                        'language': text('language'),
                        'model': text('model'),
                        'words_file': text('words_file'),
                        'commands_file': text('commands_file'),
                        # A recording has no button.
                        'open_listening': ParameterValue(
                            PythonExpression([has_wav, " or '", LaunchConfiguration('open_listening'), "' == 'true'"]),
                            value_type=bool,
                        ),
                    }
                ],
            ),
            Node(
                package='my_robot_voice',
                executable='audio_capture',
                output='screen',
                parameters=[{'use_sim_time': True, 'file': text('wav')}],
                condition=IfCondition(has_wav),
            ),
        ]
    )
