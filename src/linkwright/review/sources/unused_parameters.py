"""Find parameters that a C++ source reads although nothing uses their values."""

from __future__ import annotations

import re
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence

from linkwright.review.sources.cpp.text import blank_comments, find_arguments
from linkwright.review.sources.statements.new_failures import find_read_parameters

_TEXT = re.compile(r"\"(?:\\.|[^\"\\\n])*\"")
_LOG = re.compile(
    r"\b(?:RCLCPP|ROS|RCUTILS)_(?:DEBUG|INFO|WARN|ERROR|FATAL|LOG)\w*\s*\([^;]*;|\b(?:cout|cerr)\b[^;]*;|\bprintf\s*\([^;]*;"
)
_ARGUMENTS = r"\((?:[^();]|\((?:[^();]|\([^();]*\))*\))*\)"
_TEMPLATE = r"(?:<[^<>;()]*(?:<[^<>;()]*>)?[^<>;()]*>\s*)?"
_READ = re.compile(rf"(?:[\w:]+\s*(?:\.|->)\s*|\b(?:\w+::)+)?\b\w*[pP]aram\w*\s*{_TEMPLATE}(?P<arguments>{_ARGUMENTS})")
"""A call that reads or declares a parameter."""
_LITERAL = r"-?[\d.]+(?:e-?\d+)?f?|true|false|\"\""
_TYPE = (
    r"(?:(?:const|static|mutable|constexpr|extern|unsigned|long|short)\s+)*"
    r"(?:double|float|int|bool|size_t|long|short|unsigned|(?:std::)?u?int\d+_t|(?:std::)?size_t|(?:std::)?string|"
    r"(?:std::)?vector\s*<[^;{}()]*>)\s*"
)
_STATEMENT = (
    rf"[;{{}}]\s*(?:(?:[\w:]+\s+)*\w+\s*=\s*)?(?:\w+\s*(?:\.|->|::)\s*)*\w*[pP]aram\w*\s*{_TEMPLATE}\(\s*\"[~/.]*%s\""
)
"""The beginning of a statement that only reads or declares a parameter, with a place for its name."""


def is_read_without_use(text: str, others: Iterable[str], name: str, *, is_header: bool) -> bool:
    """Return whether a source only reads a parameter into variables, and nothing uses their values.

    Other sources use only the variables that a header declares. One that no file declares may belong to a class of
    another package, which may use it.

    Args:
        text: the text of the source.
        others: the texts of the other sources and headers of the package.
        name: the name of the parameter.
        is_header: whether the source is a header.
    """
    text, name = blank_comments(text), name.lstrip("~/")
    variables = _find_variables(text).get(name, set())
    statements = re.findall(_STATEMENT % re.escape(name), text)
    if not variables or len(statements) != len(re.findall(rf"\"[~/.]*{re.escape(name)}\"", text)):
        return False
    members = variables if is_header else {variable for variable in variables if not _declares(text, variable)}
    texts = [other for other in others if any(_names(other, member) for member in members)] if members else []
    return not any(
        _is_used(text, variable)
        or not any(_declares(other, variable) for other in (text, *texts))
        or (variable in members and any(_is_used(blank_comments(other), variable) for other in texts))
        for variable in variables
    )


def _declares(text: str, variable: str) -> bool:
    return re.search(rf"(?<![\w:<])(?:{_TYPE}|auto\s+){variable}\b", text) is not None


def find_unused_parameters(
    texts: tuple[str, str], list_others: tuple[Callable[[], Sequence[str]], Callable[[], Sequence[str]]]
) -> Iterator[str]:
    """Yield the parameters whose variable code used in the old version and none uses in the new one.

    A variable that another file names may be a member, which all sources of the package may use. Log messages do not
    count as uses.

    Args:
        texts: the texts of the old and the new source.
        list_others: functions that return the texts of the other sources and headers of the old and the new package.
    """
    old_text, new_text = map(blank_comments, texts)
    old_variables, new_variables = _find_variables(old_text), _find_variables(new_text)
    for parameter in sorted(old_variables.keys() & new_variables.keys()):
        old, new = old_variables[parameter], new_variables[parameter]
        if any(_is_used(new_text, variable) for variable in new) or not any(_is_used(old_text, name) for name in old):
            continue
        is_member = any(_names(text, variable) for text in list_others[1]() for variable in new)
        if not is_member or not any(_is_used(blank_comments(text), name) for text in list_others[1]() for name in new):
            yield parameter


def _find_variables(text: str) -> Mapping[str, set[str]]:
    """Return the variables into which a source without comments reads parameters, by parameter."""
    found: dict[str, set[str]] = {}
    for variable, parameter in find_read_parameters(text).items():
        found.setdefault(parameter, set()).add(variable)
    return found


def _names(text: str, variable: str) -> bool:
    return re.search(rf"(?<![\w:]){variable}\b", text) is not None


def _is_used(text: str, variable: str) -> bool:
    """Return whether a source without comments uses the value of a variable.

    What only declares or sets it, texts and log messages do not count.
    """
    if not _names(text, variable):
        return False
    text = _LOG.sub(";", _TEXT.sub('""', text))
    text = _READ.sub(lambda match: "read()" if _is_output(match, variable) else match[0], text)
    value = rf"(?:\w+\s*(?:\.|->)\s*)*\w*(?:[pP]aram\w*|read|as_\w+|get_value)\s*{_TEMPLATE}\([^;]*|{_LITERAL}"
    for pattern in (
        rf"(?<![\w.>]){variable}\s*=\s*(?:{value})\s*;",
        rf"(?<=[:,])\s*{variable}\s*(?:\(\s*(?:{_LITERAL})?\s*\)|\{{\s*(?:{_LITERAL})?\s*\}})(?=\s*[,{{])",
        rf"(?<![\w:<]){_TYPE}(?:\w+\s*(?:=[^;,(){{}}]*)?,\s*)*(?<!\w){variable}\s*(?=[=;,{{])",
    ):
        text = re.sub(pattern, ";", text)
    return _names(text, variable)


def _is_output(match: re.Match[str], variable: str) -> bool:
    """Return whether a call that reads or declares a parameter has a variable behind the name, or does not have it."""
    arguments = [match["arguments"][begin:end].strip() for begin, end in find_arguments(match["arguments"], 0)]
    is_read = len(arguments) > 1 and arguments[1].removeprefix("this->").strip() == variable
    return is_read or not _names(match["arguments"], variable)
