"""What a plain YAML word is as a parameter: the rules of rcl_yaml_param_parser, which are not those of YAML libraries.

Booleans are those of YAML 1.1 with ``y`` and ``n``; numbers are what C's ``strtol`` (any base) and ``strtod`` read
whole; everything else, also a quoted number, is text.
"""

from __future__ import annotations

import re
from typing import Any

_TRUE = frozenset({"Y", "y", "yes", "Yes", "YES", "true", "True", "TRUE", "on", "On", "ON"})
_FALSE = frozenset({"N", "n", "no", "No", "NO", "false", "False", "FALSE", "off", "Off", "OFF"})
_INTEGER = re.compile(r"\s*[+-]?(0[xX][0-9a-fA-F]+|0[0-7]*|[1-9][0-9]*)")
_FLOAT = re.compile(
    r"\s*[+-]?([0-9]+\.?[0-9]*([eE][+-]?[0-9]+)?|\.[0-9]+([eE][+-]?[0-9]+)?|inf(inity)?|nan)", re.IGNORECASE
)
_HEXADECIMAL_FLOAT = re.compile(r"\s*[+-]?0x[0-9a-f]*\.?[0-9a-f]*(p[+-]?[0-9]+)?", re.IGNORECASE)
_SPECIAL = {
    f"{sign}.{word}": f"{sign}{word}"
    for sign in ("", "+", "-")
    for word in ("inf", "Inf", "INF", "nan", "NaN", "NAN")
    if not (sign and word.lower() == "nan")
}
_MIN, _MAX = -(2**63), 2**63 - 1


def scalar_value(text: str, *, plain: bool) -> Any:
    """The value of a YAML scalar: bool, int, float or str.

    Args:
        text: the scalar.
        plain: whether it stands without quotes.
    """
    if not plain:
        return text
    if text in _TRUE:
        return True
    if text in _FALSE:
        return False
    if _INTEGER.fullmatch(text):
        number = _integer(text.strip())
        if _MIN <= number <= _MAX:
            return number
    if text in _SPECIAL or _FLOAT.fullmatch(text):
        return float(_SPECIAL.get(text, text))
    if _HEXADECIMAL_FLOAT.fullmatch(text) and any(each.isdigit() for each in text):
        return _hexadecimal_float(text)
    return text


def _integer(text: str) -> int:
    digits = text.lstrip("+-")
    base = 16 if digits[:2] in ("0x", "0X") else 8 if digits.startswith("0") and digits != "0" else 10
    return int(text, base)


def _hexadecimal_float(text: str) -> float | str:
    try:
        return float.fromhex(text.strip())
    except (ValueError, OverflowError):
        return text
