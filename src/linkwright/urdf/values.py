"""Attribute values as urdfdom reads them, and hints for malformed values.

urdfdom reads an attribute with a C++ stream in the classic locale, which must consume the whole text. Therefore,
whitespace may precede a number but not follow it. ``1e3``, ``.5``, ``5.`` and ``+1`` are numbers; ``inf``, ``nan``,
``0x10``, ``0,5`` and the empty string are not. A vector is split only at the space character.
"""

from __future__ import annotations

import re
from collections.abc import Iterable
from functools import lru_cache
from math import isfinite, isinf, radians

from linkwright.diagnostics import Phrase, phrase
from linkwright.diagnostics.lookalikes import to_ascii_text
from linkwright.geometry.single import Quaternion, Vector3
from linkwright.loading.deferred import lazy_pattern
from linkwright.loading.lean_typing import get_args
from linkwright.schema import ValueType, Version
from linkwright.urdf.model import JointType

_DIGITS = r"[+-]?(?:[0-9]+\.?[0-9]*|\.[0-9]+)(?:[eE][+-]?[0-9]+)?"
_NUMBER = re.compile(rf"[ \t\n\v\f\r]*{_DIGITS}").fullmatch
_COMPONENT = rf"[\t\n\v\f\r]*({_DIGITS})"
_VECTOR3 = re.compile(rf" *{_COMPONENT} +{_COMPONENT} +{_COMPONENT} *").fullmatch
# If a text consists only of these characters, Python and urdfdom agree on whether it is a number. For a single, short
# value, the fastest test is to strip these characters.
_NUMBER_CHARACTERS = "-+.0123456789eE "
_DECIMAL_CHARACTERS = re.compile(r"[-+.0-9eE ]*").fullmatch

_NAME = re.compile(r"[A-Za-z_]\w*").fullmatch

_UNIT_HINTS = {
    "deg": (phrase("angles are in radians"), 0.017453292519943295),
    "degrees": (phrase("angles are in radians"), 0.017453292519943295),
    "°": (phrase("angles are in radians"), 0.017453292519943295),
    "rad": (phrase("leave out the unit"), 1.0),
    "m": (phrase("leave out the unit"), 1.0),
    "mm": (phrase("lengths are in meters"), 0.001),
    "cm": (phrase("lengths are in meters"), 0.01),
    "kg": (phrase("leave out the unit"), 1.0),
    "g": (phrase("masses are in kilograms"), 0.001),
}
_WITH_UNIT = lazy_pattern(rf"\s*({_DIGITS})\s*(\D+?)\s*")

# Values such as "0 0 0" and "1" repeat, so a cache saves a third of the reader's time.
_CACHE_SIZE = 4096


def number(text: str) -> float:
    """Return the number in a text.

    Raises:
        ValueError: if the text is not a number, or if the number is too large for a double.
    """
    if (text.strip(_NUMBER_CHARACTERS) or text[-1:] == " ") and not _NUMBER(text):
        raise ValueError(text)
    value = float(text)
    if isinf(value):
        raise ValueError(text)
    return value


@lru_cache(maxsize=_CACHE_SIZE)
def vector3(text: str) -> Vector3:
    """Return the three numbers in a text, separated by spaces.

    Raises:
        ValueError: if the count is not 3, or if one of the words is not a number.
    """
    if _DECIMAL_CHARACTERS(text):
        x, y, z = map(float, text.split())
    else:
        match = _VECTOR3(text)
        if not match:
            raise ValueError(text)
        x, y, z = map(float, match.groups())
    if not isfinite(x + y + z) and (isinf(x) or isinf(y) or isinf(z)):  # a finite sum needs only one test
        raise ValueError(text)
    return x, y, z


def numbers(text: str) -> tuple[float, ...]:
    """Return any count of numbers in a text, separated by spaces.

    Raises:
        ValueError: if one of the words is not a number. The only argument is this word.
    """
    return tuple(number(piece) for piece in text.split(" ") if piece)


def number_hint(text: str) -> Phrase | None:
    """Return a hint for correcting a value that is not a number, or None."""
    stripped = text.strip()
    if not stripped:
        return phrase("give a number")
    if "${" in text or "$(" in text:
        return phrase("xacro did not evaluate this: expand the file with xacro first")
    if _is_number(stripped):
        return phrase("remove the space after it: '{text}'", text=text.rstrip())
    if _is_number(stripped.replace("\u2212", "-")):
        return phrase("write the minus sign as a hyphen: '{stripped}'", stripped=stripped.replace(chr(8722), "-"))
    if stripped.count(",") == 1 and _is_number(stripped.replace(",", ".")):
        return phrase("write a point as decimal separator: '{text}'", text=stripped.replace(",", "."))
    if stripped.lower().lstrip("+-") in ("inf", "infinity", "nan") or re.fullmatch(_DIGITS, stripped):
        return phrase("only finite numbers are read")
    if re.fullmatch("[+-]?0[xX][0-9a-fA-F]+", stripped):
        return phrase("write it as a decimal number: '{number}'", number=int(stripped, 16))
    if "pi" in stripped.lower():
        return phrase("URDF has no 'pi': write 3.14159..., or use xacro, where ${pi} works")
    if len(stripped.split()) > 1 and all(map(_is_number, stripped.split())):
        return phrase("give one number")
    if stripped != to_ascii_text(stripped) and _is_number(to_ascii_text(stripped)):
        return phrase("use ASCII characters: '{text}'", text=to_ascii_text(stripped))
    if stripped in _UNIT_HINTS:
        return _UNIT_HINTS[stripped][0]
    name = stripped.strip("${}\uff5b\uff5d")
    if _NAME(name) and ("_" in name or name != stripped):
        return phrase("if it is the name of a xacro property, write {expression}", expression=f"${{{name}}}")
    match = _WITH_UNIT.fullmatch(text)
    if match and match[2] in _UNIT_HINTS:
        reason, factor = _UNIT_HINTS[match[2]]
        return phrase("{reason}: '{value:.6g}'", reason=reason, value=float(match[1]) * factor)
    return None


def vector_hint(text: str, count: int) -> Phrase | None:
    """Return a hint for correcting a value that is not `count` numbers, or None."""
    if "${" in text or "$(" in text:
        return number_hint(text)
    if not text.strip():
        return phrase("give {count} numbers separated by spaces", count=count)
    pieces = text.split()
    if len(pieces) == count and all(map(_is_number, pieces)):
        return phrase(
            "separate the numbers with spaces, not tabs or line breaks: '{numbers}'", numbers=" ".join(pieces)
        )
    pieces = [piece for piece in re.split(r"[,;\s]+", text.strip()) if piece]
    if len(pieces) == count and all(map(_is_number, pieces)) and re.search("[,;]", text):
        return phrase("separate the numbers with spaces, not commas: '{numbers}'", numbers=" ".join(pieces))
    pieces = text.replace(",", ".").split()
    if "," in text and len(pieces) == count and all(map(_is_number, pieces)):
        return phrase("write a point as decimal separator: '{text}'", text=" ".join(pieces))
    pieces = to_ascii_text(text).split()
    if len(pieces) == count and text != to_ascii_text(text) and all(map(_is_number, pieces)):
        return phrase("use ASCII characters: '{text}'", text=" ".join(pieces))
    pieces = re.split(r"\s*[x\u00d7*]\s*", text.strip())
    if len(pieces) == count and all(map(_is_number, pieces)):
        return phrase("separate the numbers with spaces: '{numbers}'", numbers=" ".join(pieces))
    malformed = next((piece for piece in text.split() if not _is_number(piece)), None)
    if malformed is None:
        return phrase("give {count} numbers, not {count_given}", count=count, count_given=len(text.split()))
    if malformed.startswith("(") and "," in malformed:
        return phrase("a comma in an expression creates a tuple; use a point as the decimal separator")
    hint = number_hint(malformed)
    return (
        phrase("'{value}': {hint}", value=malformed, hint=hint)
        if hint
        else phrase("'{text}' is not a number", text=malformed)
    )


def looks_like_degrees(*angles: float) -> bool:
    """Return whether angles that should be in radians are probably in degrees.

    This is the case if one of the angles is a multiple of 5 with a magnitude between 10 and 720.
    """
    if max(map(abs, angles)) < 10:
        return False
    return any(not -10 < angle < 10 and angle % 5 == 0 and -720 <= angle <= 720 for angle in angles)


def looks_like_degree_limits(lower: float, upper: float) -> bool:
    """Return whether the bounds of a joint are probably in degrees.

    In addition to `looks_like_degrees`, one bound must be a typical joint angle in degrees, because limits of 10, 50 or
    100 rad are common for joints that have no real limits, and for motor angles before a gear.
    """
    return looks_like_degrees(lower, upper) and any(
        30 <= abs(bound) <= 360 and bound % 15 == 0 for bound in (lower, upper)
    )


def degrees_hint(*angles: float) -> Phrase:
    """Return a hint with some angles converted from degrees to radians."""
    return phrase("angles are in radians: '{angles}'", angles=" ".join(f"{radians(angle):.6g}" for angle in angles))


def shortest_text(value: float) -> str:
    """Return a number as the shortest text that the reader converts back without loss."""
    return repr(value).removesuffix(".0")


def _is_number(text: str) -> bool:
    try:
        number(text)
    except ValueError:
        return False
    return True


# --- the types of attributes -----------------------------------------------------------------------------------------

JOINT_TYPES: tuple[str, ...] = get_args(JointType)
JOINT_TYPES_TEXT = ", ".join(JOINT_TYPES)


def _format_number(value: float) -> str | None:
    return None if isinf(value) else shortest_text(value)


def _format_list(values: Iterable[float]) -> str:
    return " ".join(map(shortest_text, values))


def _read_quaternion(text: str) -> Quaternion:
    x, y, z, w = numbers(text)
    return x, y, z, w


def _read_rgba(text: str) -> Quaternion:
    red, green, blue, alpha = values = _read_quaternion(text)
    if min(values) < 0 or max(values) > 1:
        raise ValueError(text)
    return red, green, blue, alpha


def _read_joint_type(text: str) -> str:
    if text not in JOINT_TYPES:
        raise ValueError(text)
    return text


def _parse_version(text: str) -> Version:
    major, minor = map(int, text.split("."))
    return major, minor


TEXT = ValueType("text")
NUMBER = ValueType("number", number, _format_number)
VECTOR3 = ValueType("3 numbers", vector3, _format_list)
QUATERNION = ValueType("4 numbers", _read_quaternion, _format_list)
RGBA = ValueType("4 numbers from 0 to 1", _read_rgba, _format_list)
JOINT_TYPE = ValueType("joint type", _read_joint_type)
VERSION = ValueType("version", _parse_version, lambda version: f"{version[0]}.{version[1]}")

NUMBER_COUNTS = {VECTOR3: 3, QUATERNION: 4, RGBA: 4}
"""The count of numbers in a value, by the type of the value."""
