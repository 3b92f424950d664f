"""Decide whether a removed call of a macro whose file is missing is breaking."""

from __future__ import annotations

from collections.abc import Iterable

from linkwright.descriptions.comparison import Difference
from linkwright.diagnostics import Phrase
from linkwright.review.breaking import call_reason

_XACRO = "xacro:"


def find_lost_call_reason(difference: Difference, differences: Iterable[Difference]) -> Phrase | None:
    """Return why a removed call of an unknown macro is breaking, or None if it is not.

    It passes the name of a part, such as a sensor, and no added call passes the same name.

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
    """Return the name that a call of a macro passes; empty for other differences."""
    if difference.subject != "extension" or not difference.name.startswith(_XACRO):
        return ""
    return difference.name.partition(" ")[2]
