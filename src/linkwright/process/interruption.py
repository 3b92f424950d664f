"""Handling of Ctrl-C, including the time while a program is still being loaded.

During that time no ``except KeyboardInterrupt`` is in force. This module imports almost nothing, so that it takes
effect early.
"""

from __future__ import annotations

import _signal  # type: ignore[import-not-found]  # the core of ``signal``, without the enumerations around it
import _thread
import os
import sys
import time

TYPE_CHECKING = False  # defined here because importing `typing` takes longer than everything else in this module
if TYPE_CHECKING:
    from collections.abc import Callable
    from typing import Any, Protocol

    class Interruptible(Protocol):
        """A process of `subprocess` or `asyncio`."""

        def send_signal(self, signal: int, /) -> None:
            """Send a signal to the process."""

        def terminate(self) -> None:
            """Terminate the process."""


INTERRUPTED = 130
"""The exit status of a program that Ctrl-C ended: 128 and the number of SIGINT, as in shells."""

_SOON_SECONDS = 0.01


def end_at_once() -> None:
    """Let Ctrl-C, and any other SIGINT, end the process from now on, without a message.

    It is for the time when there is nothing to clean up. It also takes effect if the process was started with SIGINT
    ignored: scripts do so for every program that they start with ``&``, and then use ``kill -INT`` to end it. ROS's
    programs obey that as well, because rclpy and rclcpp always install handlers.
    """
    if _signal.getsignal(_signal.SIGINT) in (_signal.default_int_handler, _signal.SIG_IGN):
        _signal.signal(_signal.SIGINT, _end)


def raise_interrupts() -> None:
    """From now on, let Ctrl-C raise KeyboardInterrupt again, which code may handle."""
    if _signal.getsignal(_signal.SIGINT) is _end:
        _signal.signal(_signal.SIGINT, _signal.default_int_handler)
        when_lost(lambda: signal_again(_signal.SIGINT))


def when_lost(deliver: Callable[[], None]) -> Callable[[Any], Any]:
    """Redeliver each KeyboardInterrupt that Python drops with a message and that no code can catch.

    Python drops a KeyboardInterrupt that is raised in a destructor or in a weak reference's callback; imports run these
    all the time.

    Args:
        deliver: called in a new thread, a moment later.

    Returns:
        The previous ``sys.unraisablehook``.
    """
    before = sys.unraisablehook

    def later() -> None:
        time.sleep(_SOON_SECONDS)
        deliver()

    def hook(dropped: Any) -> None:
        if issubclass(dropped.exc_type, KeyboardInterrupt):
            _thread.start_new_thread(later, ())
        else:
            before(dropped)

    sys.unraisablehook = hook
    return before


def signal_again(number: int) -> None:
    """Send a signal to this process, which the main thread handles as if it came from outside."""
    if sys.platform == "win32":
        _thread.interrupt_main(number)  # ``os.kill`` would end the process there
    else:
        os.kill(os.getpid(), number)


def interrupt(process: Interruptible) -> None:
    """Ask another process to end, as Ctrl-C does.

    On Windows, which cannot send that signal, terminate it.
    """
    if sys.platform == "win32":
        process.terminate()
    else:
        process.send_signal(_signal.SIGINT)


def _end(_number: int, _frame: object) -> None:
    os._exit(INTERRUPTED)
