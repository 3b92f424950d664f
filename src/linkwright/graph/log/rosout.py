"""What nodes log, on the topic ``/rosout``."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from linkwright.graph.log.logger import Logger, LogRecord
from linkwright.graph.qos import ROSOUT_QOS, QoSProfile

if TYPE_CHECKING:
    from linkwright.graph.node import Node
    from linkwright.graph.publisher import Publisher

_NANOSECONDS_PER_SECOND = 1_000_000_000


class Rosout:
    """Publishes the records of a node's logger and its children as rcl_interfaces/msg/Log.

    Args:
        node: the node.
        logger: its logger.
        qos: what is offered.
    """

    def __init__(self, node: Node, logger: Logger, qos: QoSProfile = ROSOUT_QOS) -> None:
        self._publisher: Publisher[Any] = node.create_publisher("rcl_interfaces/msg/Log", "/rosout", qos)
        self._logger = logger
        self._publishing = False
        logger.rosout = self.publish

    def publish(self, record: LogRecord) -> None:
        """Publish one record. What publishing it logs in turn is not published."""
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
