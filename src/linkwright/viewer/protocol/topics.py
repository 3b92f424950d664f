"""The topic monitor: which topics there are, what they carry, and the last message of those that are opened."""

from __future__ import annotations

from typing import ClassVar

from msgspec import field

from linkwright.viewer.protocol.message import PageMessage, Record, ServerMessage


class TopicRow(Record):
    """A topic of the graph; several `types` are a mistake of its users."""

    name: str
    types: list[str]
    publishers: int
    subscribers: int


class TopicTraffic(Record):
    """What a measured topic carries: hertz and bytes a second. `error` tells why it cannot be measured or shown.

    Both figures are None before there are two messages.
    """

    topic: str
    rate: float | None
    bandwidth: float | None
    error: str | None


class MessageField(Record):
    """A field of a message with its value as text; `omitted` counts elements or fields that are left out."""

    name: str
    kind: str
    value: str
    children: list[MessageField] = field(default_factory=list)
    omitted: int = 0


class TopicList(ServerMessage):
    """All topics, sorted by name."""

    topics: list[TopicRow]


class TopicFigures(ServerMessage):
    """The figures of every topic that the page measures, once a second."""

    traffic: list[TopicTraffic]


class TopicMessage(ServerMessage):
    """The last message of an opened topic, a few times a second at most; `received` is seconds since the epoch."""

    NEWEST_OF: ClassVar[tuple[str, ...]] = ("topic",)

    topic: str
    received: float
    fields: list[MessageField]


class WatchTopics(PageMessage):
    """What the page follows of topics from now on: their list, figures of some, messages of some."""

    listed: bool
    measured: list[str]
    opened: list[str]
