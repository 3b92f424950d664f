"""Names, namespaces and remapping rules of nodes.

This module also counts the nodes that a launch started with each name.
"""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Iterable
from typing import Any

from linkwright.diagnostics import phrase
from linkwright.launch.errors.locations import SourceLocation, error_at
from linkwright.launch.model.context import LaunchContext
from linkwright.launch.model.substitution import (
    Substitution,
    normalize_to_list_of_substitutions,
    perform_substitutions,
)

_COUNTS_GLOBAL = "unique_ros_node_names"


def is_root_namespace(ns: str) -> bool:
    """Return whether a namespace is ``/``."""
    return ns == "/"


def is_namespace_absolute(ns: str) -> bool:
    """Return whether a namespace begins with a slash."""
    return ns.startswith("/")


def make_namespace_absolute(ns: str | None) -> str | None:
    """Return a namespace with a leading slash, and None for None."""
    return ns if ns is None or is_namespace_absolute(ns) else f"/{ns}"


def prefix_namespace(base_ns: str | None, ns: str | None, *, return_absolute_ns: bool = False) -> str | None:
    """Return a namespace nested in another one.

    An inner namespace with a leading slash remains unchanged. None means that there is no namespace.

    Args:
        base_ns: the outer namespace.
        ns: the inner namespace.
        return_absolute_ns: whether to add a leading slash to the result.
    """
    if ns is None:
        namespace = base_ns
    elif not base_ns or is_namespace_absolute(ns):
        namespace = ns
    else:
        namespace = f"{base_ns.rstrip('/')}/{ns}"
    if namespace is None:
        return None
    if not is_root_namespace(namespace):
        namespace = namespace.rstrip("/")
    return make_namespace_absolute(namespace) if return_absolute_ns else namespace


def add_node_name(context: Any, node_name: str) -> None:
    """Record that a node with the given full name was started."""
    _get_node_name_counts(context)[node_name] += 1


def get_node_name_count(context: Any, node_name: str) -> int:
    """Return the number of nodes that the launch started with the given full name."""
    return _get_node_name_counts(context).get(node_name, 0)


def record_node_start(context: Any, node_name: str) -> str | None:
    """Record the start of a node, and return a warning if there is another node with this name.

    Returns:
        The warning, or None if no other node with this name was started.
    """
    add_node_name(context, node_name)
    node_count = get_node_name_count(context, node_name)
    if node_count < 2:
        return None
    return f"there are now at least {node_count} nodes with the name {node_name} created within this launch context"


def _get_node_name_counts(context: Any) -> defaultdict[str, int]:
    try:
        counts: defaultdict[str, int] = getattr(context.locals, _COUNTS_GLOBAL)
    except AttributeError:
        counts = defaultdict(int)
        context.extend_globals({_COUNTS_GLOBAL: counts})
    return counts


def check_name(name: str) -> str:
    """Return a node name unchanged, or raise an error if it is not valid.

    Raises:
        LinkwrightError: LAUNCH134, the name is not valid.
    """
    from linkwright.graph.names.rules import InvalidNameError, check_node_name

    try:
        check_node_name(name)
    except InvalidNameError as error:
        message = phrase("node name '{name}' is malformed: {reason}", name=name, reason=error.error_msg)
        raise error_at(None, "LAUNCH134", message, ros_error=error) from error
    return name


def check_namespace(namespace: str) -> str:
    """Return a namespace unchanged, or raise an error if it is not valid.

    Raises:
        LinkwrightError: LAUNCH134, the namespace is not valid.
    """
    from linkwright.graph.names.rules import InvalidNameError, absolute_namespace

    try:
        absolute_namespace(namespace)
    except InvalidNameError as error:
        message = phrase("namespace '{namespace}' is malformed: {reason}", namespace=namespace, reason=error.error_msg)
        raise error_at(None, "LAUNCH134", message, ros_error=ValueError(message)) from error
    return namespace


RemapRule = tuple[tuple[Substitution, ...], tuple[Substitution, ...]]


def normalize_remap_rule(remap_rule: Any) -> RemapRule:
    """Return a pair of names as a pair of tuples of substitutions.

    Raises:
        TypeError: LAUNCH135, the argument is not a pair of names.
    """
    if not isinstance(remap_rule, tuple) or len(remap_rule) != 2:
        hint = phrase("write a pair: remappings=[('from', 'to')]")
        message = phrase("a remapping must be a pair of names, not {remap_rule}", remap_rule=repr(remap_rule))
        ros_error = TypeError(f"remap_rule must be a tuple of length 2, got {remap_rule!r}")
        raise error_at(SourceLocation.of_caller(), "LAUNCH135", message, hint, ros_error=ros_error)
    source, target = remap_rule
    return tuple(normalize_to_list_of_substitutions(source)), tuple(normalize_to_list_of_substitutions(target))


def normalize_remap_rules(remap_rules: Iterable[Any]) -> Iterable[RemapRule]:
    """Return pairs of names as pairs of tuples of substitutions.

    Raises:
        TypeError: LAUNCH135, the argument is not a list of pairs of names.
    """
    if isinstance(remap_rules, (str, dict)) or not isinstance(remap_rules, Iterable):
        message = phrase("'remappings' must be a list of pairs of names, not {name}", name=type(remap_rules).__name__)
        hint = phrase("write pairs in a list: remappings=[('from', 'to')]")
        raise error_at(SourceLocation.of_caller(), "LAUNCH135", message, hint, ros_error=TypeError(message))
    return [normalize_remap_rule(rule) for rule in remap_rules]


def evaluate_rules(context: LaunchContext, rules: Iterable[RemapRule]) -> list[tuple[str, str]]:
    """Return remapping rules as pairs of evaluated names."""
    return [
        (perform_substitutions(context, source), perform_substitutions(context, target)) for source, target in rules
    ]
