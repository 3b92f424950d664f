from ament_index_python.packages import get_package_share_path
from launch import LaunchDescription
from launch.actions import DeclareLaunchArgument, IncludeLaunchDescription
from launch.conditions import IfCondition
from launch.launch_description_sources import PythonLaunchDescriptionSource
from launch.substitutions import LaunchConfiguration, PythonExpression
from launch_ros.actions import Node
from launch_ros.parameter_descriptions import ParameterValue


def generate_launch_description():
    mbot = get_package_share_path('my_worlds') / 'launch' / 'load_mbot.launch.py'
    commands = get_package_share_path('my_voice') / 'config' / 'commands.yaml'
    words, wav = LaunchConfiguration('words'), LaunchConfiguration('wav')

    return LaunchDescription([
        DeclareLaunchArgument('words', default_value='',
                              description='A file of enrolled words; empty for your own'),
        DeclareLaunchArgument('wav', default_value='',
                              description='A recording instead of the microphone'),
        IncludeLaunchDescription(PythonLaunchDescriptionSource(str(mbot))),
        Node(package='my_robot_voice', executable='voice_commander', output='screen',
             parameters=[{'use_sim_time': True, 'engine': 'enrolled', 'open_listening': True,
                          'commands_file': str(commands),
                          'words_file': ParameterValue(words, value_type=str)}]),
        Node(package='my_robot_voice', executable='audio_capture', output='screen',
             parameters=[{'use_sim_time': True, 'file': ParameterValue(wav, value_type=str)}],
             condition=IfCondition(PythonExpression(["'", wav, "' != ''"]))),
        Node(package='my_voice', executable='goal_sender', parameters=[{'use_sim_time': True}]),
    ])
