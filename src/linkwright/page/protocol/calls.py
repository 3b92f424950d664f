"""The panels Services and Publisher: calls of services, and messages that the user publishes.

Requests and messages are texts in YAML, as for ``ros2 service call`` and ``ros2 topic pub``.
"""

from __future__ import annotations

from linkwright.page.protocol.message import PageMessage, Record, ServerMessage
from linkwright.page.protocol.monitor import MessageField


class ServiceRow(Record):
    """A service with its type."""

    name: str
    kind: str


class ServiceList(ServerMessage):
    """All services, sorted by name."""

    services: list[ServiceRow]


class ServiceRequest(ServerMessage):
    """A request with default values as YAML. Response to `ChooseService`.

    `error` is the reason why the type is not known, or None.
    """

    service: str
    kind: str
    text: str
    error: str | None


class ServiceResponse(ServerMessage):
    """The response to `CallService` with the seconds that it took.

    `error` is the reason why there is no response, or None.
    """

    service: str
    fields: list[MessageField]
    seconds: float
    error: str | None


class WatchServices(PageMessage):
    """Whether the page receives the list of services from now on."""

    watched: bool


class ChooseService(PageMessage):
    """A request for the YAML text of a service's request."""

    service: str


class CallService(PageMessage):
    """A call of a service with the fields of the request as YAML."""

    service: str
    text: str


class MessageTypes(ServerMessage):
    """The names of all message types."""

    types: list[str]


class MessageTemplate(ServerMessage):
    """A message with default values as YAML. Response to `RequestTemplate`."""

    kind: str
    text: str
    error: str | None


class PagePublisher(Record):
    """A publisher of a page, with an ID chosen by the page.

    `rate` is in Hz. The messages are published while `is_on` is true.
    """

    id: int
    topic: str
    kind: str
    rate: float
    text: str
    is_on: bool


class PublisherState(Record):
    """The number of messages that a publisher has published, and the subscribers of its topic.

    `error` is the reason why it cannot publish, or None.
    """

    id: int
    count: int
    subscribers: int
    error: str | None


class PublisherStates(ServerMessage):
    """The states of a page's publishers, sent once per second and after each change."""

    states: list[PublisherState]


class RequestTypes(PageMessage):
    """A request for the names of all message types."""


class RequestTemplate(PageMessage):
    """A request for a message of a type with default values."""

    name: str


class SetPublishers(PageMessage):
    """All publishers of the page from now on."""

    publishers: list[PagePublisher]


class PublishOnce(PageMessage):
    """A request to publish the message of a publisher once."""

    id: int
