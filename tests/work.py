"""Measures of work: executed lines instead of time; code without lines must at least end."""

from __future__ import annotations

import gc
import sys
import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from types import FrameType
from typing import Any

from linkwright.xacro import Limits


def lines_run(function: Callable[[], object]) -> int:
    """Return the number of executed Python lines in a call; work inside numpy counts as none.

    Nor do finalizers of objects that other tests left behind.
    """
    count = 0

    def trace(_frame: FrameType, event: str, _argument: Any) -> Any:
        nonlocal count
        count += event == "line"
        return trace

    before, collects = sys.gettrace(), gc.isenabled()
    gc.disable()
    sys.settrace(trace)
    try:
        function()
    finally:
        sys.settrace(before)
        if collects:
            gc.enable()
    return count


@contextmanager
def ends() -> Iterator[None]:
    """Assert that a block takes less processor time than the limit of an expansion.

    This is for single calls in C, which have no lines to count. They take a second at most, except on slow machines.
    """
    before = time.process_time()
    yield
    assert time.process_time() - before < Limits().seconds
