"""The sample messages of `test_msgs`, and the conversions of `rosidl_runtime_py`."""

from __future__ import annotations

from collections import OrderedDict

import pytest
from rclpy.serialization import deserialize_message, serialize_message
from rosidl_runtime_py import message_to_csv, message_to_ordereddict, message_to_yaml
from rosidl_runtime_py.convert import _convert_value
from test_msgs import message_fixtures
from test_msgs.message_fixtures import get_test_msg
from test_msgs.msg import BasicTypes, BoundedSequences
from yaml import safe_load

NAMES = [name.removeprefix("get_msg_") for name in message_fixtures.__all__ if name.startswith("get_msg_")]


@pytest.mark.parametrize("name", NAMES)
def test_sample_messages_survive_serialization(name):
    messages = getattr(message_fixtures, f"get_msg_{name}")()
    assert messages == get_test_msg(type(messages[0]).__name__)
    for message in messages:
        assert deserialize_message(serialize_message(message), type(message)) == message
        assert list(message_to_ordereddict(message)) == list(message.get_fields_and_field_types())
        assert message_to_yaml(message, truncate_length=100)


def test_sample_messages_have_expected_values():
    default, minimal, extreme = message_fixtures.get_msg_basic_types()
    assert default == BasicTypes()
    assert (minimal.bool_value, minimal.byte_value, minimal.uint8_value) == (True, b"\x17", 23)
    assert (extreme.int64_value, extreme.uint64_value) == (-(2**63), 2**64 - 1)
    assert len(message_fixtures.get_msg_bounded_sequences()[2].basic_types_values) == 3
    assert len(message_fixtures.get_msg_empty()) == 1
    assert message_fixtures.get_msg_bounded_sequences()[0] == BoundedSequences()
    with pytest.raises(ValueError, match="no samples of 'Basic'"):
        get_test_msg("Basic")


def test_bytes_are_converted_to_yaml_csv_and_dict():
    data = b"\xce\xbb"
    assert message_to_ordereddict(data) == {"bytes": data}
    assert safe_load(message_to_yaml(data)) == {"bytes": data}
    assert message_to_csv(data) == str(data)


def test_values_are_converted_and_truncated():
    assert [_convert_value(value, truncate_length=0) for value in (5, 4.5, True)] == [5, 4.5, True]
    assert _convert_value(("123", "456", "789"), truncate_length=2) == ("12...", "45...", "...")
    assert _convert_value([1, 2, 3], truncate_length=0) == ["..."]
    assert _convert_value(b"hello", truncate_length=4) == "hell..."
    assert _convert_value(OrderedDict(key="value"), truncate_length=1) == OrderedDict(key="v...")
    assert _convert_value(BasicTypes(), truncate_length=1)["bool_value"] is False
