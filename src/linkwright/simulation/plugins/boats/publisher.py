"""Messages that a description contains: ``libPublisherPlugin.so``.

Each ``<message>`` is published at the simulated time ``at``, and again every ``every`` seconds.

Source: VRX (parameters, times); ros_gz_bridge (types).
"""

from __future__ import annotations

from dataclasses import dataclass
from math import inf, nan

from linkwright.diagnostics import phrase
from linkwright.graph.stepped.node import Output
from linkwright.messages.message import Message
from linkwright.process.nanoseconds import NANOSECONDS_PER_SECOND
from linkwright.simulation.plugins.gz_messages import find_ros_type, read_message, read_topic
from linkwright.simulation.plugins.parameters import NoParameters
from linkwright.simulation.plugins.plugin import SimulatedPlugin
from linkwright.xmltree import Element


@dataclass(slots=True)
class _Sending:
    """A message that is published.

    Attributes:
        output: the publisher.
        message: the message.
        start: the time of the first publication, in nanoseconds.
        period: the time between publications, in nanoseconds; 0 for a single one.
        next_time: the time of the next publication, in nanoseconds; None after the last one.
    """

    output: Output
    message: Message
    start: int
    period: int
    next_time: int | None


class MessagePublisher(SimulatedPlugin[NoParameters]):
    """The substitute for ``libPublisherPlugin.so``."""

    IGNORED = ("message",)

    def start(self) -> None:
        """Read the messages, and create their topics.

        Raises:
            LinkwrightError: SIM160, a type, a topic, a time or a message is not valid.
        """
        element = self.context.element
        messages = () if element is None else element.elements("message")
        self._sendings = [self._read_sending(child) for child in messages]
        self.every(0.0, self._publish)

    def reset(self) -> None:
        """Publish all messages again."""
        for sending in self._sendings:
            sending.next_time = sending.start

    def _read_sending(self, element: Element) -> _Sending:
        message = read_message(self, element, element.text())
        start, period = self._read_time(element, "at"), self._read_time(element, "every")
        output = self.node.publisher(find_ros_type(self, element), read_topic(self, element))
        return _Sending(output, message, start, period, start)

    def _read_time(self, element: Element, name: str) -> int:
        """Return the time in an attribute in nanoseconds, by default 0."""
        try:
            seconds = float(element.attributes.get(name, "0"))
        except ValueError:
            seconds = nan
        if not 0.0 <= seconds < inf:
            raise self.parameter_error(
                phrase("plugin '{plugin}': '{name}' must be a time in seconds", plugin=self.context.name, name=name),
                element,
            )
        return round(seconds * NANOSECONDS_PER_SECOND)

    def _publish(self) -> None:
        for sending in self._sendings:
            if sending.next_time is not None and self.simulation.time >= sending.next_time:
                sending.output.publish(sending.message)
                sending.next_time = sending.next_time + sending.period if sending.period > 0 else None
