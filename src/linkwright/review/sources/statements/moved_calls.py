"""Find calls that send something and that move into a condition, or out of one, which both versions have."""

from __future__ import annotations

import re
from collections.abc import Iterator, Sequence
from typing import NamedTuple

from linkwright.diagnostics import Phrase, phrase
from linkwright.review.sources.names import SourceNames
from linkwright.review.sources.statements.code import Code, Part
from linkwright.review.texts.excerpts import shorten

_CALL = re.compile(
    r"(?P<call>\w[\w.>:-]*(?:\.|->)(?:publish|sendTransform|send_transform|send_goal|send_goal_async|async_send_goal|"
    r"call_async|async_send_request))\("
)
_SPACES = re.compile(r" ?(->|\.|::|\() ?")
"""A bracket or the like with the spaces around it in normalized code of C++."""
_MAX_CHARACTERS = 120
"""The maximum number of characters of shown conditions."""
_LEAVING = re.compile(r"(?:return|continue|break|throw|raise|goto|exit)\b")


class MovedCall(NamedTuple):
    """A call that moves into a condition or out of one.

    Attributes:
        text: the change in one line.
        line: the line of the call in the new version.
    """

    text: Phrase
    line: int


def find_moved_calls(old: Code, new: Code, old_names: SourceNames, new_names: SourceNames) -> Iterator[MovedCall]:
    """Yield the calls that send something and depend on a condition in one version only, which both have.

    A function counts if nothing leaves it before the call, because the rest of it depends on such a statement, too.

    Args:
        old: the code of the old version.
        new: the code of the new version.
        old_names: the names of the old version, with its conditions.
        new_names: the names of the new version, with its conditions.
    """
    for name, parts in new.functions.items():
        before = old.functions.get(name)
        if not before or [part.text for part in before] == [part.text for part in parts]:
            continue
        old_lines, new_lines = _find_single_calls(before), _find_single_calls(parts)
        known = _list_conditions(old_names, before) & _list_conditions(new_names, parts)
        for call in (call for call in new_lines if call in old_lines):
            conditions = _find_around(old_names, old_lines[call]), _find_around(new_names, new_lines[call])
            lost, added = set(conditions[0]) - set(conditions[1]), set(conditions[1]) - set(conditions[0])
            moved = [text for text in (*conditions[0], *conditions[1]) if text in lost or text in added]
            if bool(lost) != bool(added) and known.issuperset(moved):
                text = _format(name, call, " and ".join(moved), is_lost=bool(lost))
                yield MovedCall(text, new_lines[call])


def _find_single_calls(parts: Sequence[Part]) -> dict[str, int]:
    """Return the lines of calls that a function makes once, before any statement that leaves the function."""
    lines: dict[str, list[int]] = {}
    is_certain = True
    for part in sorted(parts, key=lambda item: item.first_line):
        for match in _CALL.finditer(_SPACES.sub(r"\1", part.text)):
            lines.setdefault(match["call"], []).append(part.first_line if is_certain else 0)
        is_certain = is_certain and _LEAVING.match(part.text) is None
    return {call: found[0] for call, found in lines.items() if len(found) == 1 and found[0]}


def _list_conditions(names: SourceNames, parts: Sequence[Part]) -> set[str]:
    """Return the conditions in a function, also those of which only the opposite has a branch."""
    first, last = parts[0].first_line, parts[-1].last_line
    found = [branch for branch in names.conditional_lines if first <= branch.line <= last]
    texts = {branch.condition for branch in found}
    return texts | {f"!({text})" for text in texts} | {f"not ({text})" for text in texts}


def _find_around(names: SourceNames, line: int) -> list[str]:
    """Return the conditions around a line."""
    return [branch.condition for branch in names.conditional_lines if branch.first <= line <= branch.last]


def _format(function: str, call: str, condition: str, *, is_lost: bool) -> Phrase:
    shown = shorten(condition, _MAX_CHARACTERS)
    if is_lost:
        return phrase(
            "in '{function}()': `{call}()` no longer only if {condition}",
            function=function,
            call=call,
            condition=shown,
        )
    return phrase(
        "in '{function}()': `{call}()` now only if {condition}", function=function, call=call, condition=shown
    )
