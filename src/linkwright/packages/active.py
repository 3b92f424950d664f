"""The current package finder, for code that receives none, such as a launch file."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
from contextvars import ContextVar

from linkwright.packages.finder import PackageFinder

_active: ContextVar[PackageFinder | None] = ContextVar("linkwright_package_finder", default=None)


def current_finder() -> PackageFinder:
    """Return the finder of the innermost `use_finder`, or a new one for the current folder."""
    return _active.get() or PackageFinder()


def active_finder() -> PackageFinder | None:
    """Return the finder of the innermost `use_finder`, or None if there is none."""
    return _active.get()


@contextmanager
def use_finder(finder: PackageFinder) -> Iterator[PackageFinder]:
    """Make `current_finder` and `active_finder` return a finder inside a ``with`` block."""
    token = _active.set(finder)
    try:
        yield finder
    finally:
        _active.reset(token)
