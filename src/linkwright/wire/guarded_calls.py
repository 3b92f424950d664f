"""Call functions and report their exceptions, so that the calling thread continues."""

from __future__ import annotations

import threading
from collections.abc import Callable
from functools import partial
from typing import TypeVar

R = TypeVar("R")


def call_guarded(call: Callable[[], R], report: Callable[[Exception], object] | None = None) -> R | None:
    """Call a function, and report an exception instead of raising it.

    Args:
        call: the function.
        report: receives the exception. If it is None, or fails itself, Python reports the exception as one that ends a
            thread (``threading.excepthook``).

    Returns:
        The return value of the function; None if it failed.
    """
    try:
        return call()
    except Exception as error:  # noqa: BLE001 - see above
        if report is None:
            _report_unhandled(error)
        else:
            call_guarded(partial(report, error))
        return None


def _report_unhandled(error: Exception) -> None:
    threading.excepthook(
        threading.ExceptHookArgs((type(error), error, error.__traceback__, threading.current_thread()))
    )
