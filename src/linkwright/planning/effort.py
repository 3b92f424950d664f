"""The time limits of searches: real time, or counted work for runs that must repeat exactly.

A search that ends after some real time finds more on a faster computer. In `counted_effort`, time is the sum of the
nominal durations of steps, so a search always ends after the same steps, and its random numbers are the same.
"""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
from contextvars import ContextVar
from time import perf_counter

CHECK_S, ATTEMPT_S = 1e-4, 1e-3
"""The nominal durations of a check of a configuration, and of an attempt of the inverse kinematics."""


class _Effort:
    """The work that was done so far, in nominal seconds, and the number of searches."""

    def __init__(self) -> None:
        self.seconds = 0.0
        self.searches = 0


_counted: ContextVar[_Effort | None] = ContextVar("counted_effort", default=None)


@contextmanager
def counted_effort() -> Iterator[None]:
    """Count work instead of real time in the current thread."""
    token = _counted.set(_Effort())
    try:
        yield
    finally:
        _counted.reset(token)


def elapsed_s() -> float:
    """Return the time in s that limits of searches refer to; only differences have a meaning."""
    effort = _counted.get()
    return perf_counter() if effort is None else effort.seconds


def spend(seconds: float) -> None:
    """Count the nominal duration of a step, in s. Real time passes by itself."""
    effort = _counted.get()
    if effort is not None:
        effort.seconds += seconds


def is_counted() -> bool:
    """Return whether the current thread counts work."""
    return _counted.get() is not None


def next_seed() -> int | None:
    """Return a seed for the random numbers of the next search, or None if they need not repeat."""
    effort = _counted.get()
    if effort is None:
        return None
    effort.searches += 1
    return effort.searches
