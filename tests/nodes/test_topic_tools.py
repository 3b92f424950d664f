"""The nodes of topic_tools: relay, throttle, drop, delay, mux, demux and transform."""

from __future__ import annotations

import pytest

from linkwright.diagnostics import LinkwrightError
from linkwright.graph import DurabilityPolicy, QoSProfile, ReliabilityPolicy
from linkwright.messages import String, get_message, get_service
from linkwright.nodes import NodeOptions
from linkwright.nodes.topic_tools.expressions import RelayField, Transform
from linkwright.nodes.topic_tools.mux import Demux, Mux
from linkwright.nodes.topic_tools.relay import Delay, Drop, Relay, Throttle
from linkwright.testing.stepped import AsyncSteppedGraph
from tests.remote_publishers import RemotePublisher, RemoteTransport


@pytest.fixture
async def test():
    async with AsyncSteppedGraph() as graph:
        yield graph


def start_tool(test, kind, *words, **parameters):
    return kind(test.graph, NodeOptions(arguments=list(words), parameters=parameters))


def logged_texts(test, level):
    return [record.text for record in test.log if record.level.name == level]


async def publish_texts(test, topic, *texts):
    for text in texts:
        test.publish(topic, String(data=text))
        await test.settle()


def received_texts(recording):
    return [message.data for message in recording]


async def test_relay_detects_type_and_forwards_messages(test):
    start_tool(test, Relay, "chatter", "copy")
    copy = test.record("/copy", String)
    await test.settle()
    assert test.graph.count_publishers("/copy") == 0
    test.node.create_publisher(String, "chatter", 10)
    await test.settle()
    await publish_texts(test, "chatter", "one", "two")
    assert received_texts(copy) == ["one", "two"]


async def test_relay_forwards_same_message_object(test):
    start_tool(test, Relay, input_topic="chatter")
    relayed = test.record("/chatter_relay", String)
    test.node.create_publisher(String, "chatter", 10)
    await test.settle()
    message = String(data="one")
    test.publish("chatter", message)
    await test.settle()
    assert relayed.last is message


async def test_relay_adopts_qos_of_source_and_ends_with_it(test):
    start_tool(test, Relay, "chatter", "copy")
    transient_local = QoSProfile(1, durability=DurabilityPolicy.TRANSIENT_LOCAL)
    source = test.node.create_publisher(String, "chatter", transient_local)
    source.publish(String(data="kept"))
    await test.settle()
    (copy,) = test.graph.get_publishers_info_by_topic("/copy")
    assert copy.qos_profile.durability is DurabilityPolicy.TRANSIENT_LOCAL
    late_messages = test.record("/copy")
    await test.settle()
    assert received_texts(late_messages) == ["kept"]
    test.node.create_publisher(String, "chatter", QoSProfile(1, ReliabilityPolicy.BEST_EFFORT))
    await test.settle()
    (copy,) = test.graph.get_publishers_info_by_topic("/copy")
    assert copy.qos_profile.durability is DurabilityPolicy.VOLATILE
    assert copy.qos_profile.reliability is ReliabilityPolicy.BEST_EFFORT
    assert len([text for text in logged_texts(test, "WARN") if text.startswith("Some, but not all, publishers")]) == 2
    for publisher in [publisher for publisher in test.node.publishers if publisher.name == "/chatter"]:
        test.node.destroy_publisher(publisher)
    await test.settle()
    assert test.graph.count_publishers("/copy") == 0
    number = get_message("std_msgs/msg/Int32")
    test.node.create_publisher(number, "chatter", 10)
    await test.settle()
    assert [endpoint.topic_type for endpoint in test.graph.get_publishers_info_by_topic("/copy")] == [
        "std_msgs/msg/Int32"
    ]


async def test_lazy_relay_subscribes_only_if_output_has_subscribers(test):
    running = start_tool(test, Relay, "chatter", "copy", lazy=True)
    test.node.create_publisher(String, "chatter", 10)
    await test.settle()
    assert test.graph.count_subscribers("/chatter") == 0
    listener = test.node.create_subscription(String, "copy", lambda _: None, 10)
    await test.settle()
    assert test.graph.count_subscribers("/chatter") == 1
    test.node.destroy_subscription(listener)
    await test.settle()
    assert test.graph.count_subscribers("/chatter") == 0
    running.close()
    await test.settle()
    assert test.graph.count_publishers("/copy") == 0


async def test_throttle_limits_messages_per_second(test):
    start_tool(test, Throttle, "messages", "chatter", "2.0")
    slow = test.record("/chatter_throttle", String)
    publisher = test.node.create_publisher(String, "chatter", 100)
    test.node.create_timer(0.1, lambda: publisher.publish(String()))
    await test.advance(10.0)
    assert slow.times == pytest.approx([0.5 * count for count in range(1, 21)])


async def test_throttle_limits_bytes_per_window(test):
    start_tool(test, Throttle, "bytes", "chatter", "100", "1.0", "slow")
    slow = test.record("/slow", String)
    publisher = test.node.create_publisher(String, "chatter", 100)
    test.node.create_timer(0.1, lambda: publisher.publish(String(data="x" * 31)))  # 40 bytes with header and length
    await test.advance(1.05)
    assert len(slow) == 3


async def test_drop_removes_first_messages_of_each_cycle(test):
    start_tool(test, Drop, "chatter", "1", "3")
    forwarded = test.record("/chatter_drop", String)
    test.node.create_publisher(String, "chatter", 10)
    await test.settle()
    await publish_texts(test, "chatter", *"abcdefg")
    assert received_texts(forwarded) == ["b", "c", "e", "f"]


async def test_delay_keeps_order_and_spacing(test):
    start_tool(test, Delay, "chatter", "0.5")
    delayed = test.record("/chatter_delay", String)
    test.node.create_publisher(String, "chatter", 10)
    await test.settle()
    await publish_texts(test, "chatter", "a", "b")
    await test.advance(0.2)
    await publish_texts(test, "chatter", "c")
    await test.advance(0.29)
    assert received_texts(delayed) == []
    await test.advance(0.5)
    assert received_texts(delayed) == ["a", "b", "c"]
    assert delayed.times == pytest.approx([0.5, 0.5, 0.7])


async def test_mux_selects_adds_lists_and_deletes(test):
    start_tool(test, Mux, "out", "first", "second")
    out = test.record("/out", String)
    for topic in ("first", "second", "third"):
        test.node.create_publisher(String, topic, 10)
    await test.settle()
    await publish_texts(test, "first", "1")
    await publish_texts(test, "second", "2")
    assert received_texts(out) == ["1"]

    async def ask(verb, topic=None):
        request = get_service(f"topic_tools_interfaces/srv/Mux{verb.capitalize()}").Request()
        if topic is not None:
            request.topic = topic
        return await test.call(f"/mux/{verb}", request)

    response = await ask("select", "/second")
    assert (response.success, response.prev_topic) == (True, "first")
    await publish_texts(test, "first", "1")
    await publish_texts(test, "second", "2")
    assert received_texts(out) == ["1", "2"]
    assert not (await ask("select", "third")).success
    assert (await ask("add", "third")).success
    assert not (await ask("add", "third")).success
    assert (await ask("list")).topics == ["first", "second", "third"]
    assert not (await ask("delete", "second")).success
    assert (await ask("delete", "first")).success
    assert (await ask("select", "__none")).success
    await publish_texts(test, "second", "2")
    assert received_texts(out) == ["1", "2"]
    assert logged_texts(test, "WARN") == [
        "tried to add a topic that mux was already listening to: [third]",
        "tried to delete currently selected topic second from mux",
    ]


async def test_demux_publishes_on_selected_output(test):
    start_tool(test, Demux, "in", "left", "right")
    left, right = test.record("/left", String), test.record("/right", String)
    test.node.create_publisher(String, "in", 10)
    await test.settle()
    await publish_texts(test, "in", "1")
    request = get_service("topic_tools_interfaces/srv/DemuxSelect").Request(topic="right")
    assert (await test.call("/demux/select", request)).prev_topic == "left"
    await publish_texts(test, "in", "2")
    assert (received_texts(left), received_texts(right)) == (["1"], ["2"])


async def test_transform_evaluates_expression(test):
    words = ["/imu", "--field", "orientation", "/norm", "std_msgs/Float64"]
    expression = "std_msgs.msg.Float64(data=numpy.linalg.norm([m.x, m.y, m.z, m.w]))"
    start_tool(test, Transform, *words, expression, "--import", "std_msgs", "numpy")
    norm = test.record("/norm")
    imu = get_message("sensor_msgs/msg/Imu")()
    imu.orientation.x, imu.orientation.w = 3.0, 4.0
    test.publish("/imu", imu)
    await test.settle()
    test.publish("/imu", imu)
    await test.settle()
    assert norm.last.data == 5.0


async def test_relay_field_evaluates_field_expressions(test):
    start_tool(
        test, RelayField, "/chatter", "/header", "std_msgs/Header", "{stamp: {sec: 7}, frame_id: m.data + '_link'}"
    )
    header = test.record("/header")
    test.node.create_publisher(String, "/chatter", 10)
    await test.settle()
    await publish_texts(test, "/chatter", "base")
    assert (header.last.stamp.sec, header.last.frame_id) == (7, "base_link")


async def test_failing_expression_is_reported_and_next_message_is_processed(test):
    start_tool(
        test,
        Transform,
        "/chatter",
        "/number",
        "std_msgs/Int32",
        "std_msgs.msg.Int32(data=int(m.data))",
        "-i",
        "std_msgs",
    )
    number = test.record("/number")
    test.node.create_publisher(String, "/chatter", 10)
    await test.settle()
    await publish_texts(test, "/chatter", "one", "1")
    assert [message.data for message in number] == [1]
    (text,) = logged_texts(test, "ERROR")
    assert text.endswith("ValueError: invalid literal for int() with base 10: 'one'")


@pytest.mark.parametrize(
    ("kind", "words", "text"),
    [
        (Relay, [], "parameter 'input_topic' of 'relay' is not set"),
        (Relay, ["a", "b", "c"], "unexpected argument 'c'"),
        (Throttle, ["often", "a", "1"], "parameter 'throttle_type' of 'throttle' cannot be 'often'"),
        (Throttle, ["messages", "a", "fast"], "'fast' is not a valid value for 'msgs_per_sec'"),
        (Throttle, ["messages", "a", "0"], "parameter 'msgs_per_sec' of 'throttle' cannot be '0.0'"),
        (Drop, ["a", "1"], "parameter 'Y' of 'drop' is not set"),
        (Delay, ["a", "-1"], "parameter 'delay' of 'delay' cannot be '-1.0'"),
        (Mux, ["out"], "parameter 'input_topics' of 'mux' is not set"),
        (Transform, ["a", "b", "std_msgs/Nothing"], "there is no message 'std_msgs/msg/Nothing'"),
        (Transform, ["a", "b", "std_msgs/String", "m +"], "'m +' cannot be parsed"),
        (Transform, ["a", "b"], "the following arguments are required: output_type"),
        (RelayField, ["a", "b", "std_msgs/String", "data"], "'data' cannot be parsed: it is not a mapping of fields"),
    ],
)
async def test_invalid_arguments_are_rejected(test, kind, words, text):
    with pytest.raises(LinkwrightError) as caught:
        start_tool(test, kind, *words)
    assert text in str(caught.value)
    assert test.graph.node_names() == []


async def test_unknown_parameters_are_reported_once(test):
    start_tool(test, Relay, input_topic="a", lasy=True, robot_model="x")
    assert logged_texts(test, "WARN") == ["'lasy' is not a parameter of this node; did you mean 'lazy'?"]
    assert logged_texts(test, "INFO") == ["parameters that this node does not have are ignored: robot_model"]


@pytest.mark.parametrize(
    ("kind", "words"), [(Relay, ["drive", "cmd_vel"]), (Throttle, ["messages", "drive", "1000.0", "cmd_vel"])]
)
async def test_stop_is_sent_when_velocity_publisher_is_lost(test, kind, words):
    twist = get_message("geometry_msgs/msg/Twist")
    start_tool(test, kind, *words)
    test.node.create_publisher(twist, "drive", 10)
    driven = test.record("/cmd_vel", twist)
    await test.settle()
    driver = RemotePublisher(RemoteTransport(test.graph), "/drive")
    message = twist()
    message.linear.x = 0.3
    driver.send(message)
    driver.disappear()
    await test.settle()
    assert driven.last.linear.x == 0.0
    (line,) = logged_texts(test, "WARN")
    assert line.endswith("was lost (killed, crashed or out of reach): a stop command is sent to '/cmd_vel'")
