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
    """The signals that shut contexts down."""

    NO = 0
    SIGINT = 1
    SIGTERM = 2
    ALL = 3


_OPTIONS = {signal.SIGINT: SignalHandlerOptions.SIGINT, signal.SIGTERM: SignalHandlerOptions.SIGTERM}

_on_signal: weakref.WeakSet[Any] = weakref.WeakSet()
_previous: dict[int, Any] = {}


def shut_down_on_signal(context: Any) -> None:
    """Have a context's ``shutdown_by_signal`` called on a signal."""
    _on_signal.add(context)


def install_signal_handlers(options: SignalHandlerOptions = SignalHandlerOptions.ALL) -> None:
    """Install handlers for signals: they shut all contexts down, then call the previous handler.

    Ctrl-C therefore still raises KeyboardInterrupt. Outside the main thread nothing is done, because Python installs
    handlers only there.
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
    """Return which signals are handled."""
    return SignalHandlerOptions(sum(option for number, option in _OPTIONS.items() if number in _previous))


def _handle(number: int, frame: FrameType | None) -> None:
    before: Callable[[int, FrameType | None], Any] | int | None = _previous.get(number)
    for context in tuple(_on_signal):
        context.shutdown_by_signal()
    if callable(before):
        before(number, frame)
