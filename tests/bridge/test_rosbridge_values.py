"""Messages as JSON and CBOR, fragments and patterns of names, without a connection."""

from __future__ import annotations

import base64
import io
import json
import math
import struct
from pathlib import Path

import numpy as np
import pytest

from linkwright.bridge.rosbridge import cbor
from linkwright.bridge.rosbridge.encodings import MessageEncoder, encode_raw
from linkwright.bridge.rosbridge.fragments import Fragments, split_message
from linkwright.bridge.rosbridge.globs import Globs
from linkwright.bridge.rosbridge.requests import Request, RequestError, full_type_name, split_numbered_name
from linkwright.bridge.rosbridge.values import from_json_arguments, from_json_values, to_json_values
from linkwright.messages import Time, deserialize, get_message

RECORDED = json.loads((Path(__file__).parent / "rosbridge_messages.json").read_text(encoding="utf-8"))
"""Messages with the texts that rosbridge_library 2.0 sends for them, recorded with rclpy of Jazzy."""
NOW = Time(sec=12, nanosec=34)


def read(values, type_name: str):
    return from_json_values(values, get_message(type_name), lambda: NOW)


@pytest.mark.parametrize("recorded", RECORDED, ids=[f"{index}-{entry['type']}" for index, entry in enumerate(RECORDED)])
def test_json_is_the_text_that_rosbridge_sends(recorded):
    message = deserialize(bytes.fromhex(recorded["cdr"]), get_message(recorded["type"]))
    text = MessageEncoder().encode("/topic", message, "none")
    assert text == recorded["json"]
    if "null" not in text:  # NaN and infinity do not come back
        assert read(json.loads(text)["msg"], recorded["type"]) == message


def test_numbers_that_json_lacks_are_null_also_in_fixed_arrays():
    message = get_message("nav_msgs/msg/Odometry")()
    message.twist.twist.linear.x = math.nan
    message.pose.covariance[3] = math.inf
    values = to_json_values(message)
    assert values["twist"]["twist"]["linear"]["x"] is None
    assert values["pose"]["covariance"][:5] == [0.0, 0.0, 0.0, None, 0.0]
    assert json.dumps(values, allow_nan=False)


def test_null_is_nan_for_a_client():
    scan = read({"ranges": [1, None], "range_max": None}, "sensor_msgs/msg/LaserScan")
    assert scan.ranges[0] == 1.0
    assert math.isnan(scan.ranges[1])
    assert math.isnan(scan.range_max)


def test_bytes_are_base64_or_a_list():
    image = "sensor_msgs/msg/Image"
    assert bytes(read({"data": base64.b64encode(b"abc").decode()}, image).data) == b"abc"
    assert bytes(read({"data": [1, 2]}, image).data) == b"\x01\x02"
    assert to_json_values(read({"uuid": [7] * 16}, "unique_identifier_msgs/msg/UUID")) == {
        "uuid": base64.b64encode(bytes([7] * 16)).decode()
    }


def test_single_bytes_are_numbers():
    status = read({"level": 2, "name": "motor"}, "diagnostic_msgs/msg/DiagnosticStatus")
    assert status.level == b"\x02"
    assert to_json_values(status)["level"] == 2


def test_headers_without_stamp_have_the_current_time():
    imu = "sensor_msgs/msg/Imu"
    assert read({}, imu).header.stamp == NOW
    assert read({"header": {"frame_id": "imu"}}, imu).header.stamp == NOW
    assert read({"header": {"stamp": {"sec": 1, "nanosec": 2}}}, imu).header.stamp == Time(sec=1, nanosec=2)
    assert read({"header": {"stamp": {"secs": 1, "nsecs": 2}}}, imu).header.stamp == Time(sec=1, nanosec=2)
    assert read({"clock": "now"}, "rosgraph_msgs/msg/Clock").clock == NOW
    assert read({"clock": {}}, "rosgraph_msgs/msg/Clock").clock == Time()


def test_whole_numbers_are_accepted_for_floats_and_integers():
    assert read({"linear": {"x": 1}}, "geometry_msgs/msg/Twist").linear.x == 1.0
    assert read({"data": 5.0}, "std_msgs/msg/Int32").data == 5
    assert read({"data": 2**53 + 1}, "std_msgs/msg/Int64").data == 2**53 + 1


@pytest.mark.parametrize(
    ("values", "type_name", "reason"),
    [
        ({"liner": {}}, "geometry_msgs/msg/Twist", "geometry_msgs/msg/Twist does not have a field liner"),
        ({"linear": {"q": 1}}, "geometry_msgs/msg/Twist", "does not have a field linear.q"),
        ({"linear": 3}, "geometry_msgs/msg/Twist", "field linear of geometry_msgs/msg/Twist requires a JSON object"),
        ({"data": "3"}, "std_msgs/msg/Int32", "requires int32"),
        ({"data": 3.5}, "std_msgs/msg/Int32", "requires int32"),
        ({"data": True}, "std_msgs/msg/Int32", "requires int32"),
        ({"data": 1}, "std_msgs/msg/Bool", "requires boolean"),
        ({"data": 300}, "std_msgs/msg/UInt8", "data"),
        ({"data": None}, "std_msgs/msg/String", "requires string"),
        ({"name": "arm"}, "sensor_msgs/msg/JointState", "field name of sensor_msgs/msg/JointState requires a list"),
        ({"data": "no base64!"}, "sensor_msgs/msg/Image", "field data"),
        ({"k": [1, 2]}, "sensor_msgs/msg/CameraInfo", "field k"),
        ([1], "std_msgs/msg/String", "std_msgs/msg/String requires a JSON object"),
    ],
)
def test_wrong_values_are_named(values, type_name, reason):
    with pytest.raises(RequestError) as error:
        read(values, type_name)
    assert reason in str(error.value)


def test_arguments_of_services_may_be_a_list():
    request_class = get_message("std_srvs/srv/SetBool_Request")
    assert from_json_arguments([True], request_class, lambda: NOW).data is True
    assert from_json_arguments({"data": True}, request_class, lambda: NOW).data is True
    assert from_json_arguments(None, request_class, lambda: NOW).data is False


# --- CBOR and PNG ------------------------------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("value", "encoded"),
    [  # examples of RFC 8949
        (0, "00"),
        (23, "17"),
        (24, "1818"),
        (1000, "1903e8"),
        (1000000, "1a000f4240"),
        (1000000000000, "1b000000e8d4a51000"),
        (-1, "20"),
        (-1000, "3903e7"),
        (1.1, "fb3ff199999999999a"),
        (False, "f4"),
        (True, "f5"),
        (None, "f6"),
        (b"\x01\x02", "420102"),
        ("ü", "62c3bc"),
        ("\ud800", "613f"),  # half of a character, which JSON can contain
        ([1, [2, 3]], "8201820203"),
        ({"a": 1, "b": [2, 3]}, "a26161016162820203"),
    ],
)
def test_cbor_is_that_of_its_standard(value, encoded):
    assert cbor.encode(value).hex() == encoded


def test_arrays_of_numbers_are_tagged_in_cbor():
    state = get_message("sensor_msgs/msg/JointState")(name=["a"], position=[1.5, -2.0])
    data = cbor.encode(state)
    assert b"\x68position\xd8\x56\x50" + struct.pack("<2d", 1.5, -2.0) in data
    assert b"\x64name\x81\x61a" in data
    info = get_message("sensor_msgs/msg/CameraInfo")(k=[float(number) for number in range(9)])
    assert b"\x61k\xd8\x56\x58\x48" + struct.pack("<9d", *range(9)) in cbor.encode(info)
    image = get_message("sensor_msgs/msg/Image")(data=[1, 2, 3])
    assert b"\x64data\x43\x01\x02\x03" in cbor.encode(image)


def test_raw_messages_have_the_time_of_their_reception():
    data = encode_raw("/a", b"\x00\x01", NOW)
    assert data == cbor.encode({"op": "publish", "topic": "/a", "msg": {"secs": 12, "nsecs": 34, "bytes": b"\x00\x01"}})


def test_cbor_of_other_types_is_refused():
    with pytest.raises(TypeError):
        cbor.encode(object())
    with pytest.raises(TypeError):
        cbor.encode(2**64)


@pytest.mark.parametrize("length", [0, 1, 100, 5000])
def test_png_contains_the_text(length):
    image_module = pytest.importorskip("PIL.Image")
    encoder = MessageEncoder()
    message = get_message("std_msgs/msg/String")(data="ü" * length)
    outer = json.loads(encoder.encode("/a", message, "png"))
    assert outer["op"] == "png"
    pixels = np.asarray(image_module.open(io.BytesIO(base64.b64decode(outer["data"]))))
    assert pixels.shape[2] == 3
    assert json.loads(pixels.tobytes().decode()) == json.loads(encoder.encode("/a", message, "none"))


def test_each_form_of_a_message_is_encoded_once():
    encoder = MessageEncoder()
    message = get_message("std_msgs/msg/String")(data="a")
    text = encoder.encode("/a", message, "none")
    assert encoder.encode("/a", message, "none") is text
    encoder.drop("/a")
    assert encoder.encode("/a", message, "none") is not text


# --- fragments -----------------------------------------------------------------------------------------------------


class Clock:
    now = 0.0

    def __call__(self) -> float:
        return self.now


def fragment(number: int, total: int, data: str = "x", identity: str = "a") -> Request:
    return Request(id=identity, num=number, total=total, data=data)


def test_fragments_in_any_order_give_the_message():
    text = json.dumps({"op": "publish", "data": "ü" * 100})
    parts = [Request(json.loads(part)) for part in split_message(text, 30, "call")]
    assert all(len(part["data"]) <= 30 and part["id"] == "call" for part in parts)
    fragments = Fragments(1.0, 10_000, Clock())
    results = [fragments.add(part) for part in reversed(parts)]
    assert results[:-1] == [None] * (len(parts) - 1)
    assert results[-1] == text


def test_short_messages_are_not_split():
    assert split_message("abc", 3) == ("abc",)
    assert split_message("abc", 0) == ("abc",)


def test_number_of_fragments_is_limited():
    text = "x" * 100_000
    parts = [json.loads(part) for part in split_message(text, 1)]
    assert len(parts) <= 1000
    assert "".join(part["data"] for part in parts) == text


def test_messages_without_id_have_different_ids_in_their_fragments():
    first, second = (json.loads(split_message("abcd", 2)[0])["id"] for _ in range(2))
    assert first != second


def test_old_fragments_are_dropped():
    clock = Clock()
    fragments = Fragments(1.0, 100, clock)
    assert fragments.add(fragment(0, 2, "old")) is None
    clock.now = 1.5
    assert fragments.add(fragment(1, 2, "b")) is None
    assert fragments.add(fragment(0, 2, "a")) == "ab"


@pytest.mark.parametrize(
    "wrong",
    [
        fragment(2, 2),
        fragment(-1, 2),
        fragment(0, 10**9),
        Request(id="a", num=0, total=2),
        Request(id="a", num=0, total="2", data="x"),
        Request(num=0, total=2, data="x"),
        fragment(1, 2, "x" * 101),
        fragment(0, 3),
    ],
)
def test_wrong_fragments_are_refused(wrong):
    fragments = Fragments(1.0, 100, Clock())
    fragments.add(fragment(0, 2))
    with pytest.raises(RequestError):
        fragments.add(wrong)


def test_incomplete_messages_are_limited():
    fragments = Fragments(1.0, 100, Clock())
    for number in range(32):
        fragments.add(fragment(0, 2, identity=str(number)))
    with pytest.raises(RequestError):
        fragments.add(fragment(0, 2, identity="more"))


# --- names ---------------------------------------------------------------------------------------------------------


@pytest.mark.parametrize("patterns", ["[/camera/*, '/odom']", "/camera/*,/odom", ["/camera/*", "/odom"]])
def test_patterns_select_names(patterns):
    globs = Globs(patterns)
    assert globs.match("/camera/image/raw")
    assert globs.match("/odom")
    assert not globs.match("/odometry")
    assert not globs.match("/cmd_vel")


def test_no_patterns_select_all_names():
    for patterns in ("", "[]", "[*]", []):
        assert Globs(patterns).match("/anything")
    assert Globs("[/a]", ["/rosapi/*"]).match("/rosapi/topics")
    assert Globs("", ["/rosapi/*"]).match("/b")


def test_short_names_of_types_are_completed():
    assert full_type_name("std_msgs/String", "msg") == "std_msgs/msg/String"
    assert full_type_name("std_msgs/msg/String", "msg") == "std_msgs/msg/String"
    assert full_type_name("String", "msg") == "String"


def test_old_names_with_ids_are_split():
    assert split_numbered_name("/a#3", None) == ("/a", "3")
    assert split_numbered_name("/a#3", "x") == ("/a", "x")
    assert split_numbered_name("/a", None) == ("/a", None)
