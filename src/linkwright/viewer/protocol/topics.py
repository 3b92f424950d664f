"""The topic monitor: which topics there are, what they carry, and the last message of those that are opened."""

from __future__ import annotations

from dataclasses import field
from typing import ClassVar, Literal

from linkwright.viewer.protocol.record import record


@record
class TopicRow:
    """A topic of the graph; several `types` are a mistake of its users."""

    name: str
    types: list[str]
    publishers: int
    subscribers: int


@record
class TopicTraffic:
    """What a measured topic carries: hertz and bytes a second. `error` tells why it cannot be measured or shown.

    Both figures are None before there are two messages.
    """

    topic: str
    rate: float | None
    bandwidth: float | None
    error: str | None


@record
class MessageField:
    """A field of a message with its value as text; `omitted` counts elements or fields that are left out."""

    name: str
    kind: str
    value: str
    children: list[MessageField] = field(default_factory=list)
    omitted: int = 0


@record
class TopicList:
    """All topics, sorted by name."""

    topics: list[TopicRow]
    type: Literal["topic_list"] = "topic_list"


@record
class TopicFigures:
    """The figures of every topic that the page measures, once a second."""

    traffic: list[TopicTraffic]
    type: Literal["topic_figures"] = "topic_figures"


@record
class TopicMessage:
    """The last message of an opened topic, a few times a second at most; `received` is seconds since the epoch."""

    NEWEST_OF: ClassVar[tuple[str, ...]] = ("topic",)

    topic: str
    received: float
    fields: list[MessageField]
    type: Literal["topic_message"] = "topic_message"


@record
class WatchTopics:
    """What the page wants to know of topics from now on: their list, figures of some, messages of some."""

    listed: bool
    measured: list[str]
    opened: list[str]
    type: Literal["watch_topics"] = "watch_topics"
