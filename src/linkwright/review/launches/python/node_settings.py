"""Split the parameters and remappings of a node in a Python launch file into settings."""

from __future__ import annotations

import ast
from collections.abc import Callable, Mapping, Sequence

from linkwright.review.launches.outlines import (
    CONDITION,
    NAMES_AS_REMAPPINGS,
    PARAMETER,
    REMAPPING,
    with_condition,
)
from linkwright.review.launches.python.expression_texts import BoundExpression, format_branches
from linkwright.review.texts.list_changes import nested_list_items

_INNER_ACTIONS = frozenset({"composable_node_descriptions", "on_exit"})
"""The arguments that contain other actions. These actions have their own entries."""
_IGNORED_ARGUMENTS = frozenset({"package", "executable", "plugin", "description", "cmd"})
"""The arguments that name an action or are invisible to other programs."""
_JOINED_ARGUMENTS = frozenset({"name", "namespace", "exec_name", "output", "cwd", "prefix"})
"""The arguments whose texts and substitutions launch joins to one text."""


def format_settings(values: Mapping[str, BoundExpression]) -> dict[str, str]:
    """Return the texts of the arguments of an action, without those that name it or contain other actions."""
    ignored = {*_IGNORED_ARGUMENTS, *_INNER_ACTIONS, CONDITION}
    texts: dict[str, str] = {}
    for key, value in values.items():
        format_value = value.texts.format_joined if key in _JOINED_ARGUMENTS else value.texts.text
        texts |= {} if key in ignored else {key: format_value(value.node)}
    return texts


def split_choice(value: BoundExpression, split: Callable[[BoundExpression], dict[str, str]]) -> dict[str, str]:
    """Return the settings in a list, or in one of two lists that a condition chooses, with the condition."""
    chosen = value.texts.resolve(value.node)
    if not isinstance(chosen.node, ast.IfExp):
        return split(value)
    conditions = format_branches(chosen.node.test)
    branches = [
        split_choice(BoundExpression(chosen.texts, node), split) for node in (chosen.node.body, chosen.node.orelse)
    ]
    common = {name: text for name, text in branches[0].items() if branches[1].get(name) == text}
    for condition, settings in zip(conditions, branches, strict=True):
        common |= {with_condition(name, condition): text for name, text in settings.items() if name not in common}
    return common


def split_remappings(value: BoundExpression) -> dict[str, str]:
    """Return each remapping of a list by name, and the unknown parts of the list."""
    remappings: dict[str, str] = {}
    others: list[BoundExpression] = []
    for part in value.texts.find_list_parts(value.node):
        pair = part.texts.find_pair(part.node)
        pairs = [pair] if pair is not None else part.texts.find_pairs(part.node)
        if pairs is None:
            others.append(part)
        else:
            remappings |= {f"{REMAPPING}{source}": _join_substitutions(target) for source, target in pairs}
    names = [part for part in others if _is_text(part)]
    others = [part for part in others if not _is_text(part)]
    unknown = _format_unknown_parts(NAMES_AS_REMAPPINGS, value, names)
    return unknown | _format_unknown_parts("remappings", value, others) | remappings


def _join_substitutions(name: str) -> str:
    """Return a name without the notation of a list, whose texts and substitutions launch joins."""
    is_list = name.startswith("[") and name.endswith("]") and "][" not in name  # not an item of a list
    items = nested_list_items(name) if is_list else []
    return "".join(items) if items and not any(" " in item and "$(" not in item for item in items) else name


def _is_text(part: BoundExpression) -> bool:
    node = part.texts.resolve(part.node).node
    return isinstance(node, ast.Constant) and isinstance(node.value, str)


def split_parameters(value: BoundExpression) -> dict[str, str]:
    """Return each parameter of a list by name, and the files and other parts of the list."""
    parameters: dict[str, str] = {}
    others: list[BoundExpression] = []
    for part in value.texts.find_list_parts(value.node):
        is_mapping = isinstance(part.node, (ast.Dict, ast.Call))
        pairs = part.texts.find_pairs(part.node, are_parameters=True) if is_mapping else None
        if pairs is None:
            others.append(part)
        else:
            parameters |= {f"{PARAMETER}{name}": text for name, text in pairs}
    return _format_unknown_parts("parameters", value, others) | parameters


def _format_unknown_parts(name: str, value: BoundExpression, parts: Sequence[BoundExpression]) -> dict[str, str]:
    """Return the parts of a list as one setting, or the value itself if it is not a list."""
    if not parts:
        return {}
    texts = [part.texts.text(part.node) for part in parts]
    is_list = len(parts) > 1 or _is_list(value)
    return {name: f"[{', '.join(texts)}]" if is_list else texts[0]}


def _is_list(value: BoundExpression) -> bool:
    """Return whether an expression is a literal list, or a sum of such lists."""
    value = value.texts.resolve(value.node)
    if isinstance(value.node, ast.BinOp) and isinstance(value.node.op, ast.Add):
        return all(_is_list(BoundExpression(value.texts, term)) for term in (value.node.left, value.node.right))
    return isinstance(value.node, (ast.List, ast.Tuple))
