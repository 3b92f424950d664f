"""Recognize names that differ only by the value of an argument, such as a prefix."""

from __future__ import annotations

import re
from collections.abc import Hashable, Mapping
from dataclasses import dataclass

from linkwright.review.changes import REMOVED_VALUE, Change
from linkwright.review.robots.cases import Case

_MIN_LENGTH = 2
"""The minimum length of a value that counts as the beginning of names."""
_NO_NAME = re.compile(r"true|false|[-+.\de]+", re.IGNORECASE)
"""A value that names nothing: a boolean or a number."""


@dataclass(frozen=True)
class ArgumentNames:
    """The names of one argument set, with the names of another argument set in their place.

    Attributes:
        values: the values of arguments that differ between both sets, the longest first, with those of the other set.
    """

    values: Mapping[str, str]

    def translate(self, text: str) -> str:
        """Return a text in which names begin with the values of the other argument set."""
        for value, other in self.values.items():
            text = re.sub(rf"(?<![\w.-]){re.escape(value)}(?=[\w/.-])", other.replace("\\", r"\\"), text)
        return text

    def make_key(self, change: Change) -> Hashable:
        """Return a key that is equal for the same change to names that differ only by the values of arguments.

        An added attribute, such as one that a call of a missing macro newly passes, is one change whatever value an
        argument gives it.
        """
        is_one_sided = not {"old", REMOVED_VALUE} & change.core.arguments.keys()
        if change.location is not None and change.property_name.startswith("@") and is_one_sided:
            return change.location, change.other_locations, change.effect, change.property_name
        if self.values and change.location is not None:
            effect, property_name, values = change.content
            texts = tuple(map(self.translate, values))
            return change.location, change.other_locations, (effect, self.translate(property_name), texts)
        return change.identity


def find_argument_names(first: Case | None, case: Case) -> ArgumentNames:
    """Return the names of a case, with those of the first case in their place."""
    if first is None or first.new.expansion is None or case.new.expansion is None:
        return ArgumentNames({})
    others = first.new.expansion.arguments
    values = {
        value: others[name]
        for name, value in case.new.expansion.arguments.items()
        if name in others and value != others[name] and len(value) >= _MIN_LENGTH and not _NO_NAME.fullmatch(value)
    }
    return ArgumentNames({value: values[value] for value in sorted(values, key=len, reverse=True)})
