"""How many arguments a user's callback takes."""

from __future__ import annotations

import inspect
from collections.abc import Callable


def accepts(callback: Callable[..., object], count: int, *, unknown: bool) -> bool:
    """Whether a callback can be called with so many positional arguments.

    Args:
        callback: the callback.
        count: how many.
        unknown: the answer for a callable of which Python does not know.
    """
    try:
        signature = inspect.signature(callback)
    except ValueError:
        return unknown
    try:
        signature.bind(*(None,) * count)
    except TypeError:
        return False
    return True
