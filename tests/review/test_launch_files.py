"""Changes of launch actions in Python, XML and YAML in a review.

Functions that create actions are compared, too.
"""

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


@pytest.mark.parametrize(
    ("old", "new", "expected", "is_breaking"),
    [
        ('"front")), actions', '"back")), actions',
         ("remapping of 'scan' for the nodes that follow, parameter 'use_sim_time' of the nodes that follow, "
          "node 'lidar/driver', node 'lidar/filter': condition if $(var front) -> if $(var back)"), False),
        ('PushRosNamespace("front")', 'PushRosNamespace("back")',
         "node 'lidar/driver', node 'lidar/filter': namespace front -> back", True),
        ('"scan_front"', '"scan_back"',
         "remapping of 'scan' for the nodes that follow: to scan_front -> scan_back", True),
        ('"use_sim_time", True', '"use_sim_time", False',
         "parameter 'use_sim_time' of the nodes that follow: value True -> False", False),
        ('"models"', '"worlds"', "environment variable 'GZ_SIM_RESOURCE_PATH': value models -> worlds", False),
        ('["fast", "slow"]', '["fast"]', "argument 'mode': choices [fast, slow] -> [fast]", True),
        ('{"min": 1}', '{"min": 2}', "node 'lidar/filter': parameter range.min 1 -> 2", False),
        ('"filter.yaml"', '"other.yaml"', "node 'lidar/filter': parameters [filter.yaml] -> [other.yaml]", False),
        ('("joy", "arm/joy")', '("joy", "arm/joy"), ("cmd_vel", LaunchConfiguration("cmd_vel_out"))',
         "node 'arm/teleop': remapping cmd_vel $(var cmd_vel_out) added", False),
        ('("joy", "arm/joy")', '', "node 'arm/teleop': remapping joy arm/joy removed", True),
        ('        Node(package="ros_gz_sim", executable="create", name="create"),\n', "",
         "node 'ros_gz_sim/create' removed: name create", True),
        ('        Node(package="controller_manager", executable="spawner", arguments=["arm_controller", "-v"]),\n',
         "", "node 'controller_manager/spawner' of 'arm_controller' removed: arguments [arm_controller, -v]", True),
        ('"--child-frame-id", "lidar"', '"--child-frame-id", "laser"',
         "node 'tf2_ros/static_transform_publisher' of 'laser': child frame 'lidar' -> 'laser'", True),
    ],
)  # fmt: skip
def test_actions_in_python_are_compared(review_changes, old, new, expected, is_breaking):
    changes, found_breaking = review_changes("arm.launch.py", PYTHON, old, new)
    assert changes == [expected]
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
def test_refactored_python_is_no_change(review_changes, old, new):
    assert review_changes("arm.launch.py", PYTHON, old, new) == ([], [])


def test_namespace_of_each_node_is_that_of_a_group(review_changes):
    old = """            PushRosNamespace("front"),
            SetRemap("scan", "scan_front"),
            SetParameter("use_sim_time", True),
            Node(package="lidar", executable="driver"),
            Node(package="lidar", executable="filter", """
    new = """            SetRemap("scan", "scan_front"),
            SetParameter("use_sim_time", True),
            Node(package="lidar", executable="driver", namespace="front"),
            Node(package="lidar", executable="filter", namespace="front", """
    assert review_changes("arm.launch.py", PYTHON, old, new) == ([], [])


def test_difference_at_the_end_of_a_long_value_is_shown(review_changes):
    text = PYTHON.replace('"filter.yaml"', f"build(text='{'x' * 2000}', gain=1)")
    (sentence,), _ = review_changes("arm.launch.py", text, "gain=1", "gain=2")
    assert len(sentence) < 300
    assert "gain=1" in sentence
    assert "gain=2" in sentence


def test_other_code_is_reported_besides_actions(review_changes):
    text = PYTHON.replace("    return Launch", "    print('starting')\n    return Launch")
    changed = text.replace('"models"', '"worlds"').replace("'starting'", "'started'")
    changes, _ = review_changes("arm.launch.py", text, text, changed)
    assert changes[1:] == ["other code: print('starting') -> print('started')"]


@pytest.mark.parametrize(
    ("added", "code"),
    [
        ("    pose = swap(pose)\n", "pose = swap(pose)"),
        ("    frame = Frame()\n    pose = frame.swap(pose)\n", "frame = Frame(); pose = frame.swap(pose)"),
    ],
)
def test_second_assignment_of_a_name_is_the_only_added_code(review_changes, added, code):
    text = PYTHON.replace("    return Launch", "    pose = [1, 2]\n    return Launch").replace('"-v"', "pose")
    changes, _ = review_changes("arm.launch.py", text, "    return Launch", f"{added}    return Launch")
    assert [change for change in changes if change.startswith("other code")] == [f"other code added: {code}"]
    changes, _ = review_changes("arm.launch.py", text.replace("    return", f"{added}    return"), added, "")
    assert [change for change in changes if change.startswith("other code")] == [f"other code removed: {code}"]


def test_modules_that_a_launch_file_imports_for_the_first_time_are_reported(review_changes):
    old, new = (
        "from launch_ros",
        "import os\nfrom launch.events import Shutdown\nfrom arm_lib import tool\nfrom launch_ros",
    )
    changes, _ = review_changes("arm.launch.py", PYTHON, old, new)
    assert changes == ["imports added: 'from arm_lib import tool'"]
    changes, _ = review_changes("arm.launch.py", PYTHON.replace(old, new), new, old)
    assert changes == ["imports removed: 'from arm_lib import tool'"]
    text = PYTHON.replace(old, new)
    changes, _ = review_changes("arm.launch.py", text, "import tool", "import tool, rack")
    assert changes == []


def test_launch_file_with_name_of_a_test_is_compared(review_changes):
    changes, _ = review_changes("test_arm.launch.py", PYTHON, '"models"', '"worlds"')
    assert len(changes) == 1


@pytest.mark.parametrize(
    ("old", "new", "expected", "is_breaking"),
    [
        ('if="$(arg real)"', 'unless="$(arg real)"',
         "node 'arm/driver.py', include of 'other.launch': condition if $(arg real) -> unless $(arg real)", True),
        ('ns="left"', 'ns="right"', "node 'arm/driver.py': namespace left -> right", True),
        ('to="front/scan"', 'to="back/scan"',
         "remapping of 'scan' for the nodes that follow: to front/scan -> back/scan", True),
        ('  <rosparam command="load" file="drive.yaml"/>\n', "", "parameters of 'drive.yaml' removed", False),
        ('"use_sim_time" value="true"', '"use_sim_time" value="false"',
         "parameter 'use_sim_time': value true -> false", False),
        ('"ROBOT" value="arm"', '"ROBOT" value="leg"', "environment variable 'ROBOT': value arm -> leg", False),
        ('<arg name="ur" default="$(arg ur)"/>', '<arg name="ur" default="ur10"/>',
         "include of 'other.launch': ur $(arg ur) -> ur10 (before, ur5 by default)", False),
    ],
)  # fmt: skip
def test_actions_in_xml_are_compared(review_changes, old, new, expected, is_breaking):
    changes, found_breaking = review_changes("arm.launch", XML, old, new)
    assert expected in changes
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
def test_actions_in_yaml_are_compared(review_changes, old, new, expected, is_breaking):
    changes, found_breaking = review_changes("arm.launch.yaml", YAML, old, new)
    assert changes == [expected]
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
        (
            "    ld.add_action(Mixin.arg_frame())\n",
            "",
            "argument 'frame' removed: default base; the file did not use it",
            False,
        ),
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
    return [DeclareLaunchArgument(parameter["name"], default_value=parameter["default"]) for parameter in parameters]


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
        (', {"name": "port", "default": "tty0"}', "", "argument 'port' removed: default tty0; the file did not use it"),
        ('["left", "right"]', '["left", "rear"]', "node 'arm/driver': namespace right -> rear"),
        ('["left", "right"]', '["left"]', "node 'arm/driver' removed: namespace right"),
    ],
)
def test_actions_of_loops_over_lists_are_compared(review_changes, old, new, expected):
    assert review_changes("arm.launch.py", LOOPS, old, new)[0] == [expected]


def test_name_that_is_assigned_again_has_the_value_before_the_action(review_changes):
    text = LOOPS.replace("    ld = Launch", "    side = 'a'\n    side = side + '_arm'\n    ld = Launch")
    text = text.replace('    for side in ["left", "right"]:\n        ld', "    ld")
    changes, _ = review_changes("arm.launch.py", text, "side = 'a'", "side = 'b'")
    assert changes[0] == "node 'arm/driver': namespace a_arm -> b_arm"


def test_name_that_a_branch_does_not_set_has_its_earlier_literal(review_changes):
    text = LOOPS.replace(
        'for side in ["left", "right"]:', "side = 'a'\n    if PARAMETERS:\n        side = 'b'\n    if 1:"
    )
    changes, _ = review_changes("arm.launch.py", text, "side = 'a'", "side = 'c'")
    branches = "namespace 'b' if PARAMETERS else 'a' -> 'b' if PARAMETERS else 'c'"
    assert changes[0] == f"node 'arm/driver': {branches}"


def test_command_of_a_process_is_a_change(review_changes):
    text = """from launch.actions import ExecuteProcess
def generate_launch_description():
    return LaunchDescription([ExecuteProcess(cmd=["gz", "sim", "-r", "house.sdf"], output="screen")])
"""
    changes, _ = review_changes("arm.launch.py", text, "house", "yard")
    assert changes == ["process 'gz': command [gz, sim, -r, house.sdf] -> [gz, sim, -r, yard.sdf]"]


@pytest.mark.parametrize(("old", "new"), [("/tf", "tf"), ("tf", "/tf")])
def test_relative_name_is_that_of_the_empty_namespace(review_changes, old, new):
    text = PYTHON.replace('("joy", "arm/joy")', f'("joy", "{old}")')
    assert review_changes("arm.launch.py", text, f'"{old}")', f'"{new}")')[1] == []


def test_controllers_of_a_spawner_come_after_its_options(review_changes):
    arguments = (
        '"--controller-manager-timeout", "60", "--inactive", "arm_controller", "--controller-ros-args", "-r a:=b"'
    )
    text = PYTHON.replace('"arm_controller", "-v"', arguments)
    start = text.index('        Node(package="controller_manager"')
    line = text[start : text.index("\n", start) + 1]
    assert review_changes("arm.launch.py", text, line, "")[0] == [
        (
            "node 'controller_manager/spawner' of 'arm_controller' removed: arguments "
            "[--controller-manager-timeout, 60, --inactive, arm_controller, --controller-ros-args, -r a:=b]"
        )
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
def test_action_under_a_new_name_is_replaced(review_changes, old, new, expected):
    assert review_changes("arm.launch.py", PYTHON, old, new) == ([expected], [])


def test_program_of_the_same_package_is_not_a_replacement(review_changes):
    changes, found_breaking = review_changes("arm.launch.py", PYTHON, 'executable="teleop"', 'executable="keyboard"')
    assert changes == [
        "node 'arm/keyboard' added: remapping joy -> arm/joy",
        "node 'arm/teleop' removed: remapping joy -> arm/joy",
    ]
    assert found_breaking == changes[1:]


@pytest.mark.parametrize(
    ("old", "new", "expected", "reason"),
    [
        ('<arg name="real" default="true"/>', '<arg name="real" default="false"/>',
         "argument 'real': default true -> false", "by default, node 'arm/driver.py' no longer starts"),
        ('<arg name="side" default="left"/>', '<arg name="side" default="right"/>',
         "argument 'side': default left -> right",
         "programs that use the names of the node, its topics or its services do not find them"),
        ('<arg name="urdf" default="arm.urdf"/>', '<arg name="urdf" default="$(dirname)/arm.urdf"/>',
         "argument 'urdf': default arm.urdf -> $(dirname)/arm.urdf",
         "callers that pass the name of a file instead of its path fail"),
        ('<arg name="odom_topic" default="odom"/>', '<arg name="odom_topic" default="wheel_odom"/>',
         "argument 'odom_topic': default odom -> wheel_odom", "programs that use the name 'odom' do not find it"),
        ('<arg name="tf_prefix" default=\'""\'/>', '<arg name="tf_prefix" default=""/>',
         "argument 'tf_prefix': default \"\" -> ''", None),
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
    change = find_only_change(repository, compare, DEFAULTS.replace(old, new))
    assert str(change.sentence) == expected
    assert (None if change.reason is None else str(change.reason)) == reason


def test_argument_under_a_new_name_is_renamed(repository, compare):
    new_text = DEFAULTS.replace('<arg name="ur"', '<arg name="model"').replace("$(var ur)", "$(var model)")
    change = find_only_change(repository, compare, new_text)
    assert str(change.sentence) == "argument 'ur' renamed to 'model'"
    assert str(change.reason) == "a value that a caller passes for 'ur' has no effect"


def find_only_change(repository, compare, new_text):
    """Return the only change from the launch file with defaults to a new text."""
    repository.commit({"arm/launch/arm.launch.xml": DEFAULTS})
    repository.write({"arm/launch/arm.launch.xml": new_text})
    (change,) = subject(compare(repository), "arm/launch/arm.launch.xml").changes
    return change


DEFAULTS = """<launch>
  <arg name="real" default="true"/>
  <arg name="ur" default="ur5"/>
  <arg name="side" default="left"/>
  <arg name="urdf" default="arm.urdf"/>
  <arg name="odom_topic" default="odom"/>
  <arg name="speed" default="1"/>
  <arg name="tf_prefix" default='""'/>
  <node pkg="arm" exec="driver.py" namespace="$(var side)" if="$(var real)"/>
  <node pkg="arm" exec="model" args="--type $(var ur) --speed $(var speed)"/>
  <node pkg="controller_manager" exec="spawner" args="arm_controller"/>
  <node pkg="robot_state_publisher" exec="robot_state_publisher"><param name="frame_prefix" value=""/></node>
  <node pkg="lidar" exec="driver"><param name="frame_id" value="laser"/></node>
  <node pkg="slam_toolbox" exec="slam_node" name="slam"><remap from="scan" to="/lidar/scan"/></node>
</launch>
"""


def test_same_change_of_several_nodes_is_one(review_changes):
    text = DEFAULTS.replace("<node ", '<node respawn="true" ')
    (sentence,), _ = review_changes("arm.launch.xml", text, 'respawn="true"', 'respawn="false"')
    assert sentence.startswith("node 'arm/driver.py', node 'arm/model', node 'controller_manager/spawner' of")
    assert sentence.endswith("node 'lidar/driver', node 'slam_toolbox/slam_node': respawn true -> false")


def test_added_launch_file_is_described_by_its_actions(repository, compare):
    repository.commit({"arm/launch/arm.launch.py": PYTHON})
    repository.write({"arm/launch/part.launch.py": PYTHON})
    (sentence,) = sentences(subject(compare(repository), "arm/launch/part.launch.py"))
    assert sentence.startswith(
        "launch file added: node 'lidar/driver' (if $(var front), namespace front), node 'lidar/"
    )
    assert "node 'arm/teleop'" in sentence


FAILING = """import os, sys
from launch import LaunchDescription
from launch_ros.actions import Node

def generate_launch_description():
    model = os.environ.get("MODEL", "a")
    return LaunchDescription([
        Node(package="arm", executable="driver",
             parameters=[{"rate": 10, "id": "1", "frame_name": "tool", "on": True}]),
    ])
"""


@pytest.mark.parametrize(
    ("old", "new", "expected", "is_breaking"),
    [
        ("    return L", '    if model == "x":\n        raise RuntimeError("no such model")\n    return L',
         "added: raise RuntimeError('no such model')", True),
        ("    return L", '    if not model:\n        sys.exit("no model")\n    return L',
         "added: sys.exit('no model')", True),
        ("    return L", '    if model:\n        print(model)\n    return L',
         "other code added: if model: ...; print(model)", False),
        ('"rate": 10', '"rate": 10.5', "node 'arm/driver': parameter rate 10 -> 10.5", True),
        ('"rate": 10', '"rate": 10.0', "node 'arm/driver': parameter rate 10 -> 10.0", False),
        ('"rate": 10', '"rate": 20', "node 'arm/driver': parameter rate 10 -> 20", False),
        ('"id": "1"', '"id": 1', "node 'arm/driver': parameter id '1' -> 1", True),
        ('"on": True', '"on": "true"', "node 'arm/driver': parameter on True -> 'true'", True),
        ('"rate": 10', '"rate": model', "node 'arm/driver': parameter rate 10 -> $(env MODEL a)", False),
        ('"frame_name": "tool"', '"frame_name": 3', "node 'arm/driver': parameter frame_name tool -> 3", False),
    ],
)  # fmt: skip
def test_failures_and_types_of_parameters_are_breaking(review_changes, old, new, expected, is_breaking):
    changes, found_breaking = review_changes("arm.launch.py", FAILING, old, new)
    assert changes == [expected]
    assert bool(found_breaking) is is_breaking


def test_other_message_of_an_exception_is_no_new_failure(review_changes):
    check = '    if model == "x":\n        raise RuntimeError("no such model")\n    return L'
    text = FAILING.replace("    return L", check)
    changes, found_breaking = review_changes("arm.launch.py", text, "no such model", "no model of this name")
    assert len(changes) == 1
    assert not found_breaking


def test_removed_argument_of_ros_1_makes_callers_fail(repository, compare):
    text = XML.replace('<arg name="ur" default="$(arg ur)"/>', "")
    repository.commit({"arm/launch/arm.launch": text})
    repository.write({"arm/launch/arm.launch": text.replace('  <arg name="ur" default="ur5"/>\n', "")})
    ((_, change),) = compare(repository).breaking_changes
    assert str(change.reason) == "launch files that pass 'ur' to the file fail"


def test_default_of_an_environment_variable_is_its_value(review_changes):
    text = XML.replace('name="real" default="true"', 'name="base_frame" default="base_link"')
    changes, found_breaking = review_changes(
        "arm.launch", text, 'default="base_link"', 'default="$(optenv ARM_FRAME base_link)"'
    )
    assert "argument 'base_frame': default base_link -> $(optenv ARM_FRAME base_link)" in changes
    assert found_breaking == []


def test_changed_value_is_quoted_and_not_the_statement_that_uses_it(review_changes):
    text = PYTHON.replace("    return Launch", "    size = 3\n    print(size)\n    return Launch")
    assert review_changes("arm.launch.py", text, "size = 3", "size = 4") == (["other code: size = 3 -> size = 4"], [])


@pytest.mark.parametrize(("default", "is_replaced"), [("", True), ("other", False)])
def test_node_whose_namespace_becomes_an_argument_with_the_same_default_is_replaced(
    repository, compare, default, is_replaced
):
    node = '<node pkg="lidar" exec="driver" name="lidar" namespace=""/>'
    component = '<composable_node pkg="lidar" plugin="lidar::Component" name="lidar" namespace="$(var space)"/>'
    new = (
        f'<arg name="space" default="{default}"/>'
        f'<node_container pkg="rclcpp_components" exec="component_container" name="all" namespace="">{component}'
        "</node_container>"
    )
    repository.commit({"arm/launch/arm.launch.xml": f"<launch>{node}</launch>\n"})
    repository.write({"arm/launch/arm.launch.xml": f"<launch>{new}</launch>\n"})
    found = sentences(subject(compare(repository), "arm/launch/arm.launch.xml"))
    replaced = "node 'lidar/driver' replaced by node 'lidar/lidar::Component'"
    assert (replaced in found) == is_replaced
    assert any(sentence.startswith("node 'lidar/driver' removed") for sentence in found) != is_replaced


def test_node_whose_package_program_and_name_change_is_replaced(review_changes):
    node = 'Node(package="arm_xs_driver", executable="xs_driver_node", name="xs_driver", output="screen"),'
    text = PYTHON.replace("    return LaunchDescription([", f"    return LaunchDescription([\n        {node}")
    changes, found_breaking = review_changes("arm.launch.py", text, node, node.replace("xs_", ""))
    assert changes == [
        "node 'arm_xs_driver/xs_driver_node' replaced by node 'arm_driver/driver_node'",
        "node 'arm_driver/driver_node': name xs_driver -> driver",
    ]
    assert found_breaking == changes[1:]


@pytest.mark.parametrize(("name", "is_breaking"), [("detection_overlay", False), ("front_camera", True)])
def test_name_of_a_component_that_its_class_may_have_is_not_breaking(review_changes, name, is_breaking):
    node = 'ComposableNode(package="cam", plugin="cam::Detection2DOverlay")'
    text = PYTHON.replace("    return LaunchDescription([", f"    return LaunchDescription([\n        {node},")
    text = f"from launch_ros.descriptions import ComposableNode\n{text}"
    _, found_breaking = review_changes("arm.launch.py", text, 'Overlay")', f'Overlay", name="{name}")')
    assert bool(found_breaking) is is_breaking
