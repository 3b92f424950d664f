"""The events that services publish about their requests and responses."""

import pytest

from linkwright.graph import InvalidHandleError
from linkwright.graph.endpoints.service import ServiceIntrospectionState
from linkwright.graph.qos.profile import SERVICES_QOS
from linkwright.graph.time.clock import Clock, ROSClock
from linkwright.messages import get_message, get_service

AddTwoInts = get_service("example_interfaces/srv/AddTwoInts")
Info = get_message("service_msgs/msg/ServiceEventInfo")
OFF, METADATA, CONTENTS = ServiceIntrospectionState


def add_two_ints(request, response):
    response.sum = request.a + request.b
    return response


@pytest.fixture
def nodes(graph):
    return graph.create_node("server"), graph.create_node("client")


@pytest.fixture
def service(nodes):
    return nodes[0].create_service(AddTwoInts, "add", add_two_ints)


@pytest.fixture
def client(nodes, service):
    return nodes[1].create_client(AddTwoInts, "add")


@pytest.fixture
def events(graph, service):
    events = []
    graph.create_node("watcher").create_subscription(AddTwoInts.Event, "add/_service_event", events.append, 10)
    return events


def configure_introspection(endpoint, state):
    endpoint.configure_introspection(ROSClock(timebase=endpoint.node.timebase), SERVICES_QOS, state)


async def test_service_events_are_off_by_default(graph, client, events):
    await client.call_async(AddTwoInts.Request(a=1, b=2))
    await graph.settle()
    assert events == []
    assert dict(graph.topics()).get("/add/_service_event") == ["example_interfaces/srv/AddTwoInts_Event"]


async def test_metadata_events_have_no_contents(graph, service, client, events):
    for endpoint in (service, client):
        configure_introspection(endpoint, METADATA)
    await client.call_async(AddTwoInts.Request(a=1, b=2))
    await graph.settle()
    kinds = [event.info.event_type for event in events]
    assert kinds == [Info.REQUEST_SENT, Info.REQUEST_RECEIVED, Info.RESPONSE_SENT, Info.RESPONSE_RECEIVED]
    assert all(event.request == [] and event.response == [] for event in events)


async def test_service_events_have_client_gid_and_sequence_number(graph, service, client, events):
    for endpoint in (service, client):
        configure_introspection(endpoint, METADATA)
    for _ in range(2):
        await client.call_async(AddTwoInts.Request())
    await graph.settle()
    assert [event.info.sequence_number for event in events] == [1] * 4 + [2] * 4
    assert {bytes(event.info.client_gid) for event in events} == {client.gid}


async def test_content_events_contain_request_and_response(graph, service, client, events):
    for endpoint in (service, client):
        configure_introspection(endpoint, CONTENTS)
    await client.call_async(AddTwoInts.Request(a=1, b=2))
    await graph.settle()
    request_sent, request_received, response_sent, response_received = events
    assert [(event.request[0].a, event.request[0].b, event.response) for event in (request_sent, request_received)] == [
        (1, 2, [])
    ] * 2
    assert [(event.request, event.response[0].sum) for event in (response_sent, response_received)] == [([], 3)] * 2


async def test_introspection_can_be_enabled_on_service_only(graph, service, client, events):
    configure_introspection(service, METADATA)
    await client.call_async(AddTwoInts.Request())
    await graph.settle()
    assert [event.info.event_type for event in events] == [Info.REQUEST_RECEIVED, Info.RESPONSE_SENT]


async def test_service_events_use_given_clock(graph, clock, service, client, events):
    clock_of_events = Clock(timebase=graph.timebase)
    service.configure_introspection(clock_of_events, SERVICES_QOS, METADATA)
    await client.call_async(AddTwoInts.Request())
    await graph.settle()
    assert events[0].info.stamp == clock_of_events.now().to_msg()


async def test_introspection_state_can_change_and_be_disabled(graph, service, client, events):
    configure_introspection(service, METADATA)
    configure_introspection(service, CONTENTS)
    await client.call_async(AddTwoInts.Request(a=4, b=0))
    await graph.settle()
    assert events[0].request[0].a == 4
    configure_introspection(service, OFF)
    assert not list(graph.bus.publishers("/add/_service_event"))
    await client.call_async(AddTwoInts.Request())
    await graph.settle()
    assert len(events) == 2


async def test_destroyed_client_removes_event_publisher(graph, service, client):
    configure_introspection(client, METADATA)
    client.destroy()
    assert not list(graph.bus.publishers("/add/_service_event"))
    with pytest.raises(InvalidHandleError):
        configure_introspection(client, METADATA)


async def test_invalid_introspection_state_is_rejected(service):
    with pytest.raises(ValueError, match="7"):
        configure_introspection(service, 7)
