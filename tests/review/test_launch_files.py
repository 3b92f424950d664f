"""What a review says of actions of launch files in Python, XML and YAML, and of functions that make them."""

from __future__ import annotations

import pytest

from tests.repositories import PACKAGE_XML
from tests.review.conftest import breaking, sentences, subject

PYTHON = """from launch import LaunchDescription
from launch.actions import DeclareLaunchArgument, GroupAction, SetEnvironmentVariable
from launch.conditions import IfCondition
from launch.substitutions import LaunchConfiguration
from launch_ros.actions import Node, PushRosNamespace, SetParameter, SetRemap


def generate_launch_description():
    return LaunchDescription([
        DeclareLaunchArgument("mode", default_value="fast", choices=["fast", "slow"]),
        DeclareLaunchArgument("cmd_vel_out", default_value="cmd_vel"),
        DeclareLaunchArgument("front", default_value="true"),
        DeclareLaunchArgument("back", default_value="true"),
        SetEnvironmentVariable("GZ_SIM_RESOURCE_PATH", "models"),
        GroupAction(condition=IfCondition(LaunchConfiguration("front")), actions=[
            PushRosNamespace("front"),
            SetRemap("scan", "scan_front"),
            SetParameter("use_sim_time", True),
            Node(package="lidar", executable="driver"),
            Node(package="lidar", executable="filter", parameters=[{"range": {"min": 1}}, "filter.yaml"]),
        ]),
        Node(package="arm", executable="teleop", remappings=[("joy", "arm/joy")]),
        Node(package="ros_gz_sim", executable="create", name="create"),
        Node(package="controller_manager", executable="spawner", arguments=["arm_controller", "-v"]),
        Node(package="tf2_ros", executable="static_transform_publisher",
             arguments=["--frame-id", "base", "--child-frame-id", "lidar"]),
    ])
"""
XML = """<launch>
  <arg name="real" default="true"/>
  <arg name="ur" default="ur5"/>
  <env name="ROBOT" value="arm"/>
  <remap from="scan" to="front/scan"/>
  <rosparam command="load" file="drive.yaml"/>
  <param name="use_sim_time" value="true"/>
  <group ns="left" if="$(arg real)">
    <node pkg="arm" type="driver.py" name="driver"/>
    <include file="other.launch"><arg name="ur" default="$(arg ur)"/></include>
  </group>
</launch>
"""
YAML = """launch:
- arg: {name: real, default: "true"}
- node:
    pkg: arm
    exec: driver
    if: $(var real)
    param:
    - {name: rate, value: "10"}
    remap:
    - {from: cmd, to: arm/cmd}
- group:
  - push_ros_namespace: {namespace: left}
  - include:
      file: other.launch.yaml
      arg:
      - {name: speed, value: "1"}
"""


@pytest.fixture
def changes_of(repository, compare):
    """Review a replacement in a launch file, and return the sentences of all changes and of the breaking ones."""

    def run(name: str, text: str, old: str, new: str):
        assert old in text
        repository.commit({f"arm/launch/{name}": text})
        repository.write({f"arm/launch/{name}": text.replace(old, new)})
        result = compare(repository)
        return [sentence for each in result.subjects for sentence in sentences(each)], breaking(result)

    return run


@pytest.mark.parametrize(
    ("old", "new", "expected", "is_breaking"),
    [
        ('"front")), actions', '"back")), actions',
         ("remapping of 'scan' for all nodes, parameter 'use_sim_time' of all nodes, node 'lidar/driver', "
          "node 'lidar/filter': condition if $(var front) -> if $(var back)"), False),
        ('PushRosNamespace("front")', 'PushRosNamespace("back")',
         "node 'lidar/driver', node 'lidar/filter': namespace front -> back", True),
        ('"scan_front"', '"scan_back"', "remapping of 'scan' for all nodes: to scan_front -> scan_back", True),
        ('"use_sim_time", True', '"use_sim_time", False',
         "parameter 'use_sim_time' of all nodes: value True -> False", False),
        ('"models"', '"worlds"', "environment variable 'GZ_SIM_RESOURCE_PATH': value models -> worlds", False),
        ('["fast", "slow"]', '["fast"]', "argument 'mode': choices [fast, slow] -> [fast]", True),
        ('{"min": 1}', '{"min": 2}', "node 'lidar/filter': parameter range.min 1 -> 2", False),
        ('"filter.yaml"', '"other.yaml"', "node 'lidar/filter': parameters [filter.yaml] -> [other.yaml]", False),
        ('("joy", "arm/joy")', '("joy", "arm/joy"), ("cmd_vel", LaunchConfiguration("cmd_vel_out"))',
         "node 'arm/teleop': remapping cmd_vel - -> $(var cmd_vel_out)", False),
        ('("joy", "arm/joy")', '', "node 'arm/teleop': remapping joy arm/joy -> -", True),
        ('        Node(package="ros_gz_sim", executable="create", name="create"),\n', "",
         "node 'ros_gz_sim/create' removed", False),
        ('        Node(package="controller_manager", executable="spawner", arguments=["arm_controller", "-v"]),\n',
         "", "node 'controller_manager/spawner' of 'arm_controller' removed", True),
        ('"--child-frame-id", "lidar"', '"--child-frame-id", "laser"',
         ("node 'tf2_ros/static_transform_publisher' of 'laser': "
          "arguments [--frame-id, base, --child-frame-id, lidar] -> [--frame-id, base, --child-frame-id, laser]"),
         True),
    ],
)  # fmt: skip
def test_actions_in_python_are_compared(changes_of, old, new, expected, is_breaking):
    found, found_breaking = changes_of("arm.launch.py", PYTHON, old, new)
    assert found == [expected]
    assert bool(found_breaking) is is_breaking


@pytest.mark.parametrize(
    ("old", "new"),
    [
        ('("joy", "arm/joy")', '("joy", "arm/joy"), ("cmd_vel", "cmd_vel")'),
        ("def generate_launch_description():\n", "def generate_launch_description():\n    front = 'front'\n"),
        ('Node(package="arm", executable="teleop"', 'Node(executable="teleop", package="arm"'),
        ("from launch_ros.actions import Node, ", "import os\nfrom launch_ros.actions import Node, "),
    ],
)
def test_refactored_python_is_no_change(changes_of, old, new):
    assert changes_of("arm.launch.py", PYTHON, old, new) == ([], [])


def test_namespace_of_each_node_is_that_of_a_group(changes_of):
    old = """            PushRosNamespace("front"),
            SetRemap("scan", "scan_front"),
            SetParameter("use_sim_time", True),
            Node(package="lidar", executable="driver"),
            Node(package="lidar", executable="filter", """
    new = """            SetRemap("scan", "scan_front"),
            SetParameter("use_sim_time", True),
            Node(package="lidar", executable="driver", namespace="front"),
            Node(package="lidar", executable="filter", namespace="front", """
    assert changes_of("arm.launch.py", PYTHON, old, new) == ([], [])


def test_difference_at_the_end_of_a_long_value_is_shown(changes_of):
    text = PYTHON.replace('"filter.yaml"', f"build(text='{'x' * 2000}', gain=1)")
    (sentence,), _ = changes_of("arm.launch.py", text, "gain=1", "gain=2")
    assert len(sentence) < 300
    assert "gain=1" in sentence
    assert "gain=2" in sentence


def test_other_code_is_reported_besides_actions(changes_of):
    text = PYTHON.replace("    return Launch", "    print('starting')\n    return Launch")
    changed = text.replace('"models"', '"worlds"').replace("'starting'", "'started'")
    found, _ = changes_of("arm.launch.py", text, text, changed)
    assert found[1:] == ["other code: print('starting') -> print('started')"]


def test_launch_file_with_name_of_a_test_is_compared(changes_of):
    found, _ = changes_of("test_arm.launch.py", PYTHON, '"models"', '"worlds"')
    assert len(found) == 1


@pytest.mark.parametrize(
    ("old", "new", "expected", "is_breaking"),
    [
        ('if="$(arg real)"', 'unless="$(arg real)"',
         "node 'arm/driver.py', include of 'other.launch': condition if $(arg real) -> unless $(arg real)", True),
        ('ns="left"', 'ns="right"', "node 'arm/driver.py': namespace left -> right", True),
        ('to="front/scan"', 'to="back/scan"', "remapping of 'scan' for all nodes: to front/scan -> back/scan", True),
        ('  <rosparam command="load" file="drive.yaml"/>\n', "", "parameters of 'drive.yaml' removed", False),
        ('"use_sim_time" value="true"', '"use_sim_time" value="false"',
         "parameter 'use_sim_time' of all nodes: value true -> false", False),
        ('"ROBOT" value="arm"', '"ROBOT" value="leg"', "environment variable 'ROBOT': value arm -> leg", False),
        ('<arg name="ur" default="$(arg ur)"/>', '<arg name="ur" default="ur10"/>',
         "include of 'other.launch': ur $(arg ur) -> ur10", False),
    ],
)  # fmt: skip
def test_actions_in_xml_are_compared(changes_of, old, new, expected, is_breaking):
    found, found_breaking = changes_of("arm.launch", XML, old, new)
    assert expected in found
    assert bool(found_breaking) is is_breaking


@pytest.mark.parametrize(
    ("old", "new", "expected", "is_breaking"),
    [
        ("if: $(var real)", "unless: $(var real)",
         "node 'arm/driver': condition if $(var real) -> unless $(var real)", True),
        ('"10"', '"20"', "node 'arm/driver': parameter rate 10 -> 20", False),
        ("to: arm/cmd", "to: cmd_vel", "node 'arm/driver': remapping cmd arm/cmd -> cmd_vel", True),
        ("namespace: left", "namespace: right",
         "include of 'other.launch.yaml': namespace of its nodes left -> right", True),
        ('value: "1"', 'value: "2"', "include of 'other.launch.yaml': speed 1 -> 2", False),
        ('- arg: {name: real, default: "true"}\n', "", "argument 'real' removed", True),
    ],
)  # fmt: skip
def test_actions_in_yaml_are_compared(changes_of, old, new, expected, is_breaking):
    found, found_breaking = changes_of("arm.launch.yaml", YAML, old, new)
    assert found == [expected]
    assert bool(found_breaking) is is_breaking


MIXIN = """from launch.actions import DeclareLaunchArgument
from launch_ros.actions import Node


class ArmMixin:
    @staticmethod
    def arg_frame():
        return DeclareLaunchArgument(name="frame", default_value="base")

    @staticmethod
    def node_driver(rate, **kwargs):
        return Node(package="arm", executable="driver", parameters=[{"rate": rate}], **kwargs)
"""
CALLER = """from arm import ArmMixin
from launch import LaunchDescription
from launch.conditions import IfCondition
from other_package import node_camera


class Mixin(ArmMixin):
    pass


def generate_launch_description():
    ld = LaunchDescription()
    ld.add_action(Mixin.arg_frame())
    ld.add_action(Mixin.node_driver(rate=10, condition=IfCondition("a")))
    ld.add_action(node_camera("left"))
    return ld
"""
PACKAGE = {
    "arm/package.xml": PACKAGE_XML.replace("arm_description", "arm"),
    "arm/arm/__init__.py": "from .mixin import ArmMixin\n",
    "arm/arm/mixin.py": MIXIN,
    "arm/launch/arm.launch.py": CALLER,
}


@pytest.mark.parametrize(
    ("old", "new", "expected", "is_breaking"),
    [
        ("    ld.add_action(Mixin.arg_frame())\n", "", "argument 'frame' removed", True),
        ("rate=10", "rate=20", "node 'arm/driver': parameter rate 10 -> 20", False),
        ('IfCondition("a")', 'IfCondition("b")', "node 'arm/driver': condition if a -> if b", False),
        ('"left"', '"right"', "action 'node_camera': arguments [left] -> [right]", False),
    ],
)
def test_actions_of_functions_of_the_repository_are_compared(repository, compare, old, new, expected, is_breaking):
    repository.commit(PACKAGE)
    repository.write({"arm/launch/arm.launch.py": CALLER.replace(old, new)})
    result = compare(repository)
    assert sentences(subject(result, "arm/launch/arm.launch.py")) == [expected]
    assert bool(breaking(result)) is is_breaking


def test_module_with_functions_for_launch_files_is_compared(repository, compare):
    repository.commit(PACKAGE)
    repository.write({"arm/arm/mixin.py": MIXIN.replace('default_value="base"', 'default_value="world"')})
    result = compare(repository)
    assert sentences(subject(result, "arm/arm/mixin.py")) == ["argument 'frame': default base -> world"]
    assert result.other_files == []


LOOPS = """from launch import LaunchDescription
from launch.actions import DeclareLaunchArgument
from launch_ros.actions import Node

PARAMETERS = [{"name": "rate", "default": "10"}, {"name": "port", "default": "tty0"}]


def declare(parameters):
    return [DeclareLaunchArgument(each["name"], default_value=each["default"]) for each in parameters]


def generate_launch_description():
    ld = LaunchDescription(declare(PARAMETERS))
    for side in ["left", "right"]:
        ld.add_action(Node(package="arm", executable="driver", namespace=side))
    return ld
"""


@pytest.mark.parametrize(
    ("old", "new", "expected"),
    [
        ('"tty0"', '"tty1"', "argument 'port': default tty0 -> tty1"),
        (', {"name": "port", "default": "tty0"}', "", "argument 'port' removed"),
        ('["left", "right"]', '["left", "rear"]', "node 'arm/driver': namespace right -> rear"),
        ('["left", "right"]', '["left"]', "node 'arm/driver' removed"),
    ],
)
def test_actions_of_loops_over_lists_are_compared(changes_of, old, new, expected):
    assert changes_of("arm.launch.py", LOOPS, old, new)[0] == [expected]


def test_name_that_is_assigned_again_has_the_value_before_the_action(changes_of):
    text = LOOPS.replace("    ld = Launch", "    side = 'a'\n    side = side + '_arm'\n    ld = Launch")
    text = text.replace('    for side in ["left", "right"]:\n        ld', "    ld")
    found, _ = changes_of("arm.launch.py", text, "side = 'a'", "side = 'b'")
    assert found[0] == "node 'arm/driver': namespace a_arm -> b_arm"


def test_name_with_values_in_branches_stays_a_name(changes_of):
    text = LOOPS.replace(
        'for side in ["left", "right"]:', "side = 'a'\n    if PARAMETERS:\n        side = 'b'\n    if 1:"
    )
    found, _ = changes_of("arm.launch.py", text, "side = 'a'", "side = 'c'")
    assert found == ["other code: side = 'a' -> side = 'c'"]


def test_command_of_a_process_is_a_change(changes_of):
    text = """from launch.actions import ExecuteProcess
def generate_launch_description():
    return LaunchDescription([ExecuteProcess(cmd=["gz", "sim", "-r", "house.sdf"], output="screen")])
"""
    found, _ = changes_of("arm.launch.py", text, "house", "yard")
    assert found == ["process 'gz': command [gz, sim, -r, house.sdf] -> [gz, sim, -r, yard.sdf]"]


@pytest.mark.parametrize(("old", "new"), [("/tf", "tf"), ("tf", "/tf")])
def test_relative_name_is_that_of_the_empty_namespace(changes_of, old, new):
    text = PYTHON.replace('("joy", "arm/joy")', f'("joy", "{old}")')
    assert changes_of("arm.launch.py", text, f'"{old}")', f'"{new}")')[1] == []


def test_controllers_of_a_spawner_come_after_its_options(changes_of):
    arguments = (
        '"--controller-manager-timeout", "60", "--inactive", "arm_controller", "--controller-ros-args", "-r a:=b"'
    )
    text = PYTHON.replace('"arm_controller", "-v"', arguments)
    start = text.index('        Node(package="controller_manager"')
    line = text[start : text.index("\n", start) + 1]
    assert changes_of("arm.launch.py", text, line, "")[0] == [
        "node 'controller_manager/spawner' of 'arm_controller' removed"
    ]


@pytest.mark.parametrize(
    ("old", "new", "expected"),
    [
        ("GZ_SIM_RESOURCE_PATH", "GZ_MODEL_PATH",
         "environment variable 'GZ_SIM_RESOURCE_PATH' replaced by environment variable 'GZ_MODEL_PATH'"),
        ('"ros_gz_sim", executable', '"gz_sim", executable',
         "node 'ros_gz_sim/create' replaced by node 'gz_sim/create'"),
    ],
)  # fmt: skip
def test_action_under_a_new_name_is_replaced(changes_of, old, new, expected):
    assert changes_of("arm.launch.py", PYTHON, old, new) == ([expected], [])


def test_program_of_the_same_package_is_not_a_replacement(changes_of):
    found, found_breaking = changes_of("arm.launch.py", PYTHON, 'executable="teleop"', 'executable="keyboard"')
    assert found == ["node 'arm/keyboard' added", "node 'arm/teleop' removed"]
    assert found_breaking == found[1:]


@pytest.mark.parametrize(
    ("old", "new", "expected", "reason"),
    [
        # The actions that used the old name use the new one.
        ('<arg name="ur" default="ur5"/>', '<arg name="model" default="ur5"/>', "argument 'ur' renamed to 'model'",
         "a value that a caller passes for 'ur' has no effect"),
        ('<arg name="real" default="true"/>', '<arg name="real" default="false"/>',
         "argument 'real': default true -> false", "by default, node 'arm/driver.py' does not start any more"),
        ('<arg name="side" default="left"/>', '<arg name="side" default="right"/>',
         "argument 'side': default left -> right",
         "programs that use the names of the node, its topics or its services do not find them"),
        ('<arg name="urdf" default="arm.urdf"/>', '<arg name="urdf" default="$(dirname)/arm.urdf"/>',
         "argument 'urdf': default arm.urdf -> $(dirname)/arm.urdf",
         "callers that pass the name of a file instead of its path fail"),
        ('<arg name="odom_topic" default="odom"/>', '<arg name="odom_topic" default="wheel_odom"/>',
         "argument 'odom_topic': default odom -> wheel_odom", "programs that use the name 'odom' do not find it"),
        ('<arg name="speed" default="1"/>', '<arg name="speed" default="2"/>',
         "argument 'speed': default 1 -> 2", None),
        ('args="arm_controller"', 'args="hand_controller"',
         "node 'controller_manager/spawner' of 'hand_controller': arguments arm_controller -> hand_controller",
         "the topics and services of arm_controller are missing"),
        ('name="frame_prefix" value=""', 'name="frame_prefix" value="arm/"',
         "node 'robot_state_publisher/robot_state_publisher': parameter frame_prefix '' -> arm/",
         "programs that look up the frames by their old names do not find them"),
        ('name="frame_id" value="laser"', 'name="frame_id" value="lidar"',
         "node 'lidar/driver': parameter frame_id laser -> lidar", "programs that use the name 'laser' do not find it"),
        ('<remap from="scan" to="/lidar/scan"/>', '<remap from="scan" to="/scan"/>',
         "node 'slam_toolbox/slam_node': remapping scan /lidar/scan -> /scan", None),
        ('exec="slam_node"', 'exec="sync_slam_node"',
         "node 'slam_toolbox/slam_node' replaced by node 'slam_toolbox/sync_slam_node'", None),
    ],
)  # fmt: skip
def test_reasons_of_changes_of_names_and_defaults(repository, compare, old, new, expected, reason):
    assert old in DEFAULTS
    new_text = DEFAULTS.replace(old, new)
    if "ur" in old and "model" in new:
        new_text = new_text.replace("$(var ur)", "$(var model)")
    repository.commit({"arm/launch/arm.launch.xml": DEFAULTS})
    repository.write({"arm/launch/arm.launch.xml": new_text})
    (change,) = subject(compare(repository), "arm/launch/arm.launch.xml").changes
    assert str(change.sentence) == expected
    assert (None if change.reason is None else str(change.reason)) == reason


DEFAULTS = """<launch>
  <arg name="real" default="true"/>
  <arg name="ur" default="ur5"/>
  <arg name="side" default="left"/>
  <arg name="urdf" default="arm.urdf"/>
  <arg name="odom_topic" default="odom"/>
  <arg name="speed" default="1"/>
  <node pkg="arm" exec="driver.py" namespace="$(var side)" if="$(var real)"/>
  <node pkg="arm" exec="model" args="--type $(var ur) --speed $(var speed)"/>
  <node pkg="controller_manager" exec="spawner" args="arm_controller"/>
  <node pkg="robot_state_publisher" exec="robot_state_publisher"><param name="frame_prefix" value=""/></node>
  <node pkg="lidar" exec="driver"><param name="frame_id" value="laser"/></node>
  <node pkg="slam_toolbox" exec="slam_node" name="slam"><remap from="scan" to="/lidar/scan"/></node>
</launch>
"""


def test_same_change_of_several_nodes_is_one(changes_of):
    text = DEFAULTS.replace("<node ", '<node respawn="true" ')
    (sentence,), _ = changes_of("arm.launch.xml", text, 'respawn="true"', 'respawn="false"')
    assert sentence.startswith("node 'arm/driver.py', node 'arm/model', node 'controller_manager/spawner' of")
    assert sentence.endswith(" and 2 more: respawn true -> false")


READING = """import os
from launch import LaunchDescription
from launch.actions import DeclareLaunchArgument, IncludeLaunchDescription
from launch.substitutions import LaunchConfiguration, PathJoinSubstitution, ThisLaunchFileDir
from launch_ros.actions import Node

MODEL = os.environ["MODEL"]


def generate_launch_description():
    return LaunchDescription([
        DeclareLaunchArgument("rate", default_value="1"),
        IncludeLaunchDescription(PathJoinSubstitution([ThisLaunchFileDir(), "part.launch.py"])),
        Node(package="arm", executable="driver", name=MODEL, parameters=[{"rate": LaunchConfiguration("rate")}]),
        Node(package="arm", executable="hand"),
    ])
"""
PART = """from launch import LaunchDescription
from launch.actions import DeclareLaunchArgument
from launch_ros.actions import Node


def generate_launch_description():
    return LaunchDescription([DeclareLaunchArgument("speed", default_value="1")])
"""


@pytest.fixture
def changes_with_reasons(repository, compare):
    """Review new texts of two launch files of which one includes the other, and return sentences with their reasons."""

    def run(new: str, new_part: str = PART, old: str = READING):
        repository.commit({"arm/launch/arm.launch.py": old, "arm/launch/part.launch.py": PART})
        repository.write({"arm/launch/arm.launch.py": new, "arm/launch/part.launch.py": new_part})
        subjects = [each for each in compare(repository).subjects if each.path == "arm/launch/arm.launch.py"]
        changes = subjects[0].changes if subjects else []
        return {str(change.sentence): None if change.reason is None else str(change.reason) for change in changes}

    return run


def test_argument_without_default_that_is_not_declared_is_breaking(changes_with_reasons):
    new = READING.replace('executable="hand"', 'executable="hand", name=LaunchConfiguration("n")')
    text = "node 'arm/hand' uses argument 'n', which is not declared"
    assert changes_with_reasons(new)[text] == "the launch file fails if no other file declares 'n'"


def test_argument_of_included_file_is_declared(changes_with_reasons):
    new = READING.replace('executable="hand"', 'executable="hand", respawn=LaunchConfiguration("speed")')
    assert changes_with_reasons(new) == {"node 'arm/hand': respawn - -> $(var speed)": None}


def test_removed_argument_that_is_still_used_fails(changes_with_reasons):
    new = READING.replace('        DeclareLaunchArgument("rate", default_value="1"),\n', "")
    assert changes_with_reasons(new) == {
        "argument 'rate' removed": "the launch file still uses 'rate', and fails if no other file declares it"
    }


def test_node_that_moves_into_included_file_is_moved(changes_with_reasons):
    line = '        Node(package="arm", executable="hand"),\n'
    part = PART.replace("LaunchDescription([", 'LaunchDescription([Node(package="arm", executable="hand"), ')
    assert changes_with_reasons(READING.replace(line, ""), part) == {
        "node 'arm/hand' moved to arm/launch/part.launch.py": None
    }


@pytest.mark.parametrize(
    ("old", "new", "expected", "reason"),
    [
        ('MODEL = os.environ["MODEL"]', 'MODEL = os.environ["MODEL"] + os.environ["SIDE"]',
         "use of environment variable 'SIDE' added", "the launch file fails where 'SIDE' is not set"),
        ('MODEL = os.environ["MODEL"]', 'MODEL = os.environ["MODEL"] + os.environ.get("SIDE", "")',
         "use of environment variable 'SIDE' added", None),
        ('MODEL = os.environ["MODEL"]', 'MODEL = "arm"', "use of environment variable 'MODEL' removed",
         "a value that a user sets for 'MODEL' has no effect"),
        ('"rate", default_value="1"),', '"rate", default_value="1"), DeclareLaunchArgument("side"),',
         "argument 'side' added", "callers must pass 'side'"),
        ('"rate", default_value="1"),', '"rate", default_value="1"), DeclareLaunchArgument("side", default_value="l"),',
         "argument 'side' added: default l", None),
    ],
)  # fmt: skip
def test_environment_variables_and_required_arguments(changes_with_reasons, old, new, expected, reason):
    assert changes_with_reasons(READING.replace(old, new))[expected] == reason


def test_removed_remappings_and_added_parameters_of_a_node_are_one_change_each(changes_with_reasons):
    node = 'Node(package="arm", executable="hand"'
    old = READING.replace(node, f'{node}, remappings=[("a", "arm/a"), ("b", "arm/b"), ("c", "arm/c")]')
    new = READING.replace(node, f'{node}, parameters=[{{"x": 1, "y": 2, "z": 3}}]')
    assert changes_with_reasons(new, old=old) == {
        "node 'arm/hand': parameters added: x 1, y 2, z 3": None,
        "node 'arm/hand': remappings removed: a -> arm/a, b -> arm/b, c -> arm/c": (
            "programs that use the name 'arm/a, arm/b, arm/c' do not find it"
        ),
    }


def test_other_name_of_a_parameter_of_a_function_is_no_change(changes_with_reasons):
    text = READING + "\n\ndef talk(word, count):\n    print(word * count)\n"
    assert changes_with_reasons(text.replace("word", "text"), old=text) == {}


def test_added_code_is_one_line(changes_with_reasons):
    new = READING.replace("    return", "    for word in ('a', 'b'):\n        print(word)\n    print('c')\n    return")
    assert changes_with_reasons(new) == {"other code added: for word in ('a', 'b'): ... and 2 more statements": None}


def test_added_launch_file_is_described_by_its_actions(repository, compare):
    repository.commit({"arm/launch/arm.launch.py": READING})
    repository.write({"arm/launch/part.launch.py": PYTHON})
    (sentence,) = sentences(subject(compare(repository), "arm/launch/part.launch.py"))
    assert sentence.startswith("launch file added: node 'lidar/driver', node 'lidar/filter', node 'arm/teleop'")


def test_launch_file_in_another_format_is_compared_with_the_old_one(repository, compare):
    repository.commit({"arm/launch/arm.launch.py": PART})
    repository.git("rm", "--quiet", "arm/launch/arm.launch.py")
    text = '<launch><arg name="speed" default="2"/></launch>'
    repository.write({"arm/launch/arm.launch.xml": text})
    result = compare(repository)
    assert sentences(subject(result, "arm/launch/arm.launch.xml")) == [
        "renamed from arm/launch/arm.launch.py",
        "argument 'speed': default 1 -> 2",
    ]
    assert breaking(result) == ["renamed from arm/launch/arm.launch.py"]


def test_include_of_renamed_file_is_replaced(repository, compare):
    repository.commit({"arm/launch/arm.launch.py": READING, "arm/launch/part.launch.py": PART})
    repository.git("mv", "arm/launch/part.launch.py", "arm/launch/joints.launch.py")
    repository.write({"arm/launch/arm.launch.py": READING.replace("part.launch.py", "joints.launch.py")})
    assert sentences(subject(compare(repository), "arm/launch/arm.launch.py")) == [
        "include of '$(dirname)/part.launch.py' replaced by include of '$(dirname)/joints.launch.py'"
    ]


@pytest.mark.parametrize(
    ("old", "new"),
    [
        ('FindPackageShare("arm"), "a.yaml"])', 'PathSubstitution(FindPackageShare("arm")) / "a.yaml")'),
        ('FindExecutable(name="xacro"), " arm.urdf"', '"xacro arm.urdf"'),
    ],
)
def test_other_notation_of_a_path_or_command_is_no_change(changes_of, old, new):
    text = """def generate_launch_description():
    return LaunchDescription([
        Node(package="arm", executable="driver", parameters=[
            {"file": PathJoinSubstitution([FindPackageShare("arm"), "a.yaml"])},
            {"robot_description": Command([FindExecutable(name="xacro"), " arm.urdf"])},
        ]),
    ])
"""
    before = "PathJoinSubstitution([" if "yaml" in old else ""
    assert changes_of("arm.launch.py", text, before + old, ("(" if before else "") + new) == ([], [])


def test_action_that_is_appended_to_a_list_is_no_other_code(changes_of):
    text = """def generate_launch_description():
    actions = [Node(package="arm", executable="driver")]
    actions.append(Node(package="arm", executable="hand"))
    return LaunchDescription(actions)
"""
    found, _ = changes_of(
        "arm.launch.py", text, "    return", "    actions.append(Node(package='a', executable='b'))\n    return"
    )
    assert found == ["node 'a/b' added"]


def test_removed_include_stops_its_nodes(changes_with_reasons):
    line = '        IncludeLaunchDescription(PathJoinSubstitution([ThisLaunchFileDir(), "part.launch.py"])),\n'
    assert changes_with_reasons(READING.replace(line, "")) == {
        "include of '$(dirname)/part.launch.py' removed": "its nodes do not start any more"
    }


UNUSED = """import os
from launch import LaunchDescription
from launch.actions import EmitEvent, RegisterEventHandler
from launch.event_handlers import OnProcessExit
from launch.substitutions import LaunchConfiguration
from launch_ros.actions import Node


def generate_launch_description():
    speed = LaunchConfiguration("speed", default="1")
    driver = Node(package="arm", executable="driver", parameters=[{"speed": speed}])
    hand = Node(package="arm", executable="hand", name="hand", arguments=["a" + "/b", os.path.join("c", "d") + "/e"])
    return LaunchDescription([
        driver,
        hand,
        RegisterEventHandler(OnProcessExit(target_action=driver, on_exit=[EmitEvent()])),
    ])
"""


@pytest.mark.parametrize(
    ("old", "new", "expected", "is_breaking"),
    [
        ("        hand,\n", "", ["node 'arm/hand' removed"], True),
        ('"a" + "/b", os.path.join("c", "d") + "/e"', '"a/b", "c/d/e"', [], False),
        (', name="hand"', "", ["node 'arm/hand': name hand -> -"], False),
        ("target_action=driver", "target_action=hand",
         ["event handler OnProcessExit of arm/hand added", "event handler OnProcessExit of arm/driver removed"], False),
        ("on_exit=[EmitEvent()]", "on_exit=[hand]",
         ["event handler OnProcessExit of arm/driver: on_exit [EmitEvent] -> [arm/hand]"], False),
        ('{"speed": speed}', '{"speed": 1}',
         ["node 'arm/driver': parameter speed $(var speed 1) -> 1"], False),
        ('speed = LaunchConfiguration("speed", default="1")', "speed = 1",
         ["node 'arm/driver': parameter speed $(var speed 1) -> 1"], False),
    ],
)  # fmt: skip
def test_only_what_is_used_is_compared(changes_of, old, new, expected, is_breaking):
    found, found_breaking = changes_of("arm.launch.py", UNUSED, old, new)
    assert found == expected
    assert bool(found_breaking) is is_breaking


def test_argument_that_is_used_without_being_declared_is_removed(changes_of):
    text = (
        UNUSED.replace('"speed": speed', '"rate": speed').replace("speed = L", "rate = L").replace(": speed", ": rate")
    )
    new = text.replace('LaunchConfiguration("speed", default="1")', "1")
    found, found_breaking = changes_of("arm.launch.py", text, text, new)
    assert found == ["node 'arm/driver': parameter rate $(var speed 1) -> 1", "argument 'speed' removed"]
    assert found_breaking == found[1:]


def test_node_that_moves_to_another_launch_file_is_missing_where_it_was(changes_with_reasons):
    part = PART.replace("LaunchDescription([", 'LaunchDescription([Node(package="arm", executable="hand"), ')
    alone = READING.replace('PathJoinSubstitution([ThisLaunchFileDir(), "part.launch.py"])', '"other.launch.py"')
    new = alone.replace('        Node(package="arm", executable="hand"),\n', "")
    assert changes_with_reasons(new, part, old=alone) == {
        "node 'arm/hand' moved to arm/launch/part.launch.py": "the topics and services of the node are missing"
    }


def test_items_of_lists_are_split_outside_of_parentheses(changes_of):
    text = """def generate_launch_description():
    return LaunchDescription([Node(package="a", executable="b", arguments=[f(1, 2), "c", "d", "e", "f"])])
"""
    found, _ = changes_of("arm.launch.py", text, "f(1, 2)", "f(1, 3)")
    assert found == ["node 'a/b': arguments: f(1, 3) added, f(1, 2) removed"]


def test_delay_of_a_timer_is_compared(changes_of):
    text = """def generate_launch_description():
    hand = Node(package="arm", executable="hand")
    return LaunchDescription([TimerAction(period=3.0, actions=[hand])])
"""
    found, _ = changes_of("arm.launch.py", text, "3.0", "5.0")
    assert found == ["node 'arm/hand': condition after 3.0 s -> after 5.0 s"]


def test_same_notations_in_python_and_xml(repository, compare):
    python = """def generate_launch_description():
    share = get_package_share_directory("arm")
    return LaunchDescription([
        DeclareLaunchArgument("model", default_value=[share, "/arm.urdf"]),
        Node(package="arm", executable="hand", prefix="xterm -e", parameters=[
            LaunchConfiguration("file"),
            {"robot_description": Command(["xacro ", LaunchConfiguration("model")])},
        ]),
    ])
"""
    xml = """<launch>
  <arg name="model" default="$(find-pkg-share arm)/arm.urdf"/>
  <node pkg="arm" exec="hand" launch-prefix="xterm -e">
    <param from="$(var file)"/>
    <param name="robot_description" value="$(command 'xacro $(var model)')"/>
  </node>
</launch>
"""
    repository.commit({"arm/launch/arm.launch.py": python})
    repository.git("rm", "--quiet", "arm/launch/arm.launch.py")
    repository.write({"arm/launch/arm.launch.xml": xml})
    assert sentences(subject(compare(repository), "arm/launch/arm.launch.xml")) == [
        "renamed from arm/launch/arm.launch.py"
    ]


def test_prefix_of_frames_that_is_unknown_is_not_breaking(changes_of):
    text = """def generate_launch_description():
    return LaunchDescription([
        Node(package="robot_state_publisher", executable="robot_state_publisher", parameters=[{}]),
    ])
"""
    found, found_breaking = changes_of("arm.launch.py", text, "{}", '{"frame_prefix": Mixin.prefix()}')
    assert (len(found), found_breaking) == (1, [])
