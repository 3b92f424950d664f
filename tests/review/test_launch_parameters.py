"""Parameters in launch files whose values are names that other programs use, in a review."""

from __future__ import annotations

import pytest

from tests.review.conftest import breaking

FILE = """<launch>
  <arg name="robot" default="arm"/>
  <node pkg="arm" type="driver" name="driver">
    <param name="{name}" value="state"/>
    <rosparam>
      gains:
      limit: ''
    </rosparam>
  </node>
</launch>
"""


@pytest.mark.parametrize(
    ("name", "new", "is_breaking"),
    [
        ("output_topic", "status", True),
        ("topic_pub", "status", True),
        ("pub_scan_topic", "status", True),
        ("output_topic", "/state", False),
        ("input_topic", "status", False),
        ("map_topic", "status", False),
        ("output_topic", "$(arg robot)/state", True),
    ],
)
def test_topic_that_a_node_publishes_is_a_name_that_others_use(review_changes, name, new, is_breaking):
    changes, found = review_changes("arm.launch", FILE.format(name=name), 'value="state"', f'value="{new}"')
    default = " (arm/state by default)" if "$" in new else ""
    assert changes == [f"node 'arm/driver': parameter {name} state -> {new}{default}"]
    assert found == (changes if is_breaking else [])


FILTER = """<launch>
  <node pkg="robot_localization" type="{program}" name="filter">
    <param name="{name}" value="/left/odometry"/>
  </node>
</launch>
"""


@pytest.mark.parametrize(
    ("program", "name", "new", "is_breaking"),
    [
        ("ekf_localization_node", "odom0", "right/odometry", True),
        ("ukf_localization_node", "imu1", "right/imu", True),
        ("ekf_localization_node", "odom0", "left/odometry", False),
        ("ekf_localization_node", "odom", "right/odometry", False),
        ("navsat_transform_node", "odom0", "right/odometry", False),
    ],
)
def test_topic_of_a_sensor_that_a_filter_no_longer_reads_is_breaking(review_changes, program, name, new, is_breaking):
    text = FILTER.format(program=program, name=name)
    changes, found = review_changes("arm.launch", text, "/left/odometry", new)
    assert changes == [f"node 'robot_localization/{program}': parameter {name} /left/odometry -> {new}"]
    assert found == (changes if is_breaking else [])


def test_null_is_not_an_empty_text(review_changes):
    text = FILE.format(name="rate")
    assert review_changes("arm.launch", text, "gains:", "gains: 1")[0] == [
        "node 'arm/driver': parameter gains null -> 1"
    ]


def test_empty_text_is_shown_as_one(review_changes):
    text = FILE.format(name="rate")
    assert review_changes("arm.launch", text, "limit: ''", "limit: 1")[0] == [
        "node 'arm/driver': parameter limit '' -> 1"
    ]


SERVER = """<launch>
  <arg name="robot" default="arm"/>
  <param name="description_$(arg robot)" value="text"/>
  <param name="limit" value="1"/>
  <rosparam file="$(find arm)/config/$(arg robot).yaml" command="load"/>
  <rosparam file="$(find arm)/config/limits.yaml" command="load"/>
</launch>
"""


@pytest.mark.parametrize(
    ("old", "new", "reason"),
    [
        ("description_$(arg robot)", "/$(arg robot)/description", "description_arm"),
        ("limit", "motion/limit", "limit"),
        ("limit", "limits", "limit"),
        ("limit", "/limit", ""),
    ],
)
def test_parameter_of_the_server_with_a_new_name_is_renamed(review_changes, old, new, reason):
    changes, found = review_changes("arm.launch", SERVER, f'name="{old}"', f'name="{new}"')
    assert changes == [f"parameter '{old}' renamed to '{new}'"]
    assert found == (changes if reason else [])


@pytest.mark.parametrize("new", ['name="speed" value="1"', 'name="motion/limit" value="2"'])
def test_parameter_of_the_server_with_another_name_or_value_is_another_one(review_changes, new):
    changes, found = review_changes("arm.launch", SERVER, 'name="limit" value="1"', new)
    assert len(changes) == 2
    assert not found


def test_old_name_that_another_parameter_has_is_not_gone(review_changes):
    line = '<param name="limit" value="1"/>'
    changes, found = review_changes("arm.launch", SERVER, line, f'{line}<param name="/a/limit" value="1"/>')
    assert changes == ["parameter '/a/limit' added: 1"]
    assert not found


@pytest.mark.parametrize(("new", "is_replaced"), [("config/left.yaml", True), ("other/left.yaml", False)])
def test_file_that_an_argument_chooses_is_replaced_by_a_fixed_one(review_changes, new, is_replaced):
    changes, _ = review_changes("arm.launch", SERVER, "config/$(arg robot).yaml", new)
    text = (
        "parameters of '$(find arm)/config/$(arg robot).yaml' replaced by parameters of '$(find arm)/config/left.yaml'"
    )
    assert (text in changes) == is_replaced
    assert any(change.endswith("removed") for change in changes) != is_replaced


FILE_NODE = """from launch import LaunchDescription
from launch_ros.actions import Node
from launch_ros.parameter_descriptions import ParameterFile
def generate_launch_description():
    return LaunchDescription([Node(package="arm", executable="a", parameters=[ParameterFile("/a.yaml"{})])])
"""


@pytest.mark.parametrize(
    ("old", "new", "text"),
    [
        ("", ", allow_substs=True", "[/a.yaml] -> [/a.yaml (allow_substs)]"),
        (", allow_substs=True", ", allow_substs=False", "[/a.yaml (allow_substs)] -> [/a.yaml]"),
        ("", ", allow_substs=False", ""),
    ],
)
def test_substitutions_in_a_parameter_file_of_python(repository, compare, old, new, text):
    repository.commit({"arm/package.xml": "<package><name>arm</name></package>"})
    repository.commit({"arm/launch/a.launch.py": FILE_NODE.format(old)})
    repository.write({"arm/launch/a.launch.py": FILE_NODE.format(new)})
    lines = [str(change.sentence) for subject in compare(repository).subjects for change in subject.changes]
    assert lines == ([f"node 'arm/a': parameters {text}"] if text else [])


def test_substitutions_in_a_parameter_file_of_xml(review_changes):
    text = '<launch><node pkg="arm" exec="a"><param from="/a.yaml"/></node></launch>\n'
    changes, _ = review_changes("a.launch.xml", text, 'yaml"', 'yaml" allow_substs="true"')
    assert changes == ["node 'arm/a': parameters [/a.yaml] -> [/a.yaml (allow_substs)]"]


CALLERS = """<launch>
  <arg name="{0}" default="{1}"/>
  <include file="$(find-pkg-share arm)/launch/b.launch.xml">{2}</include>
</launch>
"""


@pytest.mark.parametrize(
    ("name", "default", "passed", "is_renamed"),
    [
        ("config", "true", '<arg name="config" value="$(var config)"/>', False),
        ("config", "a.yaml", '<arg name="config" value="$(var config)"/>', False),
        ("broadcast", "true", '<arg name="publish_tf" value="$(var broadcast)"/>', True),
        ("publish_tfs", "true", '<arg name="publish_tfs" value="$(var publish_tfs)"/>', True),
    ],
)
def test_arguments_are_renamed_only_if_their_names_or_the_places_of_their_values_are_alike(
    repository, compare, name, default, passed, is_renamed
):
    old = CALLERS.format("publish_tf", "true", '<arg name="publish_tf" value="$(var publish_tf)"/>')
    repository.commit({"arm/launch/a.launch.xml": old})
    repository.write({"arm/launch/a.launch.xml": CALLERS.format(name, default, passed)})
    result = compare(repository)
    renamed = f"argument 'publish_tf' renamed to '{name}'"
    assert (renamed in breaking(result)) == is_renamed
    assert any(sentence.startswith("argument 'publish_tf' removed") for sentence in breaking(result)) != is_renamed


def test_arguments_of_conditions_of_different_actions_are_not_renamed(repository, compare):
    text = "<launch>{}<include file='$(find-pkg-share arm)/launch/{}.launch.xml' {}/></launch>\n"
    old = text.format("<arg name='safety' default='true'/>", "safety", "if='$(var safety)'")
    for file, is_renamed in (("hands", False), ("safety", True)):
        repository.commit({"arm/launch/a.launch.xml": old})
        new = text.format("<arg name='mockup' default='true'/>", file, "if='$(var mockup)'")
        repository.write({"arm/launch/a.launch.xml": new})
        assert ("argument 'safety' renamed to 'mockup'" in breaking(compare(repository))) is is_renamed


FRAMES = """<launch>
  <arg name="robot" default="amy"/>
  <node pkg="arm" type="start.sh" name="simulator" args="$(arg robot)">
    <param name="base_frame" value="$(arg robot)/base"/>
    <param name="sole_frame" value="$(arg robot)/sole"/>
    <param name="imu_frame" value="$(arg robot)/imu"/>
  </node>
</launch>
"""


def test_frames_that_no_longer_depend_on_an_argument_are_one_breaking_line(repository, compare):
    path = "arm/launch/arm.launch"
    repository.commit({path: FRAMES})
    new = FRAMES.replace("$(arg robot)/", "$(arg prefix)").replace("<node", '<arg name="prefix" default=""/><node')
    repository.write({path: new})
    ((_, change),) = compare(repository).breaking_changes
    assert str(change.sentence) == (
        "node 'arm/start.sh': parameters base_frame $(arg robot)/base -> $(arg prefix)base, "
        "sole_frame $(arg robot)/sole -> $(arg prefix)sole, imu_frame $(arg robot)/imu -> $(arg prefix)imu"
    )
    assert str(change.reason) == "for callers that pass 'robot', programs do not find the frames by their old names"


def test_a_single_frame_of_a_node_may_be_one_that_it_uses(repository, compare):
    path = "arm/launch/arm.launch"
    text = "\n".join(line for line in FRAMES.splitlines() if "sole" not in line and "imu" not in line)
    repository.commit({path: text})
    repository.write({path: text.replace("$(arg robot)/", "")})
    assert not compare(repository).breaking_changes


def test_several_changed_numbers_of_a_node_are_one_line(review_changes):
    text = """<launch><node pkg="arm" exec="driver"><param name="a" value="1"/><param name="b" value="0.5"/>
<param name="c" value="3"/><param name="on" value="true"/></node></launch>"""
    old = text[text.index("<param") : text.index("</node>")]
    new = old.replace('"1"', '"2"').replace('"0.5"', '"0.25"').replace('"3"', '"4"').replace("true", "false")
    found, _ = review_changes("arm.launch.xml", text, old, new)
    assert found == [
        "node 'arm/driver': parameters a 1 -> 2, b 0.5 -> 0.25, c 3 -> 4",
        "node 'arm/driver': parameter on true -> false",
    ]
