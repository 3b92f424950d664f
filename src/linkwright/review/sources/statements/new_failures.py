"""Find the conditions under which functions newly throw an error or exit."""

from __future__ import annotations

import re
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from difflib import SequenceMatcher

from linkwright.diagnostics import Phrase, phrase, quoted_names
from linkwright.review.sources.cpp.text import blank_comments
from linkwright.review.sources.names import NameKind, SourceNames
from linkwright.review.sources.statements.code import Code

_CPP_FAILURE = re.compile(r"\bthrow\s+[\w:]|(?<![\w.>])(?:std::)?(?P<exit>exit|abort)\s*\(")
_CPP_MAIN_FAILURE = re.compile(rf"{_CPP_FAILURE.pattern}|\breturn\s+(?P<code>-\s*\d+|[1-9]\d*|EXIT_FAILURE)\s*;")
"""A failure of ``main``, which ends the program by its result, too."""
_ARGUMENT_COUNT = re.compile(r"\bargc\s*(?:[<>]=?|[!=]=)\s*\d+|\b\d+\s*(?:[<>]=?|[!=]=)\s*argc\b")
_PYTHON_FAILURE = re.compile(r"(?:^|:)\s*raise\s+\w|(?<![\w.])(?:sys\.)?(?P<exit>exit)\s*\(")
_READ = re.compile(
    r"\b\w*[pP]aram\w*\s*(?:<[^<>;()]*>)?\s*\(\s*(?:\w+\s*\+\s*)?\"[~/.]*(?P<name>[\w./]+)\"\s*,\s*(?:this->)?(?P<variable>[A-Za-z_]\w*)\s*[,)]"
)
"""A call that reads a parameter into a variable."""
_ASSIGNED = re.compile(
    r"(?<![\w.])(?:self\.|this->)?(?P<variable>[A-Za-z_]\w*)\s*=(?!=)[^;=\n]*?"
    r"\b(?:declare|get)_?[pP]aram\w*\s*(?:<[^<>;()]*>)?\s*\(\s*[\"'][~/]*(?P<name>[\w./]+)[\"']"
)
"""An assignment of a parameter to a variable."""
_TEXT = re.compile(r"\"(?:\\.|[^\"\\])*\"|'(?:\\.|[^'\\])*'")
_NAME = re.compile(r"(?<![\w.])(?:self\.|this->)?(?P<root>[A-Za-z_]\w*)(?:(?:\.|->)\w+)*")
_KNOWN_WORDS = frozenset({"true", "false", "nullptr", "NULL", "None", "True", "False", "not", "and", "or", "in", "is"})
_FUNCTIONS = frozenset({"len", "abs", "min", "max", "fabs", "isnan", "isinf"})
_CONSTANT = re.compile(r"[A-Z][A-Z0-9_]+")
_MAX_FAILURES = 3
"""The maximum number of new failures of a function that have lines."""
_MAX_CHARACTERS = 100
"""The maximum number of characters of a shown condition."""
_MIN_SIMILARITY = 0.6
"""The minimum ratio of equal characters of two versions of a condition."""


@dataclass(frozen=True)
class FailureChange:
    """A condition under which a function newly fails.

    Attributes:
        sentence: the function and the condition.
        line: the line of the failure in the new version.
        reason: the reason why it is breaking; None if it is not certain to be.
    """

    sentence: Phrase
    line: int
    reason: Phrase | None


@dataclass(frozen=True)
class _Failure:
    """A statement in a branch that throws an error or exits.

    Attributes:
        conditions: the conditions of the branches, the innermost last.
        line: the line of the statement.
        is_exit: whether it exits the program.
    """

    conditions: tuple[str, ...]
    line: int
    is_exit: bool

    @property
    def condition(self) -> str:
        return self.conditions[-1]


class FailureSide:
    """A version of a source whose failures are compared.

    Args:
        code: the code of the functions.
        names: the names and conditions in the source.
        text: the text of the source.
        is_cpp: whether it is in C++.
    """

    def __init__(self, code: Code, names: SourceNames, text: str, *, is_cpp: bool) -> None:
        text = blank_comments(text) if is_cpp else text
        self.is_cpp = is_cpp
        self.names = names
        self.conditions = {_compact(branch.condition) for branch in names.conditional_lines}
        self.failures = {
            name: list(self._find_failures(text.split("\n"), name, parts[0].first_line, parts[-1].last_line))
            for name, parts in code.functions.items()
            if parts
        }
        self.parameters = find_read_parameters(text)
        self.reads_arguments = re.search(r"\bargv\s*\[\s*[1-9]", text) is not None

    def _find_failures(self, lines: Sequence[str], function: str, first: int, last: int) -> Iterator[_Failure]:
        """Yield the failures in the lines of a function that are in branches."""
        pattern = _PYTHON_FAILURE
        if self.is_cpp:
            pattern = _CPP_MAIN_FAILURE if function == "main" else _CPP_FAILURE
        for number in range(first, min(last + 1, len(lines)) + 1):
            line = _TEXT.sub("", lines[number - 1])
            match = pattern.search(line if self.is_cpp else line.partition("#")[0])
            if match is None:
                continue
            branches = [
                branch for branch in self.names.conditional_lines if first <= branch.first <= number <= branch.last
            ]
            branches.sort(key=lambda branch: (branch.first - branch.last, branch.line))
            if branches:
                is_exit = any(match.groupdict().values())
                yield _Failure(tuple(branch.condition for branch in branches), number, is_exit)


def find_read_parameters(text: str) -> Mapping[str, str]:
    """Return the parameters that a source reads into variables, by the name of the variable.

    Args:
        text: the source without comments.
    """
    found = [match for pattern in (_READ, _ASSIGNED) for match in pattern.finditer(text)]
    return {match["variable"]: match["name"] for match in found}


def find_new_failures(old: FailureSide, new: FailureSide) -> Iterator[FailureChange]:
    """Yield the conditions that only the new version has and under which a function of both versions fails.

    A condition that may replace another one, by its text or the variables in it, is left out.
    """
    for name, failures in new.failures.items():
        if name not in old.failures:
            continue
        lost = [item for item in old.failures[name] if _compact(item.condition) not in new.conditions]
        added = {
            _compact(item.condition): item
            for item in reversed(failures)
            if _compact(item.condition) not in old.conditions and not any(_may_replace(item, other) for other in lost)
        }
        for failure in sorted(added.values(), key=lambda item: item.line)[:_MAX_FAILURES]:
            yield _make_change(name, failure, old, new)


def _make_change(name: str, failure: _Failure, old: FailureSide, new: FailureSide) -> FailureChange:
    known = [_compact(condition) for condition in failure.conditions]
    condition = " and ".join(
        condition for condition, text in zip(failure.conditions, known, strict=True) if text not in old.conditions
    )
    shown = condition if len(condition) <= _MAX_CHARACTERS else f"{condition[:_MAX_CHARACTERS]}..."
    sentence = phrase("'{name}()' throws an error now if {condition}", name=name, condition=shown)
    if failure.is_exit:
        sentence = phrase("'{name}()' exits now if {condition}", name=name, condition=shown)
    if failure.is_exit and _ARGUMENT_COUNT.search(failure.condition) and not old.reads_arguments:
        return FailureChange(sentence, failure.line, phrase("callers that pass other arguments get an error"))
    parameters = _find_parameters(failure.conditions, new)
    known_before = {item.name.lstrip("~/") for item in old.names.of_kind(NameKind.PARAMETER)}
    kept = sorted(parameters & known_before)
    reason = phrase("values of {names} for which this holds stop the program", names=quoted_names(kept))
    return FailureChange(sentence, failure.line, reason if kept else None)


def _find_parameters(conditions: Sequence[str], side: FailureSide) -> set[str]:
    """Return the parameters on which alone conditions depend; empty if they depend on something else."""
    names = {match["root"] for text in conditions for match in _NAME.finditer(_TEXT.sub("", text))}
    names -= _KNOWN_WORDS | _FUNCTIONS
    variables = {name for name in names if not _CONSTANT.fullmatch(name)}
    if not variables or not variables <= side.parameters.keys():
        return set()
    return {side.parameters[name] for name in variables}


def _may_replace(new: _Failure, old: _Failure) -> bool:
    """Return whether a failure may be the new version of one that is gone."""
    names = [
        {match["root"] for match in _NAME.finditer(_TEXT.sub("", item.condition))} - _KNOWN_WORDS - _FUNCTIONS
        for item in (old, new)
    ]
    matcher = SequenceMatcher(None, old.condition, new.condition, autojunk=False)
    return bool(names[0] & names[1]) or matcher.ratio() >= _MIN_SIMILARITY


def _compact(condition: str) -> str:
    return "".join(condition.split())
