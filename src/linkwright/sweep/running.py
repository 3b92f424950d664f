"""Running a scenario once."""

from __future__ import annotations

import os
import random
from collections.abc import Mapping
from dataclasses import dataclass, field
from pathlib import Path

import numpy as np

from linkwright.standins import activate
from linkwright.sweep.plan import Run
from linkwright.sweep.scenario import COLUMNS, SEED, Scenario, described, line_of, load_scenario

Result = bool | int | float | str | None
"""What a scenario may return for a name."""

_SEEDS = 1 << 32
"""So many seeds numpy's old generator has."""


@dataclass(frozen=True, slots=True)
class Outcome:
    """What a run came to.

    Attributes:
        row: the number of the run.
        results: what the scenario returned.
        error: why there are no results; empty where all went well.
    """

    row: int
    results: Mapping[str, Result] = field(default_factory=dict)
    error: str = ""


class BadResultError(Exception):
    """A scenario returned what cannot stand in a table."""


def prepare(path: Path) -> Scenario:
    """Load a scenario, so that it can be run in this process from now on: the working directory is its folder.

    ROS's modules can be imported in it, such as ``rclpy`` and ``geometry_msgs.msg``.

    Raises:
        LinkwrightError: as `load_scenario`.
    """
    activate()
    scenario = load_scenario(path)
    os.chdir(path.parent)
    return scenario


def run_once(scenario: Scenario, run: Run) -> Outcome:
    """Run a scenario; what it raises becomes the outcome's error."""
    try:
        return Outcome(run.row, results_of(scenario, run))
    except (Exception, SystemExit) as error:  # noqa: BLE001 - a scenario may raise whatever it likes
        line = line_of(scenario.path, error)
        place = f" ({scenario.path.name}:{line})" if line else ""
        return Outcome(run.row, error=f"{described(error)}{place}")


def results_of(scenario: Scenario, run: Run) -> dict[str, Result]:
    """Run a scenario and check what it returns; ``random`` and ``numpy.random`` begin with the seed.

    Raises:
        BadResultError: it cannot stand in a table.
        Exception: whatever the scenario raises.
    """
    random.seed(run.seed)
    np.random.seed(run.seed % _SEEDS)
    told = {SEED: run.seed} if scenario.takes_seed else {}
    returned = scenario.function(**run.parameters, **told)
    if not isinstance(returned, Mapping):
        raise BadResultError(f"the scenario returned no dict but {type(returned).__name__}")
    taken = {*COLUMNS, *run.parameters}
    results: dict[str, Result] = {}
    for name, value in returned.items():
        if not isinstance(name, str) or name in taken:
            raise BadResultError(f"a result cannot be called {name!r}: that is a column already, or no text")
        results[name] = _plain(name, value)
    return results


def _plain(name: str, value: object) -> Result:
    if isinstance(value, np.generic) or (isinstance(value, np.ndarray) and value.ndim == 0):
        value = value.item()
    if value is None or isinstance(value, bool | int | float | str):
        return value
    raise BadResultError(f"result '{name}' is no number, text, True or False but {type(value).__name__}")
