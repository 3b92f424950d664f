"""Replace the names of arguments in ``$(eval ...)`` of ROS 1, where they have no substitution of their own."""

from __future__ import annotations

import re
from collections.abc import Callable

_EVALUATION = re.compile(r"\$\(eval (?P<text>(?:[^()]|\((?:[^()]|\([^()]*\))*\))*)\)")
_NAME = re.compile(
    r"(?P<quoted>'[^']*'|\"[^\"]*\")|\barg\(\s*(?P<quote>['\"])(?P<argument>\w+)(?P=quote)\s*\)|"
    r"(?<![\w.])(?P<name>[A-Za-z_]\w*)(?!\w*\s*[(.])"
)
"""A text, or a name outside of texts that is neither a function nor an object."""
_LITERAL = re.compile(r"[-+]?(\d+\.?\d*|\.\d+)|true|false", re.IGNORECASE)


def replace_names_in_evaluations(text: str, find_value: Callable[[str], str | None]) -> str:
    """Return a text with the values of arguments in place of their names in ``$(eval ...)``.

    As in roslaunch, a value is a boolean or a number if it looks like one, and else a text. Names of arguments with
    unknown values remain.

    Args:
        text: a value or condition of a launch file of ROS 1.
        find_value: a function that returns the value of an argument, or None if it is unknown.
    """

    def replace_name(match: re.Match[str]) -> str:
        value = find_value(match["argument"] or match["name"] or "")
        if match["quoted"] is not None or value is None or "$(" in value:
            return match[0]
        return value.capitalize() if _LITERAL.fullmatch(value) else repr(value)

    return _EVALUATION.sub(lambda match: f"$(eval {_NAME.sub(replace_name, match['text'])})", text)
