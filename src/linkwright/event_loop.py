"""Running a coroutine as ``asyncio.run`` does, with a moment between the making of the loop and its work.

Interrupted while it is being made, a loop complains of itself on standard error.
"""

from __future__ import annotations

import asyncio
import sys
from collections.abc import Callable, Coroutine
from typing import Any, TypeVar

T = TypeVar("T")


def run_coroutine(make: Callable[[], Coroutine[Any, Any, T]], ready: Callable[[], object]) -> T:
    """Run a coroutine on a loop of its own and return its result.

    Args:
        make: gives the coroutine.
        ready: called when the loop is there and nothing runs on it yet; from then on KeyboardInterrupt may be raised.
            Before Python 3.11 it is called before the loop is made.
    """
    if sys.version_info >= (3, 11):
        with asyncio.Runner() as runner:
            runner.get_loop()
            ready()
            return runner.run(make())
    else:
        ready()
        return asyncio.run(make())
