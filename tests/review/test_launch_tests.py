"""Tests of ``if`` statements in Python launch files, which depend on arguments of the file, in a review."""

from __future__ import annotations

import pytest

FILE = """from launch import LaunchDescription
from launch.actions import DeclareLaunchArgument, OpaqueFunction
from launch.substitutions import LaunchConfiguration
from launch_ros.actions import Node


def make_actions(context, scanner, other):
    kind = {value}
    actions = []
    if {test}:
        actions.append(Node(package="arm", executable="scan"))
    return actions


def generate_launch_description():
    scanner = LaunchConfiguration("scanner")
    arguments = [scanner, LaunchConfiguration("other")]
    return LaunchDescription([
        DeclareLaunchArgument("scanner", default_value="front"),
        DeclareLaunchArgument("other", default_value="false"),
        OpaqueFunction(function=make_actions, args=arguments),
    ])
"""
PERFORMED = "scanner.perform(context)"


@pytest.mark.parametrize(
    ("value", "test", "is_stopped"),
    [
        (PERFORMED, "kind == 'rear'", True),
        (PERFORMED, "kind == 'front'", False),
        (PERFORMED, "kind != 'front'", True),
        (PERFORMED, "kind in ('left', 'rear')", True),
        (PERFORMED, "kind in ('left', 'front')", False),
        (PERFORMED, "kind.upper() == 'REAR'", True),
        (PERFORMED, "kind", False),
        (PERFORMED, "not kind", True),
        (PERFORMED, "kind == 'front' and other.perform(context) == 'true'", True),
        (PERFORMED, "kind == load()", False),
        (f"str({PERFORMED})", "kind == 'rear'", True),
        ("context.launch_configurations['scanner']", "kind == 'rear'", True),
        ("LaunchConfiguration('scanner').perform(context)", "kind == 'rear'", True),
        ("context.perform_substitution(scanner)", "kind == 'rear'", True),
        ("load(scanner)", "kind == 'rear'", False),
        ("scanner", "kind == 'front'", True),
        ("scanner", "kind", False),
    ],
)
def test_node_whose_test_the_defaults_do_not_fulfill_no_longer_starts(review_changes, value, test, is_stopped):
    old = FILE.replace("{value}", value).replace("{test}", "True")
    _, found = review_changes("arm.launch.py", old, "if True:", f"if {test}:")
    texts = [text for text in found if text.startswith("node 'arm/scan': condition")]
    assert bool(texts) == is_stopped, found


@pytest.mark.parametrize(
    ("value", "test", "is_reported"),
    [
        ("scanner", "kind == 'front'", True),
        ("scanner", "'front' == kind", True),
        ("scanner", "kind in ['front', 'rear']", True),
        (PERFORMED, "scanner == 'front'", True),
        (PERFORMED, "kind == 'front'", False),
        ("scanner", "kind == other", False),
        ("scanner", "kind is None", False),
    ],
)
def test_comparison_of_a_substitution_with_a_text_is_never_true(review_changes, value, test, is_reported):
    old = FILE.replace("{value}", value).replace("{test}", "True")
    _, found = review_changes("arm.launch.py", old, "if True:", f"if {test}:")
    reported = [text for text in found if "compares the object" in text]
    assert bool(reported) == is_reported, found


def test_comparison_that_was_there_before_is_no_change(review_changes):
    old = FILE.replace("{value}", "scanner").replace("{test}", "kind == 'front'")
    changes, _ = review_changes("arm.launch.py", old, '"front"', '"rear"')
    assert not [text for text in changes if "compares the object" in text]


def test_function_with_two_actions_has_unknown_arguments(review_changes):
    old = FILE.replace("{value}", PERFORMED).replace("{test}", "True")
    action = "OpaqueFunction(function=make_actions, args=arguments),"
    old = old.replace(
        action, f"{action}\n        OpaqueFunction(function=make_actions, args=[LaunchConfiguration('x')]),"
    )
    _, found = review_changes("arm.launch.py", old, "if True:", "if kind == 'rear':")
    assert not [text for text in found if "condition" in text]


SWITCHED = """from distutils.util import strtobool

from launch import LaunchDescription
from launch.actions import DeclareLaunchArgument, OpaqueFunction
from launch.substitutions import LaunchConfiguration
from launch_ros.actions import Node


def is_set(context, name):
    \"\"\"Return a switch.\"\"\"
    value = LaunchConfiguration(name).perform(context)
    return value.lower() == "true"


def is_true(text, expected="true"):
    return text == expected


def repeat(text):
    return repeat(text)


def make_actions(context):
    def get_switch(name):
        return LaunchConfiguration(name).perform(context) in ("true", "True")

    switch = LaunchConfiguration("scan").perform(context)
    is_on = switch.lower() == "true"
    is_off = not is_on
    if {test}:
        return [Node(package="arm", executable="scan")]
    return []


def generate_launch_description():
    return LaunchDescription([
        DeclareLaunchArgument("scan", default_value="true"),
        OpaqueFunction(function=make_actions),
    ])
"""


@pytest.mark.parametrize(
    ("test", "is_stopped"),
    [
        ("is_on", True),
        ("not is_off", True),
        ("is_off", False),
        ("strtobool(switch)", True),
        ("bool(strtobool(switch))", True),
        ("not strtobool(switch)", False),
        ("bool(switch)", False),
        ("context.launch_configurations.get('scan', 'false') == 'true'", True),
        ("get_switch('scan')", True),
        ("not get_switch('scan')", False),
        ("is_set(context, 'scan')", True),
        ("is_set(context, name='scan')", True),
        ("is_set(context, 'other')", False),
        ("is_true(switch)", True),
        ("is_true(switch, 'false')", False),
        ("is_true(str(switch), expected='false') is False", False),
        ("repeat(switch)", False),
        ("is_true(text)", False),
    ],
)
def test_switch_behind_a_variable_or_function_stops_a_node(review_changes, test, is_stopped):
    old = SWITCHED.replace("{test}", test)
    changes, found = review_changes("arm.launch.py", old, 'default_value="true"', 'default_value="false"')
    assert changes == ["argument 'scan': default true -> false"]
    assert found == (changes if is_stopped else [])
