"""The graph's requests to a transport, and the handling of its results."""

from threading import Thread

import pytest

from linkwright.graph import (
    ActionClient,
    DurabilityPolicy,
    EndpointInfo,
    EndpointKind,
    MessageInfo,
    NodeIdentity,
    QoSProfile,
)
from linkwright.messages import String, get_service, serialize

Trigger = get_service("std_srvs/srv/Trigger")
LATCHED = QoSProfile(depth=3, durability=DurabilityPolicy.TRANSIENT_LOCAL)
REMOTE_NODE = NodeIdentity("elsewhere", "/far")
OWN_TOPICS = ("/parameter_events", "/rosout")


class FakeTransport:
    def __init__(self):
        self.open = []
        self.nodes, self.endpoints = [], []
        self.closed = False
        self.looked = 0
        self.tell = None
        self.lose = None

    def _known(self, endpoint):
        return endpoint.name not in OWN_TOPICS and "parameter" not in endpoint.name

    def open_node(self, node):
        self.open.append(node.name)

    def close_node(self, node):
        self.open.remove(node.name)

    def _open(self, endpoint):
        if self._known(endpoint):
            self.open.append((endpoint.kind, endpoint.name))

    def _close(self, endpoint):
        if self._known(endpoint):
            self.open.remove((endpoint.kind, endpoint.name))

    open_publisher = open_subscription = open_service = open_client = _open
    close_publisher = close_subscription = close_service = close_client = _close

    def start_discovery(self):
        self.looked += 1

    def remote_nodes(self):
        return self.nodes

    def remote_endpoints(self):
        return self.endpoints

    def watch(self, changed):
        self.tell = changed

    def watch_lost(self, lost):
        assert self.lose is None, "the graph watches for lost publishers only once"
        self.lose = lost

    def close(self):
        self.closed = True


@pytest.fixture
def transport():
    return FakeTransport()


async def test_transport_mirrors_nodes_and_endpoints(graph, transport):
    node = graph.create_node("early")
    node.create_publisher(String, "topic", 1)
    graph.attach(transport)
    assert transport.open == ["early", (EndpointKind.PUBLISHER, "/topic")]
    late_node = graph.create_node("late")
    late_node.create_subscription(String, "topic", print, 1)
    late_node.create_service(Trigger, "trigger", print)
    client = late_node.create_client(Trigger, "trigger")
    assert transport.open[2:] == [
        "late",
        (EndpointKind.SUBSCRIPTION, "/topic"),
        (EndpointKind.SERVICE, "/trigger"),
        (EndpointKind.CLIENT, "/trigger"),
    ]
    client.destroy()
    node.destroy_node()
    assert transport.open == ["late", (EndpointKind.SUBSCRIPTION, "/topic"), (EndpointKind.SERVICE, "/trigger")]
    await graph.close()
    assert transport.open == []
    assert transport.closed


@pytest.mark.parametrize("is_early", [True, False])
async def test_internal_node_is_not_mirrored_but_heard_in_process(graph, transport, is_early):
    if not is_early:
        graph.attach(transport)
    node = graph.create_node("inside", stays_inside=True)
    publisher = node.create_publisher(String, "topic", 1)
    if is_early:
        graph.attach(transport)
    messages = []
    listener = graph.create_node("listener")
    listener.create_subscription(String, "topic", messages.append, 1)
    assert transport.open == ["listener", (EndpointKind.SUBSCRIPTION, "/topic")]
    publisher.publish(String(data="here"))
    await graph.settle()
    assert [message.data for message in messages] == ["here"]
    publisher.destroy()
    node.destroy_node()
    assert transport.open == ["listener", (EndpointKind.SUBSCRIPTION, "/topic")]


async def test_graph_accepts_only_one_transport(graph, transport):
    graph.attach(transport)
    with pytest.raises(RuntimeError, match="has a transport already"):
        graph.attach(FakeTransport())
    graph.detach()
    assert transport.closed
    graph.attach(FakeTransport())


async def test_publisher_sends_to_transport_while_remote_endpoint_matches(graph):
    publisher = graph.create_node("node").create_publisher(String, "topic", 1)
    sent = []
    publisher.publish(String(data="before"))
    publisher.set_remote_sender(sent.append)
    publisher.set_remote_count(2)
    assert publisher.get_subscription_count() == 2
    publisher.publish(String(data="out"))
    data = serialize(String(data="raw"))
    publisher.publish(data)
    publisher.set_remote_sender(None)
    publisher.publish(String(data="after"))
    assert sent == [String(data="out"), data]


async def test_latched_messages_are_sent_first_and_once(graph):
    publisher = graph.create_node("node").create_publisher(String, "topic", LATCHED)
    for text in "abcd":
        publisher.publish(String(data=text))
    sent = []
    publisher.set_remote_sender(sent.append)
    publisher.set_remote_sender(sent.append)
    publisher.publish(String(data="e"))
    assert [message.data for message in sent] == list("bcde")


async def test_early_messages_are_held_until_writer_exists(graph):
    from linkwright.graph import Duration

    publisher = graph.create_node("node").create_publisher(String, "topic", 2)
    waited = []
    publisher.hold_for_remote(lambda seconds: waited.append(seconds) or len(waited) > 1)
    for text in "abc":
        publisher.publish(String(data=text))
    assert not publisher.wait_for_all_acked(Duration(seconds=1))
    assert publisher.wait_for_all_acked()
    assert waited == [1.0, None]
    sent = []
    publisher.set_remote_sender(sent.append)
    publisher.publish(String(data="d"))
    assert [message.data for message in sent] == list("bcd")
    assert publisher.wait_for_all_acked()
    assert len(waited) == 2


async def test_messages_published_while_the_held_ones_are_sent_follow_them(graph):
    publisher = graph.create_node("node").create_publisher(String, "topic", 10)
    publisher.hold_for_remote(lambda _: True)
    for text in "ab":
        publisher.publish(String(data=text))
    sent, threads = [], []

    def send(message):
        sent.append(message.data)
        if message.data == "a":
            publisher.publish(String(data="c"))
            threads.append(Thread(target=publisher.publish, args=(String(data="d"),)))
            threads[0].start()

    publisher.set_remote_sender(send)
    threads[0].join()
    assert sent == list("abcd")


async def test_messages_are_not_held_without_remote_subscription(graph):
    publisher = graph.create_node("node").create_publisher(String, "topic", 2)
    publisher.hold_for_remote(lambda _: True)
    publisher.publish(String(data="a"))
    publisher.set_remote_sender(None)
    sent = []
    publisher.set_remote_sender(sent.append)
    assert sent == []


async def test_wait_for_all_acked_asks_transport(graph):
    from linkwright.graph import Duration

    publisher = graph.create_node("node").create_publisher(String, "topic", LATCHED)
    assert publisher.wait_for_all_acked()
    timeouts = []
    publisher.set_remote_sender(print, lambda seconds: timeouts.append(seconds) or False)
    assert not publisher.wait_for_all_acked(Duration(seconds=2))
    assert not publisher.wait_for_all_acked(Duration(seconds=-1))
    assert timeouts == [2.0, None]


async def test_incoming_bytes_are_deserialized_on_delivery(graph, log):
    node = graph.create_node("node")
    messages, raw, received = [], [], []
    readers = [
        node.create_subscription(String, "topic", messages.append, 10),
        node.create_subscription(String, "topic", raw.append, 10, raw=True),
        node.create_subscription(String, "topic", lambda message, info: received.append((message, info)), 10),
    ]
    data = serialize(String(data="hello"))
    info = MessageInfo(1, 2, b"g" * 16, is_remote=True)
    for reader in readers:
        reader.receive(data, info)
    await graph.settle()
    assert messages == [String(data="hello")]
    assert raw == [data]
    assert received == [(String(data="hello"), info)]
    assert (info["source_timestamp"], dict(info)["received_timestamp"]) == (1, 2)
    assert "source_timestamp" in info
    assert info.get("sender") is None
    assert len(info) == len(list(info))
    with pytest.raises(KeyError):
        info["sender"]


async def test_malformed_bytes_are_dropped_and_reported_once(graph, log):
    node = graph.create_node("node")
    received = []
    reader = node.create_subscription(String, "topic", received.append, 10)
    for _ in range(3):
        reader.receive(b"\x00\x01\x00\x00\xff\xff\xff\x7f", MessageInfo(0, 0, is_remote=True))
    reader.receive(serialize(String(data="good")), MessageInfo(0, 0))
    await graph.settle()
    assert received == [String(data="good")]
    assert reader.malformed_count == 3
    (record,) = log
    assert record.text.startswith("Dropped a malformed message of topic '/topic'")


async def test_raw_subscriptions_and_publications_work_in_process(graph):
    node = graph.create_node("node")
    messages, raw = [], []
    node.create_subscription(String, "topic", messages.append, 10)
    node.create_subscription(String, "topic", raw.append, 10, raw=True)
    publisher = node.create_publisher(String, "topic", 10)
    publisher.publish(String(data="object"))
    publisher.publish(serialize(String(data="bytes")))
    await graph.settle()
    assert [message.data for message in messages] == ["object", "bytes"]
    assert raw == [serialize(String(data="object")), serialize(String(data="bytes"))]


async def test_message_info_is_passed_to_callbacks_that_accept_it(graph, clock):
    node = graph.create_node("node")
    messages = []
    node.create_subscription(String, "topic", lambda _message, info: messages.append(info), 10)
    publisher = node.create_publisher(String, "topic", 10)
    publisher.publish(String())
    await graph.settle()
    assert messages[0].publisher_gid == publisher.gid
    assert messages[0].source_timestamp == clock.now_ns()
    assert not messages[0].is_remote


async def test_requests_use_transport_without_local_server(graph):
    node = graph.create_node("node")
    client = node.create_client(Trigger, "trigger")
    early_future = client.call_async(Trigger.Request())
    responses, forgotten = [], []

    class RemoteServer:
        def send(self, request, response, number):
            responses.append(response)
            return lambda: forgotten.append(request)

    assert not client.service_is_ready()
    client.set_remote_service(RemoteServer())
    assert client.service_is_ready()
    late_future = client.call_async(Trigger.Request())
    assert len(responses) == 2
    for number, response in enumerate(responses):
        response(Trigger.Response(message=str(number)))
        response(Trigger.Response(message="again"))
    assert ((await early_future).message, (await late_future).message) == ("0", "1")
    given_up = client.call_async(Trigger.Request())
    client.remove_pending_request(given_up)
    assert len(forgotten) == 1
    node.create_service(Trigger, "trigger", lambda _request, _response: Trigger.Response(message="here"))
    assert (await client.call_async(Trigger.Request())).message == "here"
    assert len(responses) == 3


async def test_incoming_requests_are_answered(graph):
    node = graph.create_node("node")
    service = node.create_service(Trigger, "trigger", lambda _request, _response: Trigger.Response(message="yes"))
    responses = []
    service.receive(Trigger.Request(), responses.append)
    await graph.settle()
    assert [response.message for response in responses] == ["yes"]


async def test_graph_queries_include_local_and_remote_endpoints(graph, transport):
    node = graph.create_node("here")
    node.create_publisher(String, "topic", LATCHED)
    node.create_service(Trigger, "trigger", print)
    graph.attach(transport)
    transport.nodes.append(REMOTE_NODE)
    transport.endpoints.extend(
        EndpointInfo(kind, REMOTE_NODE, name, kind_name, QoSProfile(5), bytes(range(16)), "RIHS01_x")
        for kind, name, kind_name in (
            (EndpointKind.PUBLISHER, "/topic", "std_msgs/msg/Bool"),
            (EndpointKind.SUBSCRIPTION, "/topic", "std_msgs/msg/String"),
            (EndpointKind.CLIENT, "/trigger", "std_srvs/srv/Trigger"),
            (EndpointKind.PUBLISHER, "/count/_action/feedback", "example_interfaces/action/Fibonacci_FeedbackMessage"),
        )
    )
    assert node.get_node_names() == ["here", "elsewhere"]
    assert node.get_node_names_and_namespaces_with_enclaves() == [("here", "/", "/"), ("elsewhere", "/far", "/")]
    topics = dict(node.get_topic_names_and_types())
    assert topics["/topic"] == ["std_msgs/msg/Bool", "std_msgs/msg/String"]
    assert dict(node.get_topic_names_and_types(no_demangle=True))["rt/topic"] == [
        "std_msgs::msg::dds_::Bool_",
        "std_msgs::msg::dds_::String_",
    ]
    assert ("/trigger", ["std_srvs/srv/Trigger"]) in node.get_service_names_and_types()
    assert node.get_client_names_and_types_by_node("elsewhere", "/far") == [("/trigger", ["std_srvs/srv/Trigger"])]
    assert node.get_subscriber_names_and_types_by_node("elsewhere", "/far") == [("/topic", ["std_msgs/msg/String"])]
    assert ("/topic", ["std_msgs/msg/String"]) in node.get_publisher_names_and_types_by_node("here", "/")
    assert graph.get_action_server_names_and_types_by_node("elsewhere", "/far") == [
        ("/count", ["example_interfaces/action/Fibonacci"])
    ]
    assert (node.count_publishers("topic"), node.count_subscribers("topic")) == (2, 1)
    assert (node.count_services("trigger"), node.count_clients("trigger")) == (1, 1)
    local_info, remote_info = node.get_publishers_info_by_topic("topic")
    assert (local_info.node_name, local_info.topic_type, local_info.qos_profile.depth) == (
        "here",
        "std_msgs/msg/String",
        3,
    )
    assert (remote_info.node_namespace, remote_info.endpoint_gid, remote_info.topic_type_hash) == (
        "/far",
        list(range(16)),
        "RIHS01_x",
    )
    assert remote_info.endpoint_type.name == "PUBLISHER"
    with pytest.raises(RuntimeError, match="'nobody' in namespace '/'"):
        node.get_publisher_names_and_types_by_node("nobody", "/")


async def test_graph_query_triggers_transport_discovery(graph, transport):
    graph.create_node("ours").create_publisher(String, "chatter", 10)
    graph.attach(transport)
    assert not transport.looked
    graph.count_publishers("/chatter")
    assert transport.looked == 1


async def test_wait_for_node_finds_remote_node(graph, transport):
    import asyncio

    graph.attach(transport)
    loop = asyncio.get_running_loop()
    waiting = loop.run_in_executor(None, graph.wait_for_node, "far/elsewhere", 60.0)
    await asyncio.sleep(0.01)
    transport.nodes.append(REMOTE_NODE)
    transport.tell()
    assert await waiting
    assert not graph.wait_for_node("/far/nobody", 0.01)
    assert not graph.wait_until(lambda: graph.count_publishers("/topic") == 1, timeout_sec=0.01)
    graph.create_node("node").create_publisher(String, "topic", 1)
    assert graph.wait_until(lambda: graph.count_publishers("/topic") == 1, timeout_sec=0.01)


async def test_graph_watchers_are_notified_of_changes(graph):
    messages = []
    graph.watch(lambda: messages.append(len(graph.endpoints())))
    node = graph.create_node("node", start_parameter_services=False, enable_rosout=False)
    before = len(messages)
    node.create_publisher(String, "topic", 1)
    assert len(messages) == before + 1
    assert messages[-1] > messages[before - 1]


async def test_graph_watchers_are_notified_when_the_last_part_of_an_action_server_matches(graph):
    """Discovery reports the endpoints of a server before each of them matches."""
    client = ActionClient(graph.create_node("node"), "example_interfaces/action/Fibonacci", "count")
    was_ready = []
    graph.watch(lambda: was_ready.append(client.server_is_ready()))
    for part in (client._goal_client, client._cancel_client, client._result_client):
        part.set_remote_service(object())  # No request is sent to it.
    client._status.set_remote_count(1)
    assert not any(was_ready)
    client._feedback_subscription.set_remote_count(1)
    assert was_ready[-1]
    count = len(was_ready)
    client._feedback_subscription.set_remote_count(2)
    assert len(was_ready) == count
    client._feedback_subscription.set_remote_count(0)
    assert not was_ready[-1]
