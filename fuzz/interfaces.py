"""Interface files and bytes of messages."""

from __future__ import annotations

import contextlib

from fuzz.choices import Choices
from linkwright.diagnostics import LinkwrightError, SourceText, render
from linkwright.messages import MessageDataError, deserialize, get_message, serialize
from linkwright.messages.definitions.idl import parse_idl
from linkwright.messages.definitions.parser import parse_interface

TYPES = (
    "sensor_msgs/msg/JointState",
    "tf2_msgs/msg/TFMessage",
    "std_msgs/msg/String",
    "rcl_interfaces/msg/ParameterEvent",
    "visualization_msgs/msg/MarkerArray",
    "nav_msgs/msg/Odometry",
    "sensor_msgs/msg/PointCloud2",
    "test_msgs/msg/UnboundedSequences",
    "test_msgs/msg/BoundedSequences",
    "test_msgs/msg/Arrays",
    "test_msgs/msg/WStrings",
)
_WORDS = (
    *[
        "int32",
        "string",
        "float64[]",
        "bool[3]",
        "string<=5",
        "Other",
        "std_msgs/Header",
        "byte",
        "x",
        "y1",
        "MAX",
        "=",
        "5",
        "1.5",
        "[1,2]",
        "'c'",
        "true",
        "#",
    ],
    *("---", "[<=2]", "Header", "wstring", '"a b"', "\n", "\n", "\n"),
)


class _Any:
    def has_message(self, type_name: str) -> bool:
        return bool(type_name)

    def find_hint(self, type_name: str) -> str | None:
        return type_name


def check_interface(text: str) -> None:
    """Check that an interface file is read, or its mistakes are reported with their positions."""
    for kind in ("msg", "srv", "action"):
        source = SourceText(f"Fuzz.{kind}", text)
        try:
            parse_interface(source, f"fuzz_msgs/{kind}/Fuzz", _Any())
        except LinkwrightError as error:
            _check_places(error)


def check_idl(text: str) -> None:
    """Check that an IDL file is read, or the first mistake is reported with its position."""
    try:
        parse_idl(SourceText("Fuzz.idl", text), "fuzz_msgs/msg/Fuzz", _Any())
    except LinkwrightError as error:
        _check_places(error)


def check_message(data: bytes) -> None:
    """Check that bytes are a message that can be written again, or are rejected."""
    cls = get_message(TYPES[data[0] % len(TYPES)] if data else TYPES[0])
    with contextlib.suppress(MessageDataError):
        message = deserialize(data[1:], cls)
        again = serialize(message)
        assert serialize(deserialize(again, cls)) == again


def words(choices: Choices) -> str:
    """Return the words of an interface file, in any order."""
    return " ".join(choices.pick(_WORDS) for _ in range(choices.left))


def message_bytes(choices: Choices) -> bytes:
    """Return a message of zeros and small numbers, so that its lengths are often possible."""
    number = choices.number(len(TYPES))
    body = b"".join(
        choices.pick((b"\0", b"\0\0\0", b"\1\0\0\0", b"\2\0\0\0a\0", b"\1", b"\xff")) for _ in range(choices.left)
    )
    return bytes([number]) + b"\0\1\0\0" + body


def _check_places(error: LinkwrightError) -> None:
    for diagnostic in error.diagnostics:
        assert diagnostic.span is not None
        assert diagnostic.code in render(diagnostic)
