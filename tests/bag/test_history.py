"""The messages of the last minutes in memory: how much is kept, what is known of a time, and that it can be read on."""

from __future__ import annotations

import threading

import numpy as np
import pytest

from linkwright.bag import History, shrinking
from linkwright.bag.shrinking import whole
from linkwright.messages import TFMessage, TransformBatch, serialize
from tests.waiting import wait_until

SECOND = 1_000_000_000


class Clock:
    """Time that the test sets."""

    def __init__(self) -> None:
        self.ns = 0

    def __call__(self) -> int:
        return self.ns


def filled(most: int = 10**6, size: int = 1000, count: int = 10) -> tuple[History, Clock]:
    """A history with a message of a topic each second."""
    clock = Clock()
    history = History(most, clock)
    for second in range(count):
        clock.ns = second * SECOND
        history.add("/a", bytes([second % 256]) * size)
    return history, clock


def static(child: str) -> bytes:
    return serialize(TFMessage(batch=TransformBatch(("base",), (child,), 0, np.array([[0, 0, 0, 0, 0, 0, 1.0]]))))


def numbers(messages: object) -> list[int]:
    return [data[0] for _, _, data in messages]  # type: ignore[attr-defined]  # an iterable of recorded messages


def test_no_more_is_kept_than_so_many_bytes_and_the_oldest_go_first() -> None:
    history, _ = filled(most=5 * 1200, count=3000)
    assert history.size <= 5 * 1200
    kept = list(history.messages(["/a"], 0))
    assert [stamp // SECOND for _, stamp, _ in kept] == [2996, 2997, 2998, 2999], "and the one before is known"
    assert history.start_ns == 2996 * SECOND
    assert numbers(history.state_at(["/a"], 2995 * SECOND)) == [2995 % 256]
    assert history.state_at(["/a"], 2994 * SECOND) == []
    history.add("/a", bytes(10**5))
    assert history.count == 3000, "what alone is too large is not kept"


def test_the_state_is_the_last_of_each_topic_and_all_static_transforms_even_those_dropped() -> None:
    history, clock = filled(most=10**5)
    for child in ("one", "two", "one"):
        history.add("/tf_static", static(child))
    history.add("/map", b"\7")
    for second in range(10, 200):
        clock.ns = second * SECOND
        history.add("/a", bytes([second]) * 1000)
    state = history.state_at(["/map", "/a", "/tf_static"], 199 * SECOND)
    assert [topic for topic, _, _ in state] == ["/tf_static", "/tf_static", "/map", "/a"]
    assert state[-1][2][0] == 199
    assert history.start_ns > 100 * SECOND
    assert history.time_before(["/a"], 150 * SECOND) == 149 * SECOND
    assert history.time_before(["/a"], history.start_ns) is None


def test_who_has_read_to_the_end_reads_on_when_more_has_come() -> None:
    history, clock = filled(count=3)
    stream = history.messages(["/a", "/b"], SECOND)
    assert numbers([next(stream), next(stream)]) == [1, 2]
    assert next(stream, None) is None
    clock.ns = 3 * SECOND
    history.add("/b", b"\10")
    history.add("/a", b"\11")
    clock.ns = 2 * SECOND  # the clock was set: times never go back
    history.add("/a", b"\12")
    assert numbers(stream) == [8, 9, 10]
    assert history.end_ns == 3 * SECOND


def picture(shade: int, size: int = 200_000) -> bytes:
    return bytes([shade]) * size


def packed(history: History, most: int) -> None:
    """Wait until what is kept takes no more than so many bytes."""
    wait_until(lambda: history.size <= most)


def test_large_messages_that_repeat_themselves_take_less_room_and_are_read_as_they_came() -> None:
    clock = Clock()
    history = History(10**6, clock)
    for second in range(100):  # as they are, these would be 20 MB
        clock.ns = second * SECOND
        history.add("/camera", picture(second))
        packed(history, (second + 1) * 1000)
    assert history.start_ns == 0
    assert history.state_at(["/camera"], 50 * SECOND) == [("/camera", 50 * SECOND, picture(50))]
    assert [data for _, _, data in history.messages(["/camera"], 98 * SECOND)] == [picture(98), picture(99)]
    part = history.part(97 * SECOND, 99 * SECOND)
    assert sum(len(data) for _, _, data in part) < 204_000, "packed, but for the state before them"
    assert [whole(data) for _, _, data in part] == [picture(96), picture(97), picture(98), picture(99)]
    history.close()


def test_noise_is_kept_as_it_is() -> None:
    noise = np.random.default_rng(0).integers(0, 256, 200_000).astype(np.uint8).tobytes()
    history, _ = filled(count=0, most=10**7)
    history.add("/camera", noise)
    history.add("/camera", picture(1))
    packed(history, 202_000)
    assert history.size > 200_000
    assert history.state_at(["/camera"], 0) == [("/camera", 0, picture(1))]
    assert next(history.messages(["/camera"], 0)) == ("/camera", 0, noise)
    history.close()


def test_what_was_dropped_before_it_was_packed_does_no_harm(monkeypatch: pytest.MonkeyPatch) -> None:
    go_on = threading.Event()
    compress = shrinking._zstd().compress

    def slow(data: bytes, level: int) -> bytes:
        go_on.wait(10)
        return bytes(compress(data, level))

    monkeypatch.setattr(shrinking._zstd(), "compress", slow)
    history, _ = filled(count=0, most=500_000)
    for shade in range(5):
        history.add("/camera", picture(shade))
    assert history.size == 2 * 200_200, "one, and the one before it"
    go_on.set()
    packed(history, 210_000)
    assert [data[0] for _, _, data in history.messages(["/camera"], 0)] == [4]
    history.close()
