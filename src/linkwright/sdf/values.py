"""The types of values in SDF, and helper functions for the rules of its elements.

SDF writes a value as the text of an element: ``<mass>2.5</mass>``. Any whitespace separates numbers. The
syntax of values follows libsdformat's parser (``Param.cc``): it accepts ``inf`` and ``nan`` as numbers, and ``true``,
``false``, ``1`` or ``0`` in upper or lower case as booleans.
"""

from __future__ import annotations

import re
from collections.abc import Callable, Iterable
from math import isfinite, radians
from typing import Any

from linkwright.geometry.single import Pose, Quaternion, Vector3, rpy_from_quaternion
from linkwright.schema import UNREADABLE, AttributeRule, ElementRule, ValueType

_NUMBER_PATTERN = re.compile(
    r"[+-]?(?:(?:[0-9]+\.?[0-9]*|\.[0-9]+)(?:[eE][+-]?[0-9]+)?|inf(?:inity)?|nan)", re.IGNORECASE
)
_NUMBER_PREFIX = r"[+-]?(?:[0-9]+\.?[0-9]*|\.[0-9]+)(?:[eE][+-]?[0-9]+)?"
"""The pattern of a number as C++ reads it from a stream."""
_TRUTH_VALUES = {"true": True, "1": True, "false": False, "0": False}

Color = tuple[float, float, float, float]
"""Red, green, blue, alpha, each from 0 to 1."""


def parse_number(text: str) -> float:
    """Parse one number.

    Raises:
        ValueError: the text is not a number.
    """
    if not _NUMBER_PATTERN.fullmatch(text.strip()):
        raise ValueError(text)
    return float(text)


def parse_numbers(text: str) -> tuple[float, ...]:
    """Parse a list of numbers that are separated by whitespace.

    Raises:
        ValueError: an item is not a number.
    """
    return tuple(map(parse_number, text.split()))


def format_shortest(value: float) -> str:
    """Format a number with as few characters as possible without loss."""
    return repr(float(value) or 0.0).removesuffix(".0")  # ``or 0.0`` changes -0.0 to 0.0


def _format_numbers(values: Iterable[float]) -> str:
    return " ".join(map(format_shortest, values))


def parse_leading_number(text: str) -> float | None:
    """Return the number at the start of a text, or None if there is none.

    libsdformat reads the same number with ``std::stod``.
    """
    number_match = _NUMBER_PATTERN.match(text.strip())
    return None if number_match is None else float(number_match[0])


def parse_leading_numbers(text: str, count: int) -> tuple[float, ...] | None:
    """Return the first `count` numbers of a text, or None if there are fewer.

    libsdformat reads the same numbers with the operator ``>>``.
    """
    numbers_match = re.match(rf"\s*{_NUMBER_PREFIX}(?:\s+{_NUMBER_PREFIX}){{{count - 1}}}", text)
    return None if numbers_match is None else tuple(map(float, numbers_match[0].split()))


def _parse_integer(text: str) -> int:
    if text.strip()[:2].casefold() == "0x":
        return int(text, 16)
    value = parse_number(text)
    if not value.is_integer():
        raise ValueError(text)
    return int(value)


def _parse_truth(text: str) -> bool:
    try:
        return _TRUTH_VALUES[text.strip().casefold()]
    except KeyError:
        raise ValueError(text) from None


def _parse_finite(text: str) -> tuple[float, ...]:
    values = parse_numbers(text)
    if not all(map(isfinite, values)):
        raise ValueError(text)
    return values


def _parse_vector3(text: str) -> Vector3:
    x, y, z = _parse_finite(text)
    return x, y, z


def _parse_vector2(text: str) -> tuple[float, float]:
    x, y = _parse_finite(text)
    return x, y


def _parse_color(text: str) -> Color:
    red, green, blue, alpha = (*parse_numbers(text), 1.0)[:4] if len(text.split()) == 3 else parse_numbers(text)
    return red, green, blue, alpha


def _parse_time(text: str) -> float:
    """Parse seconds and nanoseconds, or only seconds, and return seconds."""
    parts = parse_numbers(text)
    if len(parts) == 1:
        return parts[0]
    seconds, nanoseconds = parts
    return seconds + nanoseconds * 1e-9


def _parse_pose_numbers(text: str) -> tuple[float, ...]:
    pose_values = _parse_finite(text)
    if len(pose_values) not in (6, 7):
        raise ValueError(text)
    return pose_values


TEXT = ValueType("text")
NUMBER = ValueType("number", parse_number, format_shortest)
INTEGER = ValueType("integer", _parse_integer)
TRUTH = ValueType("true or false", _parse_truth, lambda value: "true" if value else "false")
VECTOR2 = ValueType("2 numbers", _parse_vector2, _format_numbers)
VECTOR3 = ValueType("3 numbers", _parse_vector3, _format_numbers)
COLOR = ValueType("3 or 4 numbers from 0 to 1", _parse_color, _format_numbers)
TIME = ValueType("seconds, or seconds and nanoseconds", _parse_time, format_shortest)
POSE = ValueType("6 numbers", _parse_pose_numbers, _format_numbers)

NUMBER_COUNTS = {VECTOR2: 2, VECTOR3: 3, COLOR: 4, POSE: 6}
"""The number of components of a value, by type."""


def choice(*names: str) -> ValueType:
    """Return the type of a value that is one of `names`."""

    def read(text: str) -> str:
        if text.strip() not in names:
            raise ValueError(text)
        return text.strip()

    return ValueType(" | ".join(names), read)


def value(
    tag: str,
    kind: ValueType,
    meaning: str,
    unit: str = "",
    *,
    default: str | None = None,
    field: str = "",
    required: bool = False,
    usually_written: bool = False,
    get: Callable[[Any], Any] | None = None,
) -> ElementRule:
    """Return the rule of an element that contains a value, such as ``<mass>2.5</mass>``."""
    rule = AttributeRule(
        "text",
        kind,
        meaning,
        unit,
        required=required,
        default=default,
        usually_written=usually_written,
        field=field or tag,
        get=get,
    )
    default_value = None if default is None else kind.read(default)
    return ElementRule(tag, meaning, text=rule, required=required, default=(default_value,))


def values(tag: str, kind: ValueType, meaning: str, *, field: str = "") -> ElementRule:
    """Return the rule of an element that contains a value and may be repeated."""
    rule = AttributeRule("text", kind, meaning, field="value", get=_same_value)
    return ElementRule(tag, meaning, text=rule, is_repeated=True, make=_same_value, field=field or f"{tag}s")


def _same_value(value: Any) -> Any:
    return value


def never_written(_: Any) -> None:
    """Return None, so that an older synonym of an element is read but never written."""


def name_of(meaning: str = "the name, unique among elements of this kind in the model or world") -> AttributeRule:
    """Return the rule of the attribute ``name``."""
    return AttributeRule("name", TEXT, meaning, required=True, default="")


def object_rule(
    kind: Callable[..., Any], tag: str, meaning: str, *children: ElementRule, **details: Any
) -> ElementRule:
    """Return the rule of an element from which `kind` creates an object.

    Each child element is a keyword argument of `kind`. An invalid child does not affect the others.
    """
    return ElementRule(tag, meaning, children=children, make=kind, keeps_element=True, **details)


def without_unreadable(kind: Callable[..., Any]) -> Callable[..., Any]:
    """Wrap a factory to remove missing and unreadable items from its tuple arguments."""

    def make(**arguments: Any) -> Any:
        return kind(
            **{
                name: tuple(item for item in argument if item is not None and item is not UNREADABLE)
                if isinstance(argument, tuple)
                else argument
                for name, argument in arguments.items()
            }
        )

    return make


def pose_of(pose_numbers: tuple[float, ...], degrees: bool, rotation_format: str) -> Pose:
    """Return the pose that the numbers of a ``<pose>`` describe.

    Raises:
        ValueError: the number of values does not match the format, or a quaternion is zero.
    """
    if rotation_format == "quat_xyzw":
        x, y, z, *quaternion_values = pose_numbers
        qx, qy, qz, qw = quaternion_values
        length = (qx * qx + qy * qy + qz * qz + qw * qw) ** 0.5
        if length == 0.0:
            raise ValueError(pose_numbers)
        if abs(length - 1.0) < 1e-12:
            length = 1.0  # keeps a written unit quaternion unchanged
        quaternion: Quaternion = (qx / length, qy / length, qz / length, qw / length)
        return Pose((x, y, z), rpy_from_quaternion(quaternion), quaternion)
    x, y, z, roll, pitch, yaw = pose_numbers
    return Pose((x, y, z), (radians(roll), radians(pitch), radians(yaw)) if degrees else (roll, pitch, yaw))
