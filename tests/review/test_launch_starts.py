"""Changes of the nodes in launch files in a review: conditions, scripts and unknown names."""

from __future__ import annotations

import pytest

from linkwright.review.reports.sections import format_summary
from tests.repositories import Repository
from tests.review.conftest import breaking, sentences, subject

JOY = """<launch>
  <arg name="local" default="false"/>
  <group if="$(arg local)"><node pkg="joy" type="joy_node" name="joy"/></group>
  <node pkg="joy" type="joy_node" name="joy" unless="$(arg local)" machine="robot"/>
  <include file="$(find elsewhere)/launch/machines.launch"/>
  <node pkg="arm" type="clean.sh" name="clean"/>
</launch>
"""
GROUP, SECOND, INCLUDE, SCRIPT = (line + "\n" for line in JOY.splitlines()[2:6])


@pytest.mark.parametrize(
    ("replacements", "expected"),
    [
        ({GROUP: '<node pkg="joy" type="joy_node" name="joy"/>\n', SECOND: ""}, []),
        ({GROUP: "", SECOND: '<node pkg="joy" type="joy_node" name="joy"/>\n'}, []),
        ({GROUP: "", SECOND: ""}, ["node 'joy/joy_node' removed: unless $(arg local), name joy, machine robot"]),
        (
            {GROUP: '<node pkg="joy" type="joy_node" name="stick"/>\n', SECOND: ""},
            [
                "node 'joy/joy_node': name joy -> stick",
                "node 'joy/joy_node' removed: unless $(arg local), name joy, machine robot",
            ],
        ),
        ({INCLUDE: ""}, []),
        ({SCRIPT: ""}, []),
    ],
)
def test_node_that_another_action_starts_is_not_missing(repository, compare, replacements, expected):
    text = JOY
    for old, new in replacements.items():
        assert old in text
        text = text.replace(old, new)
    repository.commit({"arm/launch/arm.launch": JOY})
    repository.write({"arm/launch/arm.launch": text})
    unused = "argument 'local' is no longer used"
    assert [sentence for sentence in breaking(compare(repository)) if sentence != unused] == expected


SWITCHED = """<launch>
  <arg name="gui" default="false"/>
  <node pkg="joint_state_publisher" type="joint_state_publisher" name="joints" unless="$(arg gui)"/>
  <node pkg="PACKAGE" type="PACKAGE" name="joints" if="$(arg gui)"/>
</launch>
"""


@pytest.mark.parametrize(
    ("package", "expected"),
    [("joint_state_publisher_gui", []), ("arm_driver", ["argument 'gui': default false -> true"])],
)
def test_publisher_of_joint_states_with_a_window_is_no_missing_node(repository, compare, package, expected):
    text = SWITCHED.replace("PACKAGE", package)
    repository.commit({"arm/launch/arm.launch": text})
    repository.write({"arm/launch/arm.launch": text.replace('"false"', '"true"')})
    assert breaking(compare(repository)) == expected


@pytest.mark.parametrize(
    ("attributes", "spawner", "is_breaking"),
    [
        ("", 'args="joint_state_broadcaster"', False),
        ("", 'args="arm_controller -c /controller_manager joint_state_broadcaster"', False),
        ("", 'args="arm_controller"', True),
        ("", 'args="joint_state_broadcaster" if="false"', True),
        ("", 'args="joint_state_broadcaster" namespace="left"', True),
        ('><remap from="joint_states" to="sliders"/></node', 'args="joint_state_broadcaster"', True),
    ],
)
def test_a_broadcaster_replaces_a_publisher_of_joint_states(review_changes, attributes, spawner, is_breaking):
    node = f'<node pkg="joint_state_publisher_gui" exec="joint_state_publisher_gui"{attributes or "/"}>'
    text = f"<launch>\n  {node}\n</launch>\n"
    new_node = f'<node pkg="controller_manager" exec="spawner" {spawner}/>'
    changes, breaking_changes = review_changes("arm.launch.xml", text, node, new_node)
    assert len(breaking_changes) == is_breaking
    assert any("publishes the joint states" in str(change) for change in changes) is not is_breaking


@pytest.mark.parametrize(("program", "count"), [("joint_state_publisher_gui", 1), ("rviz2", 0)])
def test_new_namespace_of_a_publisher_with_a_window_is_breaking(review_changes, program, count):
    text = f'<launch>\n  <node pkg="{program}" exec="{program}" namespace="left"/>\n</launch>\n'
    changes, breaking_changes = review_changes("arm.launch.xml", text, '"left"', '"right"')
    assert len(changes) == 1
    assert len(breaking_changes) == count


OPTIONS = """from argparse import ArgumentParser
from launch import LaunchDescription
from launch_ros.actions import Node


def generate_launch_description():
    options = ArgumentParser()
    options.add_argument("-n", dest="node", default="camera")
    args = options.parse_args()
    return LaunchDescription([Node(package="arm", executable="camera_node", name="camera")])
"""


@pytest.mark.parametrize("name", ["args.node", 'vars(args)["node"]'])
def test_name_that_is_not_known_may_be_the_same(review_changes, name):
    changes, breaking_changes = review_changes("arm.launch.py", OPTIONS, 'name="camera"', f"name={name}")
    assert len(changes) == 1
    assert breaking_changes == []


def test_changes_of_several_files_are_counted_in_each(repository: Repository, compare):
    files = {f"arm/launch/{name}.launch": JOY for name in ("a", "b", "c")}
    repository.commit(files)
    repository.write({path: text.replace(SCRIPT, "").replace(' default="false"', "") for path, text in files.items()})
    result = compare(repository)
    assert len(sentences(subject(result, "arm/launch/a.launch"))) == 2
    assert str(format_summary(result)).startswith("3 breaking changes, 6 changes, ")


ADDED = """<launch>
  <arg name="robot"/>
  <arg name="rate" default="10"/>
  <arg name="name" default=""/>
  <include file="$(find elsewhere)/launch/demo.launch"><arg name="pipeline" value="chomp"/></include>
  <node pkg="arm" type="camera" name="camera"><remap from="image" to="/image"/><param name="fps" value="30"/></node>
  <rosparam file="$(find arm)/config/a.yaml" if="$(arg rate)"/>
</launch>
"""


def test_added_launch_file_is_shown_with_the_settings_of_its_actions(repository, compare):
    repository.commit({"arm/launch/other.launch": "<launch/>"})
    repository.write({"arm/launch/arm.launch": ADDED})
    (text,) = sentences(subject(compare(repository), "arm/launch/arm.launch"))
    assert text == (
        "launch file added: node 'arm/camera' (name camera, remapping image -> /image, parameter fps 30), "
        "include of '$(find elsewhere)/launch/demo.launch' (pipeline chomp), "
        "parameters of '$(find arm)/config/a.yaml' (if $(arg rate)), "
        "argument 'robot' (required), argument 'rate' (default 10), argument 'name' (default '', unused)"
    )


def test_condition_of_an_added_parameter_file_is_shown(repository, compare):
    line = next(line for line in ADDED.splitlines() if "rosparam" in line)
    repository.commit({"arm/launch/arm.launch": ADDED.replace(line, "")})
    repository.write({"arm/launch/arm.launch": ADDED})
    assert sentences(subject(compare(repository), "arm/launch/arm.launch")) == [
        "parameters of '$(find arm)/config/a.yaml' added: if $(arg rate)"
    ]


NODELETS = """<launch>
  <arg name="simulation" default="false"/>
  <remap from="scan" to="front/scan" if="$(arg simulation)"/>
  <node pkg="nodelet" type="nodelet" name="throttle" args="load laser/Throttle manager"/>
  <node pkg="arm" type="driver" name="left" ns="arm"/>
  <node pkg="arm" type="driver" name="right" ns="arm"/>
</launch>
"""
THROTTLE = NODELETS.splitlines()[3]


def test_nodelet_of_another_class_is_another_node(review_changes):
    new = THROTTLE.replace("throttle", "to_scan").replace("laser/Throttle", "depth/ToScan")
    changes, found = review_changes("arm.launch", NODELETS, THROTTLE, new)
    assert changes == [
        "node 'nodelet/nodelet' added: name to_scan, arguments load depth/ToScan manager",
        "node 'nodelet/nodelet' removed: name throttle, arguments load laser/Throttle manager",
    ]
    assert found == changes[1:]


def test_removed_remapping_that_did_not_hold_is_not_breaking(review_changes):
    line = NODELETS.splitlines()[2]
    assert review_changes("arm.launch", NODELETS, f"{line}\n", "") == (
        [
            "argument 'simulation' is no longer used",
            "remapping of 'scan' for the nodes that follow removed: if $(arg simulation), to front/scan",
        ],
        ["argument 'simulation' is no longer used"],
    )


def test_change_of_one_of_several_nodes_of_a_program_names_the_node(review_changes):
    assert review_changes("arm.launch", NODELETS, 'name="right"', 'name="right" output="screen"')[0] == [
        "node 'arm/driver' (arm/right): output screen added"
    ]


def test_same_change_of_several_but_not_all_nodes_of_a_program_names_each(review_changes):
    text = NODELETS.replace("</launch>", '<node pkg="arm" type="driver" name="back"/></launch>')
    assert review_changes("arm.launch", text, 'ns="arm"', 'ns="arm" output="screen"')[0] == [
        "node 'arm/driver' (arm/left), node 'arm/driver' (arm/right): output screen added"
    ]


def test_switch_that_stops_several_actions_names_all_of_them_and_static_transforms_last(repository, compare):
    text = """<launch>
  <arg name="laser" default="true"/>
  <group if="$(arg laser)">
    <node pkg="tf" type="static_transform_publisher" name="still" args="0 0 0 0 0 0 base laser 20"/>
    <include file="$(find laser)/laser.launch"/>
    <node pkg="laser" type="filter" name="filter"/>
  </group>
</launch>
"""
    repository.commit({"arm/launch/arm.launch": text})
    repository.write({"arm/launch/arm.launch": text.replace("true", "false")})
    ((_, change),) = compare(repository).breaking_changes
    assert str(change.reason) == (
        "by default, include of '$(find laser)/laser.launch', node 'laser/filter', "
        "node 'tf/static_transform_publisher' of 'laser' no longer start"
    )


@pytest.mark.parametrize(
    ("old_node", "is_breaking"),
    [
        ("", False),
        ('<node pkg="laser" type="filter" name="filter"/>', True),
        ('<node pkg="laser" type="old_filter" name="filter" if="$(arg laser)"/>', True),
    ],
)
def test_switch_does_not_stop_a_node_that_the_old_version_does_not_have(repository, compare, old_node, is_breaking):
    text = '<launch><arg name="laser" default="{}"/>{}</launch>\n'
    new_node = '<node pkg="laser" type="filter" name="filter" if="$(arg laser)"/>'
    repository.commit({"arm/launch/arm.launch": text.format("true", old_node)})
    repository.write({"arm/launch/arm.launch": text.format("false", new_node)})
    reasons = {
        str(change.sentence): change.reason for change in subject(compare(repository), "arm/launch/arm.launch").changes
    }
    is_told = reasons["argument 'laser': default true -> false"] is not None
    assert is_told == is_breaking


SPAWN = '<node pkg="ros_gz_sim" exec="create" args="-topic robot_description"/>'
SPAWNS = f'<launch><node pkg="rviz2" exec="rviz2"/>{SPAWN}</launch>'


@pytest.mark.parametrize(
    ("new", "is_breaking"),
    [
        ("", True),
        ('<include file="$(find-pkg-share arm)/launch/spawn.launch.xml"/>', False),
        ('<node pkg="gazebo_ros" exec="spawn_entity.py" args="-topic robot_description"/>', False),
        (SPAWN.replace("<node", '<node if="false"'), True),
    ],
)
def test_robot_that_is_no_longer_spawned_is_breaking(review_changes, new, is_breaking):
    assert bool(review_changes("arm.launch.xml", SPAWNS, SPAWN, new)[1]) is is_breaking


@pytest.mark.parametrize(("new", "is_breaking"), [("", True), (SPAWN, False)])
def test_spawner_of_the_repository_is_replaced_by_another_one(review_changes, new, is_breaking):
    old = '<node pkg="arm" exec="spawn_camera" args="camera.urdf"/>'
    _, found = review_changes("arm.launch.xml", SPAWNS.replace(SPAWN, old), old, new)
    assert bool(found) is is_breaking


LOOP = """import os
from launch import LaunchDescription
from launch_ros.actions import Node


def generate_launch_description():
    ld = LaunchDescription()
    for i in range(int(os.environ["ROBOTS"])):
        ld.add_action(Node(package="ros_gz_sim", executable="create", arguments=["-name", "robot" + str(i)]))
        ld.add_action(Node(package="arm", executable="driver", namespace="robot" + str(i)))
    return ld
"""
TWICE = """from launch import LaunchDescription
from launch_ros.actions import Node


def generate_launch_description():
    return LaunchDescription([
        Node(package="ros_gz_sim", executable="create", arguments=["-name", "robot1"]),
        Node(package="ros_gz_sim", executable="create", arguments=["-name", "robot2"]),
        Node(package="arm", executable="driver", namespace="robot1"),
        Node(package="arm", executable="driver", namespace="robot2"),
    ])
"""


def test_loop_of_unknown_length_may_start_all_old_nodes(repository, compare):
    repository.commit({"arm/launch/arm.launch.py": TWICE})
    repository.write({"arm/launch/arm.launch.py": LOOP})
    result = compare(repository)
    found = sentences(subject(result, "arm/launch/arm.launch.py"))
    assert any(sentence.startswith("node 'arm/driver' removed") for sentence in found)
    assert not any("removed" in sentence for sentence in breaking(result))


SWITCHES = """<launch>
  <arg name="left" default="true"/>
  <arg name="right" default="false"/>
  <group if="$(var left)"><node pkg="arm" exec="driver" name="d"/></group>
  <group if="$(var right)"><node pkg="arm" exec="driver" name="d"/></group>
</launch>
"""


def test_node_that_starts_under_another_condition_by_default_is_not_stopped(repository, compare):
    repository.commit({"arm/launch/arm.launch.xml": SWITCHES})
    new = SWITCHES.replace('"true"', '"no"').replace('"false"', '"true"').replace('"no"', '"false"')
    repository.write({"arm/launch/arm.launch.xml": new})
    assert breaking(compare(repository)) == []
    repository.write({"arm/launch/arm.launch.xml": SWITCHES.replace('"true"', '"false"')})
    assert breaking(compare(repository)) == ["argument 'left': default true -> false"]


@pytest.mark.parametrize(
    ("old", "new", "expected"),
    [
        ("5", "$(var rate)", "node 'arm/driver': parameter rate 5 -> $(var rate) (7 by default)"),
        ("7", "$(var rate)", "node 'arm/driver': parameter rate 7 -> $(var rate) (the same by default)"),
        ("$(var rate)", "5", "node 'arm/driver': parameter rate $(var rate) -> 5 (before, 7 by default)"),
        ("5", "$(env RATE)", "node 'arm/driver': parameter rate 5 -> $(env RATE)"),
    ],
)
def test_values_that_arguments_give_now_are_shown_with_their_defaults(review_changes, old, new, expected):
    node = f'<node pkg="arm" exec="driver"><param name="rate" value="{old}"/></node>'
    text = f'<launch><arg name="rate" default="7"/><let name="x" value="$(var rate)"/>{node}</launch>'
    found, _ = review_changes("arm.launch.xml", text, f'value="{old}"/></node>', f'value="{new}"/></node>')
    assert expected in found


def test_file_of_the_same_package_with_a_similar_name_replaces_an_include(review_changes):
    text = '<launch><include file="$(find camera)/launch/rs_rgbd.launch"/></launch>'
    found, lost = review_changes("arm.launch", text, "rs_rgbd", "rs_camera")
    files = [f"include of '$(find camera)/launch/{name}.launch'" for name in ("rs_rgbd", "rs_camera")]
    assert found == [" replaced by ".join(files)]
    assert lost == []


@pytest.mark.parametrize(
    ("name", "old", "new", "is_breaking"),
    [
        ("use_sim", "true", "false", True),
        ("use_fake_hardware", "false", "true", True),
        ("paused", "false", "true", True),
        ("paused", "true", "false", False),
        ("use_mock_hardware", "True", "False", True),
        ("use_gazebo", "true", "false", True),
        ("fake_execution", "false", "true", True),
        ("autostart", "true", "False", True),
        ("autostart", "true", "True", False),
        ("autostart", "false", "true", False),
        ("autostart_camera", "true", "false", False),
        ("gazebo_gui", "true", "false", False),
        ("use_sim_time", "true", "false", False),
        ("use_sim", "true", "True", False),
        ("sim_config", "true", "false", False),
    ],
)
def test_default_that_switches_between_hardware_and_simulation_is_breaking(
    repository, compare, name, old, new, is_breaking
):
    path = "arm/launch/arm.launch.xml"
    text = f"""<launch>
  <arg name="{name}" default="{{}}"/>
  <include file="$(find-pkg-share elsewhere)/launch/robot.launch.xml"><arg name="flag" value="$(var {name})"/></include>
</launch>
"""
    repository.commit({path: text.format(old)})
    repository.write({path: text.format(new)})
    assert bool(breaking(compare(repository))) is is_breaking


@pytest.mark.parametrize(
    ("name", "old", "new", "reason"),
    [
        ("paused", "false", "true", "the simulation starts paused"),
        ("paused", "false", "$(arg paused)", "the simulation starts paused"),
        ("use_sim", "true", "false", "by default, the hardware of the robot is used instead of a simulation"),
        ("autostart", "true", "False", "the nodes wait for a program that activates or starts them"),
        ("autostart", "false", "true", None),
        ("verbose", "false", "true", None),
    ],
)
def test_value_for_an_included_file_that_switches_a_simulation(repository, compare, name, old, new, reason):
    text = """<launch>
  <arg name="paused" default="true"/>
  <include file="$(find gazebo_ros)/launch/empty_world.launch"><arg name="{}" value="{}"/></include>
</launch>
"""
    path = "arm/launch/arm.launch"
    repository.commit({path: text.format(name, old)})
    repository.write({path: text.format(name, new)})
    reasons = [str(change.reason) for change in subject(compare(repository), path).changes if change.reason]
    assert reasons == ([] if reason is None else [reason])


@pytest.mark.parametrize(("name", "is_breaking"), [("gazebo", True), ("use_sim", True), ("gazebo_rate", False)])
@pytest.mark.parametrize("parent", ['<node pkg="a" type="a" name="a"/>{}', '<node pkg="a" type="a" name="a">{}</node>'])
def test_parameter_that_switches_between_hardware_and_simulation_is_breaking(
    repository, compare, name, is_breaking, parent
):
    values = [f'<param name="{name}" value="{value}"/>' for value in ("true", "false")]
    old, new = map(parent.format, values)
    repository.commit({"arm/launch/arm.launch": f"<launch>{old}</launch>"})
    repository.write({"arm/launch/arm.launch": f"<launch>{new}</launch>"})
    assert bool(breaking(compare(repository))) is is_breaking


@pytest.mark.parametrize(
    ("name", "file", "old", "new", "is_breaking"),
    [
        ("arm.launch", "$(find gazebo_ros)/launch/empty_world.launch", "true", "false", True),
        ("arm.launch", "$(find gazebo_ros)/launch/empty_world.launch", "false", "true", False),
        ("arm.launch.xml", "$(find-pkg-share gazebo_ros)/launch/gazebo.launch.py", "true", "false", True),
        ("arm.launch", "$(find elsewhere)/launch/robot.launch", "true", "false", False),
    ],
)
def test_default_that_closes_the_window_of_gazebo_is_breaking(review_changes, name, file, old, new, is_breaking):
    use = "$(arg window)" if name.endswith(".launch") else "$(var window)"
    text = f"""<launch><arg name="window" default="{old}"/>
      <include file="{file}"><arg name="gui" value="{use}"/></include></launch>"""
    _, lost = review_changes(name, text, f'default="{old}"', f'default="{new}"')
    assert bool(lost) is is_breaking


@pytest.mark.parametrize(
    ("old", "new", "is_breaking"),
    [
        ("-r a.sdf", "-r -s a.sdf", True),
        ("-r a.sdf", "-rs a.sdf", True),
        ("-r -s a.sdf", "-r a.sdf", False),
        ("-r a.sdf", "-r -s a.sdf if hidden else -r a.sdf", False),
    ],
)
def test_option_that_closes_the_window_of_gazebo_is_breaking(review_changes, old, new, is_breaking):
    text = f"""<launch><include file="$(find-pkg-share ros_gz_sim)/launch/gz_sim.launch.py">
      <arg name="gz_args" value="{old}"/></include></launch>"""
    _, lost = review_changes("arm.launch.xml", text, old, new)
    assert bool(lost) is is_breaking


CLOCK = """<launch>
  <arg name="use_sim_time" default="{default}"/>
  <node pkg="arm" exec="driver"><param name="use_sim_time" value="$(var use_sim_time)"/></node>
{more}</launch>
"""
CLOCK_REASON = "by default, timers of the nodes only run if a simulation or recording publishes '/clock'"


@pytest.mark.parametrize(
    ("path", "more", "includer", "is_breaking"),
    [
        ("arm/launch/robot.launch.xml", "", "", True),
        ("arm/launch/simulation.launch.xml", "", "", False),
        ("arm/launch/robot.launch.xml", '<include file="$(find-pkg-share ros_gz_sim)/launch/gz_sim.launch.py"/>', "",
         False),
        ("arm/launch/robot.launch.xml", '<executable cmd="ros2 bag play --clock log"/>', "", False),
        ("arm/launch/robot.launch.xml", "", '<include file="$(find-pkg-share arm)/launch/robot.launch.xml"/>', False),
    ],
)  # fmt: skip
def test_simulated_time_by_default_without_a_simulation(repository, compare, path, more, includer, is_breaking):
    manifest = "<package><name>arm</name><version>1.0.0</version></package>\n"
    others = {"arm/package.xml": manifest, "arm/launch/all.launch.xml": f"<launch>{includer}</launch>\n"}
    repository.commit({path: CLOCK.format(default="false", more=more), **others})
    repository.write({path: CLOCK.format(default="true", more=more)})
    reasons = [str(change.reason) for _, change in compare(repository).breaking_changes]
    assert reasons == ([CLOCK_REASON] if is_breaking else [])


@pytest.mark.parametrize(("value", "is_changed"), [("True", False), ("false", True), ('"true"', True)])
def test_boolean_parameter_in_another_notation_is_unchanged(repository, compare, value, is_changed):
    text = '<launch><node pkg="arm" type="arm" name="arm"><param name="on" type="bool" value=\'{}\'/></node></launch>\n'
    repository.commit({"arm/launch/arm.launch": text.format("true")})
    repository.write({"arm/launch/arm.launch": text.format(value)})
    changed = [sentence for found in compare(repository).subjects for sentence in sentences(found)]
    assert bool(changed) is is_changed


def test_node_with_another_condition_is_compared_with_the_equal_node(review_changes):
    node = '<node pkg="arm" exec="view" name="view"{} args="{}"/>'
    text = f"<launch><arg name='more' default='false'/>{node.format('', 'plain')}</launch>"
    nodes = node.format(' if="$(var more)"', "full") + node.format(' unless="$(var more)"', "plain")
    changes, found = review_changes("arm.launch.xml", text, node.format("", "plain"), nodes)
    assert [line for line in changes if line.startswith("node")] == [
        "node 'arm/view' (view): condition unless $(var more) added",
        "node 'arm/view' added: if $(var more), name view, arguments full",
    ]
    assert found == []


@pytest.mark.parametrize("name", ["hardware", "mock"])
def test_nobody_passes_the_old_values_under_the_new_name_of_an_argument(review_changes, name):
    text = """<launch><arg name="mock" default="false"/><include file="$(find-pkg-share base)/launch/a.launch.xml">
      <arg name="kind" value="$(var mock)"/></include></launch>"""
    new = text.replace('"mock" default="false"', f'"{name}" default="real"').replace("var mock", f"var {name}")
    _, found = review_changes("arm.launch.xml", text, text, new)
    is_renamed = name != "mock"
    assert found == [
        "argument 'mock' renamed to 'hardware'" if is_renamed else "argument 'mock': default false -> real"
    ]
