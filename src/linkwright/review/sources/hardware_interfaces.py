"""Find the interfaces of ros2_control that C++ sources of hardware offer, and those that controllers claim."""

from __future__ import annotations

import re
from collections.abc import Callable, Collection, Iterator

from linkwright.review.sources.cpp.text import find_arguments
from linkwright.review.sources.hardware_parameters import HARDWARE
from linkwright.review.sources.names import FoundName, NameKind
from linkwright.review.sources.parameter_defaults import split_sum
from linkwright.review.texts.comments import without_comments
from linkwright.review.versions import Version

NAME_PART, NUMBER_PART, UNKNOWN_PART = "<name>", "<number>", "<...>"
"""The marks for a name of the description, a number and another unknown text in the name of an interface."""
_OFFERED = re.compile(
    r"\b(?P<kind>Command|State)Interface\s*>?\s*[({]|"
    r"\b\w*(?P<list>command|state)_interfaces?_?\s*\.\s*emplace_back\s*\((?!\s*[\w:]*\b(?:Command|State)Interface\b)"
)
"""The construction of an interface, such as ``CommandInterface("gripper", "position", &value)``."""
_CLAIMED = re.compile(r"\bnames\s*\.\s*(?:push|emplace)_back\s*\(")
_CONSTANT = re.compile(r"\s*(?:::)?(?:\w+\s*::\s*)*HW_IF_(?P<name>[A-Z_]+)\s*")
_LITERAL = re.compile(r'\s*(?:std::string\s*[({]\s*)?"(?P<text>[^"\\]*)"\s*[)}]?\s*')
_NUMBER = re.compile(r"\s*(?:std::)?to_string\s*\(.*\)\s*", re.DOTALL)
_VARIABLE = re.compile(r"\s*[A-Za-z_][\w.:]*(?:(?:\[[^\[\]]*\]|->|\.|\.at\([^()]*\))[\w.:]*)*\s*")
_TYPED = re.compile(r"\s*(?:const\b|(?:std::)?string\b\s*&)")
"""The beginning of a parameter in the declaration of a constructor."""
_ELEMENT = re.compile(
    r"\binfo_?\s*\.\s*(?P<list>sensors|gpios|transmissions)\s*"
    r"(?:\[\s*\d+\s*\]|\.\s*(?:at\s*\(\s*\d+|(?:front|back)\s*\()\s*\))"
)
"""An element of the description that hardware reads at a fixed index, such as ``info_.sensors[0]``."""
_MIN_ARGUMENTS = 3
"""The minimum number of arguments of an interface that a list constructs: two names and a variable."""
_DESCRIPTION_SUFFIXES = (".xacro", ".urdf")
_CONTROLLER = re.compile(r"\bInterfaceConfiguration\b")


def find_hardware_interfaces(text: str, evaluate: Callable[[int, int], str | None]) -> Iterator[FoundName]:
    """Yield the interfaces of hardware and the elements that it reads, in a C++ source without comments.

    Unknown parts of the names of interfaces are marked: ``<name>/position``.

    Args:
        text: the source without comments.
        evaluate: a function that returns the text of the expression between two offsets, or None if it is not certain.
    """
    for match in _OFFERED.finditer(text):
        arguments = list(find_arguments(text, match.end() - 1))
        if len(arguments) < _MIN_ARGUMENTS - (match["kind"] is not None) or _TYPED.match(text, arguments[0][0]):
            continue
        is_command = (match["kind"] or match["list"]).lower() == "command"
        kind = NameKind.COMMAND_INTERFACE if is_command else NameKind.STATE_INTERFACE
        name = "/".join(_read_name(text, *argument, evaluate) for argument in arguments[:2])
        yield FoundName(kind, name, match.start("kind") if match["kind"] else match.start(), arguments[1][1])
    for match in _CLAIMED.finditer(text) if _CONTROLLER.search(text) else ():
        for begin, end in list(find_arguments(text, match.end() - 1))[:1]:
            name = _read_name(text, begin, end, evaluate)
            if "/" in name:
                yield FoundName(NameKind.CLAIMED_INTERFACE, name, begin, end)
    for match in _ELEMENT.finditer(text) if HARDWARE.search(text) else ():
        is_checked = re.search(rf"\b{match['list']}\s*\.\s*(?:size|empty)\s*\(", text) is not None
        name = f"<{match['list'].removesuffix('s')}>"
        is_required = not is_checked and re.search(r"\bcatch\b", text) is None
        yield FoundName(NameKind.HARDWARE_ELEMENT, name, *match.span("list"), is_required=is_required)


def find_description_without(version: Version, classes: Collection[str], elements: Collection[str]) -> str | None:
    """Return a description that uses hardware but certainly lacks an element; None if there is none.

    Args:
        version: the version of the repository.
        classes: the names of the classes of the hardware, such as ``arm::ArmHardware``.
        elements: the elements, such as ``<sensor>``.
    """
    names = "|".join(sorted({re.escape(name.rpartition("::")[2]) for name in classes}))
    plugin = re.compile(rf"<plugin>\s*(?:\w+(?:/|::))*(?:{names})\s*</plugin>")
    for path in version.paths(_DESCRIPTION_SUFFIXES):
        text = version.text(path)
        if names and plugin.search(text) is not None:
            code = without_comments(text, path)
            is_complete = "<ros2_control" in code and "include" not in code and "insert_block" not in code
            if is_complete and any(f"{element[:-1]} " not in code for element in elements):
                return path
    return None


def _read_name(text: str, begin: int, end: int, evaluate: Callable[[int, int], str | None]) -> str:
    """Return the text of an expression, with marks for the operands of a sum that are unknown."""
    known = _read_text(text[begin:end]) or evaluate(begin, end)
    if known is not None:
        return known
    parts, position = [], begin
    for part in split_sum(text[begin:end]):
        start = text.find(part, position, end)
        position = start + len(part)
        value = _read_text(part)
        value = evaluate(start, position) if value is None and start >= 0 else value
        parts.append(_mark_unknown(part) if value is None else value)
    return "".join(parts)


def _read_text(expression: str) -> str | None:
    """Return a literal, or the value of a constant such as ``HW_IF_POSITION``; None for other expressions."""
    literal, constant = _LITERAL.fullmatch(expression), _CONSTANT.fullmatch(expression)
    if literal is not None:
        return literal["text"]
    return None if constant is None else constant["name"].lower()


def _mark_unknown(expression: str) -> str:
    if _NUMBER.fullmatch(expression):
        return NUMBER_PART
    return NAME_PART if _VARIABLE.fullmatch(expression) else UNKNOWN_PART
