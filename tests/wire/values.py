"""Test values for the fields of any message, equal with every rclpy.

They are extreme, empty and random values.
"""

from __future__ import annotations

import hashlib
import importlib
import random
import re
import struct
from typing import Any

DEFAULTS, LOWEST, HIGHEST = range(3)
"""Seeds with a meaning: default values, the lowest or shortest ones, the highest or longest ones."""

_TEXTS = ("", "a", "Grüße", "漢字かな", "🤖 robot", 'with "quotes"\n\tand \\ more')
_INTEGERS = re.compile(r"(u?)int(\d+)$")
_ARRAY = re.compile(r"(.+)\[(\d+)\]$")
_SEQUENCE = re.compile(r"sequence<(.+?)(?:, (\d+))?>$")
_TEXT = re.compile(r"w?string(?:<(\d+)>)?$")
_FLOATS = {"float": ("<f", 3.0e38), "double": ("<d", 1.0e308)}


def message_from_seed(message_type: Any, seed: int) -> Any:
    """Return a message whose values follow from its type and a seed."""
    message = message_type()
    if seed != DEFAULTS:
        draw = random.Random(f"{message_type.__name__} {seed}")
        for name, kind in message_type.get_fields_and_field_types().items():
            setattr(message, name, _value(kind, seed, draw))
    return message


def to_json_value(value: Any) -> Any:
    """Return the JSON form of a message or of a part of one; it is equal for equal messages."""
    if hasattr(value, "get_fields_and_field_types"):
        return [[name, to_json_value(getattr(value, name))] for name in value.get_fields_and_field_types()]
    if isinstance(value, bytes):
        return value.hex()
    if isinstance(value, str):
        return value
    if hasattr(value, "tolist"):  # array.array and numpy arrays
        return to_json_value(value.tolist())
    if isinstance(value, (list, tuple)):
        return [to_json_value(element) for element in value]
    return float(value).hex() if isinstance(value, float) else int(value)


def load_interface(name: str) -> Any:
    """Return the class of an interface.

    Its name is ``package/msg/Name``, ``package/srv/Name`` or ``package/action/Name``.
    """
    package, folder, type_name = name.split("/")
    return getattr(importlib.import_module(f"{package}.{folder}"), type_name)


def make_bytes(number: int, size: int) -> bytes:
    """Return bytes in which every block of 32 is the hash of a number."""
    block = hashlib.sha256(str(number).encode()).digest()
    return (block * (size // len(block) + 1))[:size]


def sha256_of(data: Any) -> str:
    """Return the SHA-256 of some data."""
    return hashlib.sha256(bytes(data)).hexdigest()


def _value(kind: str, seed: int, draw: random.Random) -> Any:
    if array := _ARRAY.match(kind):
        return [_value(array[1], seed, draw) for _ in range(int(array[2]))]
    if sequence := _SEQUENCE.match(kind):
        highest = int(sequence[2] or 3)
        count = {LOWEST: 0, HIGHEST: highest}.get(seed, draw.randint(0, min(highest, 5)))
        return [_value(sequence[1], seed, draw) for _ in range(count)]
    if text := _TEXT.match(kind):
        return _text(int(text[1] or 1000), seed, draw)
    if kind == "boolean":
        return {LOWEST: False, HIGHEST: True}.get(seed, draw.random() < 0.5)
    if kind == "octet":
        return bytes([{LOWEST: 0, HIGHEST: 255}.get(seed, draw.randrange(256))])
    if kind in _FLOATS:
        return _float(kind, seed, draw)
    if integer := _INTEGERS.match("uint8" if kind == "char" else kind):
        bits = int(integer[2])
        lowest, highest = (0, 2**bits - 1) if integer[1] else (-(2 ** (bits - 1)), 2 ** (bits - 1) - 1)
        return {LOWEST: lowest, HIGHEST: highest}.get(seed, draw.randint(lowest, highest))
    package, type_name = kind.split("/")
    nested = load_interface(f"{package}/msg/{type_name}")()
    for name, field_kind in type(nested).get_fields_and_field_types().items():
        setattr(nested, name, _value(field_kind, seed, draw))
    return nested


def _text(max_bytes: int, seed: int, draw: random.Random) -> str:
    if seed == LOWEST:
        return ""
    if seed == HIGHEST:
        return "x" * max_bytes
    text = draw.choice(_TEXTS)
    return text if len(text.encode()) <= max_bytes else "y" * draw.randint(0, max_bytes)


def _float(kind: str, seed: int, draw: random.Random) -> float:
    form, largest = _FLOATS[kind]
    value = {LOWEST: -largest, HIGHEST: float("inf")}.get(seed, draw.uniform(-1e6, 1e6))
    return float(struct.unpack(form, struct.pack(form, value))[0])
