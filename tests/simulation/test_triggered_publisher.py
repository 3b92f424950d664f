"""Messages that other messages trigger, and the text format of protobuf."""

from __future__ import annotations

import pytest

from linkwright.messages import get_message
from linkwright.simulation.plugins.protobuf_text import TextFormatError, message_from_fields, parse_fields
from linkwright.testing import Recording
from tests.simulation.fluids.server import running_server
from tests.simulation.test_plugins import SECOND_NS

EMPTY_OUTPUT = '<output type="gz.msgs.Empty" topic="/out"/>'


def trigger_plugin(match: str = "", kind: str = "Boolean", output: str = EMPTY_OUTPUT) -> str:
    return (
        '<plugin name="gz::sim::systems::TriggeredPublisher" filename="gz-sim-triggered-publisher-system">'
        f'<input type="gz.msgs.{kind}" topic="in">{match}</input>{output}</plugin>'
    )


async def count_triggers(text: str, type_name: str, *messages) -> int:
    """Return the number of messages that these messages trigger."""
    async with running_server(text) as (server, graph, log):
        recording = Recording(graph, server.node, "/out")
        publisher = graph.create_node("operator").create_publisher(type_name, "/in", 10)
        for message in messages:
            publisher.publish(message)
        await graph.settle()
        server.advance(SECOND_NS // 10)
        await graph.settle()
        assert not log
        return len(recording)


@pytest.mark.parametrize(
    ("match", "count"),
    [
        ("", 2),
        ("<match/>", 2),
        ("<match>data: true</match>", 1),
        ('<match field="data">true</match>', 1),
        ('<match logic_type="negative">data: true</match>', 1),
        ("<match>data: true</match><match>data: false</match>", 0),
    ],
)
async def test_all_matches_must_hold(match, count):
    message = get_message("std_msgs/msg/Bool")
    messages = (message(data=True), message(data=False))
    assert await count_triggers(trigger_plugin(match), "std_msgs/msg/Bool", *messages) == count


@pytest.mark.parametrize(
    ("match", "count"), [("-7.5", 0), ('tol="0.2">-7.5', 2), ('tol="0.2" logic_type="negative">-7.5', 1)]
)
async def test_numbers_match_within_tolerance(match, count):
    attributes, _, value = match.rpartition(">")
    text = trigger_plugin(f'<match field="vertical_position" {attributes}>{value}</match>', "Altimeter")
    type_name = "ros_gz_interfaces/msg/Altimeter"
    messages = [get_message(type_name)(vertical_position=position) for position in (-7.4, -7.6, -7.8)]
    assert await count_triggers(text, type_name, *messages) == count


async def test_nested_fields_and_numbers_of_32_bits_match():
    twist = get_message("geometry_msgs/msg/Twist")()
    twist.linear.x = 3.0
    text = trigger_plugin('<match field="linear.x">3</match><match>linear: {x: 3.0}</match>', "Twist")
    assert await count_triggers(text, "geometry_msgs/msg/Twist", twist) == 1
    number = get_message("std_msgs/msg/Float32")(data=123456.789)
    assert (
        await count_triggers(trigger_plugin("<match>data: 123456.789</match>", "Float"), "std_msgs/msg/Float32", number)
        == 1
    )


async def test_repeated_field_contains_values_or_equals_all():
    message = get_message("actuator_msgs/msg/Actuators")(velocity=[1.0, 2.0])
    for match, count in (
        ('<match field="velocity">2</match>', 1),
        ('<match field="velocity">3</match>', 0),
        ("<match>velocity: 1 velocity: 2</match>", 1),
        ("<match>velocity: [2, 1]</match>", 0),
    ):
        assert await count_triggers(trigger_plugin(match, "Actuators"), "actuator_msgs/msg/Actuators", message) == count


async def test_outputs_are_published_after_delay():
    output = (
        '<delay_ms>500</delay_ms><output type="gz.msgs.Twist" topic="/a">linear: {x: 3}, angular { z: -1 }</output>'
        '<output type="ignition.msgs.StringMsg" topic="/b">data: "go"</output>'
    )
    async with running_server(trigger_plugin(output=output)) as (server, graph, _):
        twists, texts = (Recording(graph, server.node, topic) for topic in ("/a", "/b"))
        publisher = graph.create_node("operator").create_publisher("std_msgs/msg/Bool", "/in", 10)
        publisher.publish(get_message("std_msgs/msg/Bool")())
        await graph.settle()
        server.advance(SECOND_NS // 10 * 4)
        await graph.settle()
        assert not len(twists)
        server.advance(SECOND_NS // 10 * 2)
        await graph.settle()
        assert (twists.last.linear.x, twists.last.angular.z, texts.last.data) == (3.0, -1.0, "go")
        publisher.publish(get_message("std_msgs/msg/Bool")())
        await graph.settle()
        server.advance(SECOND_NS // 10)
        server.reset()
        server.advance(SECOND_NS)
        await graph.settle()
        assert len(twists) == 1


@pytest.mark.parametrize(
    ("text", "problem"),
    [
        (trigger_plugin(kind="Marker"), "the type 'gz.msgs.Marker' has no ROS type"),
        (trigger_plugin("<match>data: {</match>"), "'data: {' is not a message"),
        (trigger_plugin('<match field="flag">1</match>'), "flag"),
        (trigger_plugin().replace('topic="in"', ""), "<input> needs a topic"),
        ('<plugin name="a" filename="gz-sim-triggered-publisher-system"/>', "<input> is missing"),
        (trigger_plugin(output='<service name="/a"/>'), "calls of a <service> are not simulated"),
    ],
)
async def test_mistakes_are_reported(text, problem):
    async with running_server(text) as (_, __, log):
        assert any(problem in record.text for record in log), [record.text for record in log]


def test_text_format_has_comments_lists_strings_and_words():
    text = "# comment\na: 'it\\'s' b: [1, 2.5]; c < d: true > e: RED, c { d: false }"
    assert parse_fields(text) == {
        "a": ["it's"],
        "b": [1, 2.5],
        "c": [{"d": [True]}, {"d": [False]}],
        "e": ["RED"],
    }


@pytest.mark.parametrize("text", ["a", "a: ", "a: }", "a {", "a: [1", "a: [", "{", ": 1", "a: @", "a b"])
def test_text_with_mistake_is_rejected(text):
    with pytest.raises(TextFormatError):
        parse_fields(text)


def test_repeated_field_with_one_value_is_sequence():
    assert list(message_from_fields("actuator_msgs/msg/Actuators", parse_fields("velocity: 1")).velocity) == [1.0]
