"""The status that tasks fill (API of ``diagnostic_updater``)."""

from __future__ import annotations

from typing import Any

from linkwright.messages import get_message

DiagnosticArray = get_message("diagnostic_msgs/msg/DiagnosticArray")
DiagnosticStatus = get_message("diagnostic_msgs/msg/DiagnosticStatus")
KeyValue = get_message("diagnostic_msgs/msg/KeyValue")


class DiagnosticStatusWrapper(DiagnosticStatus):  # type: ignore[misc, valid-type]  # made from a definition
    """A diagnostic_msgs/msg/DiagnosticStatus with methods that fill it.

    Args:
        args: none; the constructor of a message takes keyword arguments only.
        kwds: the values of fields.
    """

    def __init__(self, *args: Any, **kwds: Any) -> None:
        super().__init__(*args, **kwds)

    def summary(self, *args: Any) -> None:
        """Set the level and the message.

        Args:
            args: a status whose level and message are copied, or a level (bytes) and a message.
        """
        self.level, message = _split_summary(args)
        self.message = str(message)

    def clearSummary(self) -> None:
        """Set the level to OK and the message to an empty text."""
        self.summary(DiagnosticStatus.OK, "")

    def mergeSummary(self, *args: Any) -> None:
        """Merge a level and a message into this status.

        The level becomes the higher one. If both levels are OK, or neither is, the messages are joined with a
        semicolon. Otherwise the message of the level that is not OK is taken.

        Args:
            args: a status, or a level (bytes) and a message.
        """
        level, message = _split_summary(args)
        if (level > DiagnosticStatus.OK) == (self.level > DiagnosticStatus.OK):
            self.message = f"{self.message}; {message}" if self.message else message
        elif level > self.level:
            self.message = message
        self.level = max(level, self.level)

    def add(self, key: str, val: str) -> None:
        """Append a key and its value, a text."""
        self.values.append(KeyValue(key=key, value=val))


def _split_summary(args: tuple[Any, ...]) -> tuple[Any, Any]:
    """Return a level and a message, of a status or as two arguments.

    Raises:
        TypeError: there is another number of arguments.
    """
    if len(args) == 1:
        return args[0].level, args[0].message
    if len(args) == 2:
        return args[0], args[1]
    raise TypeError(f"a summary is a status, or a level and a message, but there are {len(args)} arguments")
