"""rosbridge_websocket with ``bson_only_mode``, and the BSON that it reads and writes."""

from __future__ import annotations

import math
import struct
from contextlib import suppress

import pytest
from hypothesis import given
from hypothesis import strategies as st

from linkwright.bridge.rosbridge import bson
from linkwright.messages import String, get_message
from tests.bridge.rosbridge_client import add_set_bool, rosbridge_setup
from tests.waiting import eventually

TEXTS = st.text(st.characters(blacklist_categories=["Cs"], blacklist_characters="\0"))
VALUES = st.recursive(
    st.none()
    | st.booleans()
    | st.integers(-(1 << 63), (1 << 63) - 1)
    | st.floats(allow_nan=False)
    | TEXTS
    | st.binary(),
    lambda values: st.lists(values, max_size=3) | st.dictionaries(TEXTS, values, max_size=3),
    max_leaves=10,
)


def test_document_of_the_specification():
    expected = bytes.fromhex("160000000268656c6c6f0006000000776f726c640000")
    assert bson.encode({"hello": "world"}) == expected
    assert bson.decode(expected) == {"hello": "world"}


@given(VALUES)
def test_values_are_read_as_they_were_written(value):
    assert bson.decode(bson.encode({"value": value})) == {"value": value}


@given(st.binary(max_size=60))
def test_arbitrary_bytes_are_read_or_refused(content):
    for data in (content, struct.pack("<i", len(content) + 5) + content + b"\0"):
        with suppress(ValueError):
            bson.decode(data)


@pytest.mark.parametrize(("value", "reason"), [(1 << 63, "64 bits"), (object(), "object"), ({"a\0b": 1}, "null")])
def test_values_that_bson_lacks_are_errors(value, reason):
    with pytest.raises(TypeError, match=reason):
        bson.encode({"value": value})


def test_deep_nesting_is_refused():
    value: dict = {}
    for _ in range(150):
        value = {"a": value}
    with pytest.raises(ValueError, match="nested"):
        bson.decode(bson.encode(value))


def test_messages_have_binary_for_bytes_and_keep_infinite_numbers():
    image = get_message("sensor_msgs/msg/Image")(width=2, data=b"\x01\x02")
    written = bson.decode(bson.encode({"msg": image}))["msg"]
    assert (written["width"], written["data"]) == (2, b"\x01\x02")
    assert written["header"]["stamp"] == {"sec": 0, "nanosec": 0}
    scan = get_message("sensor_msgs/msg/LaserScan")(ranges=[1.0, math.inf])
    assert bson.decode(bson.encode({"msg": scan}))["msg"]["ranges"] == [1.0, math.inf]


async def test_topics_and_services_are_used_with_bson():
    async with rosbridge_setup(bson_only_mode=True) as setup, setup.client() as client:

        async def send(**fields) -> None:
            await client.socket.send_bytes(bson.encode(fields))

        add_set_bool(setup)
        await send(op="call_service", service="/switch", args={"data": True}, id="c")
        response = bson.decode(await client.next())
        assert (response["values"], response["id"]) == ({"success": True, "message": "done"}, "c")

        publisher = setup.node.create_publisher(String, "/chatter", 10)
        for compression in ("none", "png"):
            await send(op="subscribe", topic="/chatter", compression=compression)
            await eventually(lambda: publisher.get_subscription_count() == 1)
            publisher.publish(String(data=compression))
            message = bson.decode(await client.next())
            assert message == {"op": "publish", "topic": "/chatter", "msg": {"data": compression}}

        received = []
        setup.node.create_subscription("sensor_msgs/msg/Image", "/image", received.append, 10)
        await send(op="advertise", topic="/image", type="sensor_msgs/Image")
        await send(op="publish", topic="/image", msg={"width": 2, "data": b"\x01\x02"})
        await eventually(lambda: received)
        assert bytes(received[0].data) == b"\x01\x02"

        await client.socket.send_bytes(b"nonsense")
        status = bson.decode(await client.next())
        assert (status["level"], "not BSON" in status["msg"]) == ("error", True)
