"""Lockstep threads of programs, one of which runs while the graph waits for it.

The graph gives the turn to a thread. The thread runs until it waits for a lock, an event or the end of a sleep, and
then returns the turn. A thread can run again after `LockstepThread.wake`, or at the deadline of its wait, which is a
time of the graph's clock. Therefore, two threads never run at the same time, and the order of their turns is
reproducible.
"""

from __future__ import annotations

import ctypes
import math
import sys
import threading
from _thread import allocate_lock
from collections import deque
from collections.abc import Callable, Iterator
from contextlib import AbstractContextManager
from pathlib import Path
from types import FrameType
from typing import Any, Protocol

from linkwright.graph.loop.future import Future
from linkwright.graph.time.clock import JumpClock
from linkwright.process.nanoseconds import NANOSECONDS_PER_SECOND
from linkwright.process.patience import PatientClock

_MIN_WAIT_NS = 100_000
"""The minimum duration of a wait. Without a minimum, a wait until now would never let time advance."""

_MAX_POLLS = 200
"""The number of times that a thread may read the time without waiting. Then it must wait, because it probably polls."""

_POLL_WAIT_NS = 1_000_000
_KILL_TIMEOUT_S = 2.0
_CHECK_PERIOD_S = 0.2
"""The interval between two checks of a thread's computing time."""

_GENERATED_CODE_PREFIX = "<"
"""The beginning of the file name of code without a file, such as the methods of a dataclass."""

_OWN_FOLDERS = (str(Path(__file__).parents[2]), str(Path(threading.__file__).parent))


class BudgetExceededError(RuntimeError):
    """Raised when a program has computed for longer than its budget without waiting.

    Args:
        message: the error message.
        program: the program that exceeded its budget.
    """

    def __init__(self, message: str, program: Owner) -> None:
        super().__init__(message)
        self.program = program


class EndedByTest(SystemExit):
    """Raised in a thread of a program at its next wait, to end the thread with the test."""


class Owner(Protocol):
    """The interface of a program for its threads."""

    def surroundings(self) -> AbstractContextManager[object]:
        """Return a context that is entered for each turn of a thread."""

    def add(self, thread: LockstepThread) -> None:
        """Register a thread that a thread of the program starts."""

    def set_signal_handler(self, number: int, handler: Any) -> Any:
        """Set the handler of a signal, and return the previous one."""


class LockstepThread:
    """A thread that runs in lockstep with the graph, in turns.

    Args:
        turns: the scheduler of the turns.
        owner: the program that started the thread.
        is_daemon: whether the program may end while the thread runs.
    """

    def __init__(self, turns: Turns, owner: Owner, *, is_daemon: bool) -> None:
        self.turns = turns
        self.owner = owner
        self.is_daemon = is_daemon
        self.ident = 0
        self.ended: Future[None] = Future()
        self.is_killed = False
        self._turn = allocate_lock()
        self._turn.acquire()
        self._is_waiting = True
        self._polls = 0
        self._interruption: Callable[[], object] | None = None

    @property
    def clock(self) -> JumpClock:
        """The clock of the graph."""
        return self.turns.clock

    def time_after(self, seconds: float) -> int:
        """Return the steady time of the graph after a number of seconds, in ns.

        The time is rounded up, so that time advances.
        """
        return self.clock.steady_ns() + math.ceil(seconds * NANOSECONDS_PER_SECOND)

    def begin(self) -> None:
        """Associate the calling thread with this object, and wait for the first turn."""
        self.ident = threading.get_ident()
        self._turn.acquire()
        _threads[self.ident] = self

    def end(self) -> None:
        """Give the turn back for the last time, because the calling thread ends."""
        _threads.pop(self.ident, None)
        self.ended.set_result(None)
        self.turns.take_back(self)

    def wait(self, deadline_ns: int | None = None) -> None:
        """Give the turn back, and wait until `wake` is called or a steady time in ns is reached.

        Raises:
            BaseException: the exception that an interruption raises.
        """
        self._raise_if_killed()
        clock = self.clock
        alarm = None
        if deadline_ns is not None:
            due_ns = max(deadline_ns, clock.steady_ns() + _MIN_WAIT_NS)
            alarm = clock.schedule(due_ns, self.wake)
        self._polls = 0
        self._is_waiting = True
        self.turns.take_back(self)
        self._turn.acquire()
        if alarm is not None:
            alarm.cancel()
        self._raise_if_killed()
        interruption, self._interruption = self._interruption, None
        if interruption is not None:
            interruption()

    def wake(self) -> None:
        """End the wait of the thread, and queue it behind the threads that are ready."""
        if self._is_waiting:
            self._is_waiting = False
            self.turns.ready(self)

    def count_poll(self) -> None:
        """Wait briefly if the thread has read the time many times without waiting.

        Otherwise a loop until a point in time would never end, because time passes only while all threads wait.
        """
        self._raise_if_killed()
        self._polls += 1
        if self._polls >= _MAX_POLLS:
            self.wait(self.clock.steady_ns() + _POLL_WAIT_NS)

    def interrupt(self, action: Callable[[], object]) -> None:
        """End the wait of the thread, and call a function in it, which may raise an exception."""
        self._interruption = action
        self.wake()

    def kill(self) -> None:
        """Raise `EndedByTest` in the current wait of the thread, and in all later waits."""
        self.is_killed = True
        self.wake()

    def give_turn(self) -> None:
        """Let the thread run. `Turns` then waits until the turn is returned."""
        self._turn.release()

    def _raise_if_killed(self) -> None:
        if self.is_killed:
            raise EndedByTest


_threads: dict[int, LockstepThread] = {}


def current_thread() -> LockstepThread | None:
    """Return the `LockstepThread` of the calling thread, or None for any other thread."""
    return _threads.get(threading.get_ident())


class Turns:
    """The scheduler of the threads of all programs in a graph, which gives them turns.

    Args:
        clock: the clock of the graph.
    """

    def __init__(self, clock: JumpClock) -> None:
        self.clock = clock
        self.pollers: set[LockstepThread] = set()
        """The threads that wait for sockets or files."""
        self._ready: deque[LockstepThread] = deque()
        self._returned = allocate_lock()
        self._returned.acquire()
        self._running: LockstepThread | None = None

    def ready(self, thread: LockstepThread) -> None:
        """Queue a thread for its turn."""
        self._ready.append(thread)

    def take_back(self, thread: LockstepThread) -> None:
        """Receive the turn back from the running thread."""
        if self._running is thread:
            self._running = None
            self._returned.release()

    def wake_pollers(self) -> None:
        """Wake the threads that wait for sockets or files, so that they check them again."""
        for thread in tuple(self.pollers):
            thread.wake()

    def run(self, budget_s: float) -> bool:
        """Run the ready threads, and the threads that they wake, until all threads wait.

        Args:
            budget_s: the longest duration of a turn, in seconds, not counting the time in which this process waits for
                a processor.

        Returns:
            Whether any thread has run.

        Raises:
            BudgetExceededError: a thread did not give its turn back in time. It is killed.
        """
        has_run = bool(self._ready)
        while self._ready:
            self._run_thread(self._ready.popleft(), budget_s)
        return has_run

    def _run_thread(self, thread: LockstepThread, budget_s: float) -> None:
        if thread.ended.ended():
            return
        with thread.owner.surroundings():
            self._running = thread
            thread.give_turn()
            if not self._is_returned_within(budget_s):
                place = _describe_place(thread.ident)
                self._kill_running(thread)
                raise BudgetExceededError(
                    f"a program has computed for more than {budget_s:g} s without waiting, {place}: "
                    "a loop that waits for a message or for time must spin or sleep",
                    thread.owner,
                )

    def _is_returned_within(self, budget_s: float) -> bool:
        """Wait until the turn is returned, and return whether that happened within the budget."""
        if self._returned.acquire(timeout=min(_CHECK_PERIOD_S, budget_s)):
            return True
        clock = PatientClock()
        while clock.read() < budget_s - _CHECK_PERIOD_S:
            if self._returned.acquire(timeout=_CHECK_PERIOD_S):
                return True
        return False

    def _kill_running(self, thread: LockstepThread) -> None:
        """End a thread that runs without waiting. If it does not end, it gets no further turn."""
        thread.is_killed = True
        ctypes.pythonapi.PyThreadState_SetAsyncExc(ctypes.c_ulong(thread.ident), ctypes.py_object(EndedByTest))
        if not self._returned.acquire(timeout=_KILL_TIMEOUT_S):
            self._running = None
            self._returned.acquire(blocking=False)
            if not thread.ended.ended():
                thread.ended.set_result(None)


def _describe_place(thread_id: int) -> str:
    """Return a text with the current file, line and function of a thread.

    They are in the user's code if possible.
    """
    frames = list(_iterate_frames(sys._current_frames().get(thread_id)))
    if not frames:
        return "at an unknown place"
    foreign_code = (*_OWN_FOLDERS, _GENERATED_CODE_PREFIX)
    frame = next((frame for frame in frames if not frame.f_code.co_filename.startswith(foreign_code)), frames[0])
    return f"at {frame.f_code.co_filename}:{frame.f_lineno}, in {frame.f_code.co_name}"


def _iterate_frames(frame: FrameType | None) -> Iterator[FrameType]:
    while frame is not None:
        yield frame
        frame = frame.f_back
