"""Signal handlers for users' programs (``launch.utilities.signal_management``)."""

from __future__ import annotations

import asyncio
import signal
from collections.abc import Callable
from types import FrameType
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from typing_extensions import Self


class AsyncSafeSignalManager:
    """A context manager for the main thread that calls signal handlers on an event loop.

    Such contexts may be nested.

    Args:
        loop: the event loop that calls the handlers.
    """

    def __init__(self, loop: asyncio.AbstractEventLoop) -> None:
        self._loop = loop
        self._handlers: dict[int, Callable[[int], object]] = {}
        self._previous_handlers: dict[int, Any] = {}
        self._is_entered = False

    def __enter__(self) -> Self:
        self._is_entered = True
        for signal_number in self._handlers:
            self._install(signal_number)
        return self

    def __exit__(self, *_: object) -> None:
        self._is_entered = False
        for signal_number in tuple(self._previous_handlers):
            self._restore(signal_number)

    def handle(self, signum: int, handler: Callable[[int], object] | None) -> Callable[[int], object] | None:
        """Set the handler of a signal, or remove it if `handler` is None.

        The handler is called with the number of the signal.

        Returns:
            The previous handler, or None if there was none.

        Raises:
            ValueError: there is no such signal.
        """
        signal_number = signal.Signals(signum)
        previous = self._handlers.pop(signal_number, None)
        if handler is not None:
            self._handlers[signal_number] = handler
        if self._is_entered and handler is not None:
            self._install(signal_number)
        elif self._is_entered:
            self._restore(signal_number)
        return previous

    def _install(self, signal_number: int) -> None:
        if signal_number not in self._previous_handlers:
            self._previous_handlers[signal_number] = signal.signal(signal_number, self._handle_signal)

    def _restore(self, signal_number: int) -> None:
        if signal_number in self._previous_handlers:
            previous = self._previous_handlers.pop(signal_number)
            signal.signal(signal_number, signal.SIG_DFL if previous is None else previous)

    def _handle_signal(self, signal_number: int, _: FrameType | None) -> None:
        handler = self._handlers.get(signal_number)
        if handler is not None and not self._loop.is_closed():
            self._loop.call_soon_threadsafe(handler, signal_number)
