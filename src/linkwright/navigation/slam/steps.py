"""Generators of work in steps, so that a node can run other callbacks between two of them.

A function that takes long is a generator: it yields after some milliseconds, and returns its result. A caller that may
block calls `finish`; others call ``next`` when they have time, or ``yield from`` it in work of their own.
"""

from __future__ import annotations

from collections.abc import Generator
from typing import TypeVar

T = TypeVar("T")

Steps = Generator[None, None, T]
"""Work in steps with a result."""


def finish(work: Steps[T]) -> T:
    """Run all steps.

    Returns:
        Its result.
    """
    try:
        while True:
            next(work)
    except StopIteration as done:
        result: T = done.value
        return result
