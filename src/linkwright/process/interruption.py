"""Handles Ctrl-C, including while a program is still being imported.

During the imports, no ``except KeyboardInterrupt`` is active yet. This module imports almost nothing, so that it takes
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
"""The exit status of a program that Ctrl-C ended: 128 and the number of SIGINT, as in shells."""

_SOON_SECONDS = 0.01


def end_at_once() -> None:
    """Make SIGINT (Ctrl-C) end the process silently, while there is nothing to clean up.

    This also applies if the process was started with SIGINT ignored. Scripts do so for every program that they start
    with ``&``, and later use ``kill -INT`` to end the program. ROS's programs obey this signal as well, because
    rclpy and rclcpp always install handlers.
    """
    if _signal.getsignal(_signal.SIGINT) in (_signal.default_int_handler, _signal.SIG_IGN):
        _signal.signal(_signal.SIGINT, _end)


def raise_interrupts() -> None:
    """Make Ctrl-C raise KeyboardInterrupt again, so that code can handle it."""
    if _signal.getsignal(_signal.SIGINT) is _end:
        _signal.signal(_signal.SIGINT, _signal.default_int_handler)
        when_lost(lambda: signal_again(_signal.SIGINT))


def when_lost(deliver: Callable[[], None]) -> Callable[[Any], Any]:
    """Call a function for each KeyboardInterrupt that Python discards.

    Python discards a KeyboardInterrupt, with a message, if it is raised in a destructor or in the callback of a weak
    reference. Imports run these frequently, and no code can catch the exception.

    Args:
        deliver: the function, which a new thread calls shortly afterwards to send the signal again.

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
    """Send a signal to this process, so that the main thread handles it like an external signal."""
    if sys.platform == "win32":
        _thread.interrupt_main(number)  # on this system, ``os.kill`` would end the process
    else:
        os.kill(os.getpid(), number)


def interrupt(process: Interruptible) -> None:
    """Request another process to end, as Ctrl-C does; on Windows, terminate the process."""
    if sys.platform == "win32":
        process.terminate()
    else:
        process.send_signal(_signal.SIGINT)


def _end(_number: int, _frame: object) -> None:
    os._exit(INTERRUPTED)
