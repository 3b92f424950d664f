"""Find the topics and services of Gazebo's transport library in C++ sources, and decide which are equal."""

from __future__ import annotations

import re
from collections.abc import Callable, Iterator, Sequence
from typing import NamedTuple

from linkwright.review.sources.cpp.text import find_arguments, find_closing_bracket
from linkwright.review.sources.cpp.values import VARIABLE, find_assigned_expression
from linkwright.review.sources.name_patterns import extract_pattern
from linkwright.review.sources.names import NameKind, SourceName, SourceNames
from linkwright.review.sources.parameter_defaults import split_sum

GAZEBO_KINDS = (
    *(NameKind.GAZEBO_PUBLISHER, NameKind.GAZEBO_SUBSCRIPTION),
    *(NameKind.GAZEBO_SERVICE, NameKind.GAZEBO_CLIENT),
)
_KINDS = dict(zip(("Advertise", "Subscribe", "AdvertiseService", "Request"), GAZEBO_KINDS, strict=True))
_TRANSPORT = re.compile(r"\b(?:gz|ignition|gazebo)\s*(?:::|/)\s*transport\b")
_CALL = re.compile(rf"(?:->|\.)\s*(?P<name>{'|'.join(_KINDS)})\s*(?=[<(])")
_CALLBACK = re.compile(r"&\s*(?:\w+::)*(\w+)\s*$")
_VALID_NAME = re.compile(r"\s*(?:\w+::)*(?P<list>validTopic|AsValidTopic)\s*\((?P<argument>.*)\)\s*", re.DOTALL)
"""A call that returns a valid name: the first one of a list, or one without the characters that are not allowed."""
_OPERAND = re.compile(
    r"(?:std::(?:string|to_string)\s*[({]\s*)?(?:this\s*->\s*)?(?:\w+\s*(?:->|\.|::)\s*)*?(?P<name>\w+)"
    r"(?:\s*(?:->|\.)\s*(?:c_str|(?:Get)?(?:Scoped)?Name)\s*\([^()]*\))?\s*[)}]?"
)
"""An operand with an unknown value: a variable, or the name of an object."""
_ELEMENT = re.compile(r".*\bGet\s*<[^<>]*>\s*\(\s*\"(?P<name>\w+)\".*", re.DOTALL)
_UNKNOWN = "..."
_MARK = re.compile(r"<[^<>]+>")


class GazeboTopic(NamedTuple):
    """A topic or service of Gazebo's transport library.

    Attributes:
        kind: the kind of the name.
        name: the name, with marks for the unknown parts, such as ``<model>/cmd_vel``.
        type: the type of the messages or requests without its namespace; empty if it is unknown.
        begin: the offset of the argument with the name.
        end: the end of the argument.
    """

    kind: NameKind
    name: str
    type: str
    begin: int
    end: int


def find_gazebo_topics(
    text: str, headers: Sequence[str], evaluate: Callable[[int, int], str | None]
) -> Iterator[GazeboTopic]:
    """Yield the topics and services that a C++ source without comments uses in Gazebo.

    Names without any known text are left out.

    Args:
        text: the source.
        headers: the texts of the included headers of the repository.
        evaluate: a function that returns the text of the expression between two offsets, or None if it is not certain.
    """
    calls = list(_CALL.finditer(text))
    if not calls or not any(map(_TRANSPORT.search, (text, *headers))):
        return
    for match in calls:
        start, type_name = match.end(), ""
        if text[start] == "<":
            end = find_closing_bracket(text, start)
            type_name, start = text[start + 1 : end], text.find("(", end)
        arguments = list(find_arguments(text, start)) if start >= 0 else []
        if not arguments:
            continue
        begin, end = arguments[0]
        name = evaluate(begin, end) or _join(text, text[begin:end], begin)
        if name is not None:
            type_name = type_name or _find_type([text[slice(*item)] for item in arguments[1:]], (text, *headers))
            yield GazeboTopic(_KINDS[match["name"]], name, type_name.strip().rpartition("::")[2], begin, end)


def _join(text: str, expression: str, position: int) -> str | None:
    """Return the name that an expression gives at an offset, or None if it has no known text. Unknown parts have marks.

    The expression is a sum, or a variable that gets one. Of a list of possible names, the last one is the default.
    """
    variable = VARIABLE.fullmatch(expression)
    if variable is not None:
        expression = find_assigned_expression(text, variable["name"], position) or ""
    valid = _VALID_NAME.fullmatch(expression)
    if valid is not None:
        expression = valid["argument"]
        listed = re.compile(rf"\b{re.escape(expression.strip())}\s*\.\s*push_back\s*(?=\()")
        pushed = list(listed.finditer(text, 0, position)) if valid["list"] == "validTopic" else []
        if pushed:
            expression = text[pushed[-1].end() + 1 : find_closing_bracket(text, pushed[-1].end())]
    if extract_pattern(expression) is None:
        return None
    name = "".join(map(_read_operand, split_sum(expression)))
    return name if re.search(r"\w", _MARK.sub("", name)) else None


def _read_operand(expression: str) -> str:
    """Return the text of an operand of a sum, or a mark with the name of its variable, object or parameter."""
    literal = re.fullmatch(r'(?:std::string\s*[({]\s*)?"([^"\\]*)"\s*[)}]?', expression)
    if literal is not None:
        return literal[1]
    match = _OPERAND.fullmatch(expression) or _ELEMENT.fullmatch(expression)
    return f"<{_UNKNOWN if match is None else match['name'].strip('_')}>"


def _find_type(arguments: Sequence[str], texts: Sequence[str]) -> str:
    """Return the type that the only callback among arguments takes first, as written; empty if it is unknown."""
    callbacks = {match[1] for argument in arguments if (match := _CALLBACK.search(argument)) is not None}
    if len(callbacks) != 1:
        return ""
    pattern = re.compile(rf"\b{callbacks.pop()}\s*\(\s*(?:const\s+)?(?P<type>(?:\w+::)+[A-Z]\w*)\s*&")
    types = {match["type"].rpartition("::")[2] for text in texts for match in pattern.finditer(text)}
    return types.pop() if len(types) == 1 else ""


def select_gazebo_topics(items: Sequence[SourceName], other_names: SourceNames) -> list[SourceName]:
    """Return the names of Gazebo that only one version of a source has, without those that the other one may have.

    Args:
        items: the names of a kind.
        other_names: the names of the other version.
    """
    known = [other.name for other in other_names.of_kind(items[0].kind)] if items else []
    return [item for item in items if not any(_may_be_equal(item.name, name) for name in known)]


def _may_be_equal(name: str, other: str) -> bool:
    """Return whether two names with marks may be the same. A mark that both have is the same text."""
    shared = {*_MARK.findall(name)} & {*_MARK.findall(other)}
    return any(re.fullmatch(_make_pattern(first, shared), second) for first, second in ((name, other), (other, name)))


def _make_pattern(name: str, shared: set[str]) -> str:
    """Return a regular expression for the names that a name with marks may be."""
    marks = [re.escape(mark) if mark in shared else ".+" for mark in _MARK.findall(name)]
    texts = [re.escape(text) for text in _MARK.split(name)]
    return texts[0] + "".join(mark + text for mark, text in zip(marks, texts[1:], strict=True))
