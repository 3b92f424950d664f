"""Write names with consecutive numbers as one."""

from __future__ import annotations

import re
from collections.abc import Sequence

_END_NUMBER = re.compile(r"\d+$")
_MIN_RUN = 3
"""The minimum number of names with consecutive numbers that are shown as one."""


def join_numbered(names: Sequence[str]) -> list[str]:
    """Return names in their order, with consecutive numbers at their ends as one, such as ``a_0 to a_6``."""
    return [f"{run[0]} to {run[-1]}" if len(run) > 1 else run[0] for run in find_runs(names)]


def find_runs(names: Sequence[str]) -> list[list[str]]:
    """Return names in their order, those with consecutive numbers at their ends together."""
    runs: list[list[str]] = []
    for name in names:
        number = _END_NUMBER.search(name)
        stem = name[: number.start()] if number is not None else name
        last = None if not runs else _END_NUMBER.search(runs[-1][-1])
        is_next = number is not None and last is not None and int(number[0]) == int(last[0]) + 1
        if is_next and runs[-1][-1][: last.start() if last is not None else None] == stem:
            runs[-1].append(name)
        else:
            runs.append([name])
    return [part for run in runs for part in ([run] if len(run) >= _MIN_RUN else [[name] for name in run])]
