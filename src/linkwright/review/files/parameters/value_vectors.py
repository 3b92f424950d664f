"""Recognize values that belong together by their names, such as the components of a pose or of a covariance."""

from __future__ import annotations

import math
import re
from collections.abc import Iterator, Sequence
from typing import NamedTuple

from linkwright.diagnostics import Phrase, joined, phrase
from linkwright.review.texts.list_changes import list_items

_MAX_COMPONENT_NAME = 3
"""The maximum length of the name of a component, such as ``x``, ``ixx`` or ``p``."""
_POSE_PARTS = frozenset({"translation", "rotation", "position", "orientation", "xyz", "rpy"})
"""The parts of a pose, which is one group of values."""
_COMPONENT = re.compile(
    r"\d+|[avw]?[xyz]|xy|xyz|theta|roll|pitch|yaw|linear|angular|rotational|translational|rot|trans|lin|ang"
    r"|min|max|lower|upper|left|right|front|rear|back|top|bottom"
)
"""A word of a name that distinguishes values of one quantity."""
_WORD = re.compile(r"[A-Z]?[a-z]+|[A-Z]+(?![a-z])|\d+")
_POSE = ("x", "y", "z", "roll", "pitch", "yaw")
_STATE = (*_POSE, *(f"v{name}" for name in _POSE), "ax", "ay", "az")
"""The variables of the filters of robot_localization, in the order of their lists."""
_FILTER_INPUT = re.compile(r"(?:odom|pose|twist|imu)\d+_config")
_COVARIANCE = re.compile(r"\w*covariance\w*")
_ZERO = re.compile(r"[-+]?0*\.?0*(?:[eE][-+]?\d+)?")
_MAX_ITEMS = 8
"""The maximum number of changed items of a list that are shown by name."""


class Component(NamedTuple):
    """A value that is a component of a group.

    Attributes:
        parent: the path of the part with the group.
        family: the words of the name that the components have in common.
        name: the name in the part.
    """

    parent: str
    family: tuple[str, ...]
    name: str


def find_component(path: str) -> Component | None:
    """Return what a value of a parameter file is a component of, by its path; None for other values."""
    parent, _, name = path.rpartition(".")
    outer, _, part = parent.rpartition(".")
    if part in _POSE_PARTS and outer:
        return Component(outer, (), f"{part}.{name}")
    words = [word.lower() for word in _WORD.findall(name)]
    family = tuple("" if _COMPONENT.fullmatch(word) else word for word in words)
    if len(name) <= _MAX_COMPONENT_NAME or not any(family):
        return Component(parent, (), name)
    return Component(parent, family, name) if "" in family else None


def describe_items(path: str, old: str, new: str) -> Phrase | None:
    """Return the changed items of a list by their names, such as those of a covariance; None for other lists."""
    old_items, new_items = list_items(old), list_items(new)
    if len(old_items) != len(new_items):
        return None
    changed = [index for index, item in enumerate(old_items) if item.lower() != new_items[index].lower()]
    names = _name_items(path.rpartition(".")[2], len(old_items))
    if not names or not 0 < len(changed) <= _MAX_ITEMS:
        return None
    texts = [f"{names[index]} {old_items[index]} -> {new_items[index]}" for index in changed]
    return phrase("{parameter}: {changes}", parameter=path, changes=joined(texts))


def shorten_covariance(path: str, text: str) -> str:
    """Return the diagonal of a covariance that is zero elsewhere, and any other value unchanged."""
    items = list_items(text) if _COVARIANCE.fullmatch(path.rpartition(".")[2]) else []
    size = math.isqrt(len(items))
    diagonal = items[:: size + 1]
    others = [item for index, item in enumerate(items) if index % (size + 1)]
    if size < len(_POSE) or size**2 != len(items) or not all(map(_ZERO.fullmatch, others)):
        return text
    return f"{size} x {size}, diagonal [{', '.join(diagonal)}]"


def _name_items(key: str, count: int) -> Sequence[str]:
    """Return the names of the items of a list; none if they are unknown."""
    if _FILTER_INPUT.fullmatch(key) and count == len(_STATE):
        return _STATE
    for names in (_POSE, _STATE):
        if _COVARIANCE.fullmatch(key) and count == len(names) ** 2:
            return list(_name_entries(names))
    return ()


def _name_entries(names: Sequence[str]) -> Iterator[str]:
    """Yield the names of the entries of a matrix by rows; those of the diagonal have one name."""
    for row in names:
        for column in names:
            yield row if row == column else f"({row}, {column})"
