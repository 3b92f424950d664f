"""Changes in a review of launch files whose nodes other programs replace, or a simulated robot."""

from __future__ import annotations

import pytest

from tests.repositories import PACKAGE_XML
from tests.review.conftest import breaking, sentences, subject

PATH = "arm/launch/arm.launch.xml"
_DEPENDENCIES = "".join(f"<exec_depend>{name}</exec_depend>" for name in ("hokuyo", "stick", "see"))
MANIFEST = PACKAGE_XML.replace("</package>", f"{_DEPENDENCIES}</package>")
LAUNCH = "<launch>\n{}\n</launch>\n"
LASER = '<node pkg="{0}" exec="{0}_node" name="{1}"><param name="dev" value="a"/>{2}</node>'
REMAP = '<remap from="scan" to="raw"/>'


@pytest.mark.parametrize(
    ("old", "new", "expected", "broken"),
    [
        (
            LASER.format("sick", "sick", REMAP),
            LASER.format("hokuyo", "laser", REMAP),
            "node 'sick/sick_node' replaced by node 'hokuyo/hokuyo_node'",
            ["node 'hokuyo/hokuyo_node': name sick -> laser"],
        ),
        (
            '<node pkg="pad" exec="pad_node"><param name="repeat" value="10"/><param name="id" value="0"/></node>',
            '<node pkg="stick" exec="stick_node"><param name="repeat" value="10"/><param name="dev" value="1"/></node>',
            "node 'pad/pad_node' replaced by node 'stick/stick_node'",
            [],
        ),
        (
            '<node pkg="pad" exec="pad_node"><param name="odom_frame" value="odom"/></node>',
            '<node pkg="stick" exec="stick_node"><param name="odom_frame" value="odom"/></node>',
            "node 'stick/stick_node' added: parameter odom_frame odom",
            ["node 'pad/pad_node' removed: parameter odom_frame odom"],
        ),
        (
            '<node pkg="map" exec="map_HeightMap" namespace="a" name="b"/>',
            '<node pkg="see" exec="see_HeightMap"/>',
            "node 'map/map_HeightMap' replaced by node 'see/see_HeightMap'",
            ["node 'see/see_HeightMap': namespace a removed, name b removed"],
        ),
        (
            '<node pkg="map" exec="map_HeightMap"/>',
            '<node pkg="see" exec="see_HeightMap"/>',
            "node 'map/map_HeightMap' replaced by node 'see/see_HeightMap'",
            [],
        ),
        (
            '<node pkg="map" exec="map_node"/>',
            '<node pkg="see" exec="see_node"/>',
            "node 'see/see_node' added",
            ["node 'map/map_node' removed"],
        ),
    ],
)
def test_a_node_in_the_place_of_another_one_replaces_it(repository, compare, old, new, expected, broken):
    repository.commit({"arm/package.xml": MANIFEST, PATH: LAUNCH.format(old)})
    repository.write({PATH: LAUNCH.format(new)})
    result = compare(repository)
    assert expected in sentences(subject(result, PATH))
    assert breaking(result) == broken


MANAGER = '<node pkg="controller_manager" exec="ros2_control_node"/>'
SPAWN = '<node pkg="ros_gz_sim" exec="create"/>'
ROBOT = '<robot name="arm"><link name="a"/><gazebo>{}</gazebo></robot>\n'
PLUGIN = '<plugin filename="gz_ros2_control-system" name="gz_ros2_control::GazeboSimROS2ControlPlugin"/>'


@pytest.mark.parametrize(
    ("spawn", "plugin", "is_breaking"), [(SPAWN, PLUGIN, False), ("", PLUGIN, True), (SPAWN, f"<!--{PLUGIN}-->", True)]
)
def test_a_simulated_robot_has_its_own_controller_manager(repository, compare, spawn, plugin, is_breaking):
    repository.commit(
        {
            "arm/package.xml": PACKAGE_XML,
            "arm/urdf/arm.urdf.xacro": ROBOT.format(plugin),
            PATH: LAUNCH.format(MANAGER + spawn),
        }
    )
    repository.write({PATH: LAUNCH.format(spawn)})
    result = compare(repository)
    (text,) = sentences(subject(result, PATH))
    assert text.endswith("; the simulated robot has a controller manager") is not is_breaking
    assert bool(breaking(result)) is is_breaking


def test_a_node_whose_variable_gets_another_node_is_not_started(review_changes):
    text = """from launch import LaunchDescription
from launch_ros.actions import Node


def generate_launch_description():
    mux = Node(package="arm", executable="mux", name="mux")
    return LaunchDescription([mux])
"""
    line = '    mux = Node(package="arm", executable="mux", name="mux")\n'
    found, _ = review_changes(
        "arm.launch.py", text, line, f'    mux = Node(package="arm", executable="old_mux")\n{line}'
    )
    assert not any("old_mux'" in sentence and "node" in sentence.split()[0] for sentence in found), found


def test_a_costmap_loses_nothing_if_another_layer_reads_the_topic(repository, compare):
    text = """costmap:
  ros__parameters:
    plugins: [one, two, three]
    one: {plugin: nav2::Obstacles, observation_sources: scan, scan: {topic: /scan}}
    two: {plugin: nav2::Voxels, observation_sources: scan, scan: {topic: /scan}}
    three: {plugin: nav2::Voxels, observation_sources: cloud, cloud: {topic: /cloud}}
"""
    path = "arm/config/navigation.yaml"
    for plugins, is_breaking in (("two, three", False), ("one, two", True)):
        repository.commit({"arm/package.xml": PACKAGE_XML, path: text})
        repository.write({path: text.replace("one, two, three", plugins)})
        assert bool(breaking(compare(repository))) is is_breaking


def test_transforms_of_a_removed_bridge_are_those_of_the_simulator(repository, compare):
    bridge = '- ros_topic_name: "/{}"\n  gz_topic_name: "/x/{}"\n  ros_type_name: "a/msg/B"\n  gz_type_name: "c.D"\n'
    path = "arm/config/bridge.yaml"
    repository.commit({"arm/package.xml": PACKAGE_XML, path: bridge.format("tf", "tf") + bridge.format("a", "b")})
    repository.write({path: bridge.format("a", "b")})
    (change,) = subject(compare(repository), path).changes
    assert str(change.reason) == "the transforms of the simulator are no longer on '/tf'"


def test_the_spawn_command_of_the_controller_manager_of_ros_1_starts_controllers(review_changes):
    node = '<node pkg="controller_manager" type="controller_manager" name="spawner" args="spawn left right"/>'
    text = f"<launch>{node}</launch>"
    changes, found_breaking = review_changes("arm.launch", text, "spawn left right", "spawn left")
    assert found_breaking == changes
    (change,) = changes
    assert change.startswith("node 'controller_manager/controller_manager' of 'left'")


NAVIGATION = '<node pkg="{0}" exec="{1}" name="{1}"><param name="rate" value="10"/><param name="id" value="0"/></node>'
COMPONENT = """<load_composable_node target="box" if="$(var composed)">
<composable_node pkg="smooth" plugin="smooth::Server" name="smoother">
<param name="rate" value="10"/><param name="id" value="0"/></composable_node></load_composable_node>
<arg name="composed" default="false"/>"""


def test_a_component_beside_its_program_replaces_no_other_node(repository, compare):
    old = NAVIGATION.format("recover", "recoveries")
    new = '<node pkg="smooth" exec="smoother" name="smoother"/>' + COMPONENT
    repository.commit({"arm/package.xml": MANIFEST, PATH: LAUNCH.format(old)})
    repository.write({PATH: LAUNCH.format(new)})
    assert not any("smooth::Server" in line for line in breaking(compare(repository)))
