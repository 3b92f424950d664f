"""Find the QoS that a C++ source keeps in a variable."""

from __future__ import annotations

import re

_DECLARATION = (
    r"(?P<type>\bauto|\b(?:\w+::)*\w*QoS\w*)(?:\s+const)?(?:\s*&\s*|\s+){name}\s*"
    r"(?:=\s*(?P<value>[^;]*)|(?P<arguments>[({{][^;]*[)}}]))\s*;"
)
"""A declaration with a value or with the arguments of a constructor."""
_VARIABLE = re.compile(r"(?!\d)\w+")


def find_assigned_qos(text: str, argument: str, position: int) -> str | None:
    """Return the QoS that a variable has at a call, such as ``rclcpp::QoS(10).best_effort()``.

    The result is None for other expressions, and if the last declaration before the call is not of a QoS.

    Args:
        text: the source without comments.
        argument: the argument of the call.
        position: the offset of the call.
    """
    if _VARIABLE.fullmatch(argument) is None:
        return None
    name = re.escape(argument)
    declarations = list(re.finditer(_DECLARATION.format(name=name), text[:position]))
    if not declarations:
        return None
    declaration = declarations[-1]
    value = declaration["value"] or f"{declaration['type']}{declaration['arguments']}"
    if "QoS" not in value and "qos" not in value:
        return None
    following = text[declaration.end() : position]
    if re.search(rf"\b{name}\s*=(?!=)", following):
        return None  # assigned again
    changes = re.findall(rf"(?<![\w.>]){name}\s*(\.[^;]*);", following)
    return " ".join("".join([value.strip(), *changes]).split())
