"""Greetings between computers, over a topic and by UDP multicast, and the table of received ones."""

from __future__ import annotations

from collections import Counter
from dataclasses import dataclass, field

from linkwright.wire.multicast import GROUP, PORT

_GREETING = "hello, it's me "
_RULE = "-" * 60


def greeting(host: str) -> str:
    """Return the greeting of a computer, in the format of ros2doctor."""
    return f"{_GREETING}{host}"


def host_of(text: str) -> str:
    """Return the name of the computer that sent a greeting, or an empty string for an empty greeting.

    The name is the last word of the greeting.
    """
    words = text.split()
    return words[-1] if words else ""


@dataclass
class Greetings:
    """The greetings that were sent and received since the last table was printed.

    Attributes:
        own: the name of this computer, whose own greetings do not count.
        published: the number of messages published on the topic.
        sent: the number of multicast packets sent.
        subscribed: the number of messages received on the topic, by computer.
        received: the number of multicast packets received, by computer.
    """

    own: str
    published: int = 0
    sent: int = 0
    subscribed: Counter[str] = field(default_factory=Counter)
    received: Counter[str] = field(default_factory=Counter)

    def heard_on_topic(self, text: str) -> None:
        """Count a greeting received on the topic."""
        self._count(self.subscribed, text)

    def heard_by_multicast(self, text: str) -> None:
        """Count a greeting received by multicast."""
        self._count(self.received, text)

    def _count(self, heard: Counter[str], text: str) -> None:
        host = host_of(text)
        if host and host != self.own:
            heard[host] += 1

    def take_table(self, topic: str, period: float) -> str:
        """Format the table as ``ros2 doctor hello`` does, and reset the counts.

        Args:
            topic: the name of the topic.
            period: the time covered by one table, in seconds.
        """
        lines = [
            "MULTIMACHINE COMMUNICATION SUMMARY",
            f"Topic: {topic}, Published Msg Count: {self.published}",
            "Subscribed from:",
            *_rows(self.subscribed, period),
            f"Multicast Group/Port: {GROUP}/{PORT}, Sent Msg Count: {self.sent}",
            "Received from:",
            *_rows(self.received, period),
            _RULE,
        ]
        self.published = self.sent = 0
        self.subscribed.clear()
        self.received.clear()
        return "\n".join(lines)


def _rows(heard: Counter[str], period: float) -> list[str]:
    rows = [("Hostname", f"Msg Count /{period}s"), *((host, str(count)) for host, count in heard.items())]
    return [f"{'':<15} {host:<20} {count:<10}" for host, count in rows]
