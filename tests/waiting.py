"""Waiting for the results of other threads, processes and tasks.

The tests do not wait for a fixed time.

A passing test waits no longer than necessary, so the limits are generous: a busy machine causes no failures.
"""

from __future__ import annotations

import asyncio
import sys
import threading
import time
from collections.abc import Callable
from pathlib import Path

TIMEOUT_S = 60.0
_PAUSE_S = 0.005
_EXECUTOR_WAITS = ("_sleep", "work.py")
"""The function, and its file, in which an executor waits for work."""


def wait_until(
    condition: Callable[[], object], seconds: float = TIMEOUT_S, what: object = "", pause: float = _PAUSE_S
) -> None:
    """Wait in this thread until a condition holds.

    On failure, the message contains ``what``, or its result.

    The pause between two checks is given in seconds: it is longer if a check is expensive, as in a browser.
    """
    limit = time.monotonic() + seconds
    while not condition():
        assert time.monotonic() < limit, _failure(seconds, what)
        time.sleep(pause)


async def eventually(condition: Callable[[], object], seconds: float = TIMEOUT_S, what: object = "") -> None:
    """Let the other tasks run until a condition holds."""
    limit = time.monotonic() + seconds
    while not condition():
        assert time.monotonic() < limit, _failure(seconds, what)
        await asyncio.sleep(_PAUSE_S)


def is_waiting(thread: threading.Thread) -> bool:
    """Return whether a thread waits for another one.

    It may wait for an event, a condition, or the work of an executor.
    """
    frame = sys._current_frames().get(thread.ident or 0)
    if frame is None:
        return False
    code = frame.f_code
    # The frame is recognized by name, because programs of the tests also run without Linkwright.
    return code.co_filename == threading.__file__ or (code.co_name, Path(code.co_filename).name) == _EXECUTOR_WAITS


def _failure(seconds: float, what: object) -> str:
    return f"the condition did not hold within {seconds} s: {what() if callable(what) else what}"
