"""The messages of the last minutes in memory: how much is kept, what is known of a time, and that it can be read on."""

from __future__ import annotations

import numpy as np

from linkwright.bag import History
from linkwright.messages import TFMessage, TransformBatch, serialize

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
