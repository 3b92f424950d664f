"""Sample messages of ``test_msgs``, for tests of code that handles any message type."""

from __future__ import annotations

import re
from functools import partial
from typing import Any

from linkwright.messages import Message, get_message

_SEQUENCE = re.compile(r"sequence<(?P<item>[^,]+)(?:, (?P<bound>\d+))?>")
_ARRAY = re.compile(r"(?P<item>.+)\[(?P<length>\d+)\]")
_INTEGER = re.compile(r"(?P<sign>u?)int(?P<bits>\d+)")
_FLOAT_VALUES = {"float": (0.0, 1.125, -2.125), "double": (0.0, 1.125, -1.5e300)}
_TEXT_VALUES = ("", "Hello world!", "¡Hola, 世界! ñ")
_SEQUENCE_LENGTHS = (0, 2, 3)
_SAMPLE_COUNT = 3


def create_samples(name: str) -> list[Message]:
    """Return three sample messages of a type in ``test_msgs``: default, small and extreme.

    For a type without fields, return only the default message.

    Args:
        name: the name of the type, such as ``BasicTypes``.
    """
    cls = get_message(f"test_msgs/msg/{name}")
    has_fields = bool(cls.get_fields_and_field_types())
    return (
        [cls(), *(_create_filled_message(cls, sample_index) for sample_index in range(1, _SAMPLE_COUNT))]
        if has_fields
        else [cls()]
    )


def _create_filled_message(cls: type[Message], sample_index: int) -> Message:
    message = cls()
    for field, type_name in cls.get_fields_and_field_types().items():
        setattr(message, field, _create_value(type_name, sample_index))
    return message


def _create_value(type_name: str, sample_index: int) -> Any:
    if array := _ARRAY.fullmatch(type_name):
        return [
            _create_value(array["item"], (sample_index + index) % _SAMPLE_COUNT)
            for index in range(int(array["length"]))
        ]
    if sequence := _SEQUENCE.fullmatch(type_name):
        return [
            _create_value(sequence["item"], index % _SAMPLE_COUNT) for index in range(_SEQUENCE_LENGTHS[sample_index])
        ]
    if integer := _INTEGER.fullmatch(type_name):
        bits = int(integer["bits"])
        return (0, 23, 2**bits - 1 if integer["sign"] else -(2 ** (bits - 1)))[sample_index]
    if type_name in _FLOAT_VALUES:
        return _FLOAT_VALUES[type_name][sample_index]
    if type_name.startswith(("string", "wstring")):
        return _TEXT_VALUES[sample_index]
    if type_name == "boolean":
        return sample_index == 1
    if type_name == "octet":
        return bytes([(0, 23, 255)[sample_index]])
    package, _, name = type_name.partition("/")
    return _create_filled_message(get_message(f"{package}/msg/{name}"), sample_index)


def get_test_msg(message_name: str) -> list[Message]:
    """Return the sample messages of a type.

    Raises:
        ValueError: there is no such type.
    """
    if message_name not in _SAMPLED_TYPES:
        raise ValueError(f"test_msgs has no samples of '{message_name}'; it has samples of {', '.join(_SAMPLED_TYPES)}")
    return create_samples(message_name)


_SAMPLED_TYPES = (
    "Arrays",
    "BasicTypes",
    "BoundedSequences",
    "Builtins",
    "Constants",
    "Defaults",
    "Empty",
    "MultiNested",
    "Nested",
    "Strings",
    "UnboundedSequences",
    "WStrings",
)


get_msg_arrays = partial(create_samples, "Arrays")
get_msg_basic_types = partial(create_samples, "BasicTypes")
get_msg_bounded_sequences = partial(create_samples, "BoundedSequences")
get_msg_builtins = partial(create_samples, "Builtins")
get_msg_constants = partial(create_samples, "Constants")
get_msg_defaults = partial(create_samples, "Defaults")
get_msg_empty = partial(create_samples, "Empty")
get_msg_multi_nested = partial(create_samples, "MultiNested")
get_msg_nested = partial(create_samples, "Nested")
get_msg_strings = partial(create_samples, "Strings")
get_msg_unbounded_sequences = partial(create_samples, "UnboundedSequences")
get_msg_wstrings = partial(create_samples, "WStrings")
