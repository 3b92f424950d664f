"""Find the parameters that C++ sources of hardware read from its description."""

from __future__ import annotations

import re
from collections.abc import Iterator
from typing import NamedTuple

from linkwright.review.sources.cpp.branches import (
    FAILURE,
    MAX_CONDITION_CHARACTERS,
    is_in_branch,
    read_branch,
)
from linkwright.review.sources.cpp.text import find_arguments, find_closing_bracket
from linkwright.review.sources.names import FoundName, NameKind

HARDWARE = re.compile(r"\bhardware_interface\b|\bHardwareInfo\b")
_READ = r"\s*(?:\[\s*|\.\s*(?P<call>at|find|count|contains)\s*\(\s*){name}\s*[\])]"
_PARAMETER = re.compile(r"\b(?:hardware_parameters|parameters)" + _READ.format(name=r'"(?P<name>[\w.-]+)"'))
"""A parameter that hardware reads from its description, such as ``info_.hardware_parameters["port"]``."""
_CHECKS = frozenset({"find", "count", "contains"})
_MAX_BRANCH_CHARACTERS = 250
_IF = re.compile(r"\bif\s*(?=\()")
_NEXT_IF = re.compile(r"[\s);]*\bif\s*(?=\()")
_COMPARED = re.compile(r"\s*(?P<operator>[=!]=|>)\s*(?:0\b|[\w.>-]+\s*\.\s*c?end\s*\(\s*\))")
"""A comparison that tells whether a parameter is given."""
_ITERATOR = re.compile(r"\b(?P<name>\w+)\s*=\s*(?:[\w.]|->|\[[^\[\]]*\])*\Z")
_NEGATED = re.compile(r"!\s*(?:\w+\s*(?:\.|->)\s*)*\Z")
_ELSE = re.compile(r"\s*else\b")
_FUNCTION = re.compile(
    r"\b(?P<name>\w+)\s*(?:=\s*\[[^\[\]]*\]\s*)?\((?P<parameters>[^(){};]*\bstring[^(){};]*)\)\s*(?:const\s*)?"
    r"(?:->\s*[\w:<>]+\s*)?(?=\{)"
)
"""The definition of a function, or of a lambda in a variable, that takes a text."""
_KEY = re.compile(r"\s*(?:const\s+)?(?:std\s*::\s*)?string(?:_view)?\s*(?:const\s*)?&?\s*(?P<name>\w+)\s*\Z")
_MAP = re.compile(r"map\s*<>\s*(?:const\s*)?&?\s*(?P<name>\w+)\s*\Z")
_TEMPLATE = re.compile(r"<[^<>]*>")
_CONVERTED = re.compile(r"\s*(?:std\s*::\s*)?(?:to_string|string)\s*\((?P<value>[^()]*)\)\s*")


class _Helper(NamedTuple):
    """A function that reads the parameter of hardware that its caller names.

    Attributes:
        name: the name of the function.
        key: the index of the argument with the name of the parameter of hardware.
        argument_count: the number of its arguments.
        body: the offset of its body.
    """

    name: str
    key: int
    argument_count: int
    body: int


def find_hardware_parameters(text: str) -> Iterator[FoundName]:
    """Yield the parameters that hardware reads from its description, directly or with a function of its source.

    A parameter is required if the code reads it without a check, or fails where it is not given.

    Args:
        text: the source without comments.
    """
    if HARDWARE.search(text) is None:
        return
    reads = list(_PARAMETER.finditer(text))
    checks = [match for match in reads if match["call"] in _CHECKS]
    needed = {match["name"] for match in checks if _fails_without(text, match)}
    optional = {match["name"] for match in reads if match["call"] != "at" and not _fails_without(text, match)}
    is_caught = re.search(r"\bcatch\b", text) is not None
    for match in reads:
        name = match["name"]
        is_required = name not in optional and (name in needed or not is_caught)
        is_kept = match["call"] in _CHECKS and not is_required
        variable = _find_variable(text, match.end(), name) if is_kept else ""
        yield FoundName(
            NameKind.HARDWARE_PARAMETER, name, *match.span("name"), is_required=is_required, variable=variable
        )
    for helper in _find_helpers(text):
        for match in re.finditer(rf"(?<![\w:>.]){helper.name}\s*(?:<[^<>;()]*>\s*)?(?=\()", text):
            arguments = list(find_arguments(text, match.end()))
            literal = (
                re.fullmatch(r'\s*"([\w.-]+)"\s*', text[slice(*arguments[helper.key])])
                if len(arguments) == helper.argument_count
                else None
            )
            if literal is not None:
                default = text[slice(*arguments[helper.key + 1])] if helper.key + 1 < helper.argument_count else ""
                converted = _CONVERTED.fullmatch(default)
                start = arguments[helper.key][0] + literal.start(1)
                variable = (converted["value"] if converted is not None else default).strip()
                yield FoundName(
                    NameKind.HARDWARE_PARAMETER, literal[1], start, start + len(literal[1]), variable=variable
                )


def _find_helpers(text: str) -> Iterator[_Helper]:
    """Yield the functions of a source that read the parameter of hardware that an argument names."""
    for match in _FUNCTION.finditer(text):
        parameters = _TEMPLATE.sub("<>", match["parameters"]).split(",")
        maps = [found["name"] for found in map(_MAP.search, parameters) if found is not None]
        receiver = "|".join(["hardware_parameters", "parameters", *map(re.escape, maps)])
        for index, parameter in enumerate(parameters):
            key = _KEY.fullmatch(parameter)
            read = None if key is None else re.compile(rf"\b(?:{receiver}){_READ.format(name=re.escape(key['name']))}")
            if read is not None and read.search(text, match.end(), find_closing_bracket(text, match.end())):
                yield _Helper(match["name"], index, len(parameters), match.end())


def _fails_without(text: str, read: re.Match[str]) -> bool:
    """Return whether the code always checks for a parameter and fails where it is not given.

    Args:
        text: the source without comments.
        read: the call that looks for the parameter.
    """
    begin = max(0, read.start() - MAX_CONDITION_CHARACTERS)
    start = max(text.rfind(mark, begin, read.start()) for mark in ";{}") + 1
    asked = (read.start(), read.end())
    variable = _ITERATOR.search(text, start, read.start())
    condition = next(_IF.finditer(text, start, read.start()), None)
    if variable is not None:
        condition = condition or _NEXT_IF.match(text, read.end())
        if condition is None:
            return False
        closing = find_closing_bracket(text, condition.end())
        used = re.compile(rf"\b{variable['name']}\b").search(text, max(condition.end(), read.end()), closing)
        asked = used.span() if used is not None else asked
    if condition is None or is_in_branch(text, condition.start()) or text[start : condition.start()].strip() == "else":
        return False
    end = find_closing_bracket(text, condition.end())
    if not condition.end() < asked[0] < end:
        return False
    compared = _COMPARED.match(text, asked[1])
    is_negated = _NEGATED.search(text, condition.end(), _find_operand(text, asked[0])) is not None
    if compared is None and read["call"] == "find":
        return False
    is_missing = is_negated ^ (compared is not None and compared["operator"] == "==")
    if is_missing:
        branch = "" if "&&" in text[condition.end() : end] else read_branch(text, end + 1)
    else:
        first = len(text[end + 1 :]) - len(text[end + 1 :].lstrip()) + end + 1
        close = first + len(read_branch(text, end + 1))
        other = _ELSE.match(text, close + 1 if text.startswith("{", first) else close)
        branch = "" if other is None or "||" in text[condition.end() : end] else read_branch(text, other.end())
    return FAILURE.search(branch) is not None and _IF.search(branch) is None


def _find_operand(text: str, position: int) -> int:
    """Return the offset at which the object of a call begins, such as ``info_`` before ``.hardware_parameters``."""
    begin = max(0, position - MAX_CONDITION_CHARACTERS)
    match = re.search(r"(?:[\w.]|->|\[[^\[\]]*\])*\Z", text[begin:position])
    return position if match is None else begin + match.start()


def _find_variable(text: str, position: int, name: str) -> str:
    """Return the variable that gets a parameter behind a check for it; empty if there is none."""
    value = rf"->\s*second\b|parameters\s*(?:\[|\.\s*at\s*\()\s*\"{re.escape(name)}\""
    assigned = re.compile(rf"\b(\w+)\s*=(?!=)[^;=]*(?:{value})[^;]*;")
    match = assigned.search(text, position, position + _MAX_BRANCH_CHARACTERS)
    return "" if match is None else match[1]
