"""Messages from YAML values, as ``ros2 topic pub`` takes them."""

from __future__ import annotations

from array import array

import numpy as np
import pytest
import yaml
from hypothesis import given, settings
from hypothesis import strategies as st

from linkwright.messages import (
    FieldValueError,
    JointState,
    Time,
    get_message,
    interface_names,
    set_fields,
    to_dict,
    to_yaml,
)
from tests.messages.random_messages import random_message


def make_message(message_class, values):
    message = message_class()
    set_fields(message, values)
    return message


@given(name=st.sampled_from(interface_names("msg")), seed=st.integers(0, 1000))
@settings(max_examples=150, deadline=None)
def test_field_values_round_trip_through_yaml(name, seed):
    message = random_message(get_message(name), seed)
    assert make_message(type(message), to_dict(message)) == message
    assert make_message(type(message), yaml.safe_load(to_yaml(message))) == message


def test_values_are_converted_to_field_types():
    message = make_message(JointState, {"header": {"frame_id": 3, "stamp": {"sec": "5"}}, "position": [1, "2.5", True]})
    assert message.header.frame_id == "3"
    assert message.header.stamp.sec == 5
    assert message.position == array("d", [1.0, 2.5, 1.0])
    assert make_message(get_message("std_msgs/msg/Byte"), {"data": 7}).data == b"\7"
    assert make_message(get_message("std_msgs/msg/UInt8MultiArray"), {"data": b"ab"}).data == array("B", b"ab")
    assert make_message(get_message("std_msgs/msg/String"), {"data": True}).data == "true"
    covariance = {"covariance": np.zeros(36)}
    assert make_message(get_message("geometry_msgs/msg/PoseWithCovariance"), covariance).covariance.shape == (36,)


def test_omitted_fields_keep_values_and_nested_ones_get_defaults():
    message = JointState(name=["a"])
    message.header.stamp.sec = 4
    message.header.frame_id = "base"
    assert set_fields(message, {"header": {"frame_id": "map"}}) == []
    assert message.name == ["a"]
    assert (message.header.frame_id, message.header.stamp.sec) == ("map", 0)
    assert make_message(JointState, {"header": message.header}).header is message.header


def test_header_auto_sets_stamp_when_sent():
    message = get_message("geometry_msgs/msg/PoseStamped")()
    (set_stamp,) = set_fields(message, {"header": "auto"}, expand_header_auto=True)
    set_stamp(Time(sec=7, nanosec=8))
    assert message.header.stamp == Time(sec=7, nanosec=8)
    array_message = get_message("visualization_msgs/msg/MarkerArray")()
    values = {"markers": [{"header": {"stamp": "now", "frame_id": "a"}}, {"header": "auto"}]}
    setters = set_fields(array_message, values, expand_header_auto=True, expand_time_now=True)
    for setter in setters:
        setter(Time(sec=9))
    assert [marker.header.stamp.sec for marker in array_message.markers] == [9, 9]
    assert array_message.markers[0].header.frame_id == "a"
    with pytest.raises(FieldValueError):
        set_fields(message, {"header": "auto"})


@pytest.mark.parametrize(
    ("name", "values", "code", "message", "hint"),
    [
        ("JointState", {"positon": [1]}, "MSG301", "JointState has no field 'positon'", "did you mean 'position'?"),
        ("JointState", {"header": {"stmp": 1}}, "MSG301", "Header ('header') has no field 'stmp'", "'stamp'"),
        ("JointState", {"xyz": 1}, "MSG301", "has no field 'xyz'", "its fields: header, name, position"),
        ("JointState", {"name": "a"}, "MSG302", "'name' cannot be 'a'", "it must be a list (string[])"),
        ("JointState", {"effort": ["x"]}, "MSG302", "'effort' cannot be ['x']", "it must be a number"),
        (
            "JointState",
            {"header": 5},
            "MSG302",
            "'header' must be a mapping of fields to values, not 5",
            "stamp, frame_id",
        ),
        (
            "JointState",
            5,
            "MSG302",
            "a sensor_msgs/msg/JointState must be a mapping of fields to values, not 5",
            "its fields: header",
        ),
        ("CameraInfo", {"k": [1, 2]}, "MSG302", "'k' cannot be [1, 2]", "a list of 9 (float64[9]), not of 2 values"),
        ("CameraInfo", {"height": -1}, "MSG302", "'height' cannot be -1", "unsigned integer in [0, 4294967295]"),
        ("CameraInfo", {"height": 1.5}, "MSG302", "'height' cannot be 1.5", "an integer, 0 to 4294967295"),
        ("CameraInfo", {"height": float("inf")}, "MSG302", "'height' cannot be inf", "an integer"),
        ("CameraInfo", {"roi": {"do_rectify": "no"}}, "MSG302", "'roi.do_rectify' cannot be 'no'", "true or false"),
        ("CameraInfo", {"distortion_model": [1]}, "MSG302", "cannot be [1]", "it must be a string"),
        ("PointCloud2", {"fields": [{"offset": "x"}]}, "MSG302", "'fields[0].offset' cannot be 'x'", "an integer"),
        ("PointCloud2", {"fields": [{"ofset": 1}]}, "MSG301", "PointField ('fields[0]') has no", "'offset'"),
        ("PointCloud2", {"data": [256]}, "MSG302", "'data' cannot be [256]", "unsigned integer in [0, 255]"),
        (
            "PointCloud2",
            {"header": None},
            "MSG302",
            "'header' must be a mapping of fields to values, not None",
            "its fields",
        ),
    ],
)
def test_wrong_value_is_reported(name, values, code, message, hint):
    with pytest.raises(FieldValueError) as caught:
        make_message(get_message(f"sensor_msgs/msg/{name}"), values)
    (diagnostic,) = caught.value.diagnostics
    assert diagnostic.code == code
    assert message in diagnostic.message
    assert hint in (diagnostic.hint or "")
    assert isinstance(caught.value, AttributeError if code == "MSG301" else TypeError)


def test_all_wrong_values_are_reported_together():
    with pytest.raises(FieldValueError) as caught:
        make_message(JointState, {"nam": 1, "position": "a", "header": {"stamp": {"sec": "x", "nsec": 1}}})
    assert [diagnostic.code for diagnostic in caught.value.diagnostics] == ["MSG301", "MSG302", "MSG302", "MSG301"]


def test_byte_and_bounded_sequence_values_are_checked():
    with pytest.raises(FieldValueError):
        make_message(get_message("std_msgs/msg/Byte"), {"data": 256})
    with pytest.raises(FieldValueError):
        make_message(get_message("test_msgs/msg/BoundedSequences"), {"bool_values": [True] * 4})
    with pytest.raises(FieldValueError):
        make_message(get_message("test_msgs/msg/Strings"), {"bounded_string_value": "x" * 23})
