"""Reviews of remappings that a launch file adds for all nodes that follow."""

from __future__ import annotations

import pytest

from tests.repositories import PACKAGE_XML
from tests.review.conftest import subject

LAUNCH = """from launch import LaunchDescription
from launch.actions import GroupAction, IncludeLaunchDescription
from launch.launch_description_sources import PythonLaunchDescriptionSource
from launch_ros.actions import Node, SetRemap
from launch_ros.substitutions import FindPackageShare


def generate_launch_description():
    return LaunchDescription([GroupAction([STARTED])])
"""
INCLUDE = 'IncludeLaunchDescription(PythonLaunchDescriptionSource([FindPackageShare("{}"), "/launch/{}"]))'
DRIVER = INCLUDE.format("imu_driver", "imu.launch.py")
NAVIGATION = INCLUDE.format("nav2_bringup", "navigation_launch.py")
MOVEIT = INCLUDE.format("robot_moveit_config", "move_group.launch.py")
OWN = INCLUDE.format("arm", "inner.launch.py")
AMCL = 'Node(package="nav2_amcl", executable="amcl")'
RVIZ = 'Node(package="rviz2", executable="rviz2")'
REMAP = 'SetRemap("imu/data", "data"), '
MAYBE = "if the node publishes or serves '{}', programs that use it do not find it"
PATH = "arm/launch/arm.launch.py"


@pytest.mark.parametrize(
    ("started", "added", "reasons"),
    [
        (DRIVER, REMAP, [MAYBE.format("imu/data")]),
        (DRIVER, 'SetRemap(dst="data", src="imu/data"), ', [MAYBE.format("imu/data")]),
        (OWN, REMAP, [MAYBE.format("imu/data")]),
        (AMCL, 'SetRemap("amcl_pose", "pose"), ', ["programs that use the name 'amcl_pose' do not find it"]),
        (AMCL, 'SetRemap("scan", "front/scan"), ', []),
        (NAVIGATION, 'SetRemap("scan", "front/scan"), ', []),
        (MOVEIT, 'SetRemap("joint_states", "/arm/states"), ', []),
        (RVIZ, REMAP, []),
        (DRIVER, 'SetRemap("/tf", "tf"), ', []),
        ('Node(package="a", executable="a", remappings=[("imu/data", "data")])', REMAP, []),
    ],
)
def test_a_remapping_is_breaking_if_a_node_that_follows_may_publish_the_name(
    repository, compare, started, added, reasons
):
    inner = LAUNCH.replace("STARTED", 'Node(package="imu_driver", executable="imu")')
    files = {PATH: LAUNCH.replace("STARTED", started), "arm/launch/inner.launch.py": inner}
    repository.commit({"arm/package.xml": PACKAGE_XML.replace("arm_description", "arm"), **files})
    repository.write({PATH: files[PATH].replace("GroupAction([", f"GroupAction([{added}")})
    changes = subject(compare(repository), PATH).changes
    assert [str(change.reason) for change in changes if change.reason is not None] == reasons


def test_a_remapping_of_new_nodes_breaks_nothing(repository, compare):
    files = {PATH: LAUNCH.replace("STARTED", AMCL)}
    repository.commit({"arm/package.xml": PACKAGE_XML.replace("arm_description", "arm"), **files})
    repository.write({PATH: files[PATH].replace("GroupAction([", f"GroupAction([{REMAP}{DRIVER}, ")})
    changes = subject(compare(repository), PATH).changes
    assert [str(change.reason) for change in changes if change.reason is not None and "imu/data" in str(change)] == []


def test_a_remapping_that_moves_out_of_an_included_file_breaks_nothing(repository, compare):
    inner = LAUNCH.replace("STARTED", f'{REMAP}Node(package="imu_driver", executable="imu")')
    files = {PATH: LAUNCH.replace("STARTED", OWN), "arm/launch/inner.launch.py": inner}
    repository.commit({"arm/package.xml": PACKAGE_XML.replace("arm_description", "arm"), **files})
    moved = files[PATH].replace("GroupAction([", f"GroupAction([{REMAP}")
    repository.write({PATH: moved, "arm/launch/inner.launch.py": inner.replace(REMAP, "")})
    assert [change.reason for change in subject(compare(repository), PATH).changes] == [None]


def test_a_remapping_that_moves_into_an_included_file_is_breaking_without_the_other_file(repository, compare):
    inner = LAUNCH.replace("STARTED", 'Node(package="imu_driver", executable="imu")')
    files = {PATH: LAUNCH.replace("STARTED", f"{REMAP}{OWN}"), "arm/launch/inner.launch.py": inner}
    repository.commit({"arm/package.xml": PACKAGE_XML.replace("arm_description", "arm"), **files})
    moved = inner.replace("GroupAction([", f"GroupAction([{REMAP}")
    repository.write({PATH: files[PATH].replace(REMAP, ""), "arm/launch/inner.launch.py": moved})
    (change,) = subject(compare(repository), "arm/launch/inner.launch.py").changes
    assert str(change.sentence).endswith(f"; {PATH} no longer sets it")
    assert str(change.reason).startswith(f"where the file is started without {PATH}, if the node")


GROUP = """<launch>
  <node pkg="driver" type="driver" name="driver"/>
  <group ns="planner">{}
    <node pkg="{}" type="{}" name="planner"/>
  </group>
  <node pkg="other" type="other" name="other"/>
</launch>
"""
REMAPPING = '<remap from="base_scan" to="/scan"/>'


@pytest.mark.parametrize(("program", "is_breaking"), [("move_base", False), ("other", True)])
@pytest.mark.parametrize("is_removed", [False, True])
def test_a_remapping_of_a_group_concerns_only_its_nodes(review_changes, program, is_breaking, is_removed):
    texts = [GROUP.format(remapping, program, program) for remapping in ("", REMAPPING)]
    old, new = reversed(texts) if is_removed else texts
    changes, found = review_changes("arm.launch", old, old, new)
    assert len(changes) == 1
    assert bool(found) is is_breaking
