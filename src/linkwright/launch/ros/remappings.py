"""Remapping rules of nodes: pairs of names that may hold substitutions (``launch_ros.utilities``)."""

from __future__ import annotations

from collections.abc import Iterable
from typing import Any

from linkwright.launch.context import LaunchContext
from linkwright.launch.places import Place, error_at
from linkwright.launch.substitution import (
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
        hint = "write a pair: remappings=[('from', 'to')]"
        message = f"a remapping must be a pair of names, not {remap_rule!r}"
        promised = TypeError(f"remap_rule must be a tuple of length 2, got {remap_rule!r}")
        raise error_at(Place.of_caller(), "LAUNCH135", message, hint, promises=promised)
    source, target = remap_rule
    return tuple(normalize_to_list_of_substitutions(source)), tuple(normalize_to_list_of_substitutions(target))


def normalize_remap_rules(remap_rules: Iterable[Any]) -> Iterable[RemapRule]:
    """Several pairs of names as tuples of substitutions.

    Raises:
        TypeError: LAUNCH135, they are no pairs of names.
    """
    if isinstance(remap_rules, (str, dict)) or not isinstance(remap_rules, Iterable):
        message = f"'remappings' must be a list of pairs of names, not {type(remap_rules).__name__}"
        hint = "write pairs in a list: remappings=[('from', 'to')]"
        raise error_at(Place.of_caller(), "LAUNCH135", message, hint, promises=TypeError(message))
    return [normalize_remap_rule(rule) for rule in remap_rules]


def evaluated_rules(context: LaunchContext, rules: Iterable[RemapRule]) -> list[tuple[str, str]]:
    """The names of the pairs."""
    return [
        (perform_substitutions(context, source), perform_substitutions(context, target)) for source, target in rules
    ]
