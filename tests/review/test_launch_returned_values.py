"""Values that a function of a Python launch file returns early or looks up in a dictionary, in a review."""

from __future__ import annotations

import pytest

from linkwright.review.launches.conditions import evaluate_condition

FILE = """from launch import LaunchDescription
from launch.actions import DeclareLaunchArgument, OpaqueFunction
from launch.substitutions import LaunchConfiguration
from launch_ros.actions import Node

HANDS_OF_MODELS = {"twin": "two", "lone": "one", "cart": "none"}
SPEEDS = {"twin": 1, "lone": 2}


def choose_hands(hands, model):
    {function}


def make_actions(context):
    model = LaunchConfiguration("model").perform(context)
    hands = choose_hands(LaunchConfiguration("hands").perform(context), model)
    name = "grip" if hands in ("one", "two") else "roll"
    actions = [Node(package="cart", executable="drive", name=name)]
    if hands in ("one", "two"):
        actions.append(Node(package="cart", executable="grip"))
    return actions


def generate_launch_description():
    return LaunchDescription([
        DeclareLaunchArgument("model", default_value="twin"),
        DeclareLaunchArgument("hands", default_value=""),
        OpaqueFunction(function=make_actions),
    ])
"""
LOOKUP = "return HANDS_OF_MODELS[model]"
EARLY = f"""if hands:
        if hands not in ("one", "two", "none"):
            raise RuntimeError(hands)
        return hands
    if model not in HANDS_OF_MODELS:
        raise RuntimeError(model)
    {LOOKUP}"""
DEFAULT = "argument 'model': default twin -> cart"


@pytest.mark.parametrize(
    ("function", "is_known"),
    [
        (LOOKUP, True),
        (EARLY, True),
        (EARLY.replace("    if model", "    elif model", 1), True),
        ('if model == "cart":\n        return "none"\n    else:\n        return "two"', True),
        ('if model != "cart":\n        return "two"\n    raise RuntimeError(model)', False),
        ('if hands:\n        log(hands)\n    return "none"', False),
        ("if hands:\n        return\n    return HANDS_OF_MODELS[model]", False),
        ("log(model)\n    return HANDS_OF_MODELS[model]", False),
        ("return SPEEDS[model]", False),
        ("return {**HANDS_OF_MODELS}[model]", False),
        ("return load()[model]", False),
    ],
)
def test_node_that_a_returned_value_no_longer_starts_by_default(review_changes, function, is_known):
    old = FILE.replace("{function}", function)
    _, found = review_changes("cart.launch.py", old, 'default_value="twin"', 'default_value="cart"')
    assert (DEFAULT in found) == is_known, found


def test_name_that_a_returned_value_chooses_is_the_same_by_default(review_changes):
    old = FILE.replace("{function}", EARLY)
    changes, found = review_changes("cart.launch.py", old, "name=name", 'name="grip"')
    assert found == []
    assert any(text.endswith("grip (the same by default)") for text in changes), changes


@pytest.mark.parametrize(
    ("function", "is_stopped"),
    [
        ('if model == "cart":\n        return False\n    return hands == ""', True),
        ("return {'twin': 'x', 'cart': ''}[model]", True),
        ("return {'twin': True, 'cart': False}[model]", False),
    ],
)
def test_test_that_a_function_with_an_early_return_decides(review_changes, function, is_stopped):
    old = FILE.replace("{function}", function).replace('if hands in ("one", "two"):', "if hands:")
    _, found = review_changes("cart.launch.py", old, 'default_value="twin"', 'default_value="cart"')
    assert (DEFAULT in found) == is_stopped, found


@pytest.mark.parametrize(
    ("condition", "expected"),
    [
        ("if $(eval {'a': 'b'}['a'] == 'b')", True),
        ("if $(eval {'a': 'b'}['c'] == 'b')", None),
        ("if $(eval ('a' if '' != '' else 'b') == 'b')", True),
        ("if $(eval ('a' if load() else 'b') == 'b')", None),
    ],
)
def test_condition_with_a_lookup_or_a_choice_is_evaluated(condition, expected):
    assert evaluate_condition(condition) is expected
