"""Greetings between computers, on a topic and by UDP multicast, and a table of them."""

from __future__ import annotations

from collections import Counter
from dataclasses import dataclass, field

from linkwright.wire.multicast import DEFAULT_GROUP, DEFAULT_PORT

_GREETING = "hello, it's me "
_SEPARATOR = "-" * 60


def greeting(host: str) -> str:
    """Return the greeting of a computer, in the format of ros2doctor."""
    return f"{_GREETING}{host}"


def host_of(text: str) -> str:
    """Return the name of the computer that sent a greeting.

    The name is the last word of the greeting, or an empty string if the greeting is empty.
    """
    words = text.split()
    return words[-1] if words else ""


@dataclass
class Greetings:
    """Counts of the greetings that were sent and received since the last table.

    Attributes:
        own_host: the name of this computer; its own greetings are not counted.
        published: the number of messages published on the topic.
        sent: the number of multicast packets sent.
        subscribed: the number of messages received on the topic, by the name of the sending computer.
        received: the number of multicast packets received, by the name of the sending computer.
    """

    own_host: str
    published: int = 0
    sent: int = 0
    subscribed: Counter[str] = field(default_factory=Counter)
    received: Counter[str] = field(default_factory=Counter)

    def count_topic_greeting(self, text: str) -> None:
        """Count a greeting received on the topic."""
        self._count(self.subscribed, text)

    def count_multicast_greeting(self, text: str) -> None:
        """Count a greeting received by multicast."""
        self._count(self.received, text)

    def _count(self, counts: Counter[str], text: str) -> None:
        host = host_of(text)
        if host and host != self.own_host:
            counts[host] += 1

    def pop_table(self, topic: str, period: float) -> str:
        """Return the table in the format of ``ros2 doctor hello``, and reset the counts.

        Args:
            topic: the name of the topic.
            period: the time that the table covers, in seconds.
        """
        lines = [
            "MULTIMACHINE COMMUNICATION SUMMARY",
            f"Topic: {topic}, Published Msg Count: {self.published}",
            "Subscribed from:",
            *_format_rows(self.subscribed, period),
            f"Multicast Group/Port: {DEFAULT_GROUP}/{DEFAULT_PORT}, Sent Msg Count: {self.sent}",
            "Received from:",
            *_format_rows(self.received, period),
            _SEPARATOR,
        ]
        self.published = self.sent = 0
        self.subscribed.clear()
        self.received.clear()
        return "\n".join(lines)


def _format_rows(counts: Counter[str], period: float) -> list[str]:
    rows = [("Hostname", f"Msg Count /{period}s"), *((host, str(count)) for host, count in counts.items())]
    return [f"{'':<15} {host:<20} {count:<10}" for host, count in rows]
