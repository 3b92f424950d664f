"""Values of literals: numbers and booleans out of strings, and the texts that count as true.

Both are ros/xacro's, on which real robots rely: ``007`` is 7, ``true`` is True, but ``TRUE``, ``0x10`` and ``1_000``
are strings.
"""

from __future__ import annotations

from functools import lru_cache

from linkwright.loading.lean_typing import Any

_NEVER_A_LITERAL = frozenset('ABCDEGHJKLMOPQRSUVWXYZabcdeghjklmopqrsuvwxyz$/<>(["')
"""Characters that begin neither a number nor a boolean."""
_BOOLEANS = {"true": True, "True": True, "false": False, "False": False}


def literal(value: Any) -> Any:
    """The value of a string that may be a number or a boolean; anything else as it is.

    Single quotes around a string are taken off and keep it a string.
    """
    if not isinstance(value, str) or not value:
        return value
    if value[0] == "'" and value[-1] == "'" and len(value) >= 2:
        return value[1:-1]
    if "_" in value or value[0] in _NEVER_A_LITERAL:
        return value
    return number_or_boolean(value)


@lru_cache(maxsize=4096)
def number_or_boolean(text: str) -> Any:
    """The value of a text that is a number or a boolean, else the text."""
    if "." not in text:
        try:
            return int(text)
        except ValueError:
            pass
    try:
        return float(text)
    except ValueError:
        return _BOOLEANS.get(text, text)


def truth(value: Any) -> bool:
    """Whether a condition holds: ``true``, ``True``, ``false``, ``False`` or an integer; else Python's truth.

    Raises:
        ValueError: the value is a string that is none of these.
    """
    if not isinstance(value, str):
        return bool(value)
    known = _BOOLEANS.get(value)
    return bool(int(value)) if known is None else known
