"""A few of the cases of each parametrised test."""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Iterable


def spread(names: Iterable[str], most: int) -> list[str]:
    """The names of tests, with at most so many cases of each parametrised one: the first, the last and some between.

    Args:
        names: as pytest gives them, such as ``tests/test_a.py::test_sum[1-2]``.
        most: how many cases, from 1 on.

    Raises:
        ValueError: fewer than one.
    """
    if most < 1:
        raise ValueError(f"at least one case of a test has to run, not {most}")
    tests: defaultdict[str, list[str]] = defaultdict(list)
    for name in names:
        tests[name.partition("[")[0]].append(name)
    return [cases[index] for cases in tests.values() for index in _evenly(len(cases), most)]


def _evenly(count: int, most: int) -> Iterable[int]:
    if count <= most:
        return range(count)
    return (position * (count - 1) // max(1, most - 1) for position in range(most))
