"""Content filters of subscriptions: their expressions, and the messages that pass."""

from contextlib import suppress

import pytest
from hypothesis import given
from hypothesis import strategies as st

from linkwright.graph.endpoints.content_filter import ContentFilter, ContentFilterError, ContentFilterOptions
from linkwright.graph.qos.profile import DESCRIPTION_QOS
from linkwright.messages import Header, JointState, String, get_message, serialize

Bool = get_message("std_msgs/msg/Bool")
JOINT_STATE = JointState(header=Header(frame_id="base_link"), name=["left", "right"], position=[0.5, -2.0])


def filter_accepts(expression, *parameters, message=JOINT_STATE):
    return ContentFilter(ContentFilterOptions(expression, parameters), type(message)).accepts(message)


@pytest.mark.parametrize(
    ("expression", "parameters"),
    [
        ("position[0] > 0", ()),
        ("position[0]=0.5", ()),
        ("position[1] < -1.5e0", ()),
        ("position[1] <> %0", ("3",)),
        ("0 < position[0]", ()),
        ("header.frame_id = 'base_link'", ()),
        ("header.frame_id = %0", ("'base_link'",)),
        ("header.frame_id = %0", ("base_link",)),
        ("header.frame_id like 'base%'", ()),
        ("header.frame_id LIKE 'base?lin_'", ()),
        ("header.frame_id MATCH '[a-z]+_link'", ()),
        ("name[1] = 'right'", ()),
        ("position[0] BETWEEN 0 AND 1", ()),
        ("position[0] NOT BETWEEN 1 AND 0x10", ()),
        ("NOT position[0] > 1", ()),
        ("position[0] > 1 OR position[1] < 0 AND header.stamp.sec = 0", ()),
        ("(position[0] > 1 OR position[1] < 0) AND NOT (header.stamp.sec = 1)", ()),
    ],
)
def test_filter_accepts_true_conditions(expression, parameters):
    assert filter_accepts(expression, *parameters)
    assert not filter_accepts(f"NOT ({expression})", *parameters)


@pytest.mark.parametrize("expression", ["position[7] > 0", "position > 0", "header.frame_id > 5 AND name[9] = 'x'"])
def test_filter_rejects_incomparable_values(expression):
    assert not filter_accepts(expression)


def test_filter_compares_booleans_and_numeric_strings():
    assert filter_accepts("data = TRUE", message=Bool(data=True))
    assert not filter_accepts("data = %0", "false", message=Bool(data=True))
    assert filter_accepts("data = %0", "5", message=String(data="5"))


@pytest.mark.parametrize(
    ("expression", "problem"),
    [
        ("posision[0] > 0", "sensor_msgs/msg/JointState has no field 'posision\\[0\\]'"),
        ("header.frame = 'a'", "has no field 'header.frame'"),
        ("position[0]", "a comparison is missing before 'its end'"),
        ("position[0] > ", "a field or value is missing before 'its end'"),
        ("position[0] > %1", "there is no parameter %1"),
        ("(position[0] > 1", "'\\)' is missing before 'its end'"),
        ("position[0] BETWEEN 1 OR 2", "'AND' is missing before 'OR'"),
        ("position[0] > 1 1", "unexpected '1'"),
        ("position[0] ! 1", "'! 1' cannot be parsed"),
        ("name[0] MATCH '('", "'\\(' is not a regular expression"),
    ],
)
def test_invalid_filter_expressions_are_rejected(expression, problem):
    with pytest.raises(ContentFilterError, match=problem):
        filter_accepts(expression)


@given(st.text(alphabet="position[0]headr.fm_ ()<>=!%'\"ANDORTBEWLIKM123.-"))
def test_random_filter_expressions_are_parsed_or_rejected(expression):
    with suppress(ContentFilterError):
        assert filter_accepts(expression) in (True, False)


async def test_latched_messages_are_filtered(graph):
    node = graph.create_node("node")
    publisher = node.create_publisher(String, "topic", DESCRIPTION_QOS)
    messages = []
    for text in ("a", "b"):
        publisher.publish(String(data=text))
    options = ContentFilterOptions("data = 'a'")
    node.create_subscription(String, "topic", messages.append, DESCRIPTION_QOS, content_filter_options=options)
    await graph.settle()
    assert messages == []
    publisher.publish(serialize(String(data="a")))
    await graph.settle()
    assert messages == [String(data="a")]


async def test_invalid_filter_creates_no_subscription(graph):
    node = graph.create_node("node")
    with pytest.raises(ContentFilterError):
        node.create_subscription(String, "topic", print, 1, content_filter_options=ContentFilterOptions("dat = 1"))
    assert not list(graph.bus.subscriptions("/topic"))
