"""Read what the statements of functions do: conditions, results, assignments and calls."""

from __future__ import annotations

import re
from collections import Counter
from enum import Enum, auto
from typing import NamedTuple

from linkwright.review.sources.statements.code import Part

_INDENT = re.compile(r"[\d ]*")
"""The marks of the blocks before a statement in Python."""
_NAMING = re.compile(
    r"\b(?:create_\w+|declare_\w+|get_param\w*|getParam|param|advertise\w*|subscribe|serviceClient|Publisher|"
    r"Subscriber|Service\w*|Action\w+|\w*[Tt]imer)(?:<[^()]*>)?\s*\("
)
"""A call that gives a name to a topic, service or parameter, or makes a timer. Other lines report it."""
_READ = re.compile(r"\bget_param\w*\([^()]*\)")
"""A call that reads a parameter."""
_COMPUTATION = re.compile(r"[-+*/%]|\bnot\b|!")
_TARGET = re.compile(r"[\w.\[\]'\":]+(?:(?:->|\(\)[.]|\(\)->)[\w.\[\]'\":]+)*\Z")
"""The variable, member or field at the end of the left side of an assignment."""
_OPERATORS = "+-*/%&|^<>: "
"""The characters before the equals sign of an assignment that also computes, and spaces."""
_CALL = re.compile(r"(?:await )?(?P<function>[\w.:\[\]'\"]+(?:(?:->|\(\)[.]|\(\)->)[\w.:\[\]'\"]+)*)\(.*\)", re.DOTALL)
_WORD = re.compile(r"\"(?:\\.|[^\"\\])*\"|'(?:\\.|[^'\\])*'|\w+|\S")
_BLOCK_WORDS = frozenset({"else", "do", "try"})
_KEYWORDS = frozenset(
    {"if", "elif", "else", "while", "switch", "case", "return", "for", "in", "and", "or", "not", "auto"}
)
_MIN_SIMILARITY = 0.5
"""The minimum share of common names and literals of a statement that took the place of another one."""


class StatementKind(Enum):
    """The kind of a statement, by its purpose."""

    HEAD = auto()
    """The name and the parameters of the function."""
    CONDITION = auto()
    LOOP = auto()
    """A loop, or the head of a block with resources or errors."""
    RESULT = auto()
    """A result, a jump or an error."""
    ASSIGNMENT = auto()
    CALL = auto()
    OTHER = auto()
    REPORTED = auto()
    """A statement that other lines report, or a word before a block."""


_PATTERNS = (
    (StatementKind.CONDITION, re.compile(r"(?:if|elif|while|switch|case)\b")),
    (StatementKind.LOOP, re.compile(r"(?:async )?(?:for|with|try|except|catch|match)\b")),
    (StatementKind.RESULT, re.compile(r"(?:return|raise|throw|yield|continue|break|co_return)\b")),
)
_UNNAMED = frozenset({StatementKind.CONDITION, StatementKind.LOOP, StatementKind.OTHER})
"""The kinds of statements that are recognized by their names and literals."""


class FunctionStatement(NamedTuple):
    """A statement of a function.

    Attributes:
        part: the statement.
        text: its code in one line.
        kind: its kind.
        key: the assigned variable, the called function, or the first word of a condition, loop or result.
        value: the assigned value, or the whole statement.
        words: its names and literals, with their counts.
    """

    part: Part
    text: str
    kind: StatementKind
    key: str
    value: str
    words: Counter[str]

    def replaces(self, old: FunctionStatement) -> bool:
        """Return whether the statement may be the new version of another one."""
        if self.kind is not old.kind or self.kind is StatementKind.REPORTED or self.key != old.key:
            return False
        if self.kind not in _UNNAMED:
            return True
        return 2 * sum((self.words & old.words).values()) >= _MIN_SIMILARITY * (
            sum(self.words.values()) + sum(old.words.values())
        )


def list_words(text: str) -> list[str]:
    """Return the words, literals and operators of a code."""
    return _WORD.findall(text)


def read_text(part: Part) -> str:
    """Return a statement without the marks of its blocks; of a compound statement in Python, its head."""
    if part.written:
        return part.text
    text = _INDENT.sub("", part.text, count=1)
    return text.removesuffix("\n    pass").removesuffix(":")


def parse_part(part: Part, *, is_head: bool) -> FunctionStatement:
    """Return a statement of a function, whose first statement is its head."""
    text = " ".join((part.written or read_text(part)).split())
    kind, key, value = (StatementKind.HEAD, "", text) if is_head else _classify(text)
    return FunctionStatement(part, text, kind, key, value, Counter(word for word in list_words(text) if _is_name(word)))


def _is_name(word: str) -> bool:
    """Return whether a word is a name or a literal."""
    return word not in _KEYWORDS and (word[0].isalnum() or word[0] in "_\"'")


def _classify(text: str) -> tuple[StatementKind, str, str]:
    """Return the kind, key and value of a statement."""
    if text in _BLOCK_WORDS or _NAMING.search(text):
        return StatementKind.REPORTED, "", text
    for kind, pattern in _PATTERNS:
        match = pattern.match(text)
        if match is not None:
            return kind, match[0], text
    end = _find_equals_sign(text)
    target = _TARGET.search(text[:end].rstrip(_OPERATORS)) if end > 0 else None
    if target is not None:
        return StatementKind.ASSIGNMENT, target[0], text[end + 1 :].strip()
    call = _CALL.fullmatch(text)
    return (StatementKind.OTHER, "", text) if call is None else (StatementKind.CALL, call["function"], text)


def computes_otherwise(old: FunctionStatement, new: FunctionStatement) -> bool:
    """Return whether two statements assign the same parameter to the same variable after different computations."""
    ends = [_find_equals_sign(statement.text) for statement in (old, new)]
    targets = [statement.text[:end] for statement, end in zip((old, new), ends, strict=True)]
    values = [statement.text[end + 1 :] for statement, end in zip((old, new), ends, strict=True)]
    reads = [_READ.findall(value) for value in values]
    if -1 in ends or targets[0] != targets[1] or not reads[0] or reads[0] != reads[1]:
        return False
    others = [_READ.sub("", value) for value in values]
    signs = [sorted(_COMPUTATION.findall(other)) for other in others]
    return signs[0] != signs[1] and not any(_NAMING.search(other) for other in others)


def _find_equals_sign(text: str) -> int:
    """Return the index of the equals sign of an assignment, or -1."""
    depth = 0
    for index, character in enumerate(text):
        depth += (character in "([{") - (character in ")]}")
        is_comparison = text[index + 1 : index + 2] == "=" or text[index - 1 : index] in ("=", "!")
        if character == "=" and depth == 0 and index and not is_comparison:
            return index
    return -1
