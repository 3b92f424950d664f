"""Messages of several topics matched by their time: ``message_filters``."""

from __future__ import annotations

import pytest
import rclpy
from message_filters import ApproximateTimeSynchronizer, Cache, SimpleFilter, Subscriber, TimeSynchronizer
from rclpy.clock import ClockType
from rclpy.time import Time
from sensor_msgs.msg import CameraInfo, Image
from std_msgs.msg import Header, String


@pytest.fixture
def node(monkeypatch):
    monkeypatch.setenv("LINKWRIGHT_DDS", "0")
    with rclpy.init(args=[]):
        yield rclpy.create_node("matching")


def make_image(seconds):
    return Image(header=Header(stamp=Time(seconds=seconds).to_msg()))


def time_at(seconds):
    return Time(seconds=seconds, clock_type=ClockType.ROS_TIME)


def stamp_seconds(message):
    return message.header.stamp.sec + message.header.stamp.nanosec / 1e9


class RecordedMatches(list):
    """The stamps of the sets of messages that a synchronizer returns."""

    def __init__(self, synchronizer):
        super().__init__()
        synchronizer.registerCallback(lambda *messages: self.append([stamp_seconds(message) for message in messages]))


def test_time_synchronizer_matches_node_subscribers(node):
    matches = []
    picture = Subscriber(node, Image, "image", qos_profile=5)
    camera = Subscriber(node, CameraInfo, "camera_info")
    TimeSynchronizer([picture, camera], 10).registerCallback(lambda *messages: matches.append(messages), "more")
    assert (picture.getTopic(), picture.topic_name, camera.qos_profile.depth) == ("image", "/image", 10)
    sent = make_image(2.5), CameraInfo(header=Header(stamp=Time(seconds=2.5).to_msg()))
    node.create_publisher(Image, "image", 1).publish(sent[0])
    node.create_publisher(CameraInfo, "camera_info", 1).publish(sent[1])
    rclpy.spin_once(node, timeout_sec=1.0)
    rclpy.spin_once(node, timeout_sec=1.0)
    assert matches == [(*sent, "more")]
    with pytest.raises(AttributeError):
        picture.nothing  # noqa: B018


def test_time_synchronizer_requires_equal_stamps():
    left, right = SimpleFilter(), SimpleFilter()
    synchronizer = TimeSynchronizer([left, right], queue_size=2)
    matches = RecordedMatches(synchronizer)
    for seconds in (1, 2, 3):
        left.signalMessage(make_image(seconds))
    right.signalMessage(make_image(1))
    assert matches == []
    right.signalMessage(make_image(3))
    right.signalMessage(make_image(2))
    assert matches == [[3, 3], [2, 2]]
    assert [list(queue) for queue in synchronizer.queues] == [[], [10**9]]


def test_callback_may_signal_its_own_filter():
    source = SimpleFilter()
    synchronizer = TimeSynchronizer([source], 1)
    matches = RecordedMatches(synchronizer)
    synchronizer.registerCallback(
        lambda message: source.signalMessage(make_image(2)) if stamp_seconds(message) < 2 else None
    )
    source.signalMessage(make_image(1))
    assert matches == [[1], [2]]


@pytest.mark.parametrize(
    ("slop", "expected"),
    [(0.05, []), (0.2, [[1.0, 1.1]]), (0.3, [[1.0, 1.1], [1.5, 1.3]])],
)
def test_approximate_synchronizer_matches_within_slop(slop, expected):
    left, right = SimpleFilter(), SimpleFilter()
    matches = RecordedMatches(ApproximateTimeSynchronizer([left, right], 10, slop))
    left.signalMessage(make_image(1.0))
    left.signalMessage(make_image(0.8))
    right.signalMessage(make_image(1.1))
    right.signalMessage(make_image(1.3))
    left.signalMessage(make_image(1.5))
    assert matches == expected


def test_three_topics_are_matched_within_slop():
    inputs = [SimpleFilter() for _ in range(3)]
    matches = RecordedMatches(ApproximateTimeSynchronizer(inputs, 10, 0.15))
    inputs[0].signalMessage(make_image(0.9))
    inputs[0].signalMessage(make_image(1.05))
    inputs[1].signalMessage(make_image(1.1))
    inputs[2].signalMessage(make_image(1.0))
    assert matches == [[1.05, 1.1, 1.0]]


def test_messages_without_header_need_sync_arrival_time(node, capfd):
    first, other = SimpleFilter(), SimpleFilter()
    matches = []
    ApproximateTimeSynchronizer([first, other], 10, 0.1).registerCallback(lambda *messages: matches.append(messages))
    first.signalMessage(String(data="now"))
    assert matches == []
    assert "[message_filters_approx]: can not use message filters messages without" in capfd.readouterr().err
    ApproximateTimeSynchronizer([first, other], 10, 60.0, True).registerCallback(
        lambda *messages: matches.append(messages)
    )
    first.signalMessage(String(data="now"))
    other.signalMessage(String(data="too"))
    assert matches == [(String(data="now"), String(data="too"))]


def test_sync_arrival_time_ignores_stamps():
    left, right = SimpleFilter(), SimpleFilter()
    matches = RecordedMatches(ApproximateTimeSynchronizer([left, right], 10, 60.0, sync_arrival_time=True))
    left.signalMessage(make_image(1))
    right.signalMessage(make_image(1000))
    assert matches == [[1, 1000]]


def test_cache_keeps_last_messages():
    source = SimpleFilter()
    cache = Cache(source, cache_size=3)
    matches = RecordedMatches(cache)
    assert (cache.getLast(), cache.getOldestTime(), cache.getLatestTime()) == (None, None, None)
    for seconds in (1, 2, 3, 4):
        source.signalMessage(make_image(seconds))
    assert matches == [[1], [2], [3], [4]]
    assert (cache.getOldestTime(), cache.getLastestTime()) == (time_at(2), time_at(4))
    assert [stamp_seconds(message) for message in cache.getInterval(time_at(1.5), time_at(3))] == [2, 3]
    assert stamp_seconds(cache.getElemAfterTime(time_at(2.5))) == 3
    assert stamp_seconds(cache.getElemBeforeTime(time_at(2.5))) == 2
    assert cache.getElemAfterTime(time_at(5)) is cache.getElemBeforeTime(time_at(1)) is None
    assert stamp_seconds(cache.getLast()) == 4
