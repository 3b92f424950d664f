"""Ctrl-C while a program of ours is only being loaded, when no ``except KeyboardInterrupt`` is in force yet.

It imports next to nothing itself, so that little time passes before it works.
"""

from __future__ import annotations

import _signal  # type: ignore[import-not-found]  # what ``signal`` is made of, without the enumerations around it
import os

INTERRUPTED = 130
"""The exit status of a program that Ctrl-C ended: 128 and the number of SIGINT, as shells say it."""


def end_at_once() -> None:
    """Let Ctrl-C end the process from now on without a word: there is nothing to clean up.

    A process that was told to ignore it, as shells tell those in the background, goes on doing so.
    """
    if _signal.getsignal(_signal.SIGINT) is _signal.default_int_handler:
        _signal.signal(_signal.SIGINT, _end)


def raise_interrupts() -> None:
    """Let Ctrl-C raise KeyboardInterrupt again: somebody catches it from now on."""
    if _signal.getsignal(_signal.SIGINT) is _end:
        _signal.signal(_signal.SIGINT, _signal.default_int_handler)


def _end(_number: int, _frame: object) -> None:
    os._exit(INTERRUPTED)
