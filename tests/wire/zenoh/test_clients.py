"""Clients of a router.

They receive only the announcements that their own endpoints need, and the rest on request.
"""

from __future__ import annotations

from types import SimpleNamespace

import pytest
import zenoh

from linkwright.messages import String, get_interface
from linkwright.wire.zenoh import remote, transport
from linkwright.wire.zenoh.settings import OVERRIDES_VARIABLE

AddTwoInts = get_interface("example_interfaces/srv/AddTwoInts")
Int32 = get_interface("std_msgs/msg/Int32")


@pytest.fixture(autouse=True)
def router(start_router, monkeypatch, router_port) -> None:
    """Start a router, and make all sessions its clients."""
    start_router()
    monkeypatch.setenv(OVERRIDES_VARIABLE, f'mode="client";connect/endpoints=["tcp/localhost:{router_port}"]')


def remote_node_names(process):
    """Return the nodes that a process knows without a query."""
    return sorted(node.name for node in process.transport.remote_nodes())


def liveliness_listeners(process, session):
    """Return the number of a process's liveliness subscribers for a session."""
    return sum(session in key for key in tuple(process.transport._zenoh_engine._interests._declared))


def live_session_count(process):
    """Return the number of sessions known to a process that announce their departure."""
    return len(process.transport._departures.live_sessions)


def test_client_discovers_only_what_its_endpoints_need(processes):
    talker, other = processes("talker"), processes("other")
    publisher = talker.node.create_publisher(String, "chatter", 10)
    texts: list[str] = []
    ears = [processes(f"ear{number}") for number in range(2)]
    subscriptions = [
        ear.node.create_subscription(String, "chatter", lambda message: texts.append(message.data), 10) for ear in ears
    ]
    talker.spin_until(lambda: publisher.get_subscription_count() == 2)
    for ear, subscription in zip(ears, subscriptions, strict=True):
        ear.spin_until(lambda subscription=subscription: subscription.get_publisher_count() == 1)
    publisher.publish(String(data="hej"))
    for ear in ears:
        ear.spin_until(lambda: texts)
        texts.clear()
    ears[0].node.destroy_subscription(subscriptions[0])
    talker.spin_until(lambda: publisher.get_subscription_count() == 1)
    assert [remote_node_names(process) for process in (talker, other, *ears)] == [[], [], [], []]
    assert other.transport.remote_endpoints() == []


def test_first_graph_query_is_answered_completely(processes, monkeypatch):
    monkeypatch.setattr(transport, "_ANSWER_TIMEOUT_S", 60.0)  # enough for a busy machine
    monkeypatch.setattr(transport, "_QUIET_S", 1.0)
    talker, asks = processes("talker"), processes("asks")
    talker.node.create_publisher(String, "chatter", 10)
    subscription = talker.node.create_subscription(String, "said_late", print, 10)
    late_process = processes("late")
    late_process.node.create_publisher(String, "chatter", 10)
    late_process.node.create_publisher(String, "said_late", 10)
    talker.spin_until(lambda: subscription.get_publisher_count() == 1)  # the router then knows all endpoints
    assert asks.node.count_publishers("chatter") == 2
    assert sorted(asks.node.get_node_names()) == ["asks", "late", "talker"]
    late_process.close()
    asks.spin_until(lambda: asks.node.count_publishers("chatter") == 1)
    assert sorted(asks.node.get_node_names()) == ["asks", "talker"]


def test_recreated_subscription_counts_publishers_correctly(processes):
    """Data that was discovered for a subscription is dropped with it."""
    talker, ear = processes("talker"), processes("ear")
    first = talker.node.create_publisher(String, "chatter", 10)
    subscription = ear.node.create_subscription(String, "chatter", print, 10)
    ear.spin_until(lambda: subscription.get_publisher_count() == 1)
    ear.node.destroy_subscription(subscription)
    talker.node.destroy_publisher(first)
    talker.node.create_publisher(String, "chatter", 10)
    talker.node.create_publisher(String, "chatter", 10)
    recreated = ear.node.create_subscription(String, "chatter", print, 10)
    ear.spin_until(lambda: recreated.get_publisher_count() == 2)


def test_outdated_liveliness_news_is_ignored_and_returned_token_kept(processes, monkeypatch):
    """Zenoh delivers known tokens in a separate task, possibly after the news of their removal."""
    talker, ear = processes("talker"), processes("ear")
    publisher = talker.node.create_publisher(String, "chatter", 10)
    subscription = ear.node.create_subscription(String, "chatter", print, 10)
    ear.spin_until(lambda: subscription.get_publisher_count() == 1)
    (key,) = ear.transport._remote._tokens
    monkeypatch.setattr(remote, "_READD_DELAY_S", 60.0)
    talker.node.destroy_publisher(publisher)
    ear.spin_until(lambda: subscription.get_publisher_count() == 0)
    late = SimpleNamespace(kind=zenoh.SampleKind.PUT, key_expr=key)
    ear.transport._zenoh_engine._on_token(late)
    talker.node.create_publisher(String, "chatter", 10)
    ear.spin_until(lambda: subscription.get_publisher_count() > 0)
    assert subscription.get_publisher_count() == 1
    monkeypatch.setattr(remote, "_READD_DELAY_S", 0.0)
    ear.transport._zenoh_engine._on_token(late)
    ear.spin_until(lambda: subscription.get_publisher_count() == 2)


def test_services_become_ready_and_unavailable(processes):
    server, asks = processes("server"), processes("asks")

    def add(request, response):
        response.sum = request.a + request.b
        return response

    service = server.node.create_service(AddTwoInts, "add", add)
    client = asks.node.create_client(AddTwoInts, "add")
    asks.spin_until(client.service_is_ready)
    future = client.call_async(AddTwoInts.Request(a=1, b=2))
    asks.spin_until(lambda: future.done() or server.executor.spin_once(timeout_sec=0.01) or future.done())
    assert future.result().sum == 3
    server.node.destroy_service(service)
    asks.spin_until(lambda: not client.service_is_ready())


def test_duplicate_node_name_is_reported(processes):
    linkwright_process = processes("robot")
    processes("robot")
    linkwright_process.spin_until(lambda: any("exact name '/robot'" in text for text in linkwright_process.warnings()))


@pytest.mark.parametrize("its_process_goes_on", [False, True])
def test_killed_publisher_is_lost_and_closed_one_is_not(processes, programs, its_process_goes_on):
    linkwright_process = processes("ours")
    lost: list[str] = []
    subscription = linkwright_process.node.create_subscription(Int32, "flood", print, 10)
    subscription.watch_lost(lambda publisher: lost.append(publisher.node.name))
    other = processes("other")
    left = other.graph.create_node("left")
    left.create_publisher(Int32, "flood", 10)
    victim = programs("linkwright_program", "victim")
    linkwright_process.spin_until(lambda: subscription.get_publisher_count() == 2)
    linkwright_process.spin_until(
        lambda: live_session_count(linkwright_process) == 2
    )  # before that, the way a session ends is unknown
    if its_process_goes_on:
        left.destroy_node()
    else:
        other.close()
    linkwright_process.spin_until(lambda: subscription.get_publisher_count() == 1)
    victim.kill()
    linkwright_process.spin_until(lambda: lost)
    assert lost == ["victim"]


def test_ended_sessions_are_no_longer_watched(processes):
    """Many sessions join and leave during the months that a robot runs."""
    linkwright_process = processes("ours")
    subscription = linkwright_process.node.create_subscription(Int32, "flood", print, 10)
    subscription.watch_lost(print)
    for name in ("one", "two"):
        other = processes(name)
        other.node.create_publisher(Int32, "flood", 10)
        session = other.transport._zenoh_engine._session_id
        linkwright_process.spin_until(lambda session=session: liveliness_listeners(linkwright_process, session) == 2)
        other.close()
        linkwright_process.spin_until(lambda session=session: liveliness_listeners(linkwright_process, session) == 0)
