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
    """The signals that shut contexts down.

    The values can be combined.
    """

    NO = 0
    SIGINT = 1
    SIGTERM = 2
    ALL = 3


_OPTION_BY_SIGNAL = {signal.SIGINT: SignalHandlerOptions.SIGINT, signal.SIGTERM: SignalHandlerOptions.SIGTERM}

_registered_contexts: weakref.WeakSet[Any] = weakref.WeakSet()
_previous_handlers: dict[int, Any] = {}


def shut_down_on_signal(context: Any) -> None:
    """Register a context, so that a signal calls its method ``shutdown_by_signal``."""
    _registered_contexts.add(context)


def install_signal_handlers(options: SignalHandlerOptions = SignalHandlerOptions.ALL) -> None:
    """Install signal handlers that shut all contexts down and then call the previous handler.

    Because the previous handler is called, Ctrl-C still raises KeyboardInterrupt. Outside the main thread, this
    function has no effect, because Python allows only the main thread to install handlers.
    """
    if threading.current_thread() is not threading.main_thread():
        return
    for number, option in _OPTION_BY_SIGNAL.items():
        if options & option and number not in _previous_handlers:
            _previous_handlers[number] = signal.signal(number, _handle_signal)


def uninstall_signal_handlers() -> None:
    """Restore the previous signal handlers."""
    if threading.current_thread() is not threading.main_thread():
        return
    for number in tuple(_previous_handlers):
        previous_handler = _previous_handlers.pop(number)
        if signal.getsignal(number) is _handle_signal:
            signal.signal(number, signal.SIG_DFL if previous_handler is None else previous_handler)


def get_current_signal_handlers_options() -> SignalHandlerOptions:
    """Return the signals with installed handlers."""
    return SignalHandlerOptions(
        sum(option for number, option in _OPTION_BY_SIGNAL.items() if number in _previous_handlers)
    )


def _handle_signal(number: int, frame: FrameType | None) -> None:
    previous_handler: Callable[[int, FrameType | None], Any] | int | None = _previous_handlers.get(number)
    for context in tuple(_registered_contexts):
        context.shutdown_by_signal()
    if callable(previous_handler):
        previous_handler(number, frame)
