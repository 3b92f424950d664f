"""Find the interfaces of ros2_control that C++ sources of hardware offer, and those that controllers claim."""

from __future__ import annotations

import re
from collections.abc import Iterator

from linkwright.review.sources.names import FoundName, NameKind

_WORD = r"(?:\"(?P<{0}>[^\"\\]*)\"|(?:hardware_interface\s*::\s*)?HW_IF_(?P<{0}_constant>[A-Z_]+))"
_OFFERED = re.compile(
    rf"\b(?P<kind>Command|State)Interface\s*>?\s*[({{]\s*{_WORD.format('part')}\s*,\s*{_WORD.format('name')}"
)
"""The construction of an interface with a literal name, such as ``CommandInterface("gripper", "position", &value)``."""
_CLAIMED = re.compile(r"\bnames\s*\.\s*(?:push|emplace)_back\s*\(\s*\"(?P<name>[\w.-]+/[\w./-]+)\"\s*\)")
_PARAMETER = re.compile(
    r"\b(?:hardware_parameters|parameters)\s*(?:\[\s*|\.\s*(?P<call>at|find|count|contains)\s*\(\s*)"
    r"\"(?P<name>[\w.-]+)\"\s*[\])]"
)
"""A parameter that hardware reads from its description, such as ``info_.hardware_parameters["port"]``."""
_HARDWARE = re.compile(r"\bhardware_interface\b|\bHardwareInfo\b")
_CHECKS = frozenset({"find", "count", "contains"})
_MAX_BRANCH_CHARACTERS = 250
_CONTROLLER = re.compile(r"\bInterfaceConfiguration\b")


def find_hardware_interfaces(text: str) -> Iterator[FoundName]:
    """Yield the interfaces with literal names and the parameters of hardware in a C++ source without comments."""
    for match in _OFFERED.finditer(text):
        kind = NameKind.COMMAND_INTERFACE if match["kind"] == "Command" else NameKind.STATE_INTERFACE
        name = f"{_get_word(match, 'part')}/{_get_word(match, 'name')}"
        yield FoundName(kind, name, match.start("kind"), match.end())
    for match in _CLAIMED.finditer(text) if _CONTROLLER.search(text) else ():
        yield FoundName(NameKind.CLAIMED_INTERFACE, match["name"], match.start("name"), match.end("name"))
    reads = list(_PARAMETER.finditer(text)) if _HARDWARE.search(text) else []
    optional = {match["name"] for match in reads if match["call"] != "at"}
    is_caught = re.search(r"\bcatch\b", text) is not None
    for match in reads:
        is_required = match["name"] not in optional and not is_caught
        name, start, end = match["name"], match.start("name"), match.end("name")
        variable = "" if match["call"] not in _CHECKS else _find_variable(text, match.end(), name)
        yield FoundName(NameKind.HARDWARE_PARAMETER, name, start, end, is_required=is_required, variable=variable)


def _find_variable(text: str, position: int, name: str) -> str:
    """Return the variable that gets a parameter behind a check for it; empty if there is none."""
    value = rf"->\s*second\b|parameters\s*(?:\[|\.\s*at\s*\()\s*\"{re.escape(name)}\""
    assigned = re.compile(rf"\b(\w+)\s*=(?!=)[^;=]*(?:{value})[^;]*;")
    match = assigned.search(text, position, position + _MAX_BRANCH_CHARACTERS)
    return "" if match is None else match[1]


def _get_word(match: re.Match[str], group: str) -> str:
    """Return a literal, or the value of a constant such as ``HW_IF_POSITION``."""
    constant = match[f"{group}_constant"]
    return match[group] if constant is None else constant.lower()
