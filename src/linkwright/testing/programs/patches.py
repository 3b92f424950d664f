"""Replacements of Python's functions that wait or read the time.

While programs run in a graph, these functions are replaced. In a lockstep thread, a replacement uses the time of
the graph; in any other thread, it calls the original.
"""

from __future__ import annotations

import queue
import selectors
import signal
import sys
import threading
import time
from collections.abc import Callable
from contextlib import suppress
from functools import wraps
from pathlib import Path
from typing import Any

import linkwright.graph.executors.base as executors
import linkwright.graph.time.clock as clocks
from linkwright.process.nanoseconds import NANOSECONDS_PER_SECOND
from linkwright.testing.programs.locks import ThreadAwareLock
from linkwright.testing.programs.threads import EndedByTest, LockstepThread, current_thread

_PACKAGE_FOLDER = str(Path(__file__).parents[2])

Original = Callable[..., Any]

_original_values: dict[tuple[Any, str], Any] = {}
_users: list[object] = []


def install(user: object) -> None:
    """Replace the functions until `uninstall` is called for each installed user."""
    _users.append(user)
    if len(_users) == 1:
        for owner, name, create_replacement in _PATCHES:
            original = vars(owner)[name]
            _original_values[owner, name] = original
            setattr(owner, name, create_replacement(original))


def uninstall(user: object) -> None:
    """Unregister a user, and restore the functions after the last one."""
    _users.remove(user)
    if not _users:
        for (owner, name), original in _original_values.items():
            setattr(owner, name, original)
        _original_values.clear()


def _clock_patch(read: Callable[[LockstepThread], Any]) -> Callable[[Original], Original]:
    """Return a function that creates the replacement of a clock function."""

    def create_replacement(original: Original) -> Original:
        @wraps(original)
        def replacement(*args: Any) -> Any:
            thread = current_thread()
            if thread is None:
                return original(*args)
            if not sys._getframe(1).f_code.co_filename.startswith(_PACKAGE_FOLDER):
                thread.count_poll()
            return read(thread)

        return replacement

    return create_replacement


_system_ns_patch = _clock_patch(lambda thread: thread.clock.now_ns())
_system_s_patch = _clock_patch(lambda thread: thread.clock.now_ns() / NANOSECONDS_PER_SECOND)
_steady_ns_patch = _clock_patch(lambda thread: thread.clock.steady_ns())
_steady_s_patch = _clock_patch(lambda thread: thread.clock.steady_ns() / NANOSECONDS_PER_SECOND)


def _polling_patch(original: Original) -> Original:
    """Return the replacement of a method that a program may poll."""

    @wraps(original)
    def replacement(*args: Any, **kwargs: Any) -> Any:
        thread = current_thread()
        if thread is not None:
            thread.count_poll()
        return original(*args, **kwargs)

    return replacement


def _sleep_patch(original: Original) -> Original:
    @wraps(original)
    def sleep(seconds: float, /) -> None:
        thread = current_thread()
        if thread is None:
            original(seconds)
            return
        if seconds < 0:
            raise ValueError("sleep length must be non-negative")
        end_ns = thread.time_after(seconds)
        if seconds == 0:
            thread.count_poll()
        while thread.clock.steady_ns() < end_ns:
            thread.wait(end_ns)

    return sleep


def _simple_queue_patch(original: Any) -> Any:
    # `_PySimpleQueue` is the implementation in Python, whose locks are replaced.
    return lambda: original() if current_thread() is None else queue._PySimpleQueue()  # type: ignore[attr-defined]


def _recursive_lock_patch(original: Original) -> Original:
    # `_RLock` is the implementation in Python, whose lock is replaced.
    return lambda: original() if current_thread() is None else threading._RLock()


def _start_patch(original: Original) -> Original:
    @wraps(original)
    def start(self: threading.Thread) -> None:
        starter = current_thread()
        if starter is not None:
            thread = LockstepThread(starter.turns, starter.owner, is_daemon=self.daemon)
            vars(self)["_linkwright_thread"] = thread
            vars(self)["run"] = _end_quietly(self.run)
            starter.owner.add(thread)
            thread.wake()
        original(self)

    return start


def _end_quietly(run: Callable[[], object]) -> Callable[[], None]:
    def run_until_killed() -> None:
        with suppress(EndedByTest):
            run()

    return run_until_killed


def _bootstrap_patch(original: Original) -> Original:
    """Return the replacement of the function that a new thread runs first."""

    @wraps(original)
    def bootstrap(self: threading.Thread) -> None:
        thread = _find_lockstep_thread(self)
        if thread is None:
            original(self)
            return
        thread.begin()
        try:
            original(self)
        finally:
            thread.end()

    return bootstrap


def _join_patch(original: Original) -> Original:
    @wraps(original)
    def join(self: threading.Thread, timeout: float | None = None) -> None:
        thread, current = _find_lockstep_thread(self), current_thread()
        if thread is not None and current is not None and thread is not current:
            thread.ended.add_waiter(current.wake)
            clock = current.clock
            end_ns = None if timeout is None else current.time_after(timeout)
            while not thread.ended.ended() and (end_ns is None or clock.steady_ns() < end_ns):
                current.wait(end_ns)
            thread.ended.remove_waiter(current.wake)
            if not thread.ended.ended():
                return
        original(self, timeout)

    return join


def _is_alive_patch(original: Original) -> Original:
    @wraps(original)
    def is_alive(self: threading.Thread) -> bool:
        thread = _find_lockstep_thread(self)
        return bool(original(self)) and (thread is None or not thread.ended.ended())

    return is_alive


def _find_lockstep_thread(thread: threading.Thread) -> LockstepThread | None:
    lockstep_thread: LockstepThread | None = vars(thread).get("_linkwright_thread")
    return lockstep_thread


def _select_patch(original: Original) -> Original:
    """Return a replacement for an event loop's wait for sockets."""

    @wraps(original)
    def select(self: selectors.BaseSelector, timeout: float | None = None) -> Any:
        thread = current_thread()
        if thread is None:
            return original(self, timeout)
        clock = thread.clock
        end_ns = None if timeout is None else thread.time_after(timeout)
        thread.turns.pollers.add(thread)
        try:
            while not (events := original(self, 0)) and (end_ns is None or clock.steady_ns() < end_ns):
                thread.wait(end_ns)
        finally:
            thread.turns.pollers.discard(thread)
        return events

    return select


def _set_signal_patch(original: Original) -> Original:
    @wraps(original)
    def set_signal(number: int, handler: Any, /) -> Any:
        thread = current_thread()
        if thread is None:
            return original(number, handler)
        return thread.owner.set_signal_handler(number, handler)

    return set_signal


_PATCHES: list[tuple[Any, str, Callable[[Any], Any]]] = [
    (time, "time", _system_s_patch),
    (time, "time_ns", _system_ns_patch),
    (time, "monotonic", _steady_s_patch),
    (time, "monotonic_ns", _steady_ns_patch),
    (time, "perf_counter", _steady_s_patch),
    (time, "perf_counter_ns", _steady_ns_patch),
    (time, "sleep", _sleep_patch),
    (threading, "_time", _steady_s_patch),
    (threading, "_allocate_lock", lambda _: ThreadAwareLock),
    (threading, "Lock", lambda _: ThreadAwareLock),
    (threading, "RLock", _recursive_lock_patch),
    (threading.Thread, "start", _start_patch),
    (threading.Thread, "_bootstrap", _bootstrap_patch),
    (threading.Thread, "join", _join_patch),
    (threading.Thread, "is_alive", _is_alive_patch),
    (queue, "time", _steady_s_patch),
    (queue, "SimpleQueue", _simple_queue_patch),
    (signal, "signal", _set_signal_patch),
    (selectors.DefaultSelector, "select", _select_patch),
    (clocks.Clock, "now", _polling_patch),
    (executors.SpinningExecutor, "_spin_single", _polling_patch),
]
