"""Execution of long computations in slices on the event loop, between which other callbacks run."""

from __future__ import annotations

import asyncio
from collections.abc import Callable, Generator
from time import perf_counter
from typing import Any

from linkwright.graph import Node

SECONDS_A_SLICE = 0.008
_SECONDS_TO_WAIT = 0.02

WAIT = "wait"
"""Yielded by work that has to wait for an event."""


class SlicedWork:
    """A generator that runs in slices until it ends or is stopped.

    Args:
        node: the node whose clock times the waits.
        work: yields None to let other callbacks run, and `WAIT` to be resumed a little later.
        is_wanted: returns whether to continue; called before each slice.
        done: called at the end with the result and None, or with None and the exception; with None twice if `is_wanted`
            returned False.
    """

    def __init__(
        self,
        node: Node,
        work: Generator[str | None, None, Any],
        is_wanted: Callable[[], bool],
        done: Callable[[Any, Exception | None], None],
    ) -> None:
        self._node, self._work, self._is_wanted, self._done = node, work, is_wanted, done
        self._timer: Any = None
        self._turn: asyncio.Handle | None = None
        self._later()

    def stop(self) -> None:
        """Stop the work without calling `done`."""
        self._work.close()
        if self._turn is not None:
            self._turn.cancel()
        self._end_timer()

    def _later(self) -> None:
        self._turn = asyncio.get_running_loop().call_soon(self._resume)

    def _resume(self) -> None:
        self._end_timer()
        if not self._is_wanted():
            self._work.close()
            self._done(None, None)
            return
        until = perf_counter() + SECONDS_A_SLICE
        try:
            while perf_counter() < until:
                if next(self._work) == WAIT:
                    self._timer = self._node.create_timer(_SECONDS_TO_WAIT, self._resume)
                    return
        except StopIteration as end:
            self._done(end.value, None)
        except Exception as error:  # noqa: BLE001  # passed to the caller of the work
            self._done(None, error)
        else:
            self._later()

    def _end_timer(self) -> None:
        if self._timer is not None:
            self._timer.destroy()
            self._timer = None
