"""Publishers and subscriptions within one graph: order, queues and latched messages."""

import asyncio

import pytest

from linkwright.diagnostics import Diagnostic, LinkwrightError
from linkwright.graph import (
    DurabilityPolicy,
    Duration,
    Graph,
    HistoryPolicy,
    InvalidHandleError,
    LogLevel,
    QoSProfile,
    ReliabilityPolicy,
)
from linkwright.messages import Header, String, get_message

LATCHED = QoSProfile(depth=1, durability=DurabilityPolicy.TRANSIENT_LOCAL)
BEST_EFFORT = QoSProfile(depth=5, reliability=ReliabilityPolicy.BEST_EFFORT)


def received_texts(received):
    return [message.data for message in received]


async def test_messages_arrive_in_order_and_outside_publish(graph):
    received = []
    talker, listener = graph.create_node("talker"), graph.create_node("listener")
    listener.create_subscription(String, "chatter", received.append, 10)
    publisher = talker.create_publisher(String, "chatter", 10)
    for number in range(3):
        publisher.publish(String(data=str(number)))
    assert received == []
    await graph.settle()
    assert received_texts(received) == ["0", "1", "2"]
    assert publisher.get_subscription_count() == 1


async def test_batched_messages_arrive_in_one_dispatcher_call(graph):
    node, order = graph.create_node("node"), []
    many = node.create_subscription(String, "many", lambda message: order.append(message.data), 10)
    node.create_subscription(String, "few", lambda message: order.append(message.data), 10)
    publish_many, publish_few = node.create_publisher(String, "many", 10), node.create_publisher(String, "few", 10)
    many.deliver_in_batches()
    for number in range(3):
        publish_many.publish(String(data=f"many {number}"))
        publish_few.publish(String(data=f"few {number}"))
    await graph.settle()
    assert order == ["many 0", "many 1", "many 2", "few 0", "few 1", "few 2"]


async def test_malformed_messages_in_batch_are_skipped(graph):
    node, received = graph.create_node("node"), []
    subscription = node.create_subscription(String, "many", received.append, 10)
    subscription.deliver_in_batches()
    for message in (String(data="a"), b"no CDR", String(data="b")):
        subscription.receive(message)
    await graph.settle()
    assert received_texts(received) == ["a", "b"]
    assert subscription.malformed_count == 1


async def test_callbacks_are_not_reentrant(graph):
    node = graph.create_node("echo")
    depth, deepest, data_received = 0, 0, []

    def on_message(message):
        nonlocal depth, deepest
        depth += 1
        deepest = max(deepest, depth)
        data_received.append(message.data)
        if len(message.data) < 5:
            publisher.publish(String(data=message.data + "x"))
        depth -= 1

    node.create_subscription(String, "loop", on_message, 10)
    publisher = node.create_publisher(String, "loop", 10)
    publisher.publish(String(data=""))
    await graph.settle()
    assert data_received == ["", "x", "xx", "xxx", "xxxx", "xxxxx"]
    assert deepest == 1


async def test_order_holds_across_topics_and_subscriptions(graph):
    node = graph.create_node("node")
    order = []
    publishers = {}
    for topic in "ab":
        publishers[topic] = node.create_publisher(String, topic, 10)
        for subscriber in (1, 2):
            node.create_subscription(String, topic, lambda message, s=subscriber: order.append((message.data, s)), 10)
    publishers["b"].publish(String(data="b"))
    publishers["a"].publish(String(data="a"))
    await graph.settle()
    assert order == [("b", 1), ("b", 2), ("a", 1), ("a", 2)]


async def test_self_publishing_node_does_not_block_event_loop(graph):
    """A node that answers its own messages endlessly does not starve other nodes."""
    node = graph.create_node("node")
    publisher = node.create_publisher(String, "loop", 1)
    node.create_subscription(String, "loop", publisher.publish, 1)
    publisher.publish(String())
    for _ in range(20):
        await asyncio.sleep(0)


async def test_failing_callback_is_logged_and_others_continue(graph, log):
    node = graph.create_node("node", namespace="/robot")
    received = []

    def fail(message):
        raise ZeroDivisionError(message.data)

    def complain(_message):
        raise LinkwrightError(Diagnostic("GRAPH999", "the robot has no arm"))

    for callback in (fail, complain, received.append):
        node.create_subscription(String, "topic", callback, 10)
    node.create_publisher(String, "topic", 10).publish(String(data="boom"))
    await graph.settle()
    assert received_texts(received) == ["boom"]
    bug, user_error = log
    assert (bug.level, bug.node) == (LogLevel.ERROR, "robot.node")
    assert bug.text.startswith("callback of topic '/robot/topic' failed:\nTraceback")
    assert bug.text.endswith("ZeroDivisionError: boom")
    assert user_error.text == "callback of topic '/robot/topic' failed: the robot has no arm"


async def test_queue_keeps_last_messages_up_to_depth(graph):
    node = graph.create_node("node")
    last_texts, all_texts = [], []
    node.create_subscription(String, "topic", last_texts.append, 2)
    node.create_subscription(String, "topic", all_texts.append, QoSProfile(depth=1, history=HistoryPolicy.KEEP_ALL))
    publisher = node.create_publisher(String, "topic", 1)
    for number in range(5):
        publisher.publish(String(data=str(number)))
    await graph.settle()
    assert received_texts(last_texts) == ["3", "4"]
    assert received_texts(all_texts) == ["0", "1", "2", "3", "4"]


async def test_late_subscription_receives_latched_messages(graph):
    node = graph.create_node("node")
    publisher = node.create_publisher(String, "topic", QoSProfile(depth=2, durability=DurabilityPolicy.TRANSIENT_LOCAL))
    for text in "abc":
        publisher.publish(String(data=text))
    latched, volatile = [], []
    node.create_subscription(String, "topic", latched.append, QoSProfile(5, durability=LATCHED.durability))
    node.create_subscription(String, "topic", volatile.append, 5)
    publisher.publish(String(data="d"))
    await graph.settle()
    assert received_texts(latched) == ["b", "c", "d"]
    assert received_texts(volatile) == ["d"]


async def test_late_subscription_does_not_receive_expired_messages(graph, clock):
    node = graph.create_node("node")
    qos = QoSProfile(depth=5, durability=DurabilityPolicy.TRANSIENT_LOCAL, lifespan=Duration(seconds=1))
    publisher = node.create_publisher(String, "topic", qos)
    for text in "abc":
        publisher.publish(String(data=text))
        await clock.advance(0.6)
    received, sent_messages = [], []
    node.create_subscription(String, "topic", received.append, QoSProfile(5, durability=LATCHED.durability))
    publisher.set_remote_sender(sent_messages.append)
    await graph.settle()
    assert received_texts(received) == ["c"]
    assert received_texts(sent_messages) == ["c"]


async def test_volatile_publisher_keeps_no_messages(graph):
    node = graph.create_node("node")
    received = []
    node.create_publisher(String, "topic", 10).publish(String(data="gone"))
    node.create_subscription(String, "topic", received.append, 10)
    await graph.settle()
    assert received == []


@pytest.mark.parametrize(
    ("offered", "requested", "policy", "sides"),
    [
        (BEST_EFFORT, QoSProfile(5), "RELIABILITY_QOS_POLICY", ("best effort", "reliable")),
        (QoSProfile(5), LATCHED, "DURABILITY_QOS_POLICY", ("volatile", "transient local")),
        (
            BEST_EFFORT,
            LATCHED,
            "DURABILITY_QOS_POLICY",
            ("best effort, volatile", "reliable, transient local"),
        ),
    ],
)
@pytest.mark.parametrize("publisher_first", [True, False])
async def test_incompatible_qos_is_reported_to_both_sides(
    graph, log, offered, requested, policy, sides, publisher_first
):
    talker, listener = graph.create_node("talker"), graph.create_node("listener")
    received = []
    if publisher_first:
        publisher = talker.create_publisher(String, "topic", offered)
    listener.create_subscription(String, "topic", received.append, requested)
    if not publisher_first:
        publisher = talker.create_publisher(String, "topic", offered)
    publisher.publish(String())
    await graph.settle()
    assert received == []
    assert publisher.get_subscription_count() == 0
    last = f"Last incompatible policy: {policy} ('/talker' offers {sides[0]}, '/listener' requests {sides[1]})"
    none = "No messages will be"
    assert [(record.node, record.level, record.text) for record in log] == [
        (
            "listener",
            LogLevel.WARN,
            f"New publisher discovered on topic '/topic', offering incompatible QoS. {none} received from it. {last}",
        ),
        (
            "talker",
            LogLevel.WARN,
            f"New subscription discovered on topic '/topic', requesting incompatible QoS. {none} sent to it. {last}",
        ),
    ]


@pytest.mark.parametrize("requested", [BEST_EFFORT, QoSProfile(5)])
async def test_subscription_can_request_less_than_offered(graph, log, requested):
    node = graph.create_node("node")
    received = []
    node.create_subscription(String, "topic", received.append, requested)
    node.create_publisher(String, "topic", LATCHED).publish(String(data="x"))
    await graph.settle()
    assert received_texts(received) == ["x"]
    assert log == []


async def test_different_types_on_topic_are_reported(graph, log):
    node = graph.create_node("node")
    node.create_publisher(String, "topic", 1)
    node.create_subscription(Header, "topic", print, 1)
    assert "publishes std_msgs/msg/String, '/node' subscribes to std_msgs/msg/Header" in log[0].text
    assert graph.topics()["/topic"] == ["std_msgs/msg/Header", "std_msgs/msg/String"]


async def test_node_subscribing_to_both_types_causes_no_warning(graph, log):
    node, other = graph.create_node("node"), graph.create_node("other")
    received = []
    for kind in (String, Header):
        node.create_subscription(kind, "topic", received.append, 1)
    other.create_publisher(String, "topic", 1).publish(String(data="x"))
    other.create_publisher(Header, "topic", 1).publish(Header(frame_id="map"))
    await graph.settle()
    assert [type(message) for message in received] == [String, Header]
    assert log == []
    other.create_subscription(get_message("std_msgs/msg/Bool"), "topic", print, 1)
    assert ["'/other' subscribes to std_msgs/msg/Bool" in record.text for record in log] == [True, True]


async def test_subscription_with_publisher_of_its_type_causes_no_warning(graph, log):
    simulator, bridge, user = (graph.create_node(name) for name in ("gazebo", "bridge", "user"))
    received = []
    simulator.create_publisher(String, "topic", 1)
    bridge.create_publisher(Header, "topic", 1).publish(Header(frame_id="map"))
    user.create_subscription(Header, "topic", received.append, 1)
    bridge.create_publisher(Header, "topic", 1).publish(Header(frame_id="map"))
    await graph.settle()
    assert [message.frame_id for message in received] == ["map"]
    assert log == []


async def test_hidden_node_with_another_type_causes_no_warning(graph, log):
    hidden, user = graph.create_node("_bridge_gz"), graph.create_node("user")
    user.create_publisher(Header, "topic", 1)
    hidden.create_subscription(String, "topic", print, 1)
    assert log == []


async def test_publishing_another_message_type_is_rejected(graph):
    publisher = graph.create_node("node").create_publisher(String, "topic", 1)
    with pytest.raises(TypeError, match="topic '/topic' carries std_msgs/msg/String, not Header"):
        publisher.publish(Header())


async def test_destroyed_publishers_and_subscriptions_are_silent(graph):
    talker, listener = graph.create_node("talker"), graph.create_node("listener")
    received, ignored = [], []
    publisher = talker.create_publisher(String, "topic", 10)
    listener.create_subscription(String, "topic", received.append, 10)
    subscription = listener.create_subscription(String, "topic", ignored.append, 10)
    publisher.publish(String(data="sent"))
    listener.destroy_subscription(subscription)
    talker.destroy_node()
    talker.destroy_node()
    with pytest.raises(InvalidHandleError, match="destruction was requested"):
        publisher.publish(String(data="too late"))
    await graph.settle()
    assert received_texts(received) == ["sent"]
    assert ignored == []
    assert graph.node_names() == ["/listener"]
    assert graph.count_publishers("/topic") == 0
    assert graph.count_subscribers("/topic") == 1


async def test_graph_close_drops_undelivered_messages():
    graph = Graph(on_log=lambda _record: None)
    node = graph.create_node("node")
    received = []
    node.create_subscription(String, "topic", received.append, 10)
    node.create_publisher(String, "topic", 10).publish(String())
    node.create_timer(0.001, lambda: received.append("timer"))
    await graph.close()
    await asyncio.sleep(0.005)
    assert received == []


async def test_duplicate_node_names_are_reported(graph, log):
    graph.create_node("twin", namespace="home")
    graph.create_node("twin")
    assert log == []
    graph.create_node("twin", namespace="/home")
    assert "share the exact name '/home/twin'" in log[0].text
