"""Ctrl-C while a program of ours is only being loaded, when no ``except KeyboardInterrupt`` is in force yet, and later.

It imports next to nothing itself, so that little time passes before it works.
"""

from __future__ import annotations

import _signal  # type: ignore[import-not-found]  # the core of ``signal``, without the enumerations around it
import _thread
import os
import sys
import time

TYPE_CHECKING = False  # as that of `typing`, which takes longer to import than everything else here
if TYPE_CHECKING:
    from collections.abc import Callable
    from typing import Any, Protocol

    class Interruptible(Protocol):
        """A process of `subprocess` or `asyncio`."""

        def send_signal(self, signal: int, /) -> None:
            """Send it a signal."""

        def terminate(self) -> None:
            """End it."""


INTERRUPTED = 130
"""The exit status of a program that Ctrl-C ended: 128 and the number of SIGINT, as in shells."""

_SOON_SECONDS = 0.01


def end_at_once() -> None:
    """Let Ctrl-C, and any other SIGINT, end the process from now on without a message: there is nothing to clean up.

    This also holds if the process was started to ignore it: scripts do that to every program that they start with
    ``&``, and end it by ``kill -INT``. ROS's programs obey it too: rclpy and rclcpp install handlers in any case.
    """
    if _signal.getsignal(_signal.SIGINT) in (_signal.default_int_handler, _signal.SIG_IGN):
        _signal.signal(_signal.SIGINT, _end)


def raise_interrupts() -> None:
    """Let Ctrl-C raise KeyboardInterrupt again, for a handler from now on."""
    if _signal.getsignal(_signal.SIGINT) is _end:
        _signal.signal(_signal.SIGINT, _signal.default_int_handler)
        when_lost(lambda: signal_again(_signal.SIGINT))


def when_lost(deliver: Callable[[], None]) -> Callable[[Any], Any]:
    """Deliver a KeyboardInterrupt again that Python drops with a message and no code can catch.

    Python drops one that arrives in a destructor or in a weak reference's callback; imports run these all the time.

    Args:
        deliver: called in a thread of its own, a moment later.

    Returns:
        The ``sys.unraisablehook`` that was there before.
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
    """Send a signal to this process, whose handler runs in the main thread as if it came from outside."""
    if sys.platform == "win32":
        _thread.interrupt_main(number)  # ``os.kill`` would end the process there
    else:
        os.kill(os.getpid(), number)


def interrupt(process: Interruptible) -> None:
    """Ask another process to end, as Ctrl-C does; where processes cannot send that, it is ended."""
    if sys.platform == "win32":
        process.terminate()
    else:
        process.send_signal(_signal.SIGINT)


def _end(_number: int, _frame: object) -> None:
    os._exit(INTERRUPTED)
