"""Publishes log records on ``/rosout``."""

from __future__ import annotations

from typing import Any, Protocol

from linkwright.graph.log.logger import Logger, LogRecord

_NANOSECONDS_PER_SECOND = 1_000_000_000


LOG_TYPE = "rcl_interfaces/msg/Log"
ROSOUT_TOPIC = "/rosout"


class LogPublisher(Protocol):
    """A publisher of `LOG_TYPE`."""

    @property
    def msg_type(self) -> type[Any]:
        """The message class."""

    def publish(self, msg: Any) -> None:
        """Send a message."""


class Rosout:
    """Publishes the records of a node's logger and its children.

    Args:
        publisher: the node's publisher of ``/rosout``.
        logger: the node's logger.
    """

    def __init__(self, publisher: LogPublisher, logger: Logger) -> None:
        self._publisher = publisher
        self._logger = logger
        self._publishing = False
        logger.rosout = self.publish

    def publish(self, record: LogRecord) -> None:
        """Publish one record. Records that this logs in turn are not published."""
        if self._publishing:
            return
        self._publishing = True
        try:
            self._publisher.publish(self._message(record))
        finally:
            self._publishing = False

    def close(self) -> None:
        """Publish no more; the node destroys the publisher."""
        self._logger.rosout = None

    def _message(self, record: LogRecord) -> Any:
        seconds, nanoseconds = divmod(record.stamp_ns, _NANOSECONDS_PER_SECOND)
        message = self._publisher.msg_type()
        message.stamp.sec = seconds
        message.stamp.nanosec = nanoseconds
        message.level = int(record.level)
        message.name = record.node
        message.msg = record.text
        message.file = record.file
        message.function = record.function
        message.line = record.line
        return message
