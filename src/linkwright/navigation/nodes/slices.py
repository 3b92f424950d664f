"""Run long computations in slices on the event loop.

Other callbacks run between the slices.
"""

from __future__ import annotations

import asyncio
from collections.abc import Callable, Generator
from time import perf_counter
from typing import Any

from linkwright.graph import Node

SLICE_S = 0.008
_WAIT_S = 0.02

WAIT = "wait"
"""Yielded by a computation that has to wait for an event."""


class SlicedWork:
    """A generator that runs in slices until it ends or is stopped.

    Args:
        node: the node whose clock times the waits.
        work: the generator; it yields None to let other callbacks run, and `WAIT` to be resumed a little later.
        is_wanted: returns whether to continue; called before each slice.
        on_done: called at the end with the result and None, or with None and the exception; called with None and None
            if `is_wanted` returned False.
    """

    def __init__(
        self,
        node: Node,
        work: Generator[str | None, None, Any],
        is_wanted: Callable[[], bool],
        on_done: Callable[[Any, Exception | None], None],
    ) -> None:
        self._node, self._work, self._is_wanted, self._on_done = node, work, is_wanted, on_done
        self._timer: Any = None
        self._handle: asyncio.Handle | None = None
        self._schedule()

    def stop(self) -> None:
        """Stop the work without calling `on_done`."""
        self._work.close()
        if self._handle is not None:
            self._handle.cancel()
        self._end_timer()

    def _schedule(self) -> None:
        self._handle = asyncio.get_running_loop().call_soon(self._resume)

    def _resume(self) -> None:
        self._end_timer()
        if not self._is_wanted():
            self._work.close()
            self._on_done(None, None)
            return
        deadline = perf_counter() + SLICE_S
        try:
            while perf_counter() < deadline:
                if next(self._work) == WAIT:
                    self._timer = self._node.create_timer(_WAIT_S, self._resume)
                    return
        except StopIteration as end:
            self._on_done(end.value, None)
        except Exception as error:  # noqa: BLE001  # passed to the caller of the work
            self._on_done(None, error)
        else:
            self._schedule()

    def _end_timer(self) -> None:
        if self._timer is not None:
            self._timer.destroy()
            self._timer = None
