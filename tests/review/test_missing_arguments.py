"""Reviews of Python launch files with actions that lack a required argument, so that the files fail."""

from __future__ import annotations

import pytest

from tests.repositories import PACKAGE_XML
from tests.review.conftest import subject

PATH = "arm/launch/arm.launch.py"
CLASSES = """from launch import LaunchDescription
from launch.actions import ExecuteProcess
from launch.conditions import IfCondition
from launch_ros.actions import LifecycleNode, Node
from launch_ros.descriptions import ComposableNode


def generate_launch_description():
    settings = {"executable": "driver"}
    camera = Node(package="camera", executable="camera")
    return LaunchDescription([camera])
"""


@pytest.mark.parametrize(
    ("added", "missing"),
    [
        ('Node(package="debayer", plugin="Debayer")', "executable"),
        ('Node(package="debayer", plugin="Debayer", condition=IfCondition("false"))', "executable"),
        ('LifecycleNode(package="debayer", executable="debayer", name="debayer")', "namespace"),
        ('ComposableNode(package="debayer")', "plugin"),
        ("ExecuteProcess(name='x')", "cmd"),
        ('Node(package="debayer", **settings)', None),
        ('LifecycleNode(package="debayer", executable="a", name="a", namespace="")', None),
    ],
)
def test_an_action_without_a_required_argument_makes_the_launch_file_fail(repository, compare, added, missing):
    package = PACKAGE_XML.replace("arm_description", "arm").replace("</package>", "<depend>debayer</depend></package>")
    repository.commit({"arm/package.xml": package, PATH: CLASSES})
    repository.write({PATH: CLASSES.replace("[camera]", f"[camera, {added}]")})
    found = [str(change.reason) for change in subject(compare(repository), PATH).changes if change.reason is not None]
    assert found == ([] if missing is None else [f"the launch file fails without '{missing}'"])


def test_a_node_of_another_package_or_that_loses_its_required_argument(repository, compare):
    repository.commit({"arm/package.xml": PACKAGE_XML.replace("arm_description", "arm"), PATH: CLASSES})
    repository.write({PATH: CLASSES.replace('executable="camera"', 'plugin="camera"')})
    found = [str(change.reason) for change in subject(compare(repository), PATH).changes if change.reason is not None]
    assert "the launch file fails" in " ".join(found)
    other = CLASSES.replace("launch_ros.actions", "arm.actions")
    repository.commit({PATH: other})
    repository.write({PATH: other.replace("[camera]", "[camera, Node(package='arm', plugin='Arm')]")})
    assert [change.reason for change in subject(compare(repository), PATH).changes] == [None]
