"""Texts of launch files that an argument chooses, and values that ``OpaqueFunction`` passes, in a review."""

from __future__ import annotations

import pytest

from linkwright.review.launches.chosen_texts import quote_text, resolve_choices

FILE = """from launch import LaunchDescription
from launch.actions import DeclareLaunchArgument, OpaqueFunction
from launch.substitutions import LaunchConfiguration
from launch_ros.actions import Node


def make_nodes(context, team):
    side = context.perform_substitution(team)
    if side == "":
        label = ""
    else:
        label = side + "_"
    return [Node(package="arm", executable="drive", name=label + "drive", namespace=side)]


def generate_launch_description():
    argument = DeclareLaunchArgument("side", default_value="")
    side = LaunchConfiguration("side")
    return LaunchDescription([argument, OpaqueFunction(function=make_nodes, args=[side])])
"""
CHOICE = "$(eval '' if '$(var side)' == '' else '$(var side)_')"


@pytest.mark.parametrize(
    ("old", "new", "expected", "is_breaking"),
    [
        ('name=label + "drive"', 'name="drive"', f"name {CHOICE}drive -> drive (the same by default)", False),
        ('name=label + "drive"', 'name=label + "wheels"', f"name {CHOICE}drive -> {CHOICE}wheels", True),
        (
            'name=label + "drive"',
            'name="drive" if side == "" else "other"',
            f"name {CHOICE}drive -> $(eval 'drive' if '$(var side)' == '' else 'other')",
            False,
        ),
        ("namespace=side", 'namespace="left"', "namespace $(var side) -> left (before, '' by default)", True),
        ("label", "label", None, False),
    ],
)
def test_name_that_an_argument_chooses_is_compared_by_default(review_changes, old, new, expected, is_breaking):
    changes, found = review_changes("arm.launch.py", FILE, old, new)
    expected = expected and f"node 'arm/drive': {expected}"
    assert [text for text in changes if text.startswith("node")] == ([expected] if expected else [])
    assert found == ([expected] if is_breaking else [])


def test_other_names_of_variables_of_a_called_function_are_no_change(review_changes):
    renamed = FILE.replace("side = context", "value = context").replace("if side ==", "if value ==")
    renamed = renamed.replace("= side + ", "= value + ").replace("namespace=side", "namespace=value")
    changes, _ = review_changes("arm.launch.py", FILE, FILE, renamed.replace("team", "name"))
    assert not [text for text in changes if text.startswith("node")]


@pytest.mark.parametrize(
    ("text", "expected"),
    [
        ("a/$(eval 'b' if 'x' == 'x' else 'c')/d", "a/b/d"),
        ("$(eval 'b' if 'x' == 'y' else 'c' if 'x' in ['x', 'z'] else 'd')", "c"),
        ("$(eval 'b' if '$(var x)' == 'x' else 'c')", "$(eval 'b' if '$(var x)' == 'x' else 'c')"),
        ("$(eval 'b' if load('x') else 'c')", "$(eval 'b' if load('x') else 'c')"),
        ("$(eval 'b' if 'x' == 'x' else load('c'))", "b"),
        ("$(eval 'x' == 'x')", "$(eval 'x' == 'x')"),
    ],
)
def test_choice_with_a_known_test_is_resolved(text, expected):
    assert resolve_choices(text) == expected


@pytest.mark.parametrize(
    ("text", "expected"),
    [
        ("left_$(var side)", "'left_$(var side)'"),
        ("it's", None),
        ("load(a)", None),
        ("$(eval 'a' if 'x' == 'y' else 'b')", "'a' if 'x' == 'y' else 'b'"),
    ],
)
def test_only_simple_texts_are_quoted(text, expected):
    assert quote_text(text) == expected
