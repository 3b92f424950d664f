"""The order of the files of a test run."""

from __future__ import annotations

from collections.abc import Sequence
from itertools import groupby
from pathlib import Path
from typing import TypeVar

import pytest

T = TypeVar("T")

WAITING_ROOMS = ("reliability", "learning", "browser")
"""The folders whose tests wait for processes and browsers most of the time."""


def spread_waiting_files(items: Sequence[pytest.Item], tests: Path) -> list[pytest.Item]:
    """Return the tests with the files of waiting rooms spread evenly over all others.

    In the order of their names, all workers would wait in the same room at the same time, beside idle processors.

    Args:
        items: the tests, sorted by file.
        tests: the folder of all tests.
    """
    files = [(path, list(group)) for path, group in groupby(items, key=lambda item: item.path)]
    for room in WAITING_ROOMS:
        waiting = [file for file in files if (tests / room) in file[0].parents]
        files = spread([file for file in files if (tests / room) not in file[0].parents], waiting)
    return [item for _, group in files for item in group]


def spread(many: Sequence[T], few: Sequence[T]) -> list[T]:
    """Return both sequences as one in which the second is spread evenly over the first; each keeps its order."""
    places = [(index / len(many), item) for index, item in enumerate(many)]
    places += [((index + 0.5) / len(few), item) for index, item in enumerate(few)]
    return [item for _, item in sorted(places, key=lambda place: place[0])]
