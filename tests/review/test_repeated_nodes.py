"""Changes in a review of launch files with equal names of nodes, and of inputs that nothing publishes."""

from __future__ import annotations

import pytest

from tests.repositories import PACKAGE_XML
from tests.review.conftest import breaking, sentences, subject

NODE = '<node pkg="arm" type="arm" name="arm"{}/>\n'
LAUNCH = '<launch>\n<arg name="sim" default="true"/>\n{}</launch>\n'


@pytest.mark.parametrize(
    ("other", "is_breaking"),
    [
        (NODE.format(""), True),
        (NODE.format(' if="$(arg sim)"'), True),
        (NODE.format(' unless="$(arg sim)"'), False),
        (f'<group ns="left">{NODE.format("")}</group>\n', False),
    ],
)
def test_roslaunch_refuses_equal_names_of_nodes(repository, compare, other, is_breaking):
    path = "arm/launch/arm.launch"
    first = NODE.format("")
    repository.commit({"arm/package.xml": PACKAGE_XML, path: LAUNCH.format(first)})
    repository.write({path: LAUNCH.format(first + other)})
    assert breaking(compare(repository)) == (["several nodes have the name 'arm'"] if is_breaking else [])


def test_equal_names_of_nodes_are_told_in_ros_2(repository, compare):
    path = "arm/launch/arm.launch.xml"
    first = NODE.replace("type", "exec").format("")
    repository.commit({"arm/package.xml": PACKAGE_XML, path: LAUNCH.format(first)})
    repository.write({path: LAUNCH.format(first + first.replace('exec="arm"', 'exec="hand"'))})
    result = compare(repository)
    assert "several nodes have the name 'arm'" in sentences(subject(result, path))
    assert breaking(result) == []


FILTER = """ekf_filter_node:
  ros__parameters:
    odom0: /base_controller/odom
"""
CONTROLLERS = """controller_manager:
  ros__parameters:
    base_controller:
      type: diff_drive_controller/DiffDriveController
"""


LOST = "no controller publishes '/wheel_controller/odom'; parameter files have 'base_controller'"


@pytest.mark.parametrize(
    ("topic", "reason"),
    [
        ("/wheel_controller/odom", LOST),
        ("/other_controller/odom", None),
        ("/odom", None),
    ],
)
def test_an_input_of_a_filter_names_a_controller_of_the_repository(repository, compare, topic, reason):
    path = "arm/config/ekf.yaml"
    launch = '<launch><node pkg="controller_manager" exec="spawner" args="other_controller"/></launch>\n'
    files = {"arm/config/controllers.yaml": CONTROLLERS, "arm/launch/a.launch.xml": launch}
    repository.commit({"arm/package.xml": PACKAGE_XML, path: FILTER, **files})
    repository.write({path: FILTER.replace("/base_controller/odom", topic)})
    (change,) = subject(compare(repository), path).changes
    assert (None if change.reason is None else str(change.reason)) == reason
