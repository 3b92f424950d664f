"""Transform lookups: interpolation, extrapolation and errors."""

from __future__ import annotations

from math import cos, inf, nan, pi, sin, sqrt

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from linkwright.geometry.arrays import compose as compose_arrays
from linkwright.geometry.single import IDENTITY, compose, interpolate, invert
from linkwright.graph import (
    ConnectivityException,
    ExtrapolationException,
    InvalidArgumentException,
    Logger,
    LookupException,
)
from linkwright.graph.time.values import Duration, Time
from linkwright.graph.transforms.core import BufferCore
from linkwright.messages import TFMessage, TransformBatch, TransformStamped

SECOND_NS = 1_000_000_000


def make_transform(parent, child, seconds=0.0, x=0.0, yaw=0.0):
    message = TransformStamped()
    message.header.frame_id, message.child_frame_id = parent, child
    message.header.stamp = Time(seconds=seconds).to_msg()
    message.transform.translation.x = x
    message.transform.rotation.z, message.transform.rotation.w = sin(yaw / 2), cos(yaw / 2)
    return message


def time_at(seconds):
    return Time(seconds=seconds)


LATEST = Time()


@pytest.fixture
def logged():
    return []


@pytest.fixture
def buffer(logged):
    logger = Logger("tf2", lambda record: logged.append((record.level.name, record.text)), lambda: 0)
    return BufferCore(logger=logger)


def fill_buffer(buffer, *transforms, static=False):
    for transform in transforms:
        (buffer.set_transform_static if static else buffer.set_transform)(transform, "me")


def look_up_x(buffer, target, source, time=LATEST):
    return buffer.lookup_transform_core(target, source, time).transform.translation.x


def test_lookup_returns_pose_of_source_in_target(buffer):
    fill_buffer(buffer, make_transform("map", "base", 1, x=1.0, yaw=pi / 2), make_transform("base", "arm", 1, x=2.0))
    transform = buffer.lookup_transform_core("map", "arm", LATEST)
    assert (transform.header.frame_id, transform.child_frame_id, transform.header.stamp.sec) == ("map", "arm", 1)
    translation, rotation = transform.transform.translation, transform.transform.rotation
    assert (translation.x, translation.y) == (pytest.approx(1.0), pytest.approx(2.0))
    assert rotation.z == pytest.approx(sqrt(0.5))
    back = buffer.lookup_transform_core("arm", "map", LATEST).transform.translation
    assert (back.x, back.y) == (pytest.approx(-2.0), pytest.approx(1.0))


def test_number_is_rejected_as_time(buffer):
    with pytest.raises(TypeError, match=r"time must have sec and nanosec, or nanoseconds. It is 1\.5"):
        buffer.lookup_transform_core("a", "b", 1.5)


def test_poses_are_interpolated_between_stamps(buffer):
    fill_buffer(buffer, make_transform("a", "b", 1, x=0.0, yaw=0.0), make_transform("a", "b", 3, x=4.0, yaw=pi / 2))
    assert look_up_x(buffer, "a", "b", time_at(1.5)) == pytest.approx(1.0)
    rotation = buffer.lookup_transform_core("a", "b", time_at(2.0)).transform.rotation
    assert (rotation.z, rotation.w) == (pytest.approx(sin(pi / 8)), pytest.approx(cos(pi / 8)))
    assert [look_up_x(buffer, "a", "b", time_at(time)) for time in (1.0, 3.0)] == [0.0, 4.0]
    assert look_up_x(buffer, "a", "b") == 4.0
    assert buffer.lookup_transform_core("a", "b", time_at(2.0).to_msg()).transform.translation.x == pytest.approx(2.0)


def test_interpolation_takes_shorter_rotation():
    first = (0.0, 0.0, 0.0, 0.0, 0.0, sin(0.1), cos(0.1))
    second = (0.0, 0.0, 0.0, 0.0, 0.0, -sin(0.2), -cos(0.2))
    middle = interpolate(first, second, 0.5)
    assert abs(middle[5] * cos(0.15) - middle[6] * sin(0.15)) < 1e-12
    assert interpolate(first, first, 0.3) == pytest.approx(first)


def test_reparented_frame_keeps_earlier_poses(buffer):
    fill_buffer(
        buffer,
        make_transform("a", "c", 1, x=1.0),
        make_transform("b", "c", 3, x=9.0),
        make_transform("a", "b", 1, x=5.0),
    )
    fill_buffer(buffer, make_transform("a", "b", 3, x=5.0))
    assert look_up_x(buffer, "a", "c", time_at(2.0)) == 1.0
    assert look_up_x(buffer, "a", "c", time_at(3.0)) == 14.0


def test_extrapolation_is_rejected_like_tf2(buffer):
    fill_buffer(
        buffer, make_transform("map", "base", 10), make_transform("map", "base", 11), make_transform("base", "arm", 10)
    )
    for time, text in (
        (
            12,
            (
                "Lookup would require extrapolation into the future.  Requested time 12.000000 but the latest data is "
                "at time 11.000000, when looking up transform from frame [base] to frame [map]"
            ),
        ),
        (
            9,
            (
                "Lookup would require extrapolation into the past.  Requested time 9.000000 but the earliest data is "
                "at time 10.000000, when looking up transform from frame [base] to frame [map]"
            ),
        ),
    ):
        with pytest.raises(ExtrapolationException) as caught:
            buffer.lookup_transform_core("map", "base", time_at(time))
        assert str(caught.value) == text
        assert buffer.can_transform_core("map", "base", time_at(time)) == (False, text)
    with pytest.raises(ExtrapolationException) as caught:
        buffer.lookup_transform_core("base", "arm", time_at(10.5))
    assert str(caught.value) == (
        "Lookup would require extrapolation at time 10.500000, but only time 10.000000 is in the buffer, when looking "
        "up transform from frame [arm] to frame [base]"
    )
    with pytest.raises(ExtrapolationException, match=r"from frame .map. to frame .arm."):
        buffer.lookup_transform_core("arm", "map", time_at(10.5))


def test_latest_common_time_is_of_slowest_frame(buffer):
    fill_buffer(
        buffer,
        make_transform("map", "base", 1, x=1.0),
        make_transform("map", "base", 5, x=5.0),
        make_transform("base", "arm", 3, x=10.0),
    )
    transform = buffer.lookup_transform_core("map", "arm", LATEST)
    assert transform.header.stamp.sec == 3
    assert transform.transform.translation.x == pytest.approx(13.0)
    assert buffer.get_latest_common_time("map", "arm") == time_at(3)
    assert buffer.get_latest_common_time("arm", "base") == time_at(3)
    assert buffer.get_latest_common_time("base", "base") == time_at(5)
    fill_buffer(buffer, make_transform("base", "leg"), static=True)
    assert buffer.get_latest_common_time("arm", "leg") == time_at(3)
    assert buffer.get_latest_common_time("base", "leg") == LATEST


def test_static_transforms_hold_at_all_times(buffer):
    fill_buffer(buffer, make_transform("base", "camera", 100, x=1.0), static=True)
    assert [look_up_x(buffer, "base", "camera", time_at(time)) for time in (0, 1, 1000)] == [1.0, 1.0, 1.0]
    assert buffer.lookup_transform_core("base", "camera", time_at(7)).header.stamp.sec == 7
    fill_buffer(buffer, make_transform("base", "camera", 1, x=2.0), static=True)
    assert look_up_x(buffer, "base", "camera", time_at(5)) == 2.0
    fill_buffer(buffer, make_transform("base", "camera", 3, x=3.0))
    assert look_up_x(buffer, "base", "camera") == 3.0
    with pytest.raises(ExtrapolationException):
        look_up_x(buffer, "base", "camera", time_at(5))


def test_time_travel_uses_fixed_frame(buffer):
    fill_buffer(buffer, *(make_transform("world", "robot", time, x=float(time)) for time in range(1, 6)))
    fill_buffer(buffer, make_transform("world", "other", 1, x=100.0), make_transform("world", "other", 5, x=100.0))
    transform = buffer.lookup_transform_full_core("robot", time_at(4), "robot", time_at(1.5), "world")
    assert transform.transform.translation.x == pytest.approx(-2.5)
    assert (transform.header.frame_id, transform.child_frame_id, transform.header.stamp.sec) == ("robot", "robot", 4)
    assert buffer.can_transform_full_core("robot", time_at(4), "other", time_at(2), "world") == (True, "")
    possible, reason = buffer.can_transform_full_core("robot", time_at(40), "other", time_at(2), "world")
    assert not possible
    assert "into the future" in reason
    possible, reason = buffer.can_transform_full_core("robot", time_at(4), "other", time_at(2), "gone")
    assert reason == 'Invalid frame ID "gone" passed to canTransform argument fixed_frame - frame does not exist'
    with pytest.raises(LookupException, match='"gone" passed to lookupTransform argument fixed_frame does not exist'):
        buffer.lookup_transform_full_core("robot", time_at(4), "other", time_at(2), "gone")


def test_unknown_and_unconnected_frames_are_rejected(buffer):
    fill_buffer(buffer, make_transform("map", "base", 1), make_transform("x", "y", 1))
    for call, kind, text in (
        (("mapp", "base"), LookupException, '"mapp" passed to lookupTransform argument target_frame does not exist. '),
        (("map", "bas"), LookupException, '"bas" passed to lookupTransform argument source_frame does not exist. '),
        (
            ("", "base"),
            InvalidArgumentException,
            'Invalid argument "" passed to lookupTransform argument target_frame - in tf2 frame_ids cannot be empty',
        ),
        (
            ("/map", "base"),
            InvalidArgumentException,
            (
                'Invalid argument "/map" passed to lookupTransform argument target_frame - in tf2 frame_ids cannot '
                "start with a '/'"
            ),
        ),
        (
            ("map", "y"),
            ConnectivityException,
            (
                "Could not find a connection between 'map' and 'y' because they are not part of the same tree.Tf has "
                "two or more unconnected trees."
            ),
        ),
    ):
        for time in (LATEST, time_at(1)):
            with pytest.raises(kind) as caught:
                buffer.lookup_transform_core(*call, time)
            assert str(caught.value) == text
    assert buffer.can_transform_core("mapp", "base", LATEST) == (
        False,
        'Invalid frame ID "mapp" passed to canTransform argument target_frame - frame does not exist',
    )
    assert buffer.can_transform_core("map", "/y", LATEST)[1].endswith("in tf2 frame_ids cannot start with a '/'")
    assert not buffer.can_transform_core("map", "y", LATEST)[0]
    assert buffer.can_transform_core("anything", "anything", LATEST) == (True, "")
    assert look_up_x(buffer, "anything", "anything") == 0.0


def test_frame_loop_is_reported(buffer):
    fill_buffer(
        buffer,
        make_transform("a", "b", 1),
        make_transform("b", "c", 1),
        make_transform("c", "a", 1),
        make_transform("x", "y", 1),
    )
    for time in (LATEST, time_at(1)):
        with pytest.raises(LookupException, match=r"it contains a loop.\nFrame b exists"):
            buffer.lookup_transform_core("x", "b", time)


@pytest.mark.parametrize(
    ("transform", "text"),
    [
        (
            make_transform("a", ""),
            'TF_NO_CHILD_FRAME_ID: Ignoring transform from authority "me" because child_frame_id not set ',
        ),
        (
            make_transform("", "b"),
            'TF_NO_FRAME_ID: Ignoring transform with child_frame_id "b"  from authority "me" because frame_id not set',
        ),
        (
            make_transform("/a", "a"),
            (
                'TF_SELF_TRANSFORM: Ignoring transform from authority "me" with frame_id and  child_frame_id "a" '
                "because they are the same"
            ),
        ),
        (
            make_transform("a", "b", x=nan),
            (
                'TF_NAN_INPUT: Ignoring transform for child_frame_id "b" from authority "me" because of a nan value in '
                "the transform (nan 0.000000 0.000000) (0.000000 0.000000 0.000000 1.000000)"
            ),
        ),
    ],
)
def test_invalid_transforms_are_ignored_and_reported(buffer, logged, transform, text):
    fill_buffer(buffer, transform)
    assert logged == [("ERROR", text)]
    assert buffer.all_frames_as_string() == ""


def test_quaternion_must_have_unit_length(buffer, logged):
    invalid = make_transform("a", "b")
    invalid.transform.rotation.w = 0.9
    fill_buffer(buffer, invalid)
    invalid.transform.rotation.w = inf
    fill_buffer(buffer, invalid)
    assert logged[0] == (
        "ERROR",
        (
            'TF_DENORMALIZED_QUATERNION: Ignoring transform for child_frame_id "b" from authority "me" because of an '
            "invalid quaternion in the transform (0.000000 0.000000 0.000000 0.900000)"
        ),
    )
    assert len(logged) == 2


def test_old_data_is_ignored_and_out_of_order_data_sorted(buffer, logged):
    fill_buffer(
        buffer,
        make_transform("a", "b", 100, x=1.0),
        make_transform("a", "b", 95, x=2.0),
        make_transform("a", "b", 98, x=3.0),
    )
    assert [look_up_x(buffer, "a", "b", time_at(time)) for time in (95, 98, 100)] == [2.0, 3.0, 1.0]
    assert look_up_x(buffer, "a", "b", time_at(99)) == pytest.approx(2.0)
    fill_buffer(buffer, make_transform("a", "b", 98, x=3.0))
    assert logged == []
    fill_buffer(buffer, *(make_transform("a", "b", 89, x=4.0) for _ in range(9)))
    assert logged == [
        (
            "WARN",
            (
                "TF_OLD_DATA ignoring data from the past for frame b at time 89.000000 according to authority me\n"
                "Possible reasons are listed at http://wiki.ros.org/tf/Errors%20explained"
            ),
        )
    ]


def test_data_older_than_cache_time_is_dropped(logged):
    buffer = BufferCore(Duration(seconds=2))
    for tick in range(3000):
        buffer.set_transform(make_transform("a", "b", 1 + tick * 0.01, x=float(tick)), "me")
    with pytest.raises(ExtrapolationException, match="into the past"):
        buffer.lookup_transform_core("a", "b", time_at(28.0))
    assert look_up_x(buffer, "a", "b", time_at(29.5)) == pytest.approx(2850.0)
    assert "rate: 100." in buffer.all_frames_as_yaml()


def test_clear_keeps_static_transforms(buffer):
    fill_buffer(buffer, make_transform("map", "base", 1))
    fill_buffer(buffer, make_transform("base", "camera"), static=True)
    buffer.clear()
    assert buffer.can_transform_core("base", "camera", LATEST)[0]
    assert not buffer.can_transform_core("map", "base", LATEST)[0]


def test_all_frames_are_printed_as_text_yaml_and_dot(buffer):
    assert buffer.all_frames_as_yaml() == "[]"
    assert "no tf data recieved" in buffer.all_frames_as_dot()
    fill_buffer(buffer, make_transform("map", "base", 1), make_transform("map", "base", 3))
    fill_buffer(buffer, make_transform("base", "camera"), static=True)
    assert buffer.all_frames_as_string() == (
        "Frame base exists with parent map.\nFrame camera exists with parent base.\n"
    )
    assert buffer.all_frames_as_yaml() == (
        "base: \n  parent: 'map'\n  broadcaster: 'me'\n  rate: 1.000\n  most_recent_transform: 3.000000\n"
        "  oldest_transform: 1.000000\n  buffer_length: 2.000\n"
        "camera: \n  parent: 'base'\n  broadcaster: 'me'\n  rate: 10000.000\n  most_recent_transform: 0.000000\n"
        "  oldest_transform: 0.000000\n  buffer_length: 0.000\n"
    )
    assert "  transform_delay: 1.500\n" in buffer._frameYAML(time_at(4.5))
    assert '"map" -> "base"[label="Broadcaster: me\\nAverage rate: 1.000 Hz' in buffer._allFramesAsDot(time_at(4))
    assert buffer._getFrameStrings() == ["base", "map", "camera"]
    assert buffer._frameExists("map")
    assert not buffer._frameExists("gone")


def test_chain_contains_frames_between_two_frames(buffer):
    fill_buffer(
        buffer,
        *(make_transform(parent, child, 1) for parent, child in (("map", "base"), ("base", "arm"), ("arm", "hand"))),
        make_transform("base", "leg", 1),
    )
    assert buffer._chain("leg", LATEST, "hand", LATEST, "base") == ["hand", "arm", "base", "leg"]
    assert buffer._chain("hand", LATEST, "map", LATEST, "map") == ["map", "base", "arm", "hand"]
    assert buffer._chain("leg", LATEST, "hand", LATEST, "map") == ["hand", "arm", "base", "map", "base", "leg"]


def test_velocity_is_computed_from_poses(buffer):
    fill_buffer(buffer, *(make_transform("world", "robot", time, x=3.0 * time, yaw=0.1 * time) for time in range(6)))
    linear, angular = buffer.lookupVelocityCore("robot", "world", time_at(3), Duration(seconds=2))
    assert (angular[2], linear[2]) == (pytest.approx(0.1), pytest.approx(0.0))
    velocity = buffer.lookupVelocityFullCore(
        "robot", "world", "world", (0.0, 0.0, 0.0), "robot", time_at(3), Duration(seconds=2)
    )
    assert velocity == (linear, angular)
    fill_buffer(buffer, *(make_transform("world", "cart", time, x=3.0 * time) for time in range(6)))
    linear, angular = buffer.lookupVelocityCore("cart", "world", time_at(0), Duration(seconds=4, nanoseconds=1_000_000))
    assert linear == pytest.approx((3.0, 0.0, 0.0), abs=0.01)
    assert angular == pytest.approx((0.0, 0.0, 0.0))


def test_messages_can_contain_arrays(buffer):
    poses = np.array([[1.0, 0, 0, 0, 0, 0, 1], [2.0, 0, 0, 0, 0, 0, 1]])
    buffer.update(TFMessage(batch=TransformBatch(("a", "b"), ("b", "c"), 5 * SECOND_NS, poses)), static=False)
    assert look_up_x(buffer, "a", "c") == 3.0
    buffer.update(
        TFMessage(transforms=[make_transform("a", "b", 6, x=7.0), make_transform("b", "c", 7, x=0.5)]), static=False
    )
    assert buffer.get_latest_common_time("a", "c") == time_at(6)


pose = (
    st.tuples(
        *([st.floats(-10, 10)] * 3),
        *([st.floats(-1, 1)] * 4),
    )
    .filter(lambda values: sum(value * value for value in values[3:]) > 0.1)
    .map(
        lambda values: (
            *values[:3],
            *(value / sqrt(sum(component * component for component in values[3:])) for value in values[3:]),
        )
    )
)


@given(pose, pose)
def test_single_poses_compose_like_arrays(first, second):
    assert compose(first, second) == pytest.approx(compose_arrays(first, second).tolist(), abs=1e-9)
    back = compose(first, invert(first))
    assert back[:3] == pytest.approx((0.0, 0.0, 0.0), abs=1e-9)
    assert abs(back[6]) == pytest.approx(1.0)
    assert interpolate(first, second, 0.0) == pytest.approx(first)
    ended = interpolate(first, second, 1.0)
    assert ended[:3] == pytest.approx(second[:3])
    assert abs(sum(a * b for a, b in zip(ended[3:], second[3:], strict=True))) == pytest.approx(1.0)
    assert compose(IDENTITY, first) == pytest.approx(first)
