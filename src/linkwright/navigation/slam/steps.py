"""Generators that do long work in steps, so that a node can run other callbacks in between.

A function that takes long is a generator: it yields every few milliseconds, and returns its result. A caller that may
block calls `run_to_end`; other callers call ``next`` when they have time, or ``yield from`` the generator in their own.
"""

from __future__ import annotations

from collections.abc import Generator
from typing import TypeVar

T = TypeVar("T")

Steps = Generator[None, None, T]
"""Work in steps with a result."""


def run_to_end(work: Steps[T]) -> T:
    """Run all steps without pausing, and return the result of the work."""
    try:
        while True:
            next(work)
    except StopIteration as done:
        result: T = done.value
        return result
