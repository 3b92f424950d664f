"""How much work something is: lines counted, not time measured; what has no lines at least comes to an end."""

from __future__ import annotations

import sys
import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from types import FrameType
from typing import Any

from linkwright.xacro import Limits


def lines_run(function: Callable[[], object]) -> int:
    """How many lines of Python a call runs, each turn of a loop counted; what numpy does inside is none."""
    count = 0

    def trace(_frame: FrameType, event: str, _argument: Any) -> Any:
        nonlocal count
        count += event == "line"
        return trace

    before = sys.gettrace()
    sys.settrace(trace)
    try:
        function()
    finally:
        sys.settrace(before)
    return count


@contextmanager
def ends() -> Iterator[None]:
    """What is inside takes less of the processor than an expansion may altogether, where it could take hours.

    For single calls in C, which have no lines to count. They take a second at most; the rest is for slow machines.
    """
    before = time.process_time()
    yield
    assert time.process_time() - before < Limits().seconds
