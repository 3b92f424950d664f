"""The bridge: topics, services and actions that nodes of two networks exchange through it."""

from __future__ import annotations

import threading
from types import SimpleNamespace

import pytest

from linkwright.bridge.bridged_network import BridgedNetwork
from linkwright.bridge.mirrors import MirroredPublisher
from linkwright.bridge.outlet import Outlet
from linkwright.bridge.streams import get_stream
from linkwright.graph import Graph
from linkwright.graph.actions.client import ActionClient
from linkwright.graph.actions.server import ActionServer
from linkwright.graph.endpoints.base import EndpointInfo, EndpointKind
from linkwright.graph.endpoints.publisher import Publisher
from linkwright.graph.endpoints.service import Client, Service
from linkwright.graph.names.rules import NodeIdentity
from linkwright.graph.qos.profile import DurabilityPolicy, HistoryPolicy, QoSProfile, ReliabilityPolicy
from linkwright.graph.time.values import Duration
from linkwright.messages import String, get_interface, type_hash
from linkwright.wire.zenoh import attachment, qos_text
from linkwright.wire.zenoh.session import build_config, open_session
from linkwright.wire.zenoh.settings import read_settings
from linkwright.wire.zenoh.tokens import Token
from tests.bridge.conftest import spin_all
from tests.waiting import TIMEOUT_S, wait_until

TRANSIENT_LOCAL = QoSProfile(3, durability=DurabilityPolicy.TRANSIENT_LOCAL)
KEEP_ALL = QoSProfile(history=HistoryPolicy.KEEP_ALL)
WAYS = [("dds", "zenoh"), ("zenoh", "dds")]
AddTwoInts = get_interface("example_interfaces/srv/AddTwoInts")
CALL_COUNT = 50
Fibonacci = get_interface("example_interfaces/action/Fibonacci")


def listen(process, topic, qos):
    received = []
    process.node.create_subscription(String, topic, lambda message: received.append(message.data), qos)
    return received


@pytest.mark.parametrize(("source", "target"), WAYS)
def test_topic_messages_are_bridged_once_and_in_order(networks, source, target):
    networks.bridge()
    remote, local = networks.make(source)("remote"), networks.make(target)("local")
    received_here = listen(local, "chatter", KEEP_ALL)
    received_there = listen(remote, "chatter", KEEP_ALL)
    publisher = remote.node.create_publisher(String, "chatter", KEEP_ALL)
    spin_all(lambda: publisher.get_subscription_count() >= 2 and local.node.count_publishers("chatter"), remote, local)
    words = [str(number) for number in range(500)]
    for word in words:
        publisher.publish(String(data=word))
    spin_all(lambda: len(received_here) >= len(words), local, remote)
    # A message that the bridge sent back would arrive before the message of this publisher.
    back = local.node.create_publisher(String, "chatter", KEEP_ALL)
    spin_all(lambda: back.get_subscription_count() >= 2, local, remote)
    back.publish(String(data="end"))
    spin_all(lambda: "end" in received_there and "end" in received_here, remote, local)
    assert received_here == [*words, "end"]
    assert received_there == [*words, "end"]


@pytest.mark.parametrize(("source", "target"), WAYS)
def test_bridged_node_is_listed_with_its_publishers_until_it_closes(networks, source, target):
    networks.bridge()
    remote, local = networks.make(source)("remote"), networks.make(target)("local")
    qos = QoSProfile(7, reliability=ReliabilityPolicy.BEST_EFFORT)
    remote.node.create_publisher(String, "/far/chatter", qos)

    def reported():
        return local.node.get_publishers_info_by_topic("/far/chatter")

    # DDS announces an endpoint before its node.
    spin_all(lambda: [endpoint.node_name for endpoint in reported()] == ["remote"], local)
    (reported_endpoint,) = reported()
    assert reported_endpoint.topic_type == "std_msgs/msg/String"
    assert reported_endpoint.qos_profile.reliability is ReliabilityPolicy.BEST_EFFORT
    assert reported_endpoint.qos_profile.depth == 7
    assert "remote" in local.node.get_node_names()
    remote.close()
    spin_all(lambda: "remote" not in local.node.get_node_names(), local)
    assert local.node.count_publishers("/far/chatter") == 0


@pytest.mark.parametrize(("source", "target"), WAYS)
def test_bridged_node_is_listed_with_its_subscriptions_and_clients(networks, source, target):
    networks.bridge()
    remote, local = networks.make(source)("remote"), networks.make(target)("local")
    qos = QoSProfile(7, reliability=ReliabilityPolicy.BEST_EFFORT, deadline=Duration(seconds=2))
    subscription = remote.node.create_subscription(String, "/far/chatter", print, qos)
    remote.node.create_client(AddTwoInts, "/far/add")

    def reported():
        endpoints = local.node.get_subscriptions_info_by_topic("/far/chatter")
        return [endpoint for endpoint in endpoints if endpoint.node_name == "remote"]

    def called():
        return dict(local.node.get_client_names_and_types_by_node("remote", "/"))

    spin_all(lambda: reported() and "/far/add" in called(), local, remote)
    (reported_endpoint,) = reported()
    assert (reported_endpoint.topic_type, reported_endpoint.topic_type_hash) == (
        "std_msgs/msg/String",
        type_hash(String),
    )
    assert reported_endpoint.qos_profile.reliability is ReliabilityPolicy.BEST_EFFORT
    assert reported_endpoint.qos_profile.deadline == Duration(seconds=2)
    assert called()["/far/add"] == ["example_interfaces/srv/AddTwoInts"]
    assert not subscription.get_publisher_count()
    subscription.destroy()
    spin_all(lambda: not reported(), local, remote)
    remote.close()
    spin_all(lambda: "remote" not in local.node.get_node_names(), local)


@pytest.mark.parametrize(("source", "target"), WAYS)
@pytest.mark.parametrize("reliability", [ReliabilityPolicy.RELIABLE, ReliabilityPolicy.BEST_EFFORT])
def test_first_messages_of_new_publisher_reach_existing_subscription(networks, source, target, reliability):
    networks.bridge()
    local = networks.make(target)("local")
    received = listen(local, "chatter", QoSProfile(10, reliability=reliability))
    remote = networks.make(source)("remote")
    spin_all(lambda: remote.node.count_subscribers("chatter"), remote, local)
    for number in range(10):
        publisher = remote.node.create_publisher(String, "chatter", QoSProfile(10, reliability=reliability))
        spin_all(lambda publisher=publisher: publisher.get_subscription_count(), remote)
        publisher.publish(String(data=str(number)))
        spin_all(lambda number=number: len(received) > number, local)
        publisher.destroy()
        spin_all(lambda: not local.node.count_publishers("chatter"), local, remote)
    assert received == [str(number) for number in range(10)]


@pytest.mark.parametrize(("source", "target"), WAYS)
def test_late_subscription_receives_latched_messages_once(networks, source, target):
    remote = networks.make(source)("remote")
    publisher = remote.node.create_publisher(String, "described", TRANSIENT_LOCAL)
    for word in ("one", "two", "three", "four"):
        publisher.publish(String(data=word))
    networks.bridge()
    for name in ("first", "second"):
        local = networks.make(target)(name)
        received = listen(local, "described", TRANSIENT_LOCAL)
        spin_all(lambda received=received: len(received) >= 3, local)
        assert received == ["two", "three", "four"]
    publisher.publish(String(data="five"))
    spin_all(lambda: len(received) == 4, local)
    assert received[3:] == ["five"]


@pytest.mark.parametrize(("source", "target"), WAYS)
def test_first_message_of_second_publisher_on_bridged_topic_is_not_lost(networks, source, target):
    networks.bridge()
    first, local = networks.make(source)("first"), networks.make(target)("local")
    received = listen(local, "chatter", KEEP_ALL)
    publisher = first.node.create_publisher(String, "chatter", KEEP_ALL)
    spin_all(publisher.get_subscription_count, first)
    late_process = networks.make(source)("late")
    publisher = late_process.node.create_publisher(String, "chatter", KEEP_ALL)
    spin_all(publisher.get_subscription_count, late_process)
    publisher.publish(String(data="at once"))
    spin_all(lambda: received, local)
    assert received == ["at once"]


@pytest.mark.parametrize(("source", "target"), WAYS)
def test_last_message_of_closed_publisher_is_delivered(networks, monkeypatch, source, target):
    """Messages are published once the bridge is connected.

    A busy machine needs over a second to acknowledge all.
    """
    monkeypatch.setattr("linkwright.wire.dds.engine.CLOSING_TIMEOUT_S", TIMEOUT_S)
    networks.bridge()
    remote, local = networks.make(source)("remote"), networks.make(target)("local")
    received = listen(local, "chatter", KEEP_ALL)
    publisher = remote.node.create_publisher(String, "chatter", KEEP_ALL)
    spin_all(publisher.get_subscription_count, remote, local)
    publisher.publish(String(data="first"))
    spin_all(lambda: received, local, remote)
    for number in range(5000):
        publisher.publish(String(data=str(number)))
    remote.close()
    spin_all(lambda: len(received) > 5000, local)
    assert received == ["first", *map(str, range(5000))]
    spin_all(lambda: "remote" not in local.node.get_node_names(), local)


@pytest.mark.parametrize(("server", "client"), WAYS)
def test_service_responses_reach_the_client_that_sent_the_request(networks, server, client):
    networks.bridge()
    remote = networks.make(server)("remote")

    def add(request, response):
        response.sum = request.a + request.b
        return response

    remote.node.create_service(AddTwoInts, "add", add)
    asking = [networks.make(client)(name) for name in ("first", "second", "third")]
    clients = [process.node.create_client(AddTwoInts, "add") for process in asking]
    spin_all(lambda: all(client.service_is_ready() for client in clients), *asking, remote)
    answers = [[] for _ in clients]
    waiting = [None for _ in clients]

    def all_answered() -> bool:
        for index, client in enumerate(clients):
            if waiting[index] is not None and waiting[index].done():
                answers[index].append(waiting[index].result().sum)
                waiting[index] = None
            if waiting[index] is None and len(answers[index]) < CALL_COUNT:
                waiting[index] = client.call_async(AddTwoInts.Request(a=1000 * index, b=len(answers[index])))
        return all(len(answer) == CALL_COUNT for answer in answers)

    spin_all(all_answered, remote, *asking)
    assert answers == [[1000 * index + number for number in range(CALL_COUNT)] for index in range(3)]
    remote.close()
    spin_all(lambda: not any(client.service_is_ready() for client in clients), *asking)


@pytest.mark.parametrize(("server", "client"), WAYS)
def test_action_goals_and_feedback_are_bridged(networks, server, client):
    networks.bridge()
    remote, local = networks.make(server)("remote"), networks.make(client)("local")

    def execute(goal):
        for number in range(3):
            goal.publish_feedback(Fibonacci.Feedback(sequence=[number]))
        goal.succeed()
        return Fibonacci.Result(sequence=[1, 1, 2])

    ActionServer(remote.node, Fibonacci, "count", execute)
    asking = ActionClient(local.node, Fibonacci, "count")
    spin_all(asking.server_is_ready, local, remote)
    spin_all(lambda: remote.node.count_subscribers("/count/_action/feedback"), remote)
    messages = []

    def act():
        """Execute a goal; feedback that is published before the bridge has a mirror for it is lost."""
        feedback = []
        messages.append(feedback)
        sent = asking.send_goal_async(
            Fibonacci.Goal(order=3), feedback_callback=lambda message: feedback.append(list(message.feedback.sequence))
        )
        spin_all(sent.done, local, remote)
        assert sent.result().accepted
        result = sent.result().get_result_async()
        spin_all(result.done, local, remote)
        assert list(result.result().result.sequence) == [1, 1, 2]

    for _ in range(100):
        act()
        if [[0], [1], [2]] in messages:
            break
    else:
        raise AssertionError(messages)


def test_outlet_queues_messages_while_publish_blocks():
    may_continue, published, failures = threading.Event(), [], []

    def publish(data: bytes) -> None:
        may_continue.wait(TIMEOUT_S)
        published.append(data)

    outlet = Outlet(publish, failures.append)
    for number in range(3):
        outlet.put(b"%d" % number)
    assert outlet.has_more()
    assert published == []
    may_continue.set()
    wait_until(lambda: not outlet.has_more())
    assert published == [b"0", b"1", b"2"]
    assert not failures
    outlet.close()


def test_outlet_reports_failed_publish_and_sends_next_message():
    published, failures = [], []

    def publish(data: bytes) -> None:
        if data == b"1":
            raise OSError("the session has ended")
        published.append(data)

    outlet = Outlet(publish, lambda error: failures.append(str(error)))
    for number in range(3):
        outlet.put(b"%d" % number)
    wait_until(lambda: not outlet.has_more())
    assert (published, failures) == ([b"0", b"2"], ["the session has ended"])
    outlet.close()


def test_lost_endpoint_triggers_new_discovery():
    """The discovery starts long before the lease of the participant expires."""
    messages = []

    class Transport:
        def watch(self, changed):
            self.changed = changed

        def watch_lost(self, lost):
            self.lost = lost

        def start_discovery(self):
            pass

    transport, graph = Transport(), Graph(threads=True)
    BridgedNetwork("DDS", graph, transport, "b0", needs_hashes=False).watch(lambda: messages.append("look"))
    node = NodeIdentity("killed", "/")
    transport.lost(
        EndpointInfo(EndpointKind.PUBLISHER, node, "/rosout", "rcl_interfaces/msg/Log", QoSProfile(1), bytes(16))
    )
    assert messages == ["look"]
    graph.close_threadsafe()


def test_service_present_on_both_networks_is_not_bridged(networks):
    networks.bridge()
    remote, local = networks.dds("remote"), networks.zenoh("local")
    for process, answer in ((remote, 1), (local, 2)):

        def add(_request, response, answer=answer):
            response.sum = answer
            return response

        process.node.create_service(AddTwoInts, "add", add)
    asking = networks.zenoh("asking")
    client = asking.node.create_client(AddTwoInts, "add")
    spin_all(client.service_is_ready, asking)
    spin_all(lambda: {"remote", "local"} <= set(asking.node.get_node_names()), asking)
    answers = []
    for _ in range(10):
        future = client.call_async(AddTwoInts.Request())
        spin_all(future.done, asking, local, remote)
        answers.append(future.result().sum)
    assert set(answers) <= {1, 2}


def test_two_bridges_deliver_each_message_once_and_one_takes_over(networks):
    first = networks.bridge("b0")
    networks.bridge("b1")
    remote, local = networks.dds("remote"), networks.zenoh("local")
    received = listen(local, "chatter", KEEP_ALL)
    publisher = remote.node.create_publisher(String, "chatter", KEEP_ALL)

    def settled() -> bool:
        node_names = [endpoint.node_name for endpoint in remote.node.get_subscriptions_info_by_topic("chatter")]
        return node_names.count("local") == 1 and local.node.count_publishers("chatter") == 1

    spin_all(settled, remote, local)
    for number in range(100):
        publisher.publish(String(data=str(number)))
    spin_all(lambda: len(received) >= 100, local, remote)
    assert received == [str(number) for number in range(100)]
    first.close()
    spin_all(settled, remote, local)
    publisher.publish(String(data="end"))
    spin_all(lambda: len(received) > 100, local, remote)
    assert received[100:] == ["end"]


def test_denied_and_not_allowed_names_are_not_bridged(networks):
    networks.bridge(allowed=("/robot*",), denied=("/*/secret",))
    remote, local = networks.dds("remote"), networks.zenoh("local")
    for name in ("/robot1/scan", "/robot2/secret/key", "/other"):
        remote.node.create_publisher(String, name, 10)
    spin_all(lambda: local.node.count_publishers("/robot1/scan"), local)
    spin_all(lambda: "remote" in local.node.get_node_names(), local)
    names = {name for name, _ in local.node.get_topic_names_and_types()}
    assert "/robot1/scan" in names
    assert not {"/robot2/secret/key", "/other"} & names


def test_messages_of_unknown_type_are_bridged_as_raw_bytes(networks):
    networks.bridge()
    local = networks.dds("local")
    received = []
    local.node.create_subscription("strange_msgs/msg/Odd", "odd", received.append, 10, raw=True)
    type_hash = f"RIHS01_{0:064x}"
    domain = read_settings().domain_id
    token = Token(
        domain, "ab", "0", "1", NodeIdentity("stranger", "/"), EndpointKind.PUBLISHER, "/odd",
        "strange_msgs::msg::dds_::Odd_", type_hash, qos_text.write(QoSProfile(10)),
    )  # fmt: skip
    with open_session(build_config(read_settings())) as session:
        announced = session.liveliness().declare_token(token.key)
        raw_publisher = session.declare_publisher(token.data_key)
        spin_all(lambda: raw_publisher.matching_status.matching and local.node.count_publishers("/odd"), local)
        (endpoint,) = local.node.get_publishers_info_by_topic("/odd")
        assert endpoint.topic_type_hash == type_hash
        for number, gid in enumerate((token.gid, bytes(16)), 1):  # the second GID is made up, as by some programs
            raw_publisher.put(b"\0\1\0\0abc%d" % number, attachment=attachment.write(number, 2, gid))
        spin_all(lambda: len(received) == 2, local)
        announced.undeclare()
    assert received == [b"\0\1\0\0abc1", b"\0\1\0\0abc2"]
    spin_all(lambda: not local.node.count_publishers("/odd"), local)


@pytest.mark.parametrize(("expects", "seconds"), [(False, 1.0), (True, 10.0)])
def test_mirrored_publisher_waits_longer_if_listeners_are_expected(monkeypatch, expects, seconds):
    """On a very busy machine, subscribers match late.

    Their publishers must not be closed before that.
    """
    now = [1000.0]
    monkeypatch.setattr("linkwright.bridge.mirrors.time", SimpleNamespace(monotonic=lambda: now[0]))
    graph = Graph()
    info = EndpointInfo(
        EndpointKind.PUBLISHER, NodeIdentity("remote", "/"), "/odd", "strange_msgs/msg/Odd", QoSProfile(10), bytes(16)
    )
    node = graph.create_node("remote").handle
    publisher = MirroredPublisher(node, info, get_stream(info, is_keyed=False))
    publisher.expects_listeners = expects
    now[0] += seconds - 0.1
    publisher.put(b"first")
    assert publisher.has_queued_messages
    now[0] += 0.1
    assert publisher.process_pending()
    assert not publisher.has_queued_messages
    graph.close_threadsafe()


@pytest.mark.parametrize(("server", "client"), WAYS)
def test_services_of_unknown_type_are_called_with_raw_bytes(networks, server, client):
    networks.bridge()
    remote, local = networks.make(server)("remote"), networks.make(client)("local")
    type_name, name, qos = "strange_msgs/srv/Odd", "/odd", QoSProfile(10)
    requests = []

    def answer(request, reply):
        requests.append(request)
        reply(b"\0\1\0\0" + request[4:] * 2)

    service = Service(remote.node.handle, type_name, name, qos, answer, replying=True, raw=True)
    asking = Client(local.node.handle, type_name, name, qos, raw=True)
    for endpoint, process in ((service, remote), (asking, local)):
        endpoint.type_hash = f"RIHS01_{1:064x}"
        process.node.handle.add(endpoint)
    spin_all(asking.service_is_ready, local, remote)
    answers = []
    for number in range(5):
        future = asking.call_async(b"\0\1\0\0odd%d" % number)
        spin_all(future.done, local, remote)
        answers.append(future.result())
    assert requests == [b"\0\1\0\0odd%d" % number for number in range(5)]
    assert answers == [b"\0\1\0\0odd%dodd%d" % (number, number) for number in range(5)]


def test_topic_that_cannot_be_bridged_is_reported_once(networks):
    bridge = networks.bridge()
    remote, local = networks.dds("remote"), networks.zenoh("local")
    odd_publisher = Publisher(remote.node.handle, "strange_msgs/msg/Odd", "/odd", QoSProfile(10))
    odd_publisher.raw = True  # the type has no hash, as in Humble
    remote.node.handle.add(odd_publisher)
    spin_all(lambda: "remote" in local.node.get_node_names() and bridge.log, local, remote)
    (logged,) = (record.text for record in bridge.log)
    assert logged.startswith("'/odd' is not carried from DDS")
    assert "strange_msgs/msg/Odd" in logged
    assert not local.node.count_publishers("/odd")
