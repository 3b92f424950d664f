"""The types of attribute values in URDF."""

from __future__ import annotations

from collections.abc import Iterable
from math import isinf
from typing import get_args

from linkwright.geometry.single import Quaternion
from linkwright.schema import ValueType, Version
from linkwright.urdf.model import JointType
from linkwright.urdf.values import number, numbers, plain, vector3

JOINT_TYPES: tuple[str, ...] = get_args(JointType)
JOINT_TYPES_TEXT = ", ".join(JOINT_TYPES)


def _number_text(value: float) -> str | None:
    return None if isinf(value) else plain(value)


def _list_text(values: Iterable[float]) -> str:
    return " ".join(map(plain, values))


def _four(text: str) -> Quaternion:
    x, y, z, w = numbers(text)
    return x, y, z, w


def _rgba(text: str) -> Quaternion:
    red, green, blue, alpha = found = _four(text)
    if min(found) < 0 or max(found) > 1:
        raise ValueError(text)
    return red, green, blue, alpha


def _joint_type(text: str) -> str:
    if text not in JOINT_TYPES:
        raise ValueError(text)
    return text


def _version(text: str) -> Version:
    major, minor = map(int, text.split("."))
    return major, minor


TEXT = ValueType("text")
NUMBER = ValueType("number", number, _number_text)
VECTOR3 = ValueType("3 numbers", vector3, _list_text)
QUATERNION = ValueType("4 numbers", _four, _list_text)
RGBA = ValueType("4 numbers from 0 to 1", _rgba, _list_text)
JOINT_TYPE = ValueType("joint type", _joint_type)
VERSION = ValueType("version", _version, lambda version: f"{version[0]}.{version[1]}")

COUNTS = {VECTOR3: 3, QUATERNION: 4, RGBA: 4}
"""How many numbers a value of a type has."""
