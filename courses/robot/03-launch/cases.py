from linkwright.learning import Edit, right, wrong

PACKAGE = "src/my_robot_description/"
LAUNCH, RVIZ = PACKAGE + "launch/display.launch.py", PACKAGE + "rviz/urdf.rviz"
XML, SETUP = PACKAGE + "package.xml", PACKAGE + "setup.py"

WITH_XACRO_MODULE = """import xacro
from ament_index_python.packages import get_package_share_directory
from launch import LaunchDescription
from launch_ros.actions import Node


def generate_launch_description():
    share = get_package_share_directory('my_robot_description')
    urdf = xacro.process_file(share + '/urdf/mbot_base.xacro').toxml()
    state_publisher = Node(
        package='robot_state_publisher',
        executable='robot_state_publisher',
        parameters=[{'robot_description': urdf}],
    )
    description = LaunchDescription()
    description.add_action(state_publisher)
    description.add_action(Node(package='joint_state_publisher', executable='joint_state_publisher'))
    return description
"""

WITH_GLOB = """from glob import glob

from setuptools import setup

package_name = 'my_robot_description'
share = 'share/' + package_name

setup(
    name=package_name,
    version='0.0.0',
    packages=[package_name],
    data_files=[
        ('share/ament_index/resource_index/packages', ['resource/' + package_name]),
        (share, ['package.xml']),
        (share + '/launch', glob('launch/*.launch.py')),
        (share + '/rviz', glob('rviz/*')),
        (share + '/urdf', glob('urdf/*')),
    ],
    install_requires=['setuptools'],
    zip_safe=True,
    maintainer='learner',
    maintainer_email='learner@example.org',
    description='mbot, a small two-wheeled robot',
    license='MIT',
)
"""

CASES = [
    wrong(
        "publisher",
        "a file with another ending",
        {LAUNCH: None, PACKAGE + "launch/display.py": WITH_XACRO_MODULE},
        says="it has 'launch/display.py'",
    ),
    wrong(
        "publisher",
        "a missing import",
        Edit(LAUNCH, "from launch_ros.actions import Node\n", ""),
        says="import it from 'launch_ros.actions'",
    ),
    wrong(
        "publisher",
        "a misspelled executable",
        Edit(LAUNCH, "executable='robot_state_publisher'", "executable='state'"),
        says="no executable 'state'",
    ),
    wrong(
        "joints",
        "the same name twice",
        Edit(
            LAUNCH,
            "executable='joint_state_publisher'",
            "executable='joint_state_publisher', name='robot_state_publisher'",
        ),
        says="two nodes have the name",
    ),
    wrong(
        "rviz", "another topic", Edit(RVIZ, "Value: /robot_description", "Value: /robot_model"), says="is /robot_model"
    ),
    wrong("rviz", "a full-width colon", Edit(RVIZ, "Fixed Frame: base", "Fixed Frame：base"), says="full-width colon"),
    wrong("rviz", "no -d", Edit(LAUNCH, "arguments=['-d', ", "arguments=["), says="rviz2 needs two arguments"),
    wrong("argument", "an f-string", Edit(LAUNCH, "['xacro ', model]", "[f'xacro {model}']"), says="or an f-string"),
    wrong("install", "no star", Edit(SETUP, "*shared_files()", "shared_files()"), says="write a star"),
    wrong(
        "install",
        "package.xml is left out",
        Edit(SETUP, "(str(share), ['package.xml']),", ""),
        says="does not install 'package.xml'",
    ),
    right("publisher", "with the module xacro", {LAUNCH: WITH_XACRO_MODULE}),
    right("joints", "with the module xacro", {LAUNCH: WITH_XACRO_MODULE}),
    wrong("publisher", "no space after xacro", Edit(LAUNCH, "'xacro '", "'xacro'"), says="display.launch.py"),
    wrong(
        "publisher",
        "the robot of the first lesson",
        Edit(LAUNCH, "mbot_base.xacro", "mbot_base.urdf"),
        says="no base_footprint",
    ),
    wrong(
        "publisher",
        "a misspelled package",
        Edit(LAUNCH, "package='robot_state_publisher'", "package='robot_state_publishr'"),
        says="robot_state_publishr",
    ),
    wrong(
        "publisher",
        "a misspelled import",
        Edit(LAUNCH, "from launch import LaunchDescription", "from launch import LaunchDescripton"),
        says="LaunchDescripton",
    ),
    wrong(
        "publisher",
        "a file in the wrong folder",
        {LAUNCH: None, PACKAGE + "display.launch.py": WITH_XACRO_MODULE},
        says="no file 'launch/display.launch.py'",
    ),
    wrong(
        "publisher",
        "a missing file",
        Edit(LAUNCH, "'urdf' / 'mbot_base.xacro'", "'urdf' / 'mbot_bas.xacro'"),
        says="mbot_bas.xacro",
    ),
    wrong(
        "joints",
        "the node is missing",
        Edit(LAUNCH, "        Node(package='joint_state_publisher', executable='joint_state_publisher'),\n", ""),
        says="no node publishes '/joint_states'",
    ),
    right("rviz", "another view", Edit(RVIZ, "Distance: 1.7", "Distance: 3")),
    wrong(
        "rviz",
        "the robot of a file",
        Edit(RVIZ, "Description Source: Topic", "Description Source: File"),
        says="is File, but should be Topic",
    ),
    wrong(
        "rviz",
        "a topic without its line",
        Edit(RVIZ, "      Description Topic:\n        Value: /robot_description\n", ""),
        says="has no Description Topic",
    ),
    wrong(
        "rviz",
        "a topic in the line above",
        Edit(RVIZ, "Description Topic:\n        Value: /robot", "Description Topic: /robot"),
        says="write 'Value: /robot_description' below it",
    ),
    wrong(
        "rviz",
        "another fixed frame",
        Edit(RVIZ, "Fixed Frame: base_footprint", "Fixed Frame: map"),
        says="fixed frame is 'map'",
    ),
    wrong(
        "rviz",
        "no robot",
        Edit(RVIZ, "rviz_default_plugins/RobotModel", "rviz_default_plugins/Axes"),
        says="no RobotModel display",
    ),
    wrong(
        "rviz",
        "wrong indentation",
        Edit(RVIZ, "  Displays:\n    - Class", "    Displays:\n  - Class"),
        says="compare the indentation",
    ),
    wrong(
        "argument",
        "a fixed robot",
        Edit(LAUNCH, "['xacro ', model]", "['xacro ', str(package / 'urdf' / 'mbot_base.xacro')]"),
        says="still that of mbot_base.xacro",
    ),
    wrong(
        "argument",
        "no declaration",
        Edit(LAUNCH, "DeclareLaunchArgument('model',", "DeclareLaunchArgument('modell',"),
        says="model",
    ),
    right("dependencies", "as <depend>", Edit(XML, "<exec_depend>rviz2</exec_depend>", "<depend>rviz2</depend>")),
    wrong(
        "dependencies",
        "a build dependency",
        Edit(XML, "<exec_depend>rviz2</exec_depend>", "<build_depend>rviz2</build_depend>"),
        says="does not list 'rviz2'",
    ),
    wrong(
        "dependencies",
        "a missing line",
        Edit(XML, "  <exec_depend>launch_ros</exec_depend>\n", ""),
        says="does not list 'launch_ros'",
    ),
    wrong(
        "install", "a folder is missing", Edit(SETUP, "['launch', 'rviz', 'urdf']", "['launch', 'urdf']"), says="rviz"
    ),
    right("install", "with glob", {SETUP: WITH_GLOB}),
    wrong(
        "install",
        "no folders",
        {SETUP: WITH_GLOB.replace("share + '/launch'", "share")},
        says="does not install 'launch/",
    ),
    wrong("install", "a mistake in setup.py", Edit(SETUP, "Path(top)", "Pth(top)"), says="Pth"),
]
