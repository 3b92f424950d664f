"""Remappings of names that a node offers, uses, or of which nothing is known, in a review."""

from __future__ import annotations

import pytest

from tests.repositories import PACKAGE_XML
from tests.review.conftest import subject

SOURCE = """import rospy
rospy.init_node("n")
rospy.Subscriber("scan", Scan, call)
pub = rospy.Publisher("goal", Goal)
plan = rospy.ServiceProxy("make_plan", Plan)
"""
CERTAIN = "programs that use the name '{}' do not find it"
POSSIBLE = "if the node publishes or serves '{}', programs that use it do not find it"


@pytest.mark.parametrize(
    ("package", "name", "reason"),
    [
        ("arm", "scan", None),
        ("arm", "~make_plan", None),
        ("arm", "goal", CERTAIN),
        ("arm", "other", None),
        ("arm", "diagnostics", POSSIBLE),
        ("elsewhere", "scan", POSSIBLE),
        ("elsewhere", "cloud_in", None),
        ("move_base", "odom", None),
        ("move_base", "map", POSSIBLE),
        ("elsewhere", "cloud_out", CERTAIN),
    ],
)
def test_remapping_is_breaking_by_the_side_of_the_node(repository, compare, package, name, reason):
    remap = f'<remap from="{name}" to="/base/x"/>'
    text = f'<launch><node pkg="{package}" type="n.py" name="n">{remap}</node></launch>'
    files = {"arm/package.xml": PACKAGE_XML.replace("arm_description", "arm"), "arm/scripts/n.py": SOURCE}
    repository.commit({**files, "arm/launch/arm.launch": text.replace(remap, "")})
    repository.write({"arm/launch/arm.launch": text})
    (change,) = subject(compare(repository), "arm/launch/arm.launch").changes
    assert (None if change.reason is None else str(change.reason)) == (reason and reason.format(name))


@pytest.mark.parametrize(
    ("program", "name", "reason"),
    [
        ("move_base/move_base", "map", None),
        ("move_base/move_base", "move_base_simple/goal", None),
        ("move_base/move_base", "cmd_vel", CERTAIN),
        ("slam_toolbox/async_slam_toolbox_node", "map", CERTAIN),
        ("imu_filter_madgwick/imu_filter_madgwick_node", "imu/mag", None),
        ("imu_filter_madgwick/imu_filter_madgwick_node", "imu/data", CERTAIN),
        ("nav2_amcl/amcl", "initialpose", None),
        ("robot_localization/ekf_node", "odometry/filtered", CERTAIN),
        ("amcl/amcl", "map", None),
        ("map_server/map_server", "map", CERTAIN),
        ("joint_state_publisher/joint_state_publisher", "follow_joint_trajectory", None),
        ("joint_state_publisher/joint_state_publisher", "joint_states", CERTAIN),
        ("joint_state_publisher_gui/joint_state_publisher_gui", "follow_joint_trajectory", None),
        ("joint_state_publisher_gui/joint_state_publisher_gui", "joint_states", CERTAIN),
        ("joint_state_publisher/joint_state_publisher", "~other", POSSIBLE),
        ("controller_manager/ros2_control_node", "~/robot_description", None),
        ("robot_state_publisher/robot_state_publisher", "robot_description", POSSIBLE),
        ("move_base/move_base", "base_scan", None),
        ("move_base/move_base", "NavfnROS/plan", POSSIBLE),
    ],
)
def test_topics_of_well_known_programs_have_a_side(repository, compare, program, name, reason):
    remap = f'<remap from="{name}" to="/base/x"/>'
    package, _, executable = program.partition("/")
    text = f'<launch><node pkg="{package}" type="{executable}" name="n">{remap}</node></launch>'
    repository.commit({"arm/launch/arm.launch": text.replace(remap, "")})
    repository.write({"arm/launch/arm.launch": text})
    (change,) = subject(compare(repository), "arm/launch/arm.launch").changes
    assert (None if change.reason is None else str(change.reason)) == (reason and reason.format(name))


@pytest.mark.parametrize(
    ("target", "reason"),
    [("/robot/move_base/make_plan", None), ("/robot/other/make_plan", POSSIBLE), ("/robot/move_base/x", POSSIBLE)],
)
def test_a_name_of_a_well_known_node_is_used_by_other_nodes(repository, compare, target, reason):
    remap = f'<remap from="plan_route" to="{target}"/>'
    text = f'<launch><node pkg="elsewhere" type="goals" name="n">{remap}</node></launch>'
    repository.commit({"arm/launch/arm.launch": text.replace(remap, "")})
    repository.write({"arm/launch/arm.launch": text})
    (change,) = subject(compare(repository), "arm/launch/arm.launch").changes
    assert (None if change.reason is None else str(change.reason)) == (reason and reason.format("plan_route"))


def test_robot_state_publisher_of_ros2_publishes_the_description(repository, compare):
    remap = '<remap from="/robot_description" to="arm_description"/>'
    text = f'<launch><node pkg="robot_state_publisher" exec="robot_state_publisher">{remap}</node></launch>'
    repository.commit({"arm/launch/arm.launch.xml": text.replace(remap, "")})
    repository.write({"arm/launch/arm.launch.xml": text})
    (change,) = subject(compare(repository), "arm/launch/arm.launch.xml").changes
    assert str(change.reason) == CERTAIN.format("/robot_description")


@pytest.mark.parametrize(
    ("name", "reason"),
    [("/base/scan", None), ("/base/make_plan", None), ("/base/goal", CERTAIN), ("/base/other", None)],
)
def test_absolute_name_of_a_remapping_may_begin_with_the_namespace_of_the_node(repository, compare, name, reason):
    remap = f'<remap from="{name}" to="/base/x"/>'
    text = f'<launch><node pkg="arm" type="n.py" name="n">{remap}</node></launch>'
    files = {"arm/package.xml": PACKAGE_XML.replace("arm_description", "arm"), "arm/scripts/n.py": SOURCE}
    repository.commit({**files, "arm/launch/arm.launch": text.replace(remap, "")})
    repository.write({"arm/launch/arm.launch": text})
    (change,) = subject(compare(repository), "arm/launch/arm.launch").changes
    assert (None if change.reason is None else str(change.reason)) == (reason and reason.format(name))


def test_remapping_of_an_absolute_name_that_the_node_gets_in_the_same_change_breaks_nobody(repository, compare):
    text = '<launch><node pkg="arm" type="n.py" name="n"><remap from="/base/level" to="/x"/></node></launch>'
    files = {"arm/package.xml": PACKAGE_XML.replace("arm_description", "arm"), "arm/scripts/n.py": SOURCE}
    repository.commit({**files, "arm/launch/arm.launch": text.replace('<remap from="/base/level" to="/x"/>', "")})
    source = f'{SOURCE}level = rospy.Publisher("level", Level)\n'
    repository.write({"arm/launch/arm.launch": text, "arm/scripts/n.py": source})
    assert [change.reason for change in subject(compare(repository), "arm/launch/arm.launch").changes] == [None]


BRIDGE = """<launch><node pkg="ros_gz_bridge" exec="parameter_bridge"
  args="/light@std_msgs/msg/Bool[gz.msgs.Boolean /dark@std_msgs/msg/Bool]gz.msgs.Boolean"/></launch>
"""


@pytest.mark.parametrize(("topic", "is_breaking"), [("light", False), ("dark", True)])
def test_removed_remapping_to_a_topic_that_a_bridge_publishes_now(repository, compare, topic, is_breaking):
    text = f'<launch><node pkg="arm" exec="n"><remap from="out" to="{topic}"/></node></launch>'
    include = '<include file="$(dirname)/bridge.launch.xml"/></launch>'
    repository.commit({"arm/launch/bridge.launch.xml": BRIDGE, "arm/launch/arm.launch.xml": text})
    new = text.replace(f'<remap from="out" to="{topic}"/>', "").replace("</launch>", include)
    repository.write({"arm/launch/arm.launch.xml": new})
    changes = subject(compare(repository), "arm/launch/arm.launch.xml").changes
    assert [change for change in changes if change.reason is not None] == changes[: int(is_breaking)]


def test_side_of_a_nodelet_is_that_of_its_class(review_changes):
    node = '<node pkg="nodelet" type="nodelet" name="n" args="load depthimage_to_laserscan/Nodelet manager">'
    text = f'<launch>{node}<remap from="image" to="depth/image_raw"/></node></launch>'
    assert review_changes("arm.launch", text, "depth/image_raw", "other/image_raw")[1] == []


def test_remapping_of_a_name_that_is_new_in_the_node_breaks_nobody(repository, compare):
    remap = '<remap from="~goal" to="/base/x"/>'
    text = f'<launch><node pkg="arm" type="n.py" name="n">{remap}</node></launch>'
    source = SOURCE.replace('pub = rospy.Publisher("goal", Goal)\n', "")
    files = {"arm/package.xml": PACKAGE_XML.replace("arm_description", "arm"), "arm/scripts/n.py": source}
    repository.commit({**files, "arm/launch/arm.launch": text.replace(remap, "")})
    repository.write({"arm/launch/arm.launch": text, "arm/scripts/n.py": SOURCE})
    (change,) = subject(compare(repository), "arm/launch/arm.launch").changes
    assert change.reason is None


@pytest.mark.parametrize(("has_controller", "is_breaking"), [(False, False), (True, True)])
def test_remapping_of_a_name_of_a_controller_breaks_nobody_if_the_controller_is_new(
    repository, compare, has_controller, is_breaking
):
    remap = '<remap from="base_controller/transition_event" to="base_controller/_event"/>'
    node = '<launch><node pkg="controller_manager" exec="ros2_control_node" name="m">{}</node></launch>'
    controllers = "base_controller:\n  ros__parameters:\n    rate: 1\n"
    repository.commit(
        {
            "arm/package.xml": PACKAGE_XML.replace("arm_description", "arm"),
            "arm/launch/arm.launch.xml": node.format(""),
            "arm/config/controllers.yaml": controllers if has_controller else "other: 1\n",
        }
    )
    repository.write({"arm/launch/arm.launch.xml": node.format(remap), "arm/config/controllers.yaml": controllers})
    (change,) = subject(compare(repository), "arm/launch/arm.launch.xml").changes
    assert (change.reason is not None) is is_breaking


@pytest.mark.parametrize(("target", "is_breaking"), [("/base/goal", False), ("/base/place", True)])
def test_a_name_that_an_added_node_has_now_is_not_lost(repository, compare, target, is_breaking):
    remap = '<remap from="goal" to="{}"/>'
    text = '<launch><node pkg="elsewhere" type="n" name="n">{}</node>{}</launch>'
    repository.commit({"arm/launch/arm.launch": text.format(remap.format("/base/goal"), "")})
    added = f'<node pkg="elsewhere" type="switch" name="switch">{remap.format(target)}</node>'
    repository.write({"arm/launch/arm.launch": text.format("", added)})
    changes = subject(compare(repository), "arm/launch/arm.launch").changes
    assert any(change.reason is not None for change in changes) is is_breaking


@pytest.mark.parametrize(("kept", "is_breaking"), [("/base/odd", False), ("/base/goal", True)])
def test_a_name_that_another_node_newly_has_is_not_lost(repository, compare, kept, is_breaking):
    remap = '<remap from="aim" to="{}"/>'
    text = f'<launch><node pkg="elsewhere" type="n" name="n">{remap}</node>{{}}</launch>'
    switch = f'<node pkg="elsewhere" type="switch" name="switch">{remap}</node>'
    repository.commit({"arm/launch/arm.launch": text.format("/base/goal", switch.format(kept))})
    repository.write({"arm/launch/arm.launch": text.format("/base/first", switch.format("/base/goal"))})
    changes = subject(compare(repository), "arm/launch/arm.launch").changes
    assert any("/base/goal" in str(change.reason) for change in changes) is is_breaking


REMAPPINGS = """<remap from="scan" to="left/scan"/><remap from="goal" to="left/goal"/>"""


@pytest.mark.parametrize(
    ("added", "reason"),
    [
        ("", CERTAIN.format("left/goal")),
        ('<remap from="goal" to="left/goal"/>', None),
        ('<node pkg="other" exec="m"><remap from="aim" to="left/goal"/></node>', None),
    ],
)
def test_removed_node_of_a_program_that_another_node_runs_is_missing_by_its_topics(repository, compare, added, reason):
    node = '<node pkg="arm" exec="n.py">{}</node>'
    text = f"<launch>{node.format(REMAPPINGS)}{node.format('')}</launch>"
    files = {"arm/package.xml": PACKAGE_XML.replace("arm_description", "arm"), "arm/scripts/n.py": SOURCE}
    repository.commit({**files, "arm/launch/arm.launch.xml": text})
    repository.write({"arm/launch/arm.launch.xml": f"<launch>{added}{node.format('')}</launch>"})
    changes = subject(compare(repository), "arm/launch/arm.launch.xml").changes
    (change,) = [change for change in changes if "removed" in str(change.sentence)]
    assert (None if change.reason is None else str(change.reason)) == reason
