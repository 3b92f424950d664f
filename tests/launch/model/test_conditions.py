"""Conditions of launch actions."""

from __future__ import annotations

import pytest
from launch.conditions import (
    IfCondition,
    LaunchConfigurationEquals,
    LaunchConfigurationNotEquals,
    UnlessCondition,
)
from launch.substitutions import LaunchConfiguration

from launch import Condition, LaunchContext
from linkwright.diagnostics import LinkwrightError


@pytest.fixture
def context() -> LaunchContext:
    context = LaunchContext()
    context.launch_configurations.update(gui="True", mode="fast")
    return context


@pytest.mark.parametrize(
    ("value", "truth"), [("true", True), ("TRUE", True), ("1", True), (" false ", False), ("0", False)]
)
def test_if_and_unless_conditions_evaluate_text(context: LaunchContext, value: str, truth: bool) -> None:
    assert IfCondition(value).evaluate(context) is truth
    assert UnlessCondition(value).evaluate(context) is not truth


def test_conditions_evaluate_substitutions(context: LaunchContext) -> None:
    assert IfCondition(LaunchConfiguration("gui")).evaluate(context)
    assert not UnlessCondition([LaunchConfiguration("gui")]).evaluate(context)


def test_invalid_truth_value_is_rejected(context: LaunchContext) -> None:
    with pytest.raises(
        LinkwrightError, match="the condition evaluates to 'fast', but must be 'true', '1', 'false' or '0'"
    ) as caught:
        IfCondition(LaunchConfiguration("mode")).evaluate(context)
    (diagnostic,) = caught.value.diagnostics
    assert diagnostic.code == "LAUNCH127"
    assert diagnostic.span is not None
    assert diagnostic.span.file == __file__


def test_launch_configuration_equals_compares_value(context: LaunchContext) -> None:
    assert LaunchConfigurationEquals("mode", "fast").evaluate(context)
    assert not LaunchConfigurationEquals("mode", "slow").evaluate(context)
    assert not LaunchConfigurationEquals("none", "slow").evaluate(context)
    assert LaunchConfigurationEquals("none", None).evaluate(context)
    assert not LaunchConfigurationNotEquals("mode", "fast").evaluate(context)
    assert LaunchConfigurationNotEquals("none", "fast").evaluate(context)


def test_custom_predicate_is_called(context: LaunchContext) -> None:
    assert Condition(predicate=lambda context: "mode" in context.launch_configurations).evaluate(context)


def test_condition_without_predicate_is_false(context: LaunchContext) -> None:
    assert Condition().evaluate(context) is False
