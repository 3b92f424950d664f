"""Read the conditions of the preprocessor in a C++ source.

Code under ``#if 0`` is a comment. Whether other conditions hold is not known, because compilers and build files can
define names.
"""

from __future__ import annotations

import bisect
import re
from collections.abc import Iterator, Sequence
from itertools import zip_longest
from typing import NamedTuple

_COMMENT_OR_TEXT = re.compile(
    r"//[^\n]*|/\*.*?\*/|R\"(?P<mark>[^(\s]*)\(.*?\)(?P=mark)\"|\"(?:\\.|[^\"\\\n])*\"|(?<!\w)'(?:\\.|[^'\\\n])'",
    re.DOTALL,
)
_DIRECTIVE = re.compile(
    r"^[ \t]*#[ \t]*(?P<word>if|ifdef|ifndef|elif|elifdef|elifndef|else|endif)\b(?P<text>(?:[^\n\\]|\\\r?\n|\\.)*)",
    re.MULTILINE,
)
_DEFINED = re.compile(r"\bdefined\s*(?:\(\s*(\w+)\s*\)|(\w+))")
_SIMPLE = re.compile(r"\w+|defined\(\w+\)")
_GUARD = re.compile(r"!\s?defined\((?P<name>\w+)\)")
_DISABLING = re.compile(r"^[ \t]*#[ \t]*(?:if[ \t(]*(?:0|false)\b|el)", re.MULTILINE)
"""A directive without which a source has no disabled code: a condition that never holds, or another branch."""
_NEVER, _ALWAYS = "0", "1"
_CONSTANTS = {"0": _NEVER, "false": _NEVER, "1": _ALWAYS, "true": _ALWAYS, "defined(__cplusplus)": _ALWAYS}


class _Section(NamedTuple):
    """The code between two directives.

    Attributes:
        start: the offset of its first character.
        end: the offset of the next directive.
        condition: the condition of the code; empty if it has none, and None if it never holds.
    """

    start: int
    end: int
    condition: str | None


class _Group:
    """The branches from an ``#if`` to its ``#endif``.

    Args:
        outer: the condition of the code around it.
    """

    def __init__(self, outer: str | None) -> None:
        self.outer = outer
        self._others: list[str] = []
        """The conditions under which the next branches are not used."""

    def open_branch(self, condition: str) -> str | None:
        """Return the whole condition of the next branch."""
        parts = [part for part in (*self._others, condition) if part != _ALWAYS]
        self._others.append(_negate(condition))
        if self.outer is None or _NEVER in parts:
            return None
        named = list(dict.fromkeys(part for part in (self.outer, *parts) if part))
        return " && ".join(f"({part})" if len(named) > 1 and _is_disjunction(part) else part for part in named)


class Conditions:
    """The conditions of the preprocessor in a C++ source.

    They are empty for a source whose directives do not match.

    Args:
        text: the source.
    """

    def __init__(self, text: str) -> None:
        self._sections = list(_read_sections(text))
        self._starts = [section.start for section in self._sections]

    def find(self, offset: int) -> str:
        """Return the condition of the code at an offset, such as ``defined(DEBUG)``; empty if it has none."""
        index = bisect.bisect_right(self._starts, offset) - 1
        return self._sections[index].condition or "" if index >= 0 else ""

    def find_disabled(self) -> Iterator[tuple[int, int]]:
        """Yield the start and end of the code whose condition never holds."""
        return ((section.start, section.end) for section in self._sections if section.condition is None)


_DIRECTIVE_NAME = re.compile(r"[ \t]*#[ \t]*(if|ifdef|ifndef|else|elif|endif)\b")
_NO_BRACES = str.maketrans("{}", "  ")


def blank_disabled(text: str) -> str:
    """Return a C++ source with spaces for the code whose condition never holds, such as under ``#if 0``."""
    if _DISABLING.search(text) is None:
        return text
    for start, end in Conditions(text).find_disabled():
        text = text[:start] + re.sub(r"[^\n]", " ", text[start:end]) + text[end:]
    return text


def is_guard(text: str, name: str) -> bool:
    """Return whether a text before ``#define NAME`` ends with the condition that it is not defined yet."""
    negated = rf"(?:ifndef[ \t]+{name}|if[ \t]+![ \t]*defined[ \t]*\(?[ \t]*{name}[ \t]*\)?)"
    return re.search(rf"#[ \t]*{negated}\b[^\n]*\s*\Z", text) is not None


def _read_sections(text: str) -> Iterator[_Section]:
    code = _COMMENT_OR_TEXT.sub(lambda match: re.sub(r"[^\n]", " ", match[0]), text)
    directives = list(_DIRECTIVE.finditer(code))
    if not _is_balanced([match["word"] for match in directives]):
        return
    groups: list[_Group] = []
    condition: str | None = ""
    for match, following in zip_longest(directives, directives[1:]):
        word = match["word"]
        if word.startswith("if"):
            groups.append(_Group(condition))
        if word == "endif":
            condition = groups.pop().outer
        else:
            condition = groups[-1].open_branch(_normalize(word, match["text"], code[match.end() :]))
        yield _Section(match.end(), len(text) if following is None else following.start(), condition)


def _is_balanced(words: Sequence[str]) -> bool:
    depth = 0
    for word in words:
        depth += word.startswith("if") - (word == "endif")
        if depth < 0 or (depth == 0 and word.startswith("el")):
            return False
    return depth == 0


def _normalize(word: str, text: str, following: str) -> str:
    """Return the condition of a directive in one notation.

    The guard of a header always holds.
    """
    if word == "else":
        return _ALWAYS
    text = " ".join(text.replace("\\\n", " ").split())
    if word.endswith("def"):
        text = f"{'!' if word.endswith('ndef') else ''}defined({text.partition(' ')[0]})"
    text = _DEFINED.sub(lambda match: f"defined({match[1] or match[2]})", text)
    while text.startswith("(") and text.endswith(")") and text.count("(") == 1:
        text = text[1:-1].strip()
    guard = _GUARD.fullmatch(text)
    if guard is not None and re.match(rf"\s*#[ \t]*define[ \t]+{guard['name']}\b", following):
        return _ALWAYS
    return _CONSTANTS.get(text, text)


def _is_disjunction(condition: str) -> bool:
    """Return whether a condition has an ``||`` outside of parentheses."""
    while (inner := re.sub(r"\([^()]*\)", "", condition)) != condition:
        condition = inner
    return "||" in condition


def _negate(condition: str) -> str:
    if condition in (_ALWAYS, _NEVER):
        return _NEVER if condition == _ALWAYS else _ALWAYS
    if condition.startswith("!") and _SIMPLE.fullmatch(condition[1:].strip()):
        return condition[1:].strip()
    return f"!{condition}" if _SIMPLE.fullmatch(condition) else f"!({condition})"


def blank_repeated_braces(text: str) -> str:
    """Return a C++ source in which each block has one opening brace.

    A branch of the preprocessor may repeat the beginning of a block that its other branch opens, too.

    Args:
        text: the source without comments.
    """
    if "#else" not in text and "#elif" not in text:
        return text
    depths: list[tuple[int, bool]] = []  # of each group: the braces that its first branch leaves open; whether it ended
    lines = []
    for line in text.split("\n"):
        directive = _DIRECTIVE_NAME.match(line)
        if directive is None:
            if any(depth and is_over for depth, is_over in depths):
                line = line.translate(_NO_BRACES)
            else:
                change = line.count("{") - line.count("}")
                depths = [(depth + (not is_over) * change, is_over) for depth, is_over in depths]
        elif directive[1].startswith("if"):
            depths.append((0, False))
        elif depths and directive[1].startswith("el"):
            depths[-1] = depths[-1][0], True
        elif depths and directive[1] == "endif":
            depths.pop()
        lines.append(line)
    return "\n".join(lines)
