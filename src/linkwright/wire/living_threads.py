"""Calls whose failure is reported and does not end the thread that makes them."""

from __future__ import annotations

import threading
from collections.abc import Callable
from functools import partial
from typing import TypeVar

R = TypeVar("R")


def guarded(call: Callable[[], R], report: Callable[[Exception], object] | None = None) -> R | None:
    """Call a function; an exception is reported, not raised.

    Args:
        call: the function.
        report: receives the error. Where there is none, or it fails itself, Python reports the error as one that ends a
            thread (``threading.excepthook``).

    Returns:
        Its return value; None where it failed.
    """
    try:
        return call()
    except Exception as error:  # noqa: BLE001 - see above
        if report is None:
            _report_unhandled(error)
        else:
            guarded(partial(report, error))
        return None


def _report_unhandled(error: Exception) -> None:
    threading.excepthook(
        threading.ExceptHookArgs((type(error), error, error.__traceback__, threading.current_thread()))
    )
