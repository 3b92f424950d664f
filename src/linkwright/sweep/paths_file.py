"""The file with the paths of all runs of a sweep."""

from __future__ import annotations

import json
from collections.abc import Mapping, Sequence

from linkwright.sweep.execution import Outcome
from linkwright.sweep.paths import TimedPath
from linkwright.sweep.plan import Run

_DIGITS = 6
"""The number of decimal places of times in s and positions in m."""


def format_paths(runs: Sequence[Run], outcomes: Mapping[int, Outcome]) -> str:
    """Return the paths of the finished runs as JSON."""
    data = [
        {
            "row": run.row,
            "parameters": dict(run.parameters),
            "seed": run.seed,
            "paths": {name: _round(path) for name, path in outcomes[run.row].paths.items()},
        }
        for run in runs
        if run.row in outcomes
    ]
    lines = ",\n".join(json.dumps(run, ensure_ascii=False) for run in data)
    return f'{{"runs": [\n{lines}\n]}}\n'


def _round(path: TimedPath) -> list[list[float]]:
    return [[round(number, _DIGITS) + 0.0 for number in point] for point in path]
