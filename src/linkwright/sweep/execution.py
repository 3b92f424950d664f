"""Execute single runs of a scenario."""

from __future__ import annotations

import os
import random
from collections.abc import Mapping
from dataclasses import dataclass, field
from pathlib import Path

import numpy as np

from linkwright.standins import activate
from linkwright.sweep.paths import TimedPath, name_recorded_paths, parse_path
from linkwright.sweep.plan import Run
from linkwright.sweep.scenario import COLUMNS, SEED, Scenario, describe_error, find_line_in_traceback, load_scenario
from linkwright.testing.paths import record_paths

Result = bool | int | float | str | None
"""The types of the values that a scenario may return."""

_MAX_NUMPY_SEEDS = 1 << 32
"""The number of seeds that NumPy's legacy generator accepts."""


@dataclass(frozen=True, slots=True)
class Outcome:
    """The outcome of a run.

    Attributes:
        row: the row number of the run.
        results: the results that the scenario returned, by name.
        error: the reason why there are no results; empty if the run succeeded.
        paths: the paths of robots, by name, if the run records them.
    """

    row: int
    results: Mapping[str, Result] = field(default_factory=dict)
    error: str = ""
    paths: Mapping[str, TimedPath] = field(default_factory=dict)


class BadResultError(Exception):
    """Raised if a scenario returns a value that a table cannot contain."""


def load_into_process(path: Path) -> Scenario:
    """Load a scenario and change to its folder, so that this process can run it.

    The scenario can import ROS modules, such as ``rclpy`` and ``geometry_msgs.msg``.

    Raises:
        LinkwrightError: see `load_scenario`.
    """
    activate()
    scenario = load_scenario(path)
    os.chdir(path.parent)
    return scenario


def run_once(scenario: Scenario, run: Run) -> Outcome:
    """Run a scenario, and return the outcome.

    An exception becomes the outcome's error.
    """
    try:
        return run_scenario(scenario, run)
    except (Exception, SystemExit) as error:  # noqa: BLE001 - a scenario may raise any exception
        line = find_line_in_traceback(scenario.path, error)
        location = f" ({scenario.path.name}:{line})" if line else ""
        return Outcome(run.row, error=f"{describe_error(error)}{location}")


def run_scenario(scenario: Scenario, run: Run) -> Outcome:
    """Run a scenario, and return its results after checking that a table can contain them.

    ``random`` and ``numpy.random`` are seeded before the run. Results that are paths are not in the table.

    Raises:
        BadResultError: a table cannot contain the results.
        Exception: any exception that the scenario raises.
    """
    random.seed(run.seed)
    np.random.seed(run.seed % _MAX_NUMPY_SEEDS)
    seed = {SEED: run.seed} if scenario.takes_seed else {}
    recorded_points: list[TimedPath] = []
    if run.records_paths:
        with record_paths() as robot_paths:
            returned = scenario.function(**run.parameters, **seed)
        recorded_points = [path.points for path in robot_paths]
    else:
        returned = scenario.function(**run.parameters, **seed)
    if not isinstance(returned, Mapping):
        raise BadResultError(f"the scenario must return a dict, not {type(returned).__name__}")
    used_names = {*COLUMNS, *run.parameters}
    results: dict[str, Result] = {}
    paths = name_recorded_paths(recorded_points)
    for name, value in returned.items():
        if not isinstance(name, str) or name in used_names:
            raise BadResultError(f"a result cannot be named {name!r}: use text that is not a column's name")
        path = parse_path(value)
        if path is None:
            results[name] = _to_result(name, value)
        else:
            paths[name] = path
    return Outcome(run.row, results, paths=paths if run.records_paths else {})


def _to_result(name: str, value: object) -> Result:
    if isinstance(value, np.generic) or (isinstance(value, np.ndarray) and value.ndim == 0):
        value = value.item()
    if value is None or isinstance(value, bool | int | float | str):
        return value
    kind = type(value).__name__
    raise BadResultError(f"result '{name}' must be a number, text, True, False or a path of (time, x, y), not {kind}")
