"""Signals that shut contexts down (rclpy ``signals``)."""

from __future__ import annotations

import signal
import threading
import weakref
from collections.abc import Callable
from enum import IntEnum
from types import FrameType
from typing import Any


class SignalHandlerOptions(IntEnum):
    """A combination of the signals that shut contexts down."""

    NO = 0
    SIGINT = 1
    SIGTERM = 2
    ALL = 3


_OPTIONS = {signal.SIGINT: SignalHandlerOptions.SIGINT, signal.SIGTERM: SignalHandlerOptions.SIGTERM}

_on_signal: weakref.WeakSet[Any] = weakref.WeakSet()
_previous: dict[int, Any] = {}


def shut_down_on_signal(context: Any) -> None:
    """Register a context whose ``shutdown_by_signal`` is called when a signal arrives."""
    _on_signal.add(context)


def install_signal_handlers(options: SignalHandlerOptions = SignalHandlerOptions.ALL) -> None:
    """Install signal handlers that shut all contexts down and then call the previous handler.

    Because the previous handler is called, Ctrl-C still raises KeyboardInterrupt. Outside the main thread this function
    does nothing, because Python installs handlers only in the main thread.
    """
    if threading.current_thread() is not threading.main_thread():
        return
    for number, option in _OPTIONS.items():
        if options & option and number not in _previous:
            _previous[number] = signal.signal(number, _handle)


def uninstall_signal_handlers() -> None:
    """Restore the previous signal handlers."""
    if threading.current_thread() is not threading.main_thread():
        return
    for number in tuple(_previous):
        before = _previous.pop(number)
        if signal.getsignal(number) is _handle:
            signal.signal(number, signal.SIG_DFL if before is None else before)


def get_current_signal_handlers_options() -> SignalHandlerOptions:
    """Return the signals for which handlers are installed."""
    return SignalHandlerOptions(sum(option for number, option in _OPTIONS.items() if number in _previous))


def _handle(number: int, frame: FrameType | None) -> None:
    before: Callable[[int, FrameType | None], Any] | int | None = _previous.get(number)
    for context in tuple(_on_signal):
        context.shutdown_by_signal()
    if callable(before):
        before(number, frame)
