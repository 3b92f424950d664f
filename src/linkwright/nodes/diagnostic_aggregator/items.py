"""Statuses as an aggregator keeps and reports them."""

from __future__ import annotations

from dataclasses import dataclass, field
from enum import IntEnum
from typing import Any

from linkwright.messages import get_message


class Level(IntEnum):
    """The levels of diagnostic_msgs/DiagnosticStatus."""

    OK = 0
    WARN = 1
    ERROR = 2
    STALE = 3

    @property
    def text(self) -> str:
        """The message of a group with this level."""
        return {Level.WARN: "Warning", Level.ERROR: "Error", Level.STALE: "Stale"}.get(self, "OK")


@dataclass(slots=True)
class Status:
    """A status to publish, or the last one that was received with its name.

    Attributes:
        name: the name; of a status to publish, with the path of its analyzer before it.
        level: the level.
        message: the message.
        hardware_id: the ID of the hardware.
        values: the keys and values.
        update_ns: the time when the status was received.
    """

    name: str
    level: Level = Level.OK
    message: str = "OK"
    hardware_id: str = ""
    values: list[tuple[str, str]] = field(default_factory=list)
    update_ns: int = 0

    @classmethod
    def missing(cls, name: str, message: str = "Missing") -> Status:
        """Return the status of an item that was not received."""
        return cls(name, Level.STALE, message)

    @classmethod
    def from_message(cls, message: Any, now_ns: int) -> Status:
        """Return the status of a diagnostic_msgs/msg/DiagnosticStatus. An unknown level is ERROR."""
        number = message.level[0]
        level = Level(number) if number in Level._value2member_map_ else Level.ERROR
        values = [(pair.key, pair.value) for pair in message.values]
        return cls(message.name, level, message.message, message.hardware_id, values, now_ns)

    def below(self, path: str, *, is_stale: bool = False) -> Status:
        """Return the status to publish below a path, with spaces for the slashes in its name."""
        level = Level.STALE if is_stale else self.level
        name = f"{path.removesuffix('/')}/{format_item_name(self.name)}"
        return Status(name, level, self.message, self.hardware_id, list(self.values))

    def to_message(self) -> Any:
        """Return the diagnostic_msgs/msg/DiagnosticStatus."""
        message = get_message("diagnostic_msgs/msg/DiagnosticStatus")(
            name=self.name, message=self.message, hardware_id=self.hardware_id
        )
        message.level = bytes([self.level])
        pair = get_message("diagnostic_msgs/msg/KeyValue")
        message.values = [pair(key=key, value=value) for key, value in self.values]
        return message


def format_item_name(name: str) -> str:
    """Return the name of an item without slashes, which separate groups."""
    return name.replace("/", " ")


def remove_prefix(path: str, prefix: str) -> str:
    """Return a path whose last part lacks a prefix, and the colon and spaces after it."""
    if not prefix:
        return path
    parent, slash, name = path.rpartition("/")
    return parent + slash + name.removeprefix(prefix).removeprefix(":").lstrip(" ")
