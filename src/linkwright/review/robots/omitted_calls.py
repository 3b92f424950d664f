"""Describe calls of macros whose files are missing, and decide whether their changes are breaking."""

from __future__ import annotations

import re
from collections.abc import Iterable

from linkwright.descriptions.comparison import Difference
from linkwright.diagnostics import Phrase, phrase, term
from linkwright.review.breaking import call_reason

_XACRO = "xacro:"
_NAME_PARAMETER = re.compile(r"@((\w+_)?topic(_name)?|(\w+_)?namespace|(\w+_)?frame(_id|_prefix)?)", re.IGNORECASE)
"""An attribute that gives a name in the graph or in tf to a macro."""


def find_title(difference: Difference) -> tuple[Phrase, str]:
    """Return the kind and the name of the changed object."""
    if difference.subject == "extension" and difference.name.startswith(_XACRO):
        return phrase("call of macro"), difference.name.removeprefix(_XACRO)
    return term(difference.subject), difference.name


def find_passed_name_reason(difference: Difference) -> Phrase | None:
    """Return why a name that a call of an unknown macro newly passes is breaking, or None for other differences."""
    is_added = difference.kind == "changed" and difference.old is None and difference.new is not None
    if not is_added or difference.subject != "extension" or not difference.name.startswith(_XACRO):
        return None
    if _NAME_PARAMETER.fullmatch(difference.property) is None:
        return None
    return phrase("if the macro has another default, programs that use the default name do not find it")


def find_lost_call_reason(difference: Difference, differences: Iterable[Difference]) -> Phrase | None:
    """Return why a removed call of an unknown macro is breaking, or None if it is not.

    It passes the name of a part, such as a sensor, or the prefix of its links, and no added call passes the same one.

    Args:
        difference: the difference between both versions of a robot.
        differences: all differences between them.
    """
    name = _find_instance(difference)
    if difference.kind != "removed" or not name:
        return None
    if any(other.kind == "added" and _find_instance(other) == name for other in differences):
        return None
    return call_reason(name)


def _find_instance(difference: Difference) -> str:
    """Return the name, or the prefix of links, that a call of a macro passes; empty for other differences."""
    if difference.subject != "extension" or not difference.name.startswith(_XACRO):
        return ""
    return difference.name.partition(" ")[2] or _find_prefix(difference)


def _find_prefix(difference: Difference) -> str:
    """Return the prefix that a call of a macro without a name passes for the links of a part; empty if it has none.

    The prefix of the robot is also that of the link to which the call attaches the part.
    """
    attributes = {} if difference.element is None else difference.element.attributes
    prefix, parent = attributes.get("prefix", ""), attributes.get("parent", "")
    return "" if not parent or parent.startswith(prefix) else prefix
