"""Executes single runs of a scenario."""

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
"""The types of values that a scenario may return."""

_SEEDS = 1 << 32
"""The number of seeds of numpy's legacy generator."""


@dataclass(frozen=True, slots=True)
class Outcome:
    """The outcome of a run.

    Attributes:
        row: the row number of the run.
        results: the results by name that the scenario returned.
        error: the reason why there are no results; empty if the run succeeded.
    """

    row: int
    results: Mapping[str, Result] = field(default_factory=dict)
    error: str = ""


class BadResultError(Exception):
    """Raised when a scenario returns a value that a table cannot store."""


def prepare(path: Path) -> Scenario:
    """Load a scenario, and change to the scenario's folder, to run it in this process.

    The scenario can import ROS modules, such as ``rclpy`` and ``geometry_msgs.msg``.

    Raises:
        LinkwrightError: see `load_scenario`.
    """
    activate()
    scenario = load_scenario(path)
    os.chdir(path.parent)
    return scenario


def run_once(scenario: Scenario, run: Run) -> Outcome:
    """Run a scenario, and return the outcome; an exception becomes the outcome's error."""
    try:
        return Outcome(run.row, results_of(scenario, run))
    except (Exception, SystemExit) as error:  # noqa: BLE001 - a scenario may raise whatever it likes
        line = line_of(scenario.path, error)
        place = f" ({scenario.path.name}:{line})" if line else ""
        return Outcome(run.row, error=f"{described(error)}{place}")


def results_of(scenario: Scenario, run: Run) -> dict[str, Result]:
    """Run a scenario and return its results, after checking that a table can store them.

    ``random`` and ``numpy.random`` are seeded before the run.

    Raises:
        BadResultError: a table cannot store the results.
        Exception: any exception that the scenario raises.
    """
    random.seed(run.seed)
    np.random.seed(run.seed % _SEEDS)
    seed = {SEED: run.seed} if scenario.takes_seed else {}
    returned = scenario.function(**run.parameters, **seed)
    if not isinstance(returned, Mapping):
        raise BadResultError(f"the scenario must return a dict, not {type(returned).__name__}")
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
    raise BadResultError(f"result '{name}' must be a number, text, True or False, not {type(value).__name__}")
