"""Message classes: constructors, defaults, assignment and comparison."""

from array import array

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from linkwright import messages
from linkwright.messages import (
    Duration,
    Header,
    JointState,
    Quaternion,
    String,
    TFMessage,
    Time,
    Transform,
    TransformBatch,
    TransformStamped,
    Vector3,
)

TYPES = [message_type for name in messages.__all__ if hasattr(message_type := getattr(messages, name), "TYPE_NAME")]


def test_constructor_takes_keyword_arguments_only():
    """As in rclpy, where generated constructors have the signature ``(self, **kwargs)``."""
    with pytest.raises(TypeError, match="takes 1 positional argument but 2 were given"):
        String("hello")
    with pytest.raises(TypeError, match="takes 1 positional argument but 2 were given"):
        TFMessage([])


@pytest.mark.parametrize("message_type", TYPES, ids=lambda message_type: message_type.__name__)
def test_type_name_ends_with_class_name(message_type):
    package, kind, name = message_type.TYPE_NAME.split("/")
    assert package
    assert kind == "msg"
    assert name == message_type.__name__


@pytest.mark.parametrize("message_type", TYPES, ids=lambda message_type: message_type.__name__)
def test_messages_reject_unknown_attributes(message_type):
    with pytest.raises(AttributeError):
        message_type().no_such_field = 1


def test_defaults_match_msg_files():
    assert Quaternion() == Quaternion(x=0.0, y=0.0, z=0.0, w=1.0)
    assert String().data == ""
    assert JointState().name == []
    assert JointState().position == array("d")
    assert JointState().header is not JointState().header
    assert list(JointState.get_fields_and_field_types()) == [
        "header",
        "name",
        "position",
        "velocity",
        "effort",
    ]


@given(st.integers(-(2**31) * 10**9, 2**31 * 10**9 - 1))
@pytest.mark.parametrize("kind", [Time, Duration])
def test_time_and_duration_keep_nanoseconds(kind, nanoseconds):
    message = kind.from_nanoseconds(nanoseconds)
    assert message.nanoseconds == nanoseconds
    assert 0 <= message.nanosec < 10**9


def test_joint_states_compare_lists_and_arrays_by_value():
    with_list = JointState(name=["a", "b"], position=[1.0, 2.0])
    with_array = JointState(name=["a", "b"], position=np.array([1.0, 2.0]))
    assert with_list == with_array
    assert with_list != JointState(name=["a", "b"], position=[1.0, 3.0])
    assert with_list != "a"


def make_transform(parent: str, child: str, x: float, stamp: Time) -> TransformStamped:
    return TransformStamped(
        header=Header(stamp=stamp, frame_id=parent),
        child_frame_id=child,
        transform=Transform(translation=Vector3(x=x, y=0.0, z=0.0)),
    )


def test_tf_message_of_batch_returns_transforms():
    batch = TransformBatch(("world",), ("base",), 1_500_000_000, np.array([[1.0, 0, 0, 0, 0, 0, 1.0]]))
    message = TFMessage(batch=batch)
    assert message.transforms == [make_transform("world", "base", 1.0, Time(sec=1, nanosec=500_000_000))]
    assert message.batch is batch
    assert message.transforms is message.transforms


def test_tf_message_of_transforms_returns_current_batch():
    message = TFMessage()
    assert len(message.batch) == 0
    assert message.batch.poses.shape == (0, 7)
    message.transforms.append(make_transform("world", "base", 1.0, Time(sec=3)))
    message.transforms.append(make_transform("base", "arm", 2.0, Time(sec=4)))
    assert message.batch.parents == ("world", "base")
    assert message.batch.children == ("base", "arm")
    assert message.batch.stamp_ns == 4_000_000_000
    np.testing.assert_array_equal(message.batch.poses[:, [0, 6]], [[1.0, 1.0], [2.0, 1.0]])


def test_new_transforms_replace_batch():
    message = TFMessage(batch=TransformBatch(("a",), ("b",), 0, np.zeros((1, 7))))
    message.transforms = [make_transform("world", "base", 1.0, Time())]
    assert message.batch.children == ("base",)
    assert message == TFMessage(transforms=[make_transform("world", "base", 1.0, Time())])


def test_batch_of_mismatched_lengths_is_rejected():
    with pytest.raises(ValueError, match=r"1 parents, 1 children and poses of shape \(2, 7\) do not agree"):
        TransformBatch(("a",), ("b",), 0, np.zeros((2, 7)))


def test_tf_message_rejects_transforms_together_with_batch():
    with pytest.raises(ValueError, match="not both"):
        TFMessage(transforms=[], batch=TransformBatch((), (), 0, np.zeros((0, 7))))
