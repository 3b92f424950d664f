"""Find the conditions that functions newly assert."""

from __future__ import annotations

import re
from collections.abc import Iterator, Sequence
from typing import NamedTuple

from linkwright.diagnostics import Phrase, joined_first, phrase
from linkwright.review.changes import MAX_NAMES
from linkwright.review.sources.cpp.text import find_arguments
from linkwright.review.sources.statements.code import Code, Part
from linkwright.review.texts.excerpts import shorten

_CPP_ASSERTION = re.compile(
    r"(?:rcpputils :: (?:assert|require|check)_true|ROS_ASSERT(?:_MSG)?|assert|BOOST_ASSERT|Q_ASSERT) (?=\()"
)
_PYTHON_ASSERTION = re.compile(r"[\s\d]*assert (?P<condition>.+)", re.DOTALL)
_SPACES = re.compile(r" ?(\.|->|::|\(|\[) ?| (?=[)\],;])|(?<=[!~]) |(?<=[=<>(,] -) ")
_CONSTANT = re.compile(r"[\d\s()]*|true|false|True|False")
_MAX_CHARACTERS = 80
"""The maximum number of characters of a shown condition."""


class NewAssertion(NamedTuple):
    """The conditions that a function newly asserts.

    Attributes:
        sentence: the function and the conditions.
        line: the line of the first assertion in the new version.
    """

    sentence: Phrase
    line: int


def find_new_assertions(old: Code, new: Code, *, is_cpp: bool) -> Iterator[NewAssertion]:
    """Yield the functions of both versions that assert more than before.

    A function that no longer asserts another condition is left out, because one may replace the other.
    """
    for name, parts in new.functions.items():
        before, after = (_read_conditions(side, is_cpp=is_cpp) for side in (old.functions.get(name, ()), parts))
        added = [condition for condition in after if condition not in before]
        if name in old.functions and added and before.keys() <= after.keys():
            shown = joined_first([f"`{shorten(item, _MAX_CHARACTERS)}`" for item in added], MAX_NAMES)
            sentence = phrase("'{name}()' fails now unless {condition}", name=name, condition=shown)
            yield NewAssertion(sentence, after[added[0]])


def _read_conditions(parts: Sequence[Part], *, is_cpp: bool) -> dict[str, int]:
    """Return the asserted conditions of a function, each with its line."""
    conditions: dict[str, int] = {}
    for part in parts:
        match = (_CPP_ASSERTION if is_cpp else _PYTHON_ASSERTION).match(part.text)
        if match is None:
            continue
        condition = match["condition"] if not is_cpp else _read_first_argument(part.text, match.end())
        if not _CONSTANT.fullmatch(condition):
            conditions.setdefault(condition, part.first_line)
    return conditions


def _read_first_argument(text: str, position: int) -> str:
    """Return the first argument of a call in normalized code, as it is usually written."""
    start, end = next(iter(find_arguments(text, position)), (0, 0))
    return _SPACES.sub(lambda match: match[1] or "", text[start:end].strip())
