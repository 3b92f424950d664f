"""TFMessage as objects, as arrays and as bytes: three forms of the same."""

from __future__ import annotations

import copy
import pickle

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from linkwright.messages import (
    Header,
    MessageDataError,
    Quaternion,
    TFMessage,
    Time,
    Transform,
    TransformBatch,
    TransformStamped,
    Vector3,
    deserialize,
    serialize,
)
from tests.messages.random_messages import rosbags_object, rosbags_store

NAMES = st.sampled_from(["", "a", "base_link", "é漢", "link_17", "x" * 40])
NUMBERS = st.floats(allow_nan=False)
STAMPS = st.builds(Time, sec=st.integers(-(2**31), 2**31 - 1), nanosec=st.integers(0, 2**32 - 1))
TRANSFORMS = st.builds(
    TransformStamped,
    header=st.builds(Header, stamp=STAMPS, frame_id=NAMES),
    child_frame_id=NAMES,
    transform=st.builds(
        Transform,
        translation=st.builds(Vector3, x=NUMBERS, y=NUMBERS, z=NUMBERS),
        rotation=st.builds(Quaternion, x=NUMBERS, y=NUMBERS, z=NUMBERS, w=NUMBERS),
    ),
)


def chain(count, seed=0, prefix="link"):
    numbers = np.random.default_rng(seed)
    parents = ("world", *(f"{prefix}_{number}" for number in range(count - 1)))
    children = tuple(f"{prefix}_{number}" for number in range(count))
    return TransformBatch(parents, children, 12_345_678_901, numbers.normal(size=(count, 7)))


@given(st.lists(TRANSFORMS, max_size=12), st.integers(0, 10))
@settings(max_examples=150, deadline=None)
def test_objects_arrays_and_bytes_are_same_message(transforms, changed):
    message = TFMessage(transforms=transforms)
    data = serialize(message)
    assert data == bytes(rosbags_store().serialize_cdr(rosbags_object(message), TFMessage.TYPE_NAME))
    for _ in range(3):  # the first time reads each transform, and the others use the cache
        received = deserialize(data, TFMessage)
        batch = received.batch
        assert batch.children == tuple(transform.child_frame_id for transform in transforms)
        assert batch.stamp_ns == max((transform.header.stamp.nanoseconds for transform in transforms), default=0)
        np.testing.assert_array_equal(batch.poses, message.batch.poses)
        assert serialize(received) == data
        assert received.transforms == transforms
        assert serialize(received) == data
    if transforms:
        # The same frames with different values and stamps.
        other = copy.deepcopy(transforms)
        other[changed % len(other)].transform.translation.x = 17.0
        other[changed % len(other)].header.stamp = Time(sec=1, nanosec=2)
        assert deserialize(serialize(TFMessage(transforms=other)), TFMessage).transforms == other


@pytest.mark.parametrize("count", [0, 1, 5, 6, 7, 20, 100])
def test_batch_serializes_like_its_transforms(count):
    batch = chain(count) if count else TransformBatch((), (), 0, np.zeros((0, 7)))
    data = serialize(TFMessage(batch=batch))
    assert data == serialize(TFMessage(transforms=batch.to_messages()))
    received = deserialize(data, TFMessage)
    assert received == TFMessage(batch=batch)
    batch_read_back = deserialize(data, TFMessage).batch
    assert (batch_read_back.parents, batch_read_back.children, batch_read_back.stamp_ns) == (
        batch.parents,
        batch.children,
        batch.stamp_ns,
    )
    np.testing.assert_array_equal(batch_read_back.poses, batch.poses)


def test_frame_names_of_equal_length_are_distinguished():
    first, second = chain(20, prefix="left"), chain(20, prefix="rite")
    data = [serialize(TFMessage(batch=batch)) for batch in (first, second)]
    assert len(data[0]) == len(data[1])
    for _ in range(3):
        assert deserialize(data[0], TFMessage).batch.children == first.children
        assert deserialize(data[1], TFMessage).batch.children == second.children


def test_repeated_frames_return_same_tuples():
    # Receivers cache results by these tuples.
    data = serialize(TFMessage(batch=chain(20)))
    deserialize(data, TFMessage)
    assert deserialize(data, TFMessage).batch.children is deserialize(data, TFMessage).batch.children


def test_padding_bytes_are_ignored():
    data = bytearray(serialize(TFMessage(batch=chain(20))))
    expected = deserialize(bytes(data), TFMessage)
    deserialize(bytes(data), TFMessage)
    offset = data.index(b"world\0") + 6
    assert data[offset] == 0
    data[offset] = 0xCD
    assert deserialize(bytes(data), TFMessage) == expected


def test_received_message_can_be_modified():
    data = serialize(TFMessage(batch=chain(20)))
    message = deserialize(data, TFMessage)
    message = deserialize(data, TFMessage)
    message.transforms[3].transform.translation.x = 99.0
    assert message.batch.poses[3, 0] == 99.0
    assert deserialize(serialize(message), TFMessage).transforms[3].transform.translation.x == 99.0
    del message.transforms[1:]
    assert len(deserialize(serialize(message), TFMessage).transforms) == 1


def test_damaged_message_with_cached_frames_is_rejected():
    data = serialize(TFMessage(batch=chain(20)))
    deserialize(data, TFMessage)
    with pytest.raises(MessageDataError):
        deserialize(data[:-1], TFMessage)
    with pytest.raises(MessageDataError):
        deserialize(data[:4] + b"\xff\xff\xff\x7f" + data[8:], TFMessage)


def test_tf_message_has_interface_of_rclpy_class():
    message = TFMessage(transforms=[TransformStamped()])
    assert list(TFMessage.__slots__) == ["_transforms"]
    assert message._transforms is message.transforms
    assert TFMessage.get_fields_and_field_types() == {"transforms": "sequence<geometry_msgs/TransformStamped>"}
    assert repr(message).startswith("tf2_msgs.msg.TFMessage(transforms=[geometry_msgs.msg.TransformStamped(")
    with pytest.raises(AssertionError, match="each value of type 'TransformStamped'"):
        message.transforms = [1]
    with pytest.raises(AssertionError, match="Invalid arguments passed to constructor: transfroms"):
        TFMessage(transfroms=[])
    for form in (message, TFMessage(batch=chain(8)), deserialize(serialize(TFMessage(batch=chain(20))), TFMessage)):
        for other in (copy.copy(form), copy.deepcopy(form), pickle.loads(pickle.dumps(form))):
            assert other == form


def test_stamp_beyond_32_bits_is_rejected():
    batch = TransformBatch(("a",), ("b",), 2**63, np.zeros((1, 7)))
    with pytest.raises(MessageDataError, match="The 'sec' field must be an integer in"):
        serialize(TFMessage(batch=batch))


def test_tf_message_can_be_nested(interface_package):
    from linkwright.messages import get_message

    interface_package.write("msg", "Tree", "tf2_msgs/TFMessage tf\ntf2_msgs/TFMessage[] more\nint8 n\n")
    cls = get_message(f"{interface_package.name}/msg/Tree")
    message = cls(tf=TFMessage(batch=chain(9)), more=[TFMessage(batch=chain(2))], n=5)
    assert deserialize(serialize(message), cls) == message
