"""The history of the last minutes in memory.

The tests cover its size, the state at a time, and further reading.
"""

from __future__ import annotations

import threading

import numpy as np
import pytest

from linkwright.bag.history import History, _import_zstd, decompress
from linkwright.bag.saving import find_last_reset_ns, to_simulated_time
from linkwright.bag.stillness import Content, extract_content
from linkwright.messages import TFMessage, TransformBatch, deserialize, get_message, serialize
from tests.waiting import wait_until

SECOND_NS = 1_000_000_000
JointState = get_message("sensor_msgs/msg/JointState")
SimulatedTime = get_message("rosgraph_msgs/msg/Clock")


class Clock:
    """Time that the test sets."""

    def __init__(self) -> None:
        self.ns = 0

    def __call__(self) -> int:
        return self.ns


def filled_history(max_size: int = 10**6, size: int = 1000, count: int = 10) -> tuple[History, Clock]:
    """Return a history with a message of a topic each second."""
    clock = Clock()
    history = History(max_size, clock)
    for second in range(count):
        clock.ns = second * SECOND_NS
        history.add("/a", bytes([second % 256]) * size)
    return history, clock


def static_transform(child: str) -> bytes:
    return serialize(TFMessage(batch=TransformBatch(("base",), (child,), 0, np.array([[0, 0, 0, 0, 0, 0, 1.0]]))))


def message_numbers(messages: object) -> list[int]:
    return [data[0] for _, _, data in messages]  # type: ignore[attr-defined]  # an iterable of recorded messages


def test_history_drops_oldest_messages_beyond_byte_limit() -> None:
    history, _ = filled_history(max_size=5 * 1200, count=3000)
    assert history.size <= 5 * 1200
    messages = list(history.messages(["/a"], 0))
    assert [stamp // SECOND_NS for _, stamp, _ in messages] == [2996, 2997, 2998, 2999], "the last four messages fit"
    assert history.start_ns == 2996 * SECOND_NS
    assert message_numbers(history.state_at(["/a"], 2995 * SECOND_NS)) == [2995 % 256]
    assert history.state_at(["/a"], 2994 * SECOND_NS) == []
    history.add("/a", bytes(10**5))
    assert history.count == 3000, "a message larger than the limit is not stored"


def test_state_at_returns_last_messages_and_dropped_static_transforms() -> None:
    history, clock = filled_history(max_size=10**5)
    for child in ("one", "two", "one"):
        history.add("/tf_static", static_transform(child))
    history.add("/map", b"\7")
    for second in range(10, 200):
        clock.ns = second * SECOND_NS
        history.add("/a", bytes([second]) * 1000)
    state = history.state_at(["/map", "/a", "/tf_static"], 199 * SECOND_NS)
    assert [topic for topic, _, _ in state] == ["/tf_static", "/tf_static", "/map", "/a"]
    assert state[-1][2][0] == 199
    assert history.start_ns > 100 * SECOND_NS
    assert history.time_before(["/a"], 150 * SECOND_NS) == 149 * SECOND_NS
    assert history.time_before(["/a"], history.start_ns) is None


def test_message_stream_continues_after_end_when_messages_arrive() -> None:
    history, clock = filled_history(count=3)
    stream = history.messages(["/a", "/b"], SECOND_NS)
    assert message_numbers([next(stream), next(stream)]) == [1, 2]
    assert next(stream, None) is None
    clock.ns = 3 * SECOND_NS
    history.add("/b", b"\10")
    history.add("/a", b"\11")
    clock.ns = 2 * SECOND_NS  # the clock is set back, but recorded times do not decrease
    history.add("/a", b"\12")
    assert message_numbers(stream) == [8, 9, 10]
    assert history.end_ns == 3 * SECOND_NS


def make_image(shade: int, size: int = 200_000) -> bytes:
    return bytes([shade]) * size


def wait_until_packed(history: History, max_size: int) -> None:
    """Wait until the history takes no more than a number of bytes."""
    wait_until(lambda: history.size <= max_size)


def test_repetitive_large_messages_are_compressed_and_read_unchanged() -> None:
    clock = Clock()
    history = History(10**6, clock)
    for second in range(100):  # 20 MB without compression
        clock.ns = second * SECOND_NS
        history.add("/camera", make_image(second))
        wait_until_packed(history, (second + 1) * 1000)
    assert history.start_ns == 0
    assert history.state_at(["/camera"], 50 * SECOND_NS) == [("/camera", 50 * SECOND_NS, make_image(50))]
    assert [data for _, _, data in history.messages(["/camera"], 98 * SECOND_NS)] == [make_image(98), make_image(99)]
    part = history.messages_between(97 * SECOND_NS, 99 * SECOND_NS)
    assert sum(len(data) for _, _, data in part) < 204_000, "all but the state before them are compressed"
    assert [decompress(data) for _, _, data in part] == [
        make_image(96),
        make_image(97),
        make_image(98),
        make_image(99),
    ]
    history.close()


def test_incompressible_messages_are_stored_uncompressed() -> None:
    noise = np.random.default_rng(0).integers(0, 256, 200_000).astype(np.uint8).tobytes()
    history, _ = filled_history(count=0, max_size=10**7)
    history.add("/camera", noise)
    history.add("/camera", make_image(1))
    wait_until_packed(history, 202_000)
    assert history.size > 200_000
    assert history.state_at(["/camera"], 0) == [("/camera", 0, make_image(1))]
    assert next(history.messages(["/camera"], 0)) == ("/camera", 0, noise)
    history.close()


def test_messages_dropped_before_compression_are_harmless(monkeypatch: pytest.MonkeyPatch) -> None:
    proceed = threading.Event()
    compress = _import_zstd().compress

    def slow(data: bytes, level: int) -> bytes:
        proceed.wait(10)
        return bytes(compress(data, level))

    monkeypatch.setattr(_import_zstd(), "compress", slow)
    history, _ = filled_history(count=0, max_size=500_000)
    for shade in range(5):
        history.add("/camera", make_image(shade))
    assert history.size == 2 * 200_200, "two images: one is being compressed, and the newest one"
    proceed.set()
    wait_until_packed(history, 210_000)
    assert [data[0] for _, _, data in history.messages(["/camera"], 0)] == [4]
    history.close()


def add_states(clock: Clock, history: History, positions: list[float], *, start: float = 0.0) -> None:
    """Add joint states to the history, a hundred in a second."""
    for number, position in enumerate(positions):
        clock.ns = int((start + number / 100) * SECOND_NS)
        state = JointState(name=["arm"], position=[position])
        state.header.stamp.sec, state.header.stamp.nanosec = divmod(clock.ns, SECOND_NS)
        data = serialize(state)
        history.add("/joint_states", data, content=extract_content(JointState.TYPE_NAME, data))


def joint_positions(messages: list[tuple[str, int, bytes]]) -> list[tuple[float, float]]:
    """Position and stamp, in seconds, of joint states."""
    joint_states = [deserialize(decompress(data), JointState) for _, _, data in messages]
    return [
        (joint_state.position[0], joint_state.header.stamp.sec + joint_state.header.stamp.nanosec / 1e9)
        for joint_state in joint_states
    ]


def test_unmoving_joint_states_keep_two_messages_per_ten_seconds() -> None:
    clock = Clock()
    history = History(10**8, clock)
    add_states(clock, history, [1.5] * 6000)
    assert history.count == 12
    size = history.size
    add_states(clock, history, [1.5] * 900, start=60.0)
    assert history.size == size + 2 * (size // 12)
    # The position is the same at any time in between, and its stamp is not before that time.
    for second in (0.5, 7.0, 29.99, 65.0):
        ((position, stamp),) = joint_positions(history.state_at(["/joint_states"], int(second * SECOND_NS)))
        assert position == 1.5
        assert stamp >= second


def test_moving_joint_states_are_all_kept() -> None:
    clock = Clock()
    history = History(10**8, clock)
    resting, moves = [0.0] * 300, [number / 100 for number in range(1, 301)]
    add_states(clock, history, [*resting, *moves, *resting])
    assert history.count == 2 + 300 + 2
    assert joint_positions(history.state_at(["/joint_states"], int(2.5 * SECOND_NS)))[0][0] == 0.0
    assert joint_positions(history.state_at(["/joint_states"], int(4.5 * SECOND_NS)))[0] == pytest.approx((1.51, 4.5))
    assert joint_positions(history.state_at(["/joint_states"], int(8.5 * SECOND_NS)))[0][0] == 0.0
    back_and_forth = History(10**8, clock)
    add_states(clock, back_and_forth, [0.0, 1.0] * 100, start=20.0)
    assert back_and_forth.count == 200


def test_messages_between_spans_requested_interval_of_unmoving_robot() -> None:
    clock = Clock()
    history = History(10**8, clock)
    resting, moves = [0.0] * 300, [number / 100 for number in range(1, 301)]
    add_states(clock, history, [*resting, *moves, *resting])
    for start, end, last in ((1.0, 2.5, 0.0), (2.0, 4.5, 1.51), (4.5, 8.9, 0.0)):
        part = history.messages_between(int(start * SECOND_NS), int(end * SECOND_NS))
        assert (part[0][1], part[-1][1]) == (int(start * SECOND_NS), int(end * SECOND_NS))
        assert joint_positions(part)[-1][0] == pytest.approx(last)


def test_transforms_of_unmoving_publishers_are_thinned_separately() -> None:
    clock = Clock()
    history = History(10**8, clock)
    for number in range(3000):
        clock.ns = number * SECOND_NS // 100
        for child, x in (("wheel", 0.0), ("robot", number / 100)):
            pose = np.array([[x, 0, 0, 0, 0, 0, 1.0]])
            data = serialize(TFMessage(batch=TransformBatch(("base",), (child,), clock.ns, pose)))
            history.add("/tf", data, content=extract_content(TFMessage.TYPE_NAME, data))
    assert history.count == 3000 + 2 * 3
    for second in (5, 15, 28):
        batches = [deserialize(data, TFMessage).batch for _, _, data in history.state_at(["/tf"], second * SECOND_NS)]
        newest = {batch.children[0]: batch.poses[0][0] for batch in batches}
        assert newest == {"wheel": 0.0, "robot": second}


def add_transforms(history: History, clock: Clock, x: float) -> None:
    """Add a transform at the current time to the history."""
    data = serialize(
        TFMessage(batch=TransformBatch(("base",), ("robot",), clock.ns, np.array([[x, 0, 0, 0, 0, 0, 1.0]])))
    )
    history.add("/tf", data, content=extract_content(TFMessage.TYPE_NAME, data))


def publish_clock(history: History, clock: Clock, simulated_ns: int) -> None:
    """Add a message of a simulated clock at the current time to the history."""
    time = SimulatedTime()
    time.clock.sec, time.clock.nanosec = divmod(simulated_ns, SECOND_NS)
    data = serialize(time)
    history.add("/clock", data, content=extract_content(SimulatedTime.TYPE_NAME, data))


def simulated_time_at(history: History, second: float) -> float:
    """Return the simulated time at a time, both in seconds."""
    ((_, _, data),) = history.state_at(["/clock"], int(second * SECOND_NS))
    time = deserialize(data, SimulatedTime).clock
    return time.sec + time.nanosec / SECOND_NS


def test_transforms_with_rounding_noise_count_as_unmoving() -> None:
    clock = Clock()
    history = History(10**8, clock)
    for number in range(6000):
        clock.ns = number * SECOND_NS // 100
        add_transforms(history, clock, 0.1 + 1e-12 * (number % 3))
    assert history.count == 12


def test_slowly_moving_transforms_are_kept_within_nanometer() -> None:
    clock = Clock()
    history = History(10**8, clock)
    for number in range(3000):
        clock.ns = number * SECOND_NS // 100
        add_transforms(history, clock, number * 1e-10)
    for second in (0.5, 7.0, 12.34, 29.98):
        batches = [
            deserialize(data, TFMessage).batch for _, _, data in history.state_at(["/tf"], int(second * SECOND_NS))
        ]
        assert batches[-1].poses[0][0] == pytest.approx(second * 1e-8, abs=2e-9)


def test_clock_alone_is_thinned_and_interpolated() -> None:
    clock = Clock()
    history = History(10**8, clock)
    for number in range(6000):
        clock.ns = number * SECOND_NS // 100
        publish_clock(history, clock, 5 * SECOND_NS + clock.ns // 2)
    assert history.count == 12
    for second in (0.0, 0.5, 7.25, 29.99, 59.99):
        assert simulated_time_at(history, second) == pytest.approx(5 + second / 2, abs=0.01)


def test_clock_is_kept_completely_while_robot_moves() -> None:
    clock = Clock()
    history = History(10**8, clock)
    for number in range(500):
        clock.ns = number * SECOND_NS // 100
        add_transforms(history, clock, number / 100)
        publish_clock(history, clock, clock.ns)
    assert history.count == 1000


def test_clock_reset_is_detected() -> None:
    clock = Clock()
    history = History(10**8, clock)
    for number in range(800):
        clock.ns = number * SECOND_NS // 100
        publish_clock(history, clock, clock.ns % (4 * SECOND_NS))
    part = history.messages_between(0, clock.ns)
    assert find_last_reset_ns(part) == 4 * SECOND_NS
    assert simulated_time_at(history, 3.99) == pytest.approx(3.99)
    assert simulated_time_at(history, 4.0) == 0.0


def test_messages_between_thinned_clock_ticks_keep_simulated_times() -> None:
    clock = Clock()
    history = History(10**8, clock)
    for number in range(1000):
        clock.ns = number * SECOND_NS // 100
        publish_clock(history, clock, SECOND_NS + clock.ns)
        if number in (333, 667):
            add_transforms(history, clock, number)
    stamps = [stamp for name, stamp, _ in to_simulated_time(history.messages_between(0, clock.ns)) if name == "/tf"]
    assert stamps[:2] == [int(4.33 * SECOND_NS), int(7.67 * SECOND_NS)]


def test_content_of_malformed_clock_is_none() -> None:
    for data in (b"", b"\0\1\0\0", b"\0\0\0\0" + bytes(8)):
        assert extract_content(SimulatedTime.TYPE_NAME, data) is None


def test_content_of_message_without_stamp_is_none() -> None:
    assert extract_content("std_msgs/msg/Bool", serialize(get_message("std_msgs/msg/Bool")(data=True))) is None


@pytest.mark.parametrize("data", [b"", b"\0\1\0\0", b"\0\1\0\0\xff\0\0\0", b"\0\0\0\0\0\0\0\1" + bytes(80)])
def test_content_of_malformed_transforms_is_empty(data: bytes) -> None:
    transforms = extract_content(TFMessage.TYPE_NAME, data)
    assert transforms is None or transforms.child_frames == ""


def test_images_beyond_limit_are_thinned_over_minutes() -> None:
    clock = Clock()
    history = History(max_size := 4_000_000, clock)
    noise = np.random.default_rng(1).bytes(15_000)  # the limit allows 266 messages: nine seconds
    for frame in range(30 * 300):
        clock.ns = frame * SECOND_NS // 30
        history.add("/camera", noise)
        if frame % 30 == 0:
            history.add("/small", b"second")
    assert history.size <= max_size
    assert history.start_ns <= SECOND_NS
    stamps = [stamp / SECOND_NS for _, stamp, _ in history.messages(["/camera"], 0)]
    assert len(stamps) > 200
    gaps = np.diff(stamps)
    assert gaps[-20:].max() < 0.1, "the last second is not thinned"
    assert gaps.max() < 20
    assert len(list(history.messages(["/small"], 0))) == 300, "small messages are not thinned"
    assert history.state_at(["/camera"], 100 * SECOND_NS)


def test_thinned_images_reach_back_at_most_ten_minutes() -> None:
    clock = Clock()
    history = History(1_000_000, clock)
    for frame in range(2000):
        clock.ns = frame * SECOND_NS
        history.add("/camera", bytes(15_000))
    assert 500 <= (clock.ns - history.start_ns) / SECOND_NS <= 600


def content_of_poses(children: tuple[str, ...], numbers: list[list[float]], stamp_ns: int = 0) -> Content:
    batch = TransformBatch(("odom",) * len(children), children, stamp_ns, np.array(numbers))
    transforms = extract_content(TFMessage.TYPE_NAME, serialize(TFMessage(batch=batch)))
    assert transforms is not None
    return transforms


def test_content_of_transforms_has_frames_and_poses_without_stamps() -> None:
    left, right = [1.0, 2, 3, 0, 0, 0, 1], [4.0, 5, 6, 0, 0, 1, 0]
    for children, numbers in ((("a", "b"), [left, right]), (("c", "d"), [left, right]), (("c", "d"), [right, left])):
        transforms = content_of_poses(children, numbers, 7)
        assert transforms.child_frames.replace("\0", "") == "\n".join(children)
        assert np.frombuffer(transforms.poses).reshape(-1, 7).tolist() == numbers
        assert transforms == content_of_poses(children, numbers, 9_000_000_000)
        assert transforms.is_repeated_by(content_of_poses(children, numbers))
    assert not content_of_poses(("a", "b"), [left, right]).is_repeated_by(content_of_poses(("a", "c"), [left, right]))


@pytest.mark.parametrize("number", [float("inf"), float("nan")])
def test_non_finite_poses_repeat_only_if_bitwise_equal(number: float) -> None:
    pose = content_of_poses(("a",), [[number, 2, 3, 0, 0, 0, 1]])
    assert pose.is_repeated_by(content_of_poses(("a",), [[number, 2, 3, 0, 0, 0, 1]], 5))
    assert not pose.is_repeated_by(content_of_poses(("a",), [[number, 2, 3.1, 0, 0, 0, 1]]))
