"""The Publisher panel, the counterpart of ``rqt_publisher``."""

from __future__ import annotations

import asyncio
from typing import Any

from linkwright.diagnostics import LinkwrightError
from linkwright.graph import Node
from linkwright.messages import get_message
from linkwright.messages.presentation import interface_names, prototype
from linkwright.page.audience import Page
from linkwright.page.protocol.calls import (
    MessageTemplate,
    MessageTypes,
    PagePublisher,
    PublisherState,
    PublisherStates,
    PublishOnce,
    RequestTemplate,
    RequestTypes,
    SetPublishers,
)
from linkwright.panels.monitor.message_texts import MessageTextError, fill_message
from linkwright.panels.page_feature import FeatureHost, PageFeature

_STATES_PERIOD_S = 1.0
_MAX_RATE_HZ = 1000.0


class PublishersFeature(PageFeature):
    """The feature that publishes the messages of pages."""

    def __init__(self, viewer: FeatureHost) -> None:
        super().__init__(viewer)
        self._publishers: dict[Page, dict[int, _Publisher]] = {}
        self._timer: asyncio.TimerHandle | None = None

    def receive(self, page: Page, message: RequestTypes | RequestTemplate | SetPublishers | PublishOnce) -> None:
        """Handle a request."""
        if isinstance(message, RequestTypes):
            page.send(MessageTypes(sorted(interface_names("msg"))))
        elif isinstance(message, RequestTemplate):
            page.send(_make_template(message.name))
        elif isinstance(message, PublishOnce):
            publisher = self._publishers.get(page, {}).get(message.id)
            if publisher is not None:
                publisher.publish()
                self._send_states()
        else:
            self._set_publishers(page, message.publishers)

    def remove_page(self, page: Page) -> None:
        """Close the publishers of the page."""
        for publisher in self._publishers.pop(page, {}).values():
            publisher.close()

    def close(self) -> None:
        """Close all publishers."""
        for page in tuple(self._publishers):
            self.remove_page(page)
        if self._timer is not None:
            self._timer.cancel()

    def _set_publishers(self, page: Page, requested: list[PagePublisher]) -> None:
        publishers = self._publishers.setdefault(page, {})
        for number in publishers.keys() - {request.id for request in requested}:
            publishers.pop(number).close()
        for request in requested:
            if request.id not in publishers:
                publishers[request.id] = _Publisher(self.context.node)
            publishers[request.id].apply(request)
        self._send_states()

    def _send_states(self) -> None:
        if self._timer is not None:
            self._timer.cancel()
        self._timer = None
        for page, publishers in self._publishers.items():
            page.send(PublisherStates([publisher.make_state(number) for number, publisher in publishers.items()]))
        if any(self._publishers.values()):
            self._timer = asyncio.get_running_loop().call_later(_STATES_PERIOD_S, self._send_states)


class _Publisher:
    """A publisher of a page."""

    def __init__(self, node: Node) -> None:
        self._node = node
        self._request: PagePublisher | None = None
        self._publisher: Any = None
        self._message: Any = None
        self._stamps: list[Any] = []
        self._timer: asyncio.TimerHandle | None = None
        self._count = 0
        self._error: str | None = None

    def apply(self, request: PagePublisher) -> None:
        """Adopt the topic, type, rate and text of a request."""
        last = self._request
        if request == last:
            return
        self._request = request
        if last is None or (request.topic, request.kind) != (last.topic, last.kind):
            self._destroy()
        self._error = None
        try:
            message_class = get_message(request.kind)
            self._message = message_class()
            self._stamps = fill_message(self._message, request.text)
            if self._publisher is None and request.topic:
                self._publisher = self._node.create_publisher(message_class, request.topic, 10)
        except MessageTextError as error:
            self._error = str(error)
        except LinkwrightError as error:
            self._error = error.diagnostics[0].message
        self._schedule()

    def publish(self) -> None:
        """Publish the message once, unless there is an error."""
        if self._publisher is None or self._error is not None:
            return
        for set_stamp in self._stamps:
            set_stamp(self._node.get_clock().now().to_msg())
        self._publisher.publish(self._message)
        self._count += 1

    def make_state(self, number: int) -> PublisherState:
        """Return the state for pages."""
        subscribers = 0 if self._publisher is None else self._publisher.get_subscription_count()
        return PublisherState(number, self._count, subscribers, self._error)

    def close(self) -> None:
        """Stop publishing."""
        self._cancel()
        self._destroy()

    def _schedule(self) -> None:
        self._cancel()
        request = self._request
        if request is not None and request.is_on and self._error is None and 0 < request.rate <= _MAX_RATE_HZ:
            loop = asyncio.get_running_loop()
            self._publish_at(loop, loop.time(), 1.0 / request.rate)

    def _publish_at(self, loop: asyncio.AbstractEventLoop, due: float, period_s: float) -> None:
        """Publish now, and again at equal intervals after `due`."""
        self.publish()
        due = max(due + period_s, loop.time())
        self._timer = loop.call_at(due, self._publish_at, loop, due, period_s)

    def _cancel(self) -> None:
        if self._timer is not None:
            self._timer.cancel()
            self._timer = None

    def _destroy(self) -> None:
        if self._publisher is not None:
            self._node.destroy_publisher(self._publisher)
            self._publisher = None
            self._count = 0


def _make_template(kind: str) -> MessageTemplate:
    try:
        return MessageTemplate(kind, prototype(get_message(kind)), None)
    except LinkwrightError as error:
        return MessageTemplate(kind, "", error.diagnostics[0].message)
