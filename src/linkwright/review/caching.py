"""Caches of results that stay the same during a review, in which no file changes."""

from __future__ import annotations

from collections.abc import Callable
from functools import _lru_cache_wrapper, lru_cache
from typing import TypeVar

_Result = TypeVar("_Result")
_clear_functions: list[Callable[[], None]] = []


def cached_in_review(maxsize: int) -> Callable[[Callable[..., _Result]], _lru_cache_wrapper[_Result]]:
    """Return a decorator that caches the results of a function until the next review.

    The results are shared: callers must not change them.

    Args:
        maxsize: the maximum number of results to keep.
    """

    def decorate(function: Callable[..., _Result]) -> _lru_cache_wrapper[_Result]:
        cached = lru_cache(maxsize=maxsize)(function)
        _clear_functions.append(cached.cache_clear)
        return cached

    return decorate


def forget_cached_results() -> None:
    """Clear all caches, because a working tree may change between two reviews."""
    for clear in _clear_functions:
        clear()
