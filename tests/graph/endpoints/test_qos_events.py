"""Events of endpoints: incompatible QoS, matches, deadlines and liveliness."""

import pytest

from linkwright.graph import (
    DurabilityPolicy,
    Duration,
    LivelinessPolicy,
    MessageInfo,
    PublisherEventCallbacks,
    QoSPolicyKind,
    QoSProfile,
    ReliabilityPolicy,
    SubscriptionEventCallbacks,
)
from linkwright.messages import String, serialize

BEST_EFFORT = QoSProfile(depth=5, reliability=ReliabilityPolicy.BEST_EFFORT)


@pytest.fixture
def node(graph):
    return graph.create_node("node")


def ignore(_message):
    pass


async def test_publisher_receives_incompatible_qos_events(graph, node, log):
    events = []
    node.create_publisher(
        String, "topic", BEST_EFFORT, event_callbacks=PublisherEventCallbacks(incompatible_qos=events.append)
    )
    for _ in range(2):
        node.create_subscription(
            String,
            "topic",
            ignore,
            QoSProfile(5, durability=DurabilityPolicy.TRANSIENT_LOCAL),
            event_callbacks=SubscriptionEventCallbacks(use_default_callbacks=False),
        )
    assert events == []
    await graph.settle()
    assert [(event.total_count, event.total_count_change) for event in events] == [(1, 1), (2, 1)]
    assert events[0].last_policy_kind == QoSPolicyKind.DURABILITY
    assert log == []


async def test_matched_events_count_endpoints(graph, node):
    published, subscribed = [], []
    publisher = node.create_publisher(
        String, "topic", 1, event_callbacks=PublisherEventCallbacks(matched=published.append)
    )
    subscription = node.create_subscription(
        String, "topic", ignore, 1, event_callbacks=SubscriptionEventCallbacks(matched=subscribed.append)
    )
    subscription.set_remote_count(2)
    await graph.settle()
    node.destroy_publisher(publisher)
    await graph.settle()

    def numbers(event):
        return event.total_count, event.total_count_change, event.current_count, event.current_count_change

    assert [numbers(event) for event in published] == [(1, 1, 1, 1)]
    assert [numbers(event) for event in subscribed] == [(1, 1, 1, 1), (3, 2, 3, 2), (3, 0, 2, -1)]


async def test_deadline_missed_events_are_sent_to_both_sides(graph, node, clock):
    offered_events, requested_events = [], []
    qos = QoSProfile(depth=1, deadline=Duration(seconds=1.0))
    publisher = node.create_publisher(
        String, "topic", qos, event_callbacks=PublisherEventCallbacks(deadline=offered_events.append)
    )
    node.create_subscription(
        String, "topic", ignore, qos, event_callbacks=SubscriptionEventCallbacks(deadline=requested_events.append)
    )
    await clock.advance(5.0)
    assert (offered_events, requested_events) == ([], [])  # the deadline begins with the first message, as in DDS
    for _ in range(10):
        publisher.publish(String())
        await clock.advance(0.9)
    assert (offered_events, requested_events) == ([], [])
    await clock.advance(2.5)
    assert [event.total_count for event in offered_events] == [1, 2, 3]
    assert [event.total_count for event in requested_events] == [1, 2, 3]
    node.destroy_node()
    await clock.advance(10.0)
    assert len(offered_events) == 3


async def test_remote_messages_satisfy_deadline(node, clock):
    missed = []
    qos = QoSProfile(depth=1, deadline=Duration(seconds=1.0))
    events = SubscriptionEventCallbacks(deadline=missed.append)
    subscription = node.create_subscription(String, "topic", ignore, qos, event_callbacks=events)
    subscription.set_remote_count(1)
    await clock.advance(5.0)
    for _ in range(10):
        subscription.receive(serialize(String()), MessageInfo(1, 1, bytes(16)))
        await clock.advance(0.9)
    assert missed == []
    await clock.advance(0.2)
    assert [event.total_count for event in missed] == [1]


async def test_deadline_is_missed_without_running_executor(graph, node, clock):
    missed = []
    qos = QoSProfile(depth=1, deadline=Duration(seconds=1.0))
    node.create_subscription(
        String, "topic", ignore, qos, event_callbacks=SubscriptionEventCallbacks(deadline=missed.append)
    )
    publisher = node.create_publisher(String, "topic", qos)
    node.handle.set_dispatcher(None)
    publisher.publish(String())
    await clock.advance(1.5)
    assert missed == []
    node.handle.set_dispatcher(graph.dispatcher)
    await clock.advance(0.0)
    assert [event.total_count for event in missed] == [1]


async def test_liveliness_events_are_sent_to_both_sides(graph, node, clock):
    lost, events = [], []
    qos = QoSProfile(
        depth=1, liveliness=LivelinessPolicy.MANUAL_BY_TOPIC, liveliness_lease_duration=Duration(seconds=1.0)
    )
    publisher = node.create_publisher(
        String, "topic", qos, event_callbacks=PublisherEventCallbacks(liveliness=lost.append)
    )
    node.create_subscription(
        String, "topic", ignore, qos, event_callbacks=SubscriptionEventCallbacks(liveliness=events.append)
    )
    for _ in range(3):
        publisher.assert_liveliness()
        await clock.advance(0.9)
    assert lost == []
    await clock.advance(5.0)
    assert [event.total_count for event in lost] == [1]
    publisher.publish(String())
    await graph.settle()
    assert [(event.alive_count, event.not_alive_count) for event in events] == [(1, 0), (0, 1), (1, 0)]


async def test_destroyed_lost_publisher_decrements_not_alive_count(graph, node, clock):
    events = []
    qos = QoSProfile(
        depth=1, liveliness=LivelinessPolicy.MANUAL_BY_TOPIC, liveliness_lease_duration=Duration(seconds=1.0)
    )
    publisher = node.create_publisher(String, "topic", qos, event_callbacks=PublisherEventCallbacks())
    await clock.advance(2.0)
    node.create_subscription(
        String, "topic", ignore, qos, event_callbacks=SubscriptionEventCallbacks(liveliness=events.append)
    )
    publisher.assert_liveliness()
    await clock.advance(2.0)
    node.destroy_publisher(publisher)
    await graph.settle()
    assert [(event.alive_count, event.not_alive_count) for event in events] == [(0, 1), (1, 0), (0, 1), (0, 0)]


async def test_liveliness_of_remote_publishers_is_counted(graph, node):
    events = []
    subscription = node.create_subscription(
        String, "topic", ignore, 1, event_callbacks=SubscriptionEventCallbacks(liveliness=events.append)
    )
    for alive, not_alive in [(2, 0), (2, 0), (1, 1), (0, 1), (0, 0)]:
        subscription.set_remote_count(alive + not_alive)
        subscription.set_remote_liveliness(alive, not_alive)
    await graph.settle()
    result = [(status.alive_count, status.not_alive_count, status.alive_count_change) for status in events]
    assert result == [(2, 0, 2), (1, 1, -1), (0, 1, -1), (0, 0, 0)]


async def test_message_lost_events_count_messages(graph, node):
    lost = []
    subscription = node.create_subscription(
        String, "topic", ignore, 2, event_callbacks=SubscriptionEventCallbacks(message_lost=lost.append)
    )
    publisher = node.create_publisher(String, "topic", 10)
    for _ in range(5):
        publisher.publish(String())
    subscription.count_lost_remote(4)
    await graph.settle()
    assert [(event.total_count, event.total_count_change) for event in lost] == [(1, 1), (2, 1), (3, 1), (7, 4)]


async def test_message_expires_after_lifespan(graph, clock):
    node = graph.create_node("node")
    received = []
    node.create_subscription(String, "topic", received.append, 10)
    publisher = node.create_publisher(String, "topic", QoSProfile(depth=10, lifespan=Duration(seconds=1.0)))
    node.handle.set_dispatcher(None)
    publisher.publish(String(data="old"))
    await clock.advance(1.5)
    publisher.publish(String(data="new"))
    node.handle.set_dispatcher(graph.dispatcher)
    await graph.settle()
    assert [message.data for message in received] == ["new"]
