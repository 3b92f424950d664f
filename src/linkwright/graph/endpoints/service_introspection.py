"""Service introspection: the requests and responses of a service, published on a topic beside it (REP 2012)."""

from __future__ import annotations

from enum import IntEnum
from typing import Any, NamedTuple

from linkwright.graph.endpoints.base import ServiceEndpoint
from linkwright.graph.endpoints.publisher import Publisher
from linkwright.graph.qos.compatibility import best_available
from linkwright.graph.qos.profile import QoSProfile
from linkwright.graph.time.clock import Clock
from linkwright.messages import get_message

EVENT_TOPIC_SUFFIX = "/_service_event"
"""The suffix that makes the name of a service the name of its event topic."""


class ServiceIntrospectionState(IntEnum):
    """Which part of a request is published; numbers and names are rclpy's."""

    OFF = 0
    METADATA = 1
    CONTENTS = 2


class EventType(IntEnum):
    """The kinds of service events (``service_msgs/msg/ServiceEventInfo``)."""

    REQUEST_SENT = 0
    REQUEST_RECEIVED = 1
    RESPONSE_SENT = 2
    RESPONSE_RECEIVED = 3


class RequestId(NamedTuple):
    """Which request of which client.

    Attributes:
        client_gid: the GID of the client, 16 bytes.
        number: counted by the client, from 1.
    """

    client_gid: bytes
    number: int


NO_REQUEST_ID = RequestId(bytes(16), 0)


class ServiceEvents:
    """Publishes the events of the requests of one client or service.

    Args:
        endpoint: the client or service; the publisher becomes its node's.
        clock: stamps the events.
        qos_profile: how they are published.
        contents: whether requests and responses are published too.
    """

    def __init__(self, endpoint: ServiceEndpoint, clock: Clock, qos_profile: QoSProfile, *, contents: bool) -> None:
        self.clock = clock
        self.contents = contents
        self._event_class: Any = endpoint.interface.Event
        self._info_class: Any = get_message("service_msgs/msg/ServiceEventInfo")
        node = endpoint.node
        name = node.resolve_topic_name(endpoint.name + EVENT_TOPIC_SUFFIX)
        qos = best_available(QoSProfile.of(qos_profile), (), publisher=True)
        self._publisher: Publisher[Any] = node.add(Publisher(node, self._event_class, name, qos))

    def publish_event(
        self, event_type: EventType, request_id: RequestId, *, request: Any = None, response: Any = None
    ) -> None:
        """Publish an event, with its request or response."""
        info = self._info_class(
            event_type=int(event_type),
            stamp=self.clock.now().to_msg(),
            client_gid=list(request_id.client_gid),
            sequence_number=request_id.number,
        )
        event = self._event_class(info=info)
        if self.contents:
            event.request = [] if request is None else [request]
            event.response = [] if response is None else [response]
        self._publisher.publish(event)

    def close(self) -> None:
        """Destroy the publisher."""
        self._publisher.destroy()


class IntrospectedEndpoint(ServiceEndpoint):
    """A client or service whose requests can be introspected.

    Attributes:
        service_events: publishes them; None while that is off, which is the default.
    """

    service_events: ServiceEvents | None = None

    def configure_introspection(
        self, clock: Clock, service_event_qos_profile: QoSProfile, introspection_state: ServiceIntrospectionState
    ) -> None:
        """Publish the events of requests on ``SERVICE/_service_event``, or stop that.

        Args:
            clock: stamps the events.
            service_event_qos_profile: the QoS of the publisher; one that exists already keeps its own.
            introspection_state: whether they are published, and whether with the requests and responses.

        Raises:
            InvalidHandleError: the client or service was destroyed.
        """
        self.check_alive()
        state = ServiceIntrospectionState(introspection_state)
        events = self.service_events
        if state is ServiceIntrospectionState.OFF:
            self.end_introspection()
        elif events is None:
            contents = state is ServiceIntrospectionState.CONTENTS
            self.service_events = ServiceEvents(self, clock, service_event_qos_profile, contents=contents)
        else:
            events.clock = clock
            events.contents = state is ServiceIntrospectionState.CONTENTS

    def end_introspection(self) -> None:
        """Publish events no longer."""
        events, self.service_events = self.service_events, None
        if events is not None:
            events.close()
