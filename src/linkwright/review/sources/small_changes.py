"""Show the statements of functions in Python in which only conditions, results or sent messages differ."""

from __future__ import annotations

import re
from collections.abc import Iterator, Sequence
from difflib import SequenceMatcher

from linkwright.diagnostics import Phrase, joined, phrase
from linkwright.review.excerpts import shorten
from linkwright.review.sources.code import Code, Part
from linkwright.review.sources.code_changes import CodeChange, ReportedLines, format_function
from linkwright.review.sources.names import SourceNames

_INDENT = re.compile(r"[\d ]*")
"""The marks of the blocks before a statement."""
_HEAD = re.compile(r"(?:async )?def \w+(?P<arguments>\(.*\))", re.DOTALL)
"""The first line of a function without decorators."""
_CONDITION = re.compile(r"(?:if|elif|while) .*", re.DOTALL)
_RETURN = re.compile(r"return\b.*|raise\b.*|continue|break", re.DOTALL)
_CONSTANT_RETURN = re.compile(r"return (?:None|True|False|-?[\d.]+|'[^']*'|(?:\w+\.)*[A-Z][A-Z0-9_]+)")
_SENDING = re.compile(
    r"(?:await )?[\w.\[\]'\"]+\."
    r"(?:publish|sendTransform|send_transform|send_goal|send_goal_async|call|call_async|wait_for_service|wait_for_server)"
    r"\(.*",
    re.DOTALL,
)
"""A call that sends something, or waits for the one who gets it."""
_WITH_CONSTANT = re.compile(
    r"(?!return\b|raise\b|for\b|with\b|def\b)[^'\"]*(?:[(,=] ?(?:\w+\.)*[A-Z][A-Z0-9_]{2,}\b|[(,=] ?-?\d)[^'\"]*"
)
"""A statement without texts that passes or assigns a constant or a number."""
_NAMING = re.compile(r"\b(?:create_\w+|declare_\w+|get_param\w*|Publisher|Subscriber|Service\w*|Action\w+|\w*Timer)\(")
"""A call that gives a name to a topic, service or parameter, or makes a timer. Other lines report it."""
_MAX_CHANGES = 2
"""The maximum number of places that differ in a function."""
_MAX_CHARACTERS = 100


def find_small_changes(old: Code, new: Code, lines: ReportedLines, names: SourceNames) -> Iterator[CodeChange]:
    """Yield the functions in which few statements differ, if these are conditions, results or sent messages.

    Args:
        old: the code of the old version.
        new: the code of the new version.
        lines: the other lines about the source.
        names: the names in the new version.
    """
    for name, parts in new.functions.items():
        before = old.functions.get(name)
        if before is None or not lines.has_unreported_change(before, parts, name):
            continue
        changes = list(_compare(before, parts, lines))
        if changes and len(changes) <= _MAX_CHANGES and all(text is not None for text, _, _ in changes):
            texts = joined([text for text, _, _ in changes if text is not None], "; ")
            _, line, is_old = changes[0]
            yield CodeChange(
                phrase("in {function}: {changes}", function=format_function(name, names), changes=texts), line, is_old
            )


def _compare(
    old: Sequence[Part], new: Sequence[Part], lines: ReportedLines
) -> Iterator[tuple[Phrase | None, int, bool]]:
    """Yield the differences of two functions, each with its line; without a text if it is not small.

    Added and removed statements that other lines report are left out.
    """
    texts = [[_read(part) for part in parts] for parts in (old, new)]
    matcher = SequenceMatcher(None, texts[0], texts[1], autojunk=False)
    for tag, old_start, old_end, new_start, new_end in matcher.get_opcodes():
        if tag != "equal":
            parts = [old[old_start:old_end], new[new_start:new_end]]
            if not all(parts):
                is_old = bool(parts[0])
                parts = [[part for part in own if not lines.reports(part, is_old=is_old)] for own in parts]
            if not any(parts):
                continue
            part = (parts[1] or parts[0])[0]
            before, after = ([_read(item) for item in own] for own in parts)
            is_moved = any(item in texts[1] for item in before) or any(item in texts[0] for item in after)
            text = None if is_moved else _describe(before, after)
            yield text, part.first_line, new_end == new_start


def _read(part: Part) -> str:
    """Return a statement without the marks of its blocks; of a compound statement, its head."""
    text = _INDENT.sub("", part.text, count=1)
    return text.removesuffix("\n    pass").removesuffix(":")


def _describe(old: Sequence[str], new: Sequence[str]) -> Phrase | None:
    """Return the text of a small difference, or None for another one."""
    if any(len(text) > _MAX_CHARACTERS for text in (*old, *new)):
        return None
    if len(old) == len(new) == 1:
        heads = _HEAD.fullmatch(old[0]), _HEAD.fullmatch(new[0])
        if heads[0] and heads[1]:
            return phrase("arguments {old} -> {new}", old=heads[0]["arguments"], new=heads[1]["arguments"])
        is_small = any(pattern.fullmatch(old[0]) and pattern.fullmatch(new[0]) for pattern in (_CONDITION, _RETURN))
        return phrase("`{old}` -> `{new}`", old=_format(old), new=_format(new)) if is_small else None
    if not old and _is_plain(new):
        return phrase("{items} added", items=f"`{_format(new)}`")
    return phrase("{items} removed", items=f"`{_format(old)}`") if not new and _is_plain(old) else None


def _is_plain(texts: Sequence[str]) -> bool:
    """Return whether statements are a condition, with or without a jump, or a constant result.

    A sent message, and one statement with a constant, are plain, too.
    """
    if len(texts) == 1:
        patterns = (_CONDITION, _CONSTANT_RETURN, _SENDING, _WITH_CONSTANT)
        return any(pattern.fullmatch(texts[0]) for pattern in patterns) and not _NAMING.search(texts[0])
    return len(texts) == 2 and bool(_CONDITION.fullmatch(texts[0]) and _RETURN.fullmatch(texts[1]))


def _format(texts: Sequence[str]) -> str:
    return shorten(": ".join(" ".join(text.split()) for text in texts), _MAX_CHARACTERS)
