"""The lines of a review about actions in groups and handlers of Python launch files that no list contains."""

from __future__ import annotations

import pytest

from tests.review.conftest import breaking, sentences

LAUNCH = """from launch import LaunchDescription
from launch.actions import GroupAction, RegisterEventHandler, TimerAction
from launch.event_handlers import OnProcessExit
from launch_ros.actions import Node


def generate_launch_description():
    driver = Node(package="arm", executable="driver")
    reader = Node(package="arm", executable="reader")
    later = GROUP
    handler = RegisterEventHandler(OnProcessExit(target_action=driver, on_exit=[later]))
    return LaunchDescription([
        driver,
        handler,
    ])
"""
GROUPS = ("TimerAction(period=2.0, actions=[reader])", "GroupAction([reader])", "[reader]", "reader")
PATH = "arm/launch/arm.launch.py"


@pytest.mark.parametrize("group", GROUPS)
def test_nodes_of_a_handler_that_leaves_the_list_are_removed(repository, compare, group):
    text = LAUNCH.replace("GROUP", group)
    repository.commit({PATH: text})
    repository.write({PATH: text.replace("        handler,\n", "        # handler,\n")})
    delay = ": after 2.0 s" if "TimerAction" in group else ""
    assert breaking(compare(repository)) == [f"node 'arm/reader' removed{delay}"]


@pytest.mark.parametrize("group", GROUPS)
def test_changed_nodes_of_an_unused_handler_are_not_compared(repository, compare, group):
    text = LAUNCH.replace("GROUP", group).replace("        handler,\n", "")
    repository.commit({PATH: text})
    repository.write({PATH: text.replace('executable="reader"', 'executable="writer"')})
    assert breaking(compare(repository)) == []


def test_nodes_of_a_used_handler_are_compared(repository, compare):
    text = LAUNCH.replace("GROUP", GROUPS[0])
    repository.commit({PATH: text})
    repository.write({PATH: text.replace('executable="reader"', 'executable="writer"')})
    lines = [line for found in compare(repository).subjects for line in sentences(found)]
    assert any("arm/writer" in line for line in lines)
