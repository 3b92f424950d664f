"""The topic monitor, the counterpart of ``rqt_topic``."""

from __future__ import annotations

import time
from collections.abc import Iterable
from dataclasses import dataclass, field
from typing import Any

from linkwright.diagnostics import LinkwrightError
from linkwright.graph import EndpointKind, MessageInfo
from linkwright.graph.introspection.traffic import TrafficWindow
from linkwright.messages import Message, definition_of
from linkwright.messages.definitions.interfaces import Container, Field
from linkwright.page.audience import Page
from linkwright.page.protocol.monitor import (
    MessageField,
    TopicFigures,
    TopicList,
    TopicMessage,
    TopicRow,
    TopicTraffic,
    WatchTopics,
)
from linkwright.panels.monitor.topic_tap import RateLimiter, TopicTap
from linkwright.panels.page_feature import FeatureHost, PageFeature
from linkwright.process.nanoseconds import NANOSECONDS_PER_SECOND
from linkwright.rviz.context import ViewerContext

_MAX_ROWS = 1500
"""The largest number of rows of a message. Further rows are omitted."""
_MAX_ELEMENTS = 64
_MAX_INLINE_ELEMENTS = 8
"""The number of elements that are shown in the row of an array."""
_MAX_TEXT_LENGTH = 400


def make_message_tree(message: Message) -> list[MessageField]:
    """Return the fields of a message, in order."""
    return _TreeBuilder().fields(message)


class _TreeBuilder:
    def __init__(self) -> None:
        self._remaining_rows = _MAX_ROWS

    def fields(self, message: Message) -> list[MessageField]:
        rows = []
        for message_field in definition_of(type(message)).fields:
            if self._remaining_rows <= 0:
                break
            value = getattr(message, message_field.name)
            if message_field.type.container is Container.ONE:
                rows.append(self._make_value_row(message_field.name, message_field, value))
            else:
                rows.append(self._make_array_row(message_field, value))
        return rows

    def _make_value_row(self, name: str, field: Field, value: Any) -> MessageField:
        self._remaining_rows -= 1
        type_text = field.type._replace(container=Container.ONE, size=None).to_idl_text()
        if isinstance(value, Message):
            return MessageField(name, type_text, "", self.fields(value))
        return MessageField(name, type_text, _format_value(value))

    def _make_array_row(self, field: Field, values: Any) -> MessageField:
        self._remaining_rows -= 1
        type_text = field.type.to_idl_text()
        count = len(values)
        if field.type.primitive is None:
            row = MessageField(field.name, type_text, "")
        else:
            element_texts = ", ".join(_format_value(value) for value in values[:_MAX_INLINE_ELEMENTS])
            row = MessageField(
                field.name, type_text, f"[{element_texts}{', ...' if count > _MAX_INLINE_ELEMENTS else ''}]"
            )
        for index in range(min(count, _MAX_ELEMENTS)):
            if self._remaining_rows <= 0:
                break
            row.children.append(self._make_value_row(f"[{index}]", field, values[index]))
        row.omitted = count - len(row.children)
        return row


def _format_value(value: Any) -> str:
    if isinstance(value, bool):
        return str(value).lower()
    if isinstance(value, bytes):
        return f"0x{value.hex()}"
    if isinstance(value, str):
        return value if len(value) <= _MAX_TEXT_LENGTH else f"{value[:_MAX_TEXT_LENGTH]}..."
    return str(value)


_FIGURES_PERIOD_S = 1.0
_MESSAGES_PERIOD_S = 0.2
_MAX_WINDOW_MESSAGES = 2000
_WINDOW_NS = 5_000_000_000
_MIN_MEASURED_NS = 500_000_000
"""The minimum time of measuring before figures are sent, because messages may arrive in bursts."""


@dataclass(slots=True)
class _Request:
    """The topics that a page lists, measures and shows with their messages."""

    wants_list: bool = False
    measured_topics: frozenset[str] = frozenset()
    opened_topics: frozenset[str] = frozenset()
    sent: TopicList | None = None
    due: set[str] = field(default_factory=set)
    """The opened topics with new messages for this page."""


class _Gauge:
    """A gauge of the rate and bandwidth of a topic.

    The last message is stored as bytes, which are decoded only when a page shows it.
    """

    def __init__(self, feature: TopicsFeature, context: ViewerContext, topic: str) -> None:
        self._feature = feature
        self.topic = topic
        self.window = TrafficWindow(_MAX_WINDOW_MESSAGES, _WINDOW_NS)
        self.last: tuple[bytes, float] | None = None
        self.tap = TopicTap(context, topic, self._receive, raw=True, on_change=feature.schedule_figures)

    def message(self) -> TopicMessage | None:
        """Return the last message, or None if there is none or it cannot be decoded."""
        from linkwright.messages import deserialize

        if self.last is None or self.tap.message_class is None:
            return None
        data, receive_time = self.last
        try:
            return TopicMessage(self.topic, receive_time, make_message_tree(deserialize(data, self.tap.message_class)))
        except LinkwrightError:
            self.tap.error = "a message of the topic could not be read"
            return None

    def measure(self) -> TopicTraffic:
        figures = self.window.measure(time.monotonic_ns())
        if figures is None or figures.age_ns < _MIN_MEASURED_NS:
            return TopicTraffic(self.topic, None, None, self.tap.error)
        return TopicTraffic(self.topic, figures.messages_per_second, figures.bytes_per_second, self.tap.error)

    def _receive(self, data: Any, info: MessageInfo) -> None:
        self.window.add(time.monotonic_ns(), len(data))
        self.last = (data, info.received_timestamp / NANOSECONDS_PER_SECOND)
        self._feature.on_message_received(self.topic)


class TopicsFeature(PageFeature):
    """The feature that lists all topics, and measures or shows topics on request.

    The feature subscribes only to topics that a page measures or shows.
    """

    def __init__(self, viewer: FeatureHost) -> None:
        super().__init__(viewer)
        self._requests: dict[Page, _Request] = {}
        self._gauges: dict[str, _Gauge] = {}
        self._figures_sender = RateLimiter(self._send_figures, _FIGURES_PERIOD_S)
        self._messages_sender = RateLimiter(self._send_messages, _MESSAGES_PERIOD_S)

    def receive(self, page: Page, message: WatchTopics) -> None:
        """Replace the topics that a page lists, measures and expands."""
        previous_request = self._requests.get(page, _Request())
        opened_topics = frozenset(message.opened_topics)
        request = _Request(
            message.wants_list,
            frozenset(message.measured_topics),
            opened_topics,
            previous_request.sent if message.wants_list else None,
        )
        request.due = {topic for topic in opened_topics if topic in self._gauges and self._gauges[topic].last}
        self._requests[page] = request
        self._update_subscriptions(page)
        if message.wants_list:
            self._send_topic_lists()

    def remove_page(self, page: Page) -> None:
        """Discard the page's requests, and end the subscriptions that no other page needs."""
        if self._requests.pop(page, None) is not None:
            self._update_subscriptions()

    def close(self) -> None:
        """End all subscriptions."""
        self._requests.clear()
        self._update_subscriptions()

    def on_message_received(self, topic: str) -> None:
        """Schedule sending a topic's new message to the pages that show the topic."""
        for request in self._requests.values():
            if topic in request.opened_topics:
                request.due.add(topic)
                self._messages_sender.request()

    def schedule_figures(self) -> None:
        """Send measurements as soon as the period since the last measurements has passed."""
        self._figures_sender.request()

    def _update_subscriptions(self, page: Page | None = None) -> None:
        """Open the subscriptions that pages need, and close all others.

        `page` is a page with changed requests, or None. The page receives the last messages of its topics soon.
        """
        requests = self._requests.values()
        requested_topics = set[str]().union(*(request.measured_topics | request.opened_topics for request in requests))
        for topic in self._gauges.keys() - requested_topics:
            self._gauges.pop(topic).tap.close()
        for topic in sorted(requested_topics - self._gauges.keys()):
            self._gauges[topic] = _Gauge(self, self.context, topic)
        if any(request.wants_list for request in requests):
            self.context.graph_changes.watch(self._send_topic_lists)
        else:
            self.context.graph_changes.unwatch(self._send_topic_lists)
        if not requested_topics:
            self._figures_sender.cancel()
            self._messages_sender.cancel()
            return
        self._figures_sender.request()
        if page is not None and self._requests[page].due:
            self._messages_sender.request()

    def _send_topic_lists(self) -> None:
        topic_list = TopicList(self._make_topic_rows())
        for page, request in self._requests.items():
            if request.wants_list and request.sent != topic_list:
                request.sent = topic_list
                page.send(topic_list)

    def _make_topic_rows(self) -> list[TopicRow]:
        rows: dict[str, TopicRow] = {}
        for endpoint in self.context.node.graph.endpoints():
            if endpoint.kind not in (EndpointKind.PUBLISHER, EndpointKind.SUBSCRIPTION):
                continue
            row = rows.setdefault(endpoint.name, TopicRow(endpoint.name, [], 0, 0))
            if endpoint.type_name not in row.types:
                row.types.append(endpoint.type_name)
                row.types.sort()
            if endpoint.kind is EndpointKind.PUBLISHER:
                row.publishers += 1
            else:
                row.subscribers += 1
        return [rows[name] for name in sorted(rows)]

    def _send_figures(self) -> None:
        for page, request in self._requests.items():
            gauges = self._find_gauges(request.measured_topics | request.opened_topics)
            if gauges:
                page.send(TopicFigures([gauge.measure() for gauge in gauges]))
        if self._gauges:
            self._figures_sender.request()

    def _send_messages(self) -> None:
        messages: dict[str, TopicMessage | None] = {}
        for page, request in self._requests.items():
            for gauge in self._find_gauges(request.due):
                if gauge.topic not in messages:
                    messages[gauge.topic] = gauge.message()
                message = messages[gauge.topic]
                if message is not None:
                    page.send(message)
            request.due.clear()

    def _find_gauges(self, topics: Iterable[str]) -> list[_Gauge]:
        return [self._gauges[topic] for topic in sorted(topics)]
