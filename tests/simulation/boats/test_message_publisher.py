"""Messages of a description are published at their times."""

from __future__ import annotations

import pytest

from linkwright.testing import Recording
from tests.simulation.fluids.server import running_server
from tests.simulation.test_plugins import SECOND_NS


def publisher_plugin(*messages: str) -> str:
    return f'<plugin name="vrx::PublisherPlugin" filename="libPublisherPlugin.so">{"".join(messages)}</plugin>'


def message(attributes: str, text: str = "data: 2") -> str:
    return f"<message {attributes}>{text}</message>"


async def test_messages_are_published_once_or_periodically_and_again_after_reset():
    plugin = publisher_plugin(
        message('type="gz.msgs.Double" topic="/once"'),
        message('type="gz.msgs.Double" topic="later" at="3"'),
        message('type="ignition.msgs.StringMsg" topic="/often" at="1" every="2"', "data: 'ahoy'"),
    )
    async with running_server(plugin) as (server, graph, log):
        once, later, often = (Recording(graph, server.node, topic) for topic in ("/once", "/later", "/often"))
        await graph.settle()
        for count in (1, 2):
            server.advance(2 * SECOND_NS)
            await graph.settle()
            assert [len(item) for item in (once, later, often)] == [count, count - 1, 4 * count - 3]
            server.advance(4 * SECOND_NS)
            await graph.settle()
            server.advance(2 * SECOND_NS)
            await graph.settle()
            assert [len(item) for item in (once, later, often)] == [count, count, 4 * count]
            assert (once.last.data, often.last.data) == (2.0, "ahoy")
            server.reset()
        assert not log


async def test_parameters_have_types_of_ros():
    text = (
        'params { key: "a" value { type: DOUBLE double_value: 1 } } params { key: "b" value { int_value: 2 } }'
        'params { key: "c" value { string_value: "PMS" } } params { key: "d" value { bool_value: true } }'
        'params { key: "e" value { vector3d_value { x: 1 } } }'
    )
    plugin = publisher_plugin(message('type="gz.msgs.Param" topic="/sea"', text))
    async with running_server(plugin) as (server, graph, log):
        recording = Recording(graph, server.node, "/sea")
        await graph.settle()
        server.advance(SECOND_NS)
        await graph.settle()
        values = {item.name: item.value for item in recording.last.params}
        assert {name: value.type for name, value in values.items()} == {"a": 3, "b": 2, "c": 4, "d": 1}
        assert (values["a"].double_value, values["b"].integer_value) == (1.0, 2)
        assert (values["c"].string_value, values["d"].bool_value) == ("PMS", True)
        assert not log


@pytest.mark.parametrize(
    ("text", "reason"),
    [
        (message('type="gz.msgs.Wind" topic="/t"', ""), "the type 'gz.msgs.Wind' has no ROS type"),
        (message('type="gz.msgs.Double"'), "<message> needs a topic"),
        (message('type="gz.msgs.Double" topic="/t" at="-1"'), "'at' must be a time in seconds"),
        (message('type="gz.msgs.Double" topic="/t" every="often"'), "'every' must be a time in seconds"),
        (message('type="gz.msgs.Double" topic="/t"', "data {"), "is not a message in the text format"),
        (message('type="gz.msgs.Param" topic="/t"', "params: 3"), "is not a message in the text format"),
    ],
)
async def test_invalid_messages_are_reported(text, reason):
    async with running_server(publisher_plugin(text)) as (_, __, log):
        assert any(reason in record.text for record in log), [record.text for record in log]
