"""The queue and the workers of an executor.

The tests cover which thread wakes when, and Ctrl-C at any point of a wait.
"""

from __future__ import annotations

import dis
import sys
import threading
import time
from functools import cache
from itertools import count, pairwise
from types import CodeType, FrameType
from typing import Any

import pytest

from linkwright.graph.executors.multi_threaded import Workers
from linkwright.graph.executors.work import WorkQueue
from tests.waiting import TIMEOUT_S, is_waiting, wait_until


class InterruptedAt:
    """Raises KeyboardInterrupt in this thread, in code outside of this file, as a signal does.

    Args:
        check_number: the number of Python's check for signals that raises; the first is 1.
    """

    def __init__(self, check_number: int) -> None:
        self._checks_left = check_number
        self._previous_trace = sys.gettrace()

    def __enter__(self) -> None:
        sys._getframe().f_trace_opcodes = True  # Python 3.12 reads this attribute only in `settrace`
        sys.settrace(self._trace)

    def __exit__(self, *_: object) -> None:
        sys.settrace(self._previous_trace)

    def _trace(self, frame: FrameType, event: str, _argument: object) -> Any:
        if frame.f_code.co_filename == __file__:
            return None
        frame.f_trace_opcodes = True
        if event == "opcode" and frame.f_lasti in signal_check_offsets(frame.f_code):
            self._checks_left -= 1
            if self._checks_left == 0:
                raise KeyboardInterrupt
        return self._trace


@cache
def signal_check_offsets(code: CodeType) -> frozenset[int]:
    """Return the offsets at which Python checks for signals.

    These are the first one, and those after calls and backward jumps.
    """
    instructions = list(dis.get_instructions(code))
    return frozenset(
        later.offset
        for earlier, later in pairwise(instructions)
        if earlier.opname.startswith(("CALL", "JUMP_BACKWARD", "JUMP_ABSOLUTE", "RESUME"))
    )


def test_interrupt_during_wait_raises_keyboard_interrupt_and_keeps_queue() -> None:
    queue = WorkQueue()
    for check_number in count(1):
        queue.call_at(2**62, str)
        try:
            with InterruptedAt(check_number):
                queue.wait(time.monotonic_ns() + 1_000_000)
        except KeyboardInterrupt:
            queue.add(check_number)
            assert queue.take() == check_number
        else:
            break  # the wait ended before this moment
    assert check_number > 10
    thread = threading.Thread(target=queue.wait, args=(None,), daemon=True)
    thread.start()
    wait_until(lambda: is_waiting(thread))
    queue.add("something")
    thread.join(TIMEOUT_S)
    assert not thread.is_alive()


@pytest.mark.parametrize("rouse", [lambda queue: queue.add(1), lambda queue: queue.add_first([1]), WorkQueue.wake])
def test_wake_notifies_all_waiting_threads(rouse: Any) -> None:
    queue = WorkQueue()
    threads = [threading.Thread(target=queue.wait, args=(None,), daemon=True) for _ in range(3)]
    for thread in threads:
        thread.start()
    wait_until(lambda: all(map(is_waiting, threads)))
    rouse(queue)
    for thread in threads:
        thread.join(TIMEOUT_S)
        assert not thread.is_alive()


def test_ready_work_does_not_end_wait_for_wake() -> None:
    queue = WorkQueue()
    queue.add(1)
    queue.wait_for_wake(0)
    queue.wake()
    queue.wait_for_wake(None)
    assert queue.take() == 1


def test_earlier_alarm_shortens_wait() -> None:
    queue = WorkQueue()
    thread = threading.Thread(target=queue.wait, args=(None,), daemon=True)
    thread.start()
    wait_until(lambda: is_waiting(thread))
    called: list[int] = []
    queue.call_at(0, lambda: called.append(1))
    thread.join(TIMEOUT_S)
    assert not thread.is_alive()
    assert queue.take() is None
    assert called == [1]


def test_busy_workers_share_one_shutdown_timeout():
    go_on = threading.Event()
    workers = Workers(4, "busy", lambda: None)
    for _ in range(4):
        workers.submit(go_on.wait)
    begin = time.monotonic()
    assert not workers.close(1.0)
    assert 1.0 <= time.monotonic() - begin < 3.0
    go_on.set()
