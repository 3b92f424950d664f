"""Greetings between computers, on a topic and by UDP multicast, and a table of them."""

from __future__ import annotations

from collections import Counter
from dataclasses import dataclass, field

from linkwright.wire.multicast import DEFAULT_GROUP, DEFAULT_PORT

_GREETING = "hello, it's me "
_SEPARATOR = "-" * 60


def make_greeting(host: str) -> str:
    """Return the greeting of a computer, in the format of ros2doctor."""
    return f"{_GREETING}{host}"


def parse_host(text: str) -> str:
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
        published_count: the number of messages published on the topic.
        sent_count: the number of multicast packets sent.
        topic_counts: the number of messages received on the topic, by the name of the sending computer.
        multicast_counts: the number of multicast packets received, by the name of the sending computer.
    """

    own_host: str
    published_count: int = 0
    sent_count: int = 0
    topic_counts: Counter[str] = field(default_factory=Counter)
    multicast_counts: Counter[str] = field(default_factory=Counter)

    def count_topic_greeting(self, text: str) -> None:
        """Count a greeting received on the topic."""
        self._count(self.topic_counts, text)

    def count_multicast_greeting(self, text: str) -> None:
        """Count a greeting received by multicast."""
        self._count(self.multicast_counts, text)

    def _count(self, counts: Counter[str], text: str) -> None:
        host = parse_host(text)
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
            f"Topic: {topic}, Published Msg Count: {self.published_count}",
            "Subscribed from:",
            *_format_rows(self.topic_counts, period),
            f"Multicast Group/Port: {DEFAULT_GROUP}/{DEFAULT_PORT}, Sent Msg Count: {self.sent_count}",
            "Received from:",
            *_format_rows(self.multicast_counts, period),
            _SEPARATOR,
        ]
        self.published_count = self.sent_count = 0
        self.topic_counts.clear()
        self.multicast_counts.clear()
        return "\n".join(lines)


def _format_rows(counts: Counter[str], period: float) -> list[str]:
    rows = [("Hostname", f"Msg Count /{period}s"), *((host, str(count)) for host, count in counts.items())]
    return [f"{'':<15} {host:<20} {count:<10}" for host, count in rows]
