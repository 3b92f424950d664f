"""Signal handlers of users' programs (``launch.utilities.signal_management``)."""

from __future__ import annotations

import asyncio
import signal
from collections.abc import Callable
from types import FrameType
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from typing_extensions import Self


class AsyncSafeSignalManager:
    """Runs signal handlers on an event loop while a ``with`` block in the main thread is active.

    Blocks may be nested.

    Args:
        loop: the event loop that calls the handlers.
    """

    def __init__(self, loop: asyncio.AbstractEventLoop) -> None:
        self._loop = loop
        self._handlers: dict[int, Callable[[int], object]] = {}
        self._before: dict[int, Any] = {}
        self._entered = False

    def __enter__(self) -> Self:
        self._entered = True
        for number in self._handlers:
            self._take_over(number)
        return self

    def __exit__(self, *_: object) -> None:
        self._entered = False
        for number in tuple(self._before):
            self._give_back(number)

    def handle(self, signum: int, handler: Callable[[int], object] | None) -> Callable[[int], object] | None:
        """Set the handler of a signal, or remove it if `handler` is None.

        The handler is called with the signal's number.

        Returns:
            The previous handler, or None.

        Raises:
            ValueError: there is no such signal.
        """
        number = signal.Signals(signum)
        previous = self._handlers.pop(number, None)
        if handler is not None:
            self._handlers[number] = handler
        if self._entered and handler is not None:
            self._take_over(number)
        elif self._entered:
            self._give_back(number)
        return previous

    def _take_over(self, number: int) -> None:
        if number not in self._before:
            self._before[number] = signal.signal(number, self._came)

    def _give_back(self, number: int) -> None:
        if number in self._before:
            before = self._before.pop(number)
            signal.signal(number, signal.SIG_DFL if before is None else before)

    def _came(self, number: int, _: FrameType | None) -> None:
        handler = self._handlers.get(number)
        if handler is not None and not self._loop.is_closed():
            self._loop.call_soon_threadsafe(handler, number)
