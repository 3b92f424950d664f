"""Remapping rules of nodes: pairs of names that may hold substitutions (``launch_ros.utilities``)."""

from __future__ import annotations

from collections.abc import Iterable
from typing import Any

from linkwright.diagnostics import phrase
from linkwright.launch.errors.places import Place, error_at
from linkwright.launch.model.context import LaunchContext
from linkwright.launch.model.substitution import (
    Substitution,
    normalize_to_list_of_substitutions,
    perform_substitutions,
)

RemapRule = tuple[tuple[Substitution, ...], tuple[Substitution, ...]]


def normalize_remap_rule(remap_rule: Any) -> RemapRule:
    """A pair of names as tuples of substitutions.

    Raises:
        TypeError: LAUNCH135, it is no pair of names.
    """
    if not isinstance(remap_rule, tuple) or len(remap_rule) != 2:
        hint = phrase("write a pair: remappings=[('from', 'to')]")
        message = phrase("a remapping must be a pair of names, not {remap_rule}", remap_rule=repr(remap_rule))
        ros_error = TypeError(f"remap_rule must be a tuple of length 2, got {remap_rule!r}")
        raise error_at(Place.of_caller(), "LAUNCH135", message, hint, ros_error=ros_error)
    source, target = remap_rule
    return tuple(normalize_to_list_of_substitutions(source)), tuple(normalize_to_list_of_substitutions(target))


def normalize_remap_rules(remap_rules: Iterable[Any]) -> Iterable[RemapRule]:
    """Several pairs of names as tuples of substitutions.

    Raises:
        TypeError: LAUNCH135, they are no pairs of names.
    """
    if isinstance(remap_rules, (str, dict)) or not isinstance(remap_rules, Iterable):
        message = phrase("'remappings' must be a list of pairs of names, not {name}", name=type(remap_rules).__name__)
        hint = phrase("write pairs in a list: remappings=[('from', 'to')]")
        raise error_at(Place.of_caller(), "LAUNCH135", message, hint, ros_error=TypeError(message))
    return [normalize_remap_rule(rule) for rule in remap_rules]


def evaluated_rules(context: LaunchContext, rules: Iterable[RemapRule]) -> list[tuple[str, str]]:
    """The names of the pairs."""
    return [
        (perform_substitutions(context, source), perform_substitutions(context, target)) for source, target in rules
    ]
