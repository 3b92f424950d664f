"""Handles Ctrl-C, also while a program is still being imported.

During the imports, no ``except KeyboardInterrupt`` is active yet. This module imports very little, so that it takes
effect early.
"""

from __future__ import annotations

import _signal  # type: ignore[import-not-found]  # the core of ``signal``, without the enumerations around it
import _thread
import os
import sys
import time

TYPE_CHECKING = False  # defined here, because importing `typing` takes longer than the rest of this module
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
"""The exit status of a program that Ctrl-C ended.

As in shells, it is 128 plus the number of SIGINT.
"""

_RESEND_DELAY_S = 0.01


def end_on_interrupt() -> None:
    """Make SIGINT (Ctrl-C) end the process silently while there is nothing to clean up.

    This also applies if the process was started with SIGINT ignored. Scripts do this for every program that they start
    with ``&``, and later end it with ``kill -INT``. The programs of ROS also end on this signal, because rclpy and
    rclcpp always install handlers.
    """
    if _signal.getsignal(_signal.SIGINT) in (_signal.default_int_handler, _signal.SIG_IGN):
        _signal.signal(_signal.SIGINT, _handle_interrupt)


def raise_interrupts() -> None:
    """Make Ctrl-C raise KeyboardInterrupt again, so that code can handle it."""
    if _signal.getsignal(_signal.SIGINT) is _handle_interrupt:
        _signal.signal(_signal.SIGINT, _signal.default_int_handler)
        on_lost_interrupt(lambda: resend_signal(_signal.SIGINT))


def on_lost_interrupt(deliver: Callable[[], None]) -> Callable[[Any], Any]:
    """Register a function that is called for each KeyboardInterrupt that Python discards.

    Python discards a KeyboardInterrupt, with a message, if it is raised in a destructor or in the callback of a weak
    reference. Both run frequently during imports, and no code can catch the exception.

    Args:
        deliver: the function, which a new thread calls after a short delay to send the signal again.

    Returns:
        The previous value of ``sys.unraisablehook``.
    """
    previous_hook = sys.unraisablehook

    def deliver_later() -> None:
        time.sleep(_RESEND_DELAY_S)
        deliver()

    def hook(unraisable: Any) -> None:
        if issubclass(unraisable.exc_type, KeyboardInterrupt):
            _thread.start_new_thread(deliver_later, ())
        else:
            previous_hook(unraisable)

    sys.unraisablehook = hook
    return previous_hook


def resend_signal(signal_number: int) -> None:
    """Send a signal to this process.

    The main thread handles it like a signal from outside.
    """
    if sys.platform == "win32":
        _thread.interrupt_main(signal_number)  # on this system, ``os.kill`` would end the process
    else:
        os.kill(os.getpid(), signal_number)


def interrupt(process: Interruptible) -> None:
    """Request the end of another process, as Ctrl-C does.

    On Windows, terminate the process.
    """
    if sys.platform == "win32":
        process.terminate()
    else:
        process.send_signal(_signal.SIGINT)


def _handle_interrupt(_number: int, _frame: object) -> None:
    os._exit(INTERRUPTED)
