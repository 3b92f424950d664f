"""Values for the fields of any message, the same ones with every rclpy: extremes, empty ones, and drawn by a seed."""

from __future__ import annotations

import hashlib
import importlib
import random
import re
import struct
from typing import Any

DEFAULTS, LEAST, MOST = range(3)
"""Seeds with a meaning: as constructed, the least of everything, the most."""

_TEXTS = ("", "a", "Grüße", "漢字かな", "🤖 robot", 'with "quotes"\n\tand \\ more')
_INTEGERS = re.compile(r"(u?)int(\d+)$")
_ARRAY = re.compile(r"(.+)\[(\d+)\]$")
_SEQUENCE = re.compile(r"sequence<(.+?)(?:, (\d+))?>$")
_TEXT = re.compile(r"w?string(?:<(\d+)>)?$")
_FLOATS = {"float": ("<f", 3.0e38), "double": ("<d", 1.0e308)}


def message_from_seed(message_type: Any, seed: int) -> Any:
    """A message whose values follow from its type and a seed."""
    message = message_type()
    if seed != DEFAULTS:
        draw = random.Random(f"{message_type.__name__} {seed}")
        for name, kind in message_type.get_fields_and_field_types().items():
            setattr(message, name, _value(kind, seed, draw))
    return message


def plain(value: Any) -> Any:
    """A message or a part of one, as JSON writes it; equal for equal messages."""
    if hasattr(value, "get_fields_and_field_types"):
        return [[name, plain(getattr(value, name))] for name in value.get_fields_and_field_types()]
    if isinstance(value, bytes):
        return value.hex()
    if isinstance(value, str):
        return value
    if hasattr(value, "tolist"):  # array.array and numpy arrays
        return plain(value.tolist())
    if isinstance(value, (list, tuple)):
        return [plain(element) for element in value]
    return float(value).hex() if isinstance(value, float) else int(value)


def interface(name: str) -> Any:
    """The class of ``package/msg/Name``, ``package/srv/Name`` or ``package/action/Name``."""
    package, kind, own = name.split("/")
    return getattr(importlib.import_module(f"{package}.{kind}"), own)


def large(number: int, size: int) -> bytes:
    """Bytes that differ everywhere."""
    block = hashlib.sha256(str(number).encode()).digest()
    return (block * (size // len(block) + 1))[:size]


def digest(data: Any) -> str:
    """Whether bytes are those that were meant."""
    return hashlib.sha256(bytes(data)).hexdigest()


def _value(kind: str, seed: int, draw: random.Random) -> Any:
    if array := _ARRAY.match(kind):
        return [_value(array[1], seed, draw) for _ in range(int(array[2]))]
    if sequence := _SEQUENCE.match(kind):
        most = int(sequence[2] or 3)
        count = {LEAST: 0, MOST: most}.get(seed, draw.randint(0, min(most, 5)))
        return [_value(sequence[1], seed, draw) for _ in range(count)]
    if text := _TEXT.match(kind):
        return _text(int(text[1] or 1000), seed, draw)
    if kind == "boolean":
        return {LEAST: False, MOST: True}.get(seed, draw.random() < 0.5)
    if kind == "octet":
        return bytes([{LEAST: 0, MOST: 255}.get(seed, draw.randrange(256))])
    if kind in _FLOATS:
        return _float(kind, seed, draw)
    if integer := _INTEGERS.match("uint8" if kind == "char" else kind):
        bits = int(integer[2])
        least, most = (0, 2**bits - 1) if integer[1] else (-(2 ** (bits - 1)), 2 ** (bits - 1) - 1)
        return {LEAST: least, MOST: most}.get(seed, draw.randint(least, most))
    package, own = kind.split("/")
    nested = interface(f"{package}/msg/{own}")()
    for name, of in type(nested).get_fields_and_field_types().items():
        setattr(nested, name, _value(of, seed, draw))
    return nested


def _text(most: int, seed: int, draw: random.Random) -> str:
    if seed == LEAST:
        return ""
    if seed == MOST:
        return "x" * most
    text = draw.choice(_TEXTS)
    return text if len(text.encode()) <= most else "y" * draw.randint(0, most)


def _float(kind: str, seed: int, draw: random.Random) -> float:
    form, largest = _FLOATS[kind]
    value = {LEAST: -largest, MOST: float("inf")}.get(seed, draw.uniform(-1e6, 1e6))
    return float(struct.unpack(form, struct.pack(form, value))[0])
