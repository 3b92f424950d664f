"""Scenario files for tests."""

from __future__ import annotations

from pathlib import Path

from linkwright.sweep.execution import Outcome
from linkwright.sweep.scenario import Scenario, load_scenario

HEAD = "from linkwright.sweep import Normal, Uniform, scenario\n"
SQUARES = f"""{HEAD}
@scenario(n=[1, 2, 3], drawn=Uniform(0.0, 1.0), seeds=2)
def squares(n, drawn, seed):
    return {{"square": n * n, "big": n > 2, "sum": n + drawn + seed}}
"""


def write_scenario(folder: Path, text: str = SQUARES, name: str = "squares.py") -> Path:
    """Write a scenario file."""
    path = folder / name
    path.write_text(text, encoding="utf-8")
    return path


def load_scenario_text(folder: Path, text: str = SQUARES) -> Scenario:
    """Return the scenario of a text."""
    return load_scenario(write_scenario(folder, text))


def ignore(_: Outcome) -> None:
    """Ignore a report."""
