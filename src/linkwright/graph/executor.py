"""Runs callbacks: on the event loop, one after another, in the order in which they became ready."""

from __future__ import annotations

import asyncio
import traceback
from collections import deque
from collections.abc import Callable

from linkwright.diagnostics import LinkwrightError
from linkwright.graph.log import Logger


class Executor:
    """A queue of work for the running event loop.

    Work that is submitted while other work runs comes after it, never inside it. Each turn does what was ready at its
    beginning and then lets the loop serve sockets and timers.
    """

    def __init__(self) -> None:
        self._loop = asyncio.get_running_loop()
        self._ready: deque[Callable[[], None]] = deque()
        self._turn: asyncio.Handle | None = None

    def submit(self, work: Callable[[], None]) -> None:
        """Do something soon. It may not raise: see `run_logged`."""
        self._ready.append(work)
        if self._turn is None:
            self._turn = self._loop.call_soon(self._run_turn)

    async def settle(self) -> None:
        """Wait until everything submitted is done, and whatever that submitted, and so on."""
        await asyncio.sleep(0)
        while self._ready:  # noqa: ASYNC110  # what is waited for are turns of the loop, not an event
            await asyncio.sleep(0)

    def close(self) -> None:
        """Forget all work."""
        self._ready.clear()
        if self._turn is not None:
            self._turn.cancel()
            self._turn = None

    def _run_turn(self) -> None:
        self._turn = None
        try:
            for _ in range(len(self._ready)):
                self._ready.popleft()()
        finally:
            if self._ready and self._turn is None:
                self._turn = self._loop.call_soon(self._run_turn)


def run_logged(logger: Logger, what: str, callback: Callable[[], object]) -> None:
    """Call something; if it fails, say so in the log and go on.

    An error in the user's input is told by its own words, anything else with the traceback that its author needs.
    """
    try:
        callback()
    except LinkwrightError as error:
        problem = f" {error}"
    except Exception:  # noqa: BLE001  # one callback must not take the other nodes of the process with it
        problem = "\n" + traceback.format_exc().rstrip()
    else:
        return
    logger.error(f"{what} failed:{problem}")
