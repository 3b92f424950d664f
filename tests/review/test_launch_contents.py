"""Contents of added and removed launch actions in a review.

The tests also cover settings under conditions, and parameters of ROS 1.
"""

from __future__ import annotations

import pytest

from tests.repositories import PACKAGE_XML
from tests.review.conftest import breaking, sentences, subject

PATH = "arm/launch/arm.launch"


@pytest.fixture
def review_changes(repository, compare):
    """Review two contents of a launch file.

    Return the sentences of all changes and of the breaking ones.
    """

    def run(old: str, new: str, **files: str):
        other_files = {f"arm/{name}": text for name, text in files.items()}
        repository.commit({"arm/package.xml": PACKAGE_XML, PATH: f"<launch>\n{old}\n</launch>\n", **other_files})
        repository.write({PATH: f"<launch>\n{new}\n</launch>\n"})
        result = compare(repository)
        return sentences(subject(result, PATH)) if result.subjects else [], breaking(result)

    return run


NODE = """<node pkg="cam" type="driver" name="cam" output="screen" args="--fast">
  <param name="rate" value="10"/>
  <rosparam>
    gain: 3
    pid: {p: 1, i: 2}
  </rosparam>
  <rosparam param="sizes">[1, 2]</rosparam>
  <rosparam command="load" file="cam.yaml" ns="lens"/>
  <remap from="image" to="front/image"/>
  <env name="DISPLAY" value=":1"/>
</node>"""


@pytest.mark.parametrize(("is_added", "word"), [(True, "added"), (False, "removed")])
def test_added_and_removed_node_has_its_contents(review_changes, is_added, word):
    changes, _ = review_changes(*(("", NODE) if is_added else (NODE, "")))
    assert changes == [
        (
            f"node 'cam/driver' {word}: name cam, arguments --fast, remapping image -> front/image, "
            "environment variable DISPLAY :1, parameter rate 10, parameter gain 3, parameter pid.p 1, "
            "parameter pid.i 2, parameter sizes [1, 2], parameters [cam.yaml (namespace lens)], output screen"
        )
    ]


def test_added_launch_file_names_everything_before_details(repository, compare):
    parameters = "".join(f'<param name="rate_of_stream_{number}" value="{number}"/>' for number in range(12))
    nodes = "".join(f'<node pkg="cam" exec="driver_{number}">{parameters}</node>' for number in range(6))
    repository.commit({"arm/package.xml": PACKAGE_XML})
    repository.write({PATH: f'<launch><arg name="side" default="left"/>{nodes}</launch>'})
    (sentence,) = sentences(subject(compare(repository), PATH))
    assert len(sentence) < 1000
    assert "node 'cam/driver_5' (parameter rate_of_stream_0 0, parameter rate_of_stream_1 1 and 10 more)" in sentence
    assert sentence.endswith("argument 'side' (default left, unused)")


def test_all_parameter_files_of_an_added_node_are_shown(review_changes):
    files = [f"$(find arm_navigation)/config/{name}_costmap_params.yaml" for name in ("common", "global", "local")]
    loads = "".join(f'<rosparam command="load" file="{file}"/>' for file in files)
    (change,), _ = review_changes("", f'<node pkg="move" type="move" name="move">{loads}</node>')
    assert f"parameters [{', '.join(files)}]" in change


def test_all_remappings_of_an_added_node_are_shown(review_changes):
    topics = [f"camera/stream_{number}/image_raw" for number in range(20)]
    node = "".join(f'<remap from="{topic}" to="front/{topic}"/>' for topic in topics)
    (change,), _ = review_changes(
        "", f'<node pkg="cam" type="driver" name="cam">{node}<param name="a" value="1"/></node>'
    )
    assert change.count("remapping") == len(topics)
    assert change.endswith("parameter a 1")


@pytest.mark.parametrize(
    ("old", "new", "expected"),
    [
        ("p: 1", "p: 4", "node 'cam/driver': parameter pid.p 1 -> 4"),
        ("[1, 2]", "[1, 3]", "node 'cam/driver': parameter sizes [1, 2] -> [1, 3]"),
        ('"10"', '"10.5"', "node 'cam/driver': parameter rate 10 -> 10.5"),
        (":1", ":2", "node 'cam/driver': environment variable DISPLAY :1 -> :2"),
        ("lens", "mount",
         "node 'cam/driver': parameters [cam.yaml (namespace lens)] -> [cam.yaml (namespace mount)]"),
    ],
)  # fmt: skip
def test_changed_parameters_of_a_node_of_ros1_are_named(review_changes, old, new, expected):
    assert review_changes(NODE, NODE.replace(old, new)) == ([expected], [])


def test_parameters_in_a_text_that_is_not_yaml_are_shown_as_it_is(review_changes):
    argument, text = '<arg name="x" default="1"/>', "<rosparam>a: [$(arg x)}</rosparam>"
    assert review_changes(argument, argument + text)[0] == ["parameter 'YAML text' added: a: [$(arg x)}"]


def test_renamed_parameter_file_is_the_same_one(review_changes):
    old, new = (f'<rosparam ns="x" command="load" file="$(find arm)/{name}.yaml"/>' for name in ("limits", "limit"))
    (change,), _ = review_changes(old, new)
    assert change == "parameters of '$(find arm)/limits.yaml' replaced by parameters of '$(find arm)/limit.yaml'"


ARGUMENTS = """<arg name="sim" default="false"/>
<arg name="side" value="sim" if="$(arg sim)"/>
<arg name="side" value="real" unless="$(arg sim)"/>
"""
REMAP = '<node pkg="cam" type="driver" name="cam"><remap from="scan" to="{}"/></node>'
REMAPS = REMAP.format("real/scan").replace(
    "<remap ", '<remap if="$(arg sim)" from="scan" to="sim/scan"/><remap unless="$(arg sim)" '
)


def test_values_of_one_name_have_their_conditions(review_changes):
    changes, _ = review_changes(ARGUMENTS, ARGUMENTS.replace('"real"', '"robot"'))
    assert changes == ["argument 'side' (unless $(arg sim)): value real -> robot"]


def test_name_has_the_value_whose_condition_holds_by_default(review_changes):
    old, new = REMAP.format("$(arg side)/scan"), REMAP.format("real/scan")
    changes, found_breaking = review_changes(ARGUMENTS + old, ARGUMENTS + new)
    assert changes == ["node 'cam/driver': remapping scan $(arg side)/scan -> real/scan (the same by default)"]
    assert found_breaking == []
    _, found_breaking = review_changes(ARGUMENTS + old, ARGUMENTS + REMAP.format("sim/scan"))
    assert len(found_breaking) == 1


@pytest.mark.parametrize(
    ("old", "new", "expected", "is_breaking"),
    [
        (REMAPS, REMAPS.replace("sim/scan", "gz/scan"), "scan (if $(arg sim)) sim/scan -> gz/scan", True),
        (REMAP.format("real/scan"), REMAPS,
         "scan real/scan -> sim/scan (if $(arg sim)), real/scan (unless $(arg sim))", False),
        (REMAP.format("scan"), REMAPS,
         "scan scan -> sim/scan (if $(arg sim)), real/scan (unless $(arg sim))", True),
    ],
)  # fmt: skip
def test_remappings_of_one_name_under_conditions_are_told_apart(review_changes, old, new, expected, is_breaking):
    changes, found_breaking = review_changes(ARGUMENTS + old, ARGUMENTS + new)
    assert changes == [f"node 'cam/driver': remapping {expected}"]
    assert bool(found_breaking) is is_breaking


def test_old_text_has_the_old_name_of_a_renamed_argument(review_changes):
    text = '<arg name="robot" default="a"/><node pkg="cam" type="driver" name="cam" args="-m $(arg robot) -x {}"/>'
    changes, _ = review_changes(text.format(1), text.replace("robot", "model").format(2))
    assert changes[1:] == ["node 'cam/driver': arguments -m $(arg robot) -x 1 -> -m $(arg model) -x 2"]


def test_targets_of_remappings_with_another_prefix_are_one_change(review_changes):
    text = "".join(
        f'<node pkg="cam" type="{name}" name="{name}"><remap from="a" to="/x/a"/>'
        f'<remap from="{name}" to="/x/{name}"/></node>'
        for name in ("left", "right")
    )
    changes, found_breaking = review_changes(text, text.replace("/x/", "/y/"))
    assert changes == found_breaking
    assert changes == [
        "node 'cam/left', node 'cam/right': remappings /x/a -> /y/a, /x/left -> /y/left, /x/right -> /y/right"
    ]


ROBOT = """<robot xmlns:xacro="http://www.ros.org/wiki/xacro" name="arm">
  <xacro:arg name="x" default="$(optenv TOOL a)"/>
</robot>
"""


def test_environment_variable_that_only_another_file_still_reads_is_breaking(review_changes):
    text = '<arg name="tool" default="$(optenv TOOL a)"/>'
    changes, found_breaking = review_changes(text, '<arg name="tool" default="a"/>', **{"urdf/arm.xacro": ROBOT})
    assert changes == [
        "argument 'tool': default $(optenv TOOL a) -> a",
        "use of environment variable 'TOOL' removed; arm/urdf/arm.xacro uses it",
    ]
    assert found_breaking == changes[1:]


def test_environment_variable_that_another_file_only_mentions_in_a_comment_is_breaking(review_changes):
    robot = ROBOT.replace("  <xacro:arg", "  <!-- <xacro:arg").replace("/>\n<", "/> -->\n<")
    text = '<arg name="tool" default="$(env TOOL)"/>'
    _, found_breaking = review_changes(text, '<arg name="tool" default="a"/>', **{"urdf/arm.xacro": robot})
    assert found_breaking == ["use of environment variable 'TOOL' removed"]


def test_name_that_callers_choose_is_not_a_lost_name(review_changes):
    node = '<node pkg="cam" type="driver" name="$(arg name)"/>'
    _, found_breaking = review_changes(
        f'<arg name="name" default="cam"/>{node}', f'<arg name="robot"/><arg name="name" default="$(arg robot)"/>{node}'
    )
    assert found_breaking == ["argument 'robot' added (required)"]


TRANSFORM = '<node pkg="tf2_ros" exec="static_transform_publisher" args="0 0 0 0 0 0 base wheel"/>'
STATES = '<node pkg="joint_state_publisher" exec="joint_state_publisher"/>'


@pytest.mark.parametrize(("old", "new", "count"), [("", "", 1), ("", STATES, 0), (STATES, STATES, 1)])
def test_frame_of_a_joint_whose_position_is_published_now_may_not_be_lost(review_changes, old, new, count):
    _, found_breaking = review_changes(TRANSFORM + old, new)
    assert len([sentence for sentence in found_breaking if "static_transform_publisher" in sentence]) == count


def test_name_to_which_another_topic_of_the_node_is_remapped_is_not_lost(review_changes):
    old = REMAP.format("scan_raw")
    changes, found_breaking = review_changes(old, old.replace('from="scan"', 'from="lidar/scan"'))
    assert changes == [
        "node 'cam/driver': remapping lidar/scan scan_raw added",
        "node 'cam/driver': remapping scan scan_raw removed",
    ]
    assert found_breaking == ["node 'cam/driver': remapping lidar/scan scan_raw added"]


@pytest.mark.parametrize(("name", "is_breaking"), [("ekf_filter_node", False), ("filter", True)])
def test_name_that_a_known_program_has_anyway_is_not_lost(review_changes, name, is_breaking):
    node = '<node pkg="robot_localization" exec="ekf_node"{}/>'
    _, found_breaking = review_changes(node.format(f' name="{name}"'), node.format(""))
    assert bool(found_breaking) is is_breaking


@pytest.mark.parametrize(("name", "is_breaking"), [("set_pose", True), ("imu/data", False)])
def test_name_to_which_others_send_is_lost_if_a_known_program_serves_it(review_changes, name, is_breaking):
    node = '<node pkg="robot_localization" exec="ekf_node">{}</node>'
    _, found_breaking = review_changes(node.format(""), node.format(f'<remap from="{name}" to="filter/{name}"/>'))
    assert bool(found_breaking) is is_breaking


def test_deleted_parameters_of_ros_1_are_called_deleted(repository, compare):
    path, node = "arm/launch/arm.launch", '<launch>{}<node pkg="arm" type="d" name="d">{}</node></launch>'
    old = node.format("", '<rosparam command="delete" param="old"/>')
    new = node.format('<rosparam command="delete" param="cal"/>', '<rosparam command="delete" param="a"/>')
    repository.commit({"arm/package.xml": PACKAGE_XML, path: old})
    repository.write({path: new})
    assert sentences(subject(compare(repository), path)) == [
        "node 'arm/d': deleted parameters [old] -> [a]",
        "deletion of the parameters 'cal' added",
    ]


def test_added_launch_file_names_environment_variables_that_must_be_set(repository, compare):
    repository.commit({"arm/package.xml": PACKAGE_XML})
    text = """import os
from launch import LaunchDescription
from launch.actions import DeclareLaunchArgument

MODEL, WORLD = os.environ["ARM_MODEL"], os.environ.get("ARM_WORLD", "")


def generate_launch_description():
    return LaunchDescription([DeclareLaunchArgument("gui", default_value="false")])
"""
    repository.write({"arm/launch/arm.launch.py": text})
    assert sentences(subject(compare(repository), "arm/launch/arm.launch.py")) == [
        "launch file added: use of environment variable 'ARM_MODEL' (required), argument 'gui' (default false, unused)"
    ]


def test_parameter_from_a_command_is_called_one(review_changes):
    text = '<param name="robot_description" command="xacro {}.xacro"/>'
    changes, _ = review_changes(text.format("a"), text.format("b"))
    assert "$(command xacro a.xacro) -> $(command xacro b.xacro)" in changes[0]


@pytest.mark.parametrize(
    ("child", "tag"),
    [
        ('<include file="b.launch">{}</include>', '<remap from="a" to="b"/>'),
        ('<node pkg="arm" type="arm" name="arm">{}</node>', '<arg name="a" value="b"/>'),
    ],
)
def test_tags_that_roslaunch_ignores_are_named(review_changes, child, tag):
    other = '<node pkg="cam" type="cam" name="cam"/>'
    changes, lost = review_changes(other + child.format(""), other + child.format(tag))
    assert [change for change in changes if "effect" in change] == [
        f"tag without effect <{tag[1:-2]}> in <{child[1:].split(' ')[0]}> added"
    ]
    assert lost == []


def test_tags_that_roslaunch_reads_are_not_without_effect(review_changes):
    node = NODE.replace("</node>", '<env-loader/></node><include file="b.launch"><arg name="a" value="b"/></include>')
    changes, _ = review_changes("", node.replace("<env-loader/>", ""))
    assert not [change for change in changes if "effect" in change]


UNUSED_ARGUMENT = """<launch>
  <arg name="rate" default="1"/><arg name="gui" default="false"/>{}
  <node pkg="arm" type="arm" name="arm" args="$(arg rate)"/>
</launch>
"""


@pytest.mark.parametrize(
    ("other", "is_unused"),
    [
        ("", True),
        ('<include file="$(find arm)/launch/b.launch"/>', True),
        ('<include file="$(find arm)/launch/b.launch" pass_all_args="true"/>', False),
        ('<include file="$(find-pkg-share arm)/launch/b.launch.py"/>', False),  # ROS 2 passes all arguments
        ('<group if="$(arg gui)"><node pkg="gui" type="gui" name="gui"/></group>', False),
    ],
)
def test_unused_arguments_of_an_added_launch_file_are_marked(repository, compare, other, is_unused):
    text = UNUSED_ARGUMENT.format(other)
    text = text.replace("type=", "exec=").replace("$(arg", "$(var") if "find-pkg-share" in text else text
    repository.commit({"arm/package.xml": PACKAGE_XML})
    repository.write({PATH: text})
    (line,) = sentences(subject(compare(repository), PATH))
    assert ("argument 'gui' (default false, unused)" in line) is is_unused
    assert "argument 'rate' (default 1)" in line


@pytest.mark.parametrize(("value", "is_told"), [("true", True), ("1", True), ("false", False)])
def test_an_include_that_passes_all_arguments_is_told(repository, compare, value, is_told):
    include = '<include file="$(find arm)/launch/b.launch"{}><arg name="rate" value="2"/></include>'
    text = f'<launch><arg name="rate" default="1"/><arg name="gui" default="1"/>{include}</launch>'
    included = '<launch><arg name="rate"/><arg name="gui" default="0"/></launch>'
    other = {"arm/package.xml": PACKAGE_XML.replace("arm_description", "arm"), "arm/launch/b.launch": included}
    repository.commit({**other, PATH: text.format("")})
    repository.write({PATH: text.format(f' pass_all_args="{value}"')})
    result = compare(repository)
    found = [sentence for item in result.subjects for sentence in sentences(item)]
    assert found == (["include of '$(find arm)/launch/b.launch': pass_all_args true added"] if is_told else [])
    assert not result.breaking_changes


def test_a_removed_launch_file_is_told_with_what_it_started(repository, compare):
    include = '<include file="$(find arm)/launch/b.launch"><arg name="name" value="left"/></include>'
    repository.commit({PATH: f"<launch><arg name='a' default='1'/>{NODE}{include}</launch>\n", "a.txt": "a"})
    repository.write({PATH: None})
    assert breaking(compare(repository)) == [
        "launch file removed: node 'cam/driver', include of '$(find arm)/launch/b.launch' (name left)"
    ]


@pytest.mark.parametrize(("use", "is_unused"), [("", True), ("[port]", False)])
def test_argument_of_an_added_python_file_whose_name_nothing_uses_is_unused(repository, compare, use, is_unused):
    text = f"""from launch import LaunchDescription
from launch.actions import DeclareLaunchArgument
from launch.substitutions import LaunchConfiguration
from launch_ros.actions import Node


def generate_launch_description():
    port = LaunchConfiguration("port", default="/dev/ttyUSB0")
    driver = Node(package="arm", executable="driver", arguments={use or "[]"})
    return LaunchDescription([DeclareLaunchArgument("port", default_value="/dev/ttyUSB0"), driver])
"""
    repository.commit({"arm/package.xml": PACKAGE_XML})
    repository.write({"arm/launch/arm.launch.py": text})
    (line,) = sentences(subject(compare(repository), "arm/launch/arm.launch.py"))[:1]
    assert ("argument 'port' (default /dev/ttyUSB0, unused)" in line) is is_unused
