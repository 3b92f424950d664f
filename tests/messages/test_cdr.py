"""Messages as bytes.

Rosbags writes the same bytes, and invalid bytes raise an error instead of a crash.
"""

from __future__ import annotations

import contextlib
import struct
import tracemalloc
from importlib.util import find_spec

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from linkwright.messages import (
    Header,
    JointState,
    MessageDataError,
    String,
    Time,
    deserialize,
    get_interface,
    get_message,
    interface_names,
    serialize,
)
from tests.messages.random_messages import random_message, rosbags_object, rosbags_store

OF_ROSBAGS = sorted(rosbags_store().fielddefs) if find_spec("rosbags") else []
ALL_TYPES = sorted(interface_names("msg"))


@pytest.mark.parametrize("name", OF_ROSBAGS)
def test_serialized_bytes_match_rosbags(name):
    for seed in range(6):
        message = random_message(get_message(name), seed)
        serialized = serialize(message)
        assert serialized == bytes(rosbags_store().serialize_cdr(rosbags_object(message), name))
        big_endian = bytes(rosbags_store().serialize_cdr(rosbags_object(message), name, little_endian=False))
        assert deserialize(big_endian, type(message)) == message


@given(name=st.sampled_from(ALL_TYPES), seed=st.integers(0, 2**32))
@settings(max_examples=400, deadline=None)
def test_message_round_trip_is_lossless(name, seed):
    message = random_message(get_message(name), seed)
    data = serialize(message)
    for form in (data, bytearray(data), memoryview(data), data + b"\0\0\0"):
        assert deserialize(form, type(message)) == message


def message_classes(name):
    cls = get_interface(name)
    if hasattr(cls, "Goal"):
        return [cls.Goal, cls.Result, cls.Feedback, cls.Impl.FeedbackMessage, cls.Impl.SendGoalService.Request,
                cls.Impl.SendGoalService.Response, cls.Impl.GetResultService.Response]  # fmt: skip
    return [cls.Request, cls.Response, cls.Event]


@pytest.mark.parametrize("name", interface_names("srv") + interface_names("action"))
def test_service_and_action_parts_round_trip(name):
    for cls in message_classes(name):
        message = random_message(cls, 3)
        assert deserialize(serialize(message), cls) == message


@given(name=st.sampled_from(ALL_TYPES), seed=st.integers(0, 2**32), data=st.data())
@settings(max_examples=600, deadline=None)
def test_corrupted_bytes_are_rejected_or_deserialized(name, seed, data):
    cls = get_message(name)
    raw = bytearray(serialize(random_message(cls, seed)))
    raw[1] = data.draw(st.sampled_from([1, 1, 1, 0]))
    for _ in range(data.draw(st.integers(1, 6))):
        raw[data.draw(st.integers(4, max(4, len(raw) - 1))) % len(raw)] = data.draw(
            st.sampled_from([0, 1, 127, 128, 255])
        )
    del raw[data.draw(st.integers(4, len(raw))) :]
    try:
        message = deserialize(bytes(raw), cls)
    except MessageDataError:
        return
    # A message that was read can be written and read again.
    assert type(deserialize(serialize(message), cls)) is cls


@pytest.mark.parametrize("name", ["sensor_msgs/msg/JointState", "tf2_msgs/msg/TFMessage", "nav_msgs/msg/Odometry",
                                  "rcl_interfaces/msg/ParameterEvent", "visualization_msgs/msg/MarkerArray",
                                  "sensor_msgs/msg/PointCloud2", "test_msgs/msg/MultiNested"])  # fmt: skip
def test_truncated_message_is_rejected(name):
    cls = get_message(name)
    data = serialize(random_message(cls, 5))
    for length in range(0, len(data) - 1, max(1, len(data) // 400)):
        with pytest.raises(MessageDataError):
            deserialize(data[:length], cls)


@pytest.mark.parametrize(
    "name",
    [
        "std_msgs/msg/String",
        "std_msgs/msg/Float64MultiArray",
        "sensor_msgs/msg/Image",
        "diagnostic_msgs/msg/DiagnosticArray",
        "rcl_interfaces/msg/ParameterValue",
    ],
)
def test_length_beyond_data_allocates_no_memory(name):
    cls = get_message(name)
    data = serialize(cls())
    tracemalloc.start()
    for offset in range(4, len(data) - 3):
        for length in (0x7FFFFFFF, 0xFFFFFFFF, 0x10000000):
            malformed = data[:offset] + struct.pack("<I", length) + data[offset + 4 :]
            with contextlib.suppress(MessageDataError):
                deserialize(malformed, cls)
    _, peak_bytes = tracemalloc.get_traced_memory()
    tracemalloc.stop()
    assert peak_bytes < 2_000_000


class TestRejectedBytes:
    def refused(self, data, cls):
        with pytest.raises(MessageDataError) as caught:
            deserialize(data, cls)
        assert caught.value.diagnostics[0].code == "MSG201"
        return caught.value.diagnostics[0].message

    def test_malformed_encapsulation_header_is_rejected(self):
        assert "0 bytes are too few for the header" in self.refused(b"", String)
        assert "its header declares the encoding CDR2_LE" in self.refused(b"\0\7\0\0\1\0\0\0\0", String)
        assert "it begins with 48 69 21 21" in self.refused(b"Hi!!", String)

    def test_string_that_is_not_utf_8_is_rejected(self):
        assert "a string is not UTF-8" in self.refused(b"\0\1\0\0\3\0\0\0\xff\xfe\0", String)

    def test_string_without_terminator_is_rejected(self):
        assert "the end of a string does not match its length" in self.refused(b"\0\1\0\0\2\0\0\0ab", String)

    def test_invalid_bool_is_rejected(self):
        assert "a bool has the invalid value 2" in self.refused(b"\0\1\0\0\2", get_message("std_msgs/msg/Bool"))
        raw = serialize(get_message("test_msgs/msg/UnboundedSequences")(bool_values=[True, False]))
        assert "a bool has the invalid value 7" in self.refused(raw[:8] + b"\7" + raw[9:],
                                                   get_message("test_msgs/msg/UnboundedSequences"))  # fmt: skip

    def test_sequence_beyond_its_bound_is_rejected(self):
        cls = get_message("rcl_interfaces/msg/ParameterDescriptor")
        data = bytearray(serialize(cls()))
        data[-4:] = b"\2\0\0\0"
        assert "'integer_range' is longer than its maximum length of 1" in self.refused(bytes(data), cls)
        cls = get_message("type_description_interfaces/msg/FieldType")
        text = b"\0\1\0\0" + bytes(24) + struct.pack("<I", 301) + b"a" * 300 + b"\0"
        assert "'nested_type_name' is longer than its maximum length of 255" in self.refused(text, cls)


def test_string_of_length_zero_is_empty():
    # Some writers omit the NUL of an empty string.
    assert deserialize(b"\0\1\0\0\0\0\0\0", String) == String()


def test_invalid_field_value_is_named_by_serialize():
    message = JointState(name=["a"])
    message.name.append(3)
    with pytest.raises(MessageDataError, match="cannot be serialized: The 'name' field must be a set or sequence"):
        serialize(message)
    message = get_message("nav_msgs/msg/Path")()
    message.poses.append(get_message("geometry_msgs/msg/PoseStamped")())
    message.poses[0].pose.position._x = "far"
    with pytest.raises(MessageDataError, match=r"The 'poses\[0\].pose.position.x' field must be of type 'float'"):
        serialize(message)
    message = get_message("test_msgs/msg/Arrays")()
    message.string_values.append("one too many")
    with pytest.raises(MessageDataError, match="with length 3"):
        serialize(message)
    with pytest.raises(MessageDataError, match="'int' is not a message class"):
        serialize(5)


def test_out_of_range_value_is_not_wrapped():
    stamp = Time()
    stamp._nanosec = -1
    with pytest.raises(MessageDataError, match="must be an unsigned integer"):
        serialize(stamp)


def test_wide_strings_use_four_bytes_per_utf_16_unit():
    cls = get_message("example_interfaces/msg/WString")
    written = b"\0\1\0\0\3\0\0\0a\0\0\0\x3d\xd8\0\0\x00\xde\0\0"  # as Jazzy's rclpy with Fast DDS writes it
    assert serialize(cls(data="a😀")) == written
    assert deserialize(written, cls).data == "a😀"
    assert deserialize(b"\0\0\0\0\0\0\0\2\0\0\0a\0\0\0b", cls).data == "ab"
    assert deserialize(b"\0\1\0\0\0\0\0\0", cls).data == ""
    with pytest.raises(
        MessageDataError, match="a wide string contains the UTF-16 unit 65536, but units are at most 65535"
    ):
        deserialize(b"\0\1\0\0\1\0\0\0\0\0\1\0", cls)
    with pytest.raises(MessageDataError, match="in the middle of the message"):
        deserialize(b"\0\1\0\0\2\0\0\0a\0\0\0", cls)


def test_empty_message_is_one_byte():
    cls = get_message("std_msgs/msg/Empty")
    assert serialize(cls()) == b"\0\1\0\0\0"
    assert deserialize(b"\0\1\0\0\0", cls) == cls()


def test_non_contiguous_arrays_are_serialized_by_value():
    cls = get_message("geometry_msgs/msg/PoseWithCovariance")
    numbers = np.arange(72, dtype=np.float64)
    assert serialize(cls(covariance=numbers[::2])) == serialize(cls(covariance=numbers[::2].copy()))
    square = cls()
    square.covariance = np.arange(36.0).reshape(6, 6).T
    assert deserialize(serialize(square), cls).covariance.tolist() == np.arange(36.0).reshape(6, 6).T.ravel().tolist()


def test_deserialized_messages_are_mutable_and_independent():
    data = serialize(
        JointState(header=Header(stamp=Time(sec=1, nanosec=2), frame_id="a"), name=["x", "y"], position=[1.0, 2.0])
    )
    first, second = deserialize(data, JointState), deserialize(data, JointState)
    first.name.append("z")
    first.position[0] = 5.0
    assert second.name == ["x", "y"]
    assert second.position[0] == 1.0
    assert deserialize(data, JointState).name == ["x", "y"]


def test_cached_names_survive_other_names_in_between():
    data = serialize(JointState(name=["a", "b"]))
    other = serialize(JointState(name=["a", "c"]))
    longer = serialize(JointState(name=["a", "b", "d" * 100]))
    for _ in range(3):
        assert deserialize(data, JointState).name == ["a", "b"]
        assert deserialize(other, JointState).name == ["a", "c"]
        assert deserialize(longer, JointState).name == ["a", "b", "d" * 100]


def test_deeply_nested_types_round_trip(tmp_path, interface_package):
    for depth in range(12):
        field_lines = f"Level{depth + 1}[] below\nLevel{depth + 1} one" if depth < 11 else "int8 n"
        interface_package.write("msg", f"Level{depth}", f"bool b\n{field_lines}\n")
    cls = get_message(f"{interface_package.name}/msg/Level0")
    lower = [get_message(f"{interface_package.name}/msg/Level{depth}") for depth in range(12)]
    message = cls(below=[lower[1](b=True, below=[lower[2]()])])
    assert deserialize(serialize(message), cls) == message
