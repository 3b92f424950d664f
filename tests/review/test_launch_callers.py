"""Changes in a review of launch files that others include.

The files are moved, have new requirements, or are in another language.
"""

from __future__ import annotations

import pytest

from tests.review.conftest import breaking, sentences, subject

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
def review_changes_with_reasons(repository, compare):
    """Review new texts of two launch files, of which one includes the other.

    Return sentences with their reasons.
    """

    def run(new: str, new_part: str = PART, old: str = READING, old_part: str = PART):
        repository.commit({"arm/launch/arm.launch.py": old, "arm/launch/part.launch.py": old_part})
        repository.write({"arm/launch/arm.launch.py": new, "arm/launch/part.launch.py": new_part})
        subjects = [entry for entry in compare(repository).subjects if entry.path == "arm/launch/arm.launch.py"]
        changes = subjects[0].changes if subjects else []
        return {str(change.sentence): None if change.reason is None else str(change.reason) for change in changes}

    return run


def test_argument_without_default_that_is_not_declared_is_breaking(review_changes_with_reasons):
    new = READING.replace('executable="hand"', 'executable="hand", name=LaunchConfiguration("n")')
    text = "node 'arm/hand' uses argument 'n', which is not declared"
    assert review_changes_with_reasons(new)[text] == "the launch file fails if no other file declares 'n'"


def test_argument_of_included_file_is_declared(review_changes_with_reasons):
    new = READING.replace('executable="hand"', 'executable="hand", respawn=LaunchConfiguration("speed")')
    assert review_changes_with_reasons(new) == {"node 'arm/hand': respawn $(var speed) added": None}


def test_removed_argument_that_is_still_used_fails(review_changes_with_reasons):
    new = READING.replace('        DeclareLaunchArgument("rate", default_value="1"),\n', "")
    assert review_changes_with_reasons(new) == {
        "argument 'rate' removed": "the launch file still uses 'rate', and fails if no other file declares it"
    }


def test_node_that_moves_into_included_file_is_moved(review_changes_with_reasons):
    line = '        Node(package="arm", executable="hand"),\n'
    part = PART.replace("LaunchDescription([", 'LaunchDescription([Node(package="arm", executable="hand"), ')
    assert review_changes_with_reasons(READING.replace(line, ""), part) == {
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
         "argument 'side' added (required)", "callers must pass 'side'"),
        ('"rate", default_value="1"),', '"rate", default_value="1"), DeclareLaunchArgument("side", default_value="l"),',
         "argument 'side' added: default l", None),
    ],
)  # fmt: skip
def test_environment_variables_and_required_arguments(review_changes_with_reasons, old, new, expected, reason):
    assert review_changes_with_reasons(READING.replace(old, new))[expected] == reason


def test_variable_that_ros_reads_itself_keeps_its_effect(review_changes_with_reasons):
    old = READING.replace('"MODEL"', '"ROS_IP"')
    changes = review_changes_with_reasons(old.replace('os.environ["ROS_IP"]', '"arm"'), old=old)
    assert changes["use of environment variable 'ROS_IP' removed"] is None


def test_removed_remappings_and_added_parameters_of_a_node_are_one_change_each(review_changes_with_reasons):
    node = 'Node(package="arm", executable="hand"'
    old = READING.replace(node, f'{node}, remappings=[("a", "arm/a"), ("b", "arm/b"), ("c", "arm/c")]')
    new = READING.replace(node, f'{node}, parameters=[{{"x": 1, "y": 2, "z": 3}}]')
    assert review_changes_with_reasons(new, old=old) == {
        "node 'arm/hand': parameters added: x 1, y 2, z 3": None,
        "node 'arm/hand': remappings removed: a -> arm/a, b -> arm/b, c -> arm/c": (
            "if the node publishes or serves 'arm/a', 'arm/b', 'arm/c', programs that use the names do not find them"
        ),
    }


def test_other_name_of_a_parameter_of_a_function_is_no_change(review_changes_with_reasons):
    text = READING + "\n\ndef talk(word, count):\n    print(word * count)\n"
    assert review_changes_with_reasons(text.replace("word", "text"), old=text) == {}


def test_added_code_is_one_line(review_changes_with_reasons):
    new = READING.replace("    return", "    for word in ('a', 'b'):\n        print(word)\n    print('c')\n    return")
    assert review_changes_with_reasons(new) == {
        "other code added: for word in ('a', 'b'): ... and 2 more statements": None
    }


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
def test_other_notation_of_a_path_or_command_is_no_change(review_changes, old, new):
    text = """from launch.substitutions import PathSubstitution

def generate_launch_description():
    return LaunchDescription([
        Node(package="arm", executable="driver", parameters=[
            {"file": PathJoinSubstitution([FindPackageShare("arm"), "a.yaml"])},
            {"robot_description": Command([FindExecutable(name="xacro"), " arm.urdf"])},
        ]),
    ])
"""
    before = "PathJoinSubstitution([" if "yaml" in old else ""
    assert review_changes("arm.launch.py", text, before + old, ("(" if before else "") + new) == ([], [])


def test_action_that_is_appended_to_a_list_is_no_other_code(review_changes):
    text = """def generate_launch_description():
    actions = [Node(package="arm", executable="driver")]
    actions.append(Node(package="arm", executable="hand"))
    return LaunchDescription(actions)
"""
    found, _ = review_changes(
        "arm.launch.py", text, "    return", "    actions.append(Node(package='a', executable='b'))\n    return"
    )
    assert found == ["node 'a/b' added"]


WITH_NODE = PART.replace('"1")]', '"1"), Node(package="arm", executable="hand")]')


@pytest.mark.parametrize(("part", "reason"), [(WITH_NODE, "its nodes no longer start"), (PART, None)])
def test_removed_include_stops_its_nodes(review_changes_with_reasons, part, reason):
    line = '        IncludeLaunchDescription(PathJoinSubstitution([ThisLaunchFileDir(), "part.launch.py"])),\n'
    new = READING.replace(line, "")
    assert review_changes_with_reasons(new, part, old_part=part) == {
        "include of '$(dirname)/part.launch.py' removed": reason
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
        ("        hand,\n", "", ["node 'arm/hand' removed: name hand, arguments [a/b, c/d/e]"], True),
        ('"a" + "/b", os.path.join("c", "d") + "/e"', '"a/b", "c/d/e"', [], False),
        (', name="hand"', "", ["node 'arm/hand': name hand removed"], False),
        ("target_action=driver", "target_action=hand",
         ["event handler OnProcessExit of arm/hand added: on_exit [EmitEvent]",
          "event handler OnProcessExit of arm/driver removed: on_exit [EmitEvent]"], False),
        ("on_exit=[EmitEvent()]", "on_exit=[hand]",
         ["event handler OnProcessExit of arm/driver: on_exit [EmitEvent] -> [arm/hand]"], False),
        ('{"speed": speed}', '{"speed": 1}',
         ["node 'arm/driver': parameter speed $(var speed 1) -> 1 (the same by default)"], False),
        ('speed = LaunchConfiguration("speed", default="1")', "speed = 1",
         ["node 'arm/driver': parameter speed $(var speed 1) -> 1 (the same by default)"], False),
    ],
)  # fmt: skip
def test_only_what_is_used_is_compared(review_changes, old, new, expected, is_breaking):
    found, found_breaking = review_changes("arm.launch.py", UNUSED, old, new)
    assert found == expected
    assert bool(found_breaking) is is_breaking


def test_argument_that_is_used_without_being_declared_is_removed(review_changes):
    text = (
        UNUSED.replace('"speed": speed', '"rate": speed').replace("speed = L", "rate = L").replace(": speed", ": rate")
    )
    new = text.replace('LaunchConfiguration("speed", default="1")', "1")
    found, found_breaking = review_changes("arm.launch.py", text, text, new)
    assert found == [
        "node 'arm/driver': parameter rate $(var speed 1) -> 1 (the same by default)",
        "argument 'speed' removed",
    ]
    assert found_breaking == found[1:]


def test_node_that_moves_to_another_launch_file_is_missing_where_it_was(review_changes_with_reasons):
    part = PART.replace("LaunchDescription([", 'LaunchDescription([Node(package="arm", executable="hand"), ')
    alone = READING.replace('PathJoinSubstitution([ThisLaunchFileDir(), "part.launch.py"])', '"other.launch.py"')
    new = alone.replace('        Node(package="arm", executable="hand"),\n', "")
    assert review_changes_with_reasons(new, part, old=alone) == {
        "node 'arm/hand' moved to arm/launch/part.launch.py": (
            "where the file is started without arm/launch/part.launch.py, "
            "the topics and services of the node are missing"
        )
    }


def test_items_of_lists_are_split_outside_of_parentheses(review_changes):
    text = """def generate_launch_description():
    return LaunchDescription([Node(package="a", executable="b", arguments=[f(1, 2), "c", "d", "e", "f"])])
"""
    found, _ = review_changes("arm.launch.py", text, "f(1, 2)", "f(1, 3)")
    assert found == ["node 'a/b': arguments: f(1, 3) added, f(1, 2) removed"]


def test_delay_of_a_timer_is_compared(review_changes):
    text = """def generate_launch_description():
    hand = Node(package="arm", executable="hand")
    return LaunchDescription([TimerAction(period=3.0, actions=[hand])])
"""
    found, _ = review_changes("arm.launch.py", text, "3.0", "5.0")
    assert found == ["node 'arm/hand': condition after 3.0 s -> after 5.0 s"]


def test_same_notations_in_python_and_xml(repository, compare):
    python = """from ament_index_python.packages import get_package_share_directory
from launch import LaunchDescription
from launch.actions import *
from launch.substitutions import *
from launch_ros.actions import *


def generate_launch_description():
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


def test_prefix_of_frames_that_is_unknown_is_not_breaking(review_changes):
    text = """from arm import Mixin

def generate_launch_description():
    publisher = Node(package="robot_state_publisher", executable="robot_state_publisher", parameters=[{}])
    return LaunchDescription([publisher])
"""
    found, found_breaking = review_changes("arm.launch.py", text, "{}", '{"frame_prefix": Mixin.prefix()}')
    assert (len(found), found_breaking) == (1, [])


def test_joined_path_of_a_substitution_instead_of_a_list_is_not_the_substitution(review_changes):
    text = """def generate_launch_description():
    command = Command([PathJoinSubstitution(FindExecutable(name="xacro")), " arm.urdf"])
    return LaunchDescription([Node(package="arm", executable="driver", parameters=[{"model": command}])])
"""
    old = 'PathJoinSubstitution(FindExecutable(name="xacro"))'
    assert review_changes("arm.launch.py", text, old, 'FindExecutable(name="xacro")')[0] == [
        (
            "node 'arm/driver': parameter model $(command PathJoinSubstitution($(find-exec xacro)) arm.urdf) -> "
            "$(command xacro arm.urdf)"
        )
    ]


SIMULATION = """<launch>
  <node pkg="arm" type="hand" name="hand" respawn="true">
    <param name="speed" value="1.0"/>
    <param name="width" value="0.2"/>
  </node>
</launch>
"""


@pytest.mark.parametrize(
    ("old", "new", "expected"),
    [
        ("", "", "node 'arm/hand' moved from arm/launch/part.launch"),
        (
            'value="0.2"',
            'value="0.3"',
            "node 'arm/hand' moved from arm/launch/part.launch, now with parameter width 0.3",
        ),
        (' respawn="true"', "", "node 'arm/hand' moved from arm/launch/part.launch, without respawn"),
        (
            'respawn="true"',
            'output="screen"',
            "node 'arm/hand' moved from arm/launch/part.launch, now with output screen, without respawn",
        ),
    ],
)
def test_moved_action_names_its_other_settings(repository, compare, old, new, expected):
    repository.commit({"arm/launch/part.launch": SIMULATION, "arm/launch/arm.launch": "<launch/>\n"})
    repository.write({"arm/launch/part.launch": None, "arm/launch/arm.launch": SIMULATION.replace(old, new)})
    assert sentences(subject(compare(repository), "arm/launch/arm.launch")) == [expected]


LIFECYCLE = """from arm import make
from launch import LaunchDescription
from launch.actions import EmitEvent
from launch_ros.actions import Node, LifecycleNode


def generate_launch_description():
    hand = Node(package="arm", executable="hand", name="hand", namespace="")
    ld = LaunchDescription()
    ld.add_action(hand)
    return ld
"""


def test_node_that_becomes_a_lifecycle_node_is_named(repository, compare):
    path = "arm/launch/arm.launch.py"
    repository.commit({path: LIFECYCLE})
    event = "    start = EmitEvent(event=make(hand))\n    ld.add_action(start)\n    return ld\n"
    new = LIFECYCLE.replace("hand = Node", "hand = LifecycleNode").replace("    return ld\n", event)
    repository.write({path: new})
    assert sentences(subject(compare(repository), path)) == [
        "node 'arm/hand': is a lifecycle node now",
        "other code added: start = EmitEvent(event=make(hand)); ld.add_action(start)",
    ]


def test_node_of_xml_that_becomes_a_lifecycle_node_is_named(repository, compare):
    path = "arm/launch/arm.launch.xml"
    text = '<launch>\n  <node pkg="arm" exec="hand" name="hand" namespace=""/>\n</launch>\n'
    repository.commit({path: text})
    repository.write({path: text.replace("<node", "<lifecycle_node")})
    assert sentences(subject(compare(repository), path)) == ["node 'arm/hand': is a lifecycle node now"]


@pytest.mark.parametrize(
    ("use", "expected"),
    [
        ("", "argument 'mode' removed: default fast; the file did not use it"),
        ('<node pkg="arm" exec="driver" name="$(var mode)"/>', "argument 'mode' removed: default fast"),
        ('<!-- <node exec="$(var mode)"/> -->', "argument 'mode' removed: default fast; the file did not use it"),
    ],
)  # fmt: skip
def test_removed_argument_that_the_file_did_not_use_is_not_breaking(repository, compare, use, expected):
    declaration = '<arg name="mode" default="fast"/>'
    include = '<include file="$(find-pkg-share other)/launch/base.launch.xml"/>'
    repository.commit({"arm/launch/arm.launch.xml": f"<launch>{declaration}{use}{include}</launch>"})
    new_use = use.replace(' name="$(var mode)"', "")
    repository.write({"arm/launch/arm.launch.xml": f"<launch>{new_use}{include}</launch>"})
    result = compare(repository)
    assert expected in sentences(subject(result, "arm/launch/arm.launch.xml"))
    assert (expected in breaking(result)) is ("did not use" not in expected)


def test_removed_argument_that_a_python_file_uses_by_a_computed_name_is_breaking(review_changes):
    text = READING.replace(
        '"rate": LaunchConfiguration("rate")', "name: LaunchConfiguration(name) for name in ['rat' + 'e']"
    )
    declaration = '        DeclareLaunchArgument("rate", default_value="1"),\n'
    assert review_changes("arm.launch.py", text, declaration, "")[1] == ["argument 'rate' removed: default 1"]


def test_removed_argument_of_ros1_is_breaking_though_the_file_did_not_use_it(repository, compare):
    node = '<node pkg="arm" type="driver" name="d"/>'
    repository.commit({"arm/launch/arm.launch": f'<launch><arg name="mode" default="fast"/>{node}</launch>'})
    repository.write({"arm/launch/arm.launch": f"<launch>{node}</launch>"})
    assert breaking(compare(repository)) == ["argument 'mode' removed: default fast"]


@pytest.mark.parametrize(
    ("part", "node", "expected"),
    [
        ('<param name="speed" value="1.0"/>', '<param name="speed" value="1.0"/>', ""),
        ('<param name="speed" value="1.0"/>', '<param name="speed" value="2.0"/>', ", now with parameter speed 2.0"),
        ('<remap from="a" to="b"/>', "", ", without remapping a"),
        ('<param name="speed" value="$(var rate)"/>', '<param name="speed" value="2.0"/>', ""),
    ],
)
def test_a_node_that_moves_out_of_an_included_file_is_compared(repository, compare, part, node, expected):
    text = '<launch><node pkg="arm" exec="hand" name="hand">{}</node></launch>\n'
    include = '<launch><include file="$(dirname)/part.launch.xml"/></launch>\n'
    repository.commit({"arm/launch/arm.launch.xml": include, "arm/launch/part.launch.xml": text.format(part)})
    repository.write({"arm/launch/arm.launch.xml": text.format(node)})
    lines = sentences(subject(compare(repository), "arm/launch/arm.launch.xml"))
    assert f"node 'arm/hand' moved from arm/launch/part.launch.xml{expected}" in lines


LIMITS = """import os
from launch import LaunchDescription
from launch_ros.actions import Node

LOWER = os.environ.get("LEFT_LOWER", "0")
UPPER = os.getenv("LEFT_UPPER", "1")

def generate_launch_description():
    return LaunchDescription([Node(package="arm", executable="hand", arguments=[LOWER, UPPER])])
"""


def test_renamed_environment_variables_are_told_as_such(review_changes_with_reasons):
    changes = review_changes_with_reasons(LIMITS.replace("LEFT_", "RIGHT_"), old=LIMITS)
    assert changes == {
        "environment variable 'LEFT_LOWER' renamed to 'RIGHT_LOWER'": (
            "a value that a user sets for 'LEFT_LOWER' has no effect"
        ),
        "environment variable 'LEFT_UPPER' renamed to 'RIGHT_UPPER'": (
            "a value that a user sets for 'LEFT_UPPER' has no effect"
        ),
    }
    assert next(iter(changes)).startswith("environment variable 'LEFT_LOWER'")


def test_environment_variable_for_another_setting_is_not_renamed(review_changes_with_reasons):
    new = LIMITS.replace('UPPER = os.getenv("LEFT_UPPER", "1")', 'UPPER, NAME = "1", os.getenv("ARM_NAME", "hand")')
    changes = review_changes_with_reasons(new.replace('executable="hand"', 'executable="hand", name=NAME'), old=LIMITS)
    assert "use of environment variable 'LEFT_UPPER' removed" in changes
    assert "use of environment variable 'ARM_NAME' added" in changes


@pytest.mark.parametrize("name", ["arm.launch", "arm.launch.xml"])
def test_removed_argument_that_a_file_of_ros2_still_uses_makes_it_fail(repository, compare, name):
    text = """<launch>
      <arg name="namespace" default="arm"/>
      <push-ros-namespace namespace="$(var namespace)"/>
      <node pkg="arm" exec="arm"/>
    </launch>"""
    repository.commit({f"arm/launch/{name}": text})
    repository.write({f"arm/launch/{name}": text.replace('arg name="namespace"', 'arg name="robot"')})
    ((_, change),) = compare(repository).breaking_changes
    assert str(change.reason) == "the launch file still uses 'namespace', and fails if no other file declares it"
