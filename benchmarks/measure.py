"""The rows of tables, and the measurement of time and memory of calls and commands."""

from __future__ import annotations

import gc
import os
import statistics
import subprocess
import sys
import time
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import Protocol

ROOT = Path(__file__).resolve().parents[1]
LINKWRIGHT = str(Path(sys.executable).with_name("linkwright"))


class Measured(Protocol):
    """A row of a table."""

    def cells(self) -> tuple[str, ...]:
        """Return the cells of the row in the page's table."""

    def line(self) -> str:
        """Return the line for the terminal."""


@dataclass
class Row:
    """A row of the table of measurements.

    Attributes:
        what: the measured quantity.
        ours: our figure.
        unit: its unit.
        target: the promised figure as text, or empty.
        peers: maps the name of a peer to its figure; None if it is not installed or not capable.
    """

    what: str
    ours: float
    unit: str
    target: str = ""
    peers: dict[str, float | None] = field(default_factory=dict)

    def cells(self) -> tuple[str, str, str, str]:
        """Return the quantity, our figure, the promised figure, and the peers with their ratios."""
        peers = [
            f"{name} not measured" if value is None else f"{name} {value:.4g} {self.unit}{self._format_ratio(value)}"
            for name, value in self.peers.items()
        ]
        shown = f"{self.ours:.3g}" if abs(self.ours) < 1000 else f"{self.ours:.0f}"
        return self.what, f"{shown} {self.unit}", self.target, ", ".join(peers)

    def line(self) -> str:
        """Return the line for the terminal."""
        what, ours, target, peers = self.cells()
        return f"{what:58} {ours:>12}   {f'(promised: {target})  ' if target else ''}{peers}"

    def _format_ratio(self, value: float) -> str:
        return f" ({value / self.ours:.1f}x)" if self.ours else ""


def show(rows: Sequence[Measured]) -> None:
    """Print rows to the terminal."""
    for row in rows:
        print(row.line())


def measure_side_by_side(
    calls: Mapping[str, Callable[[], object] | None],
    rounds: int,
    repeat: int = 1,
    before: Callable[[], object] = gc.collect,
) -> dict[str, float]:
    """Return the median seconds of one call of each, called in turns under equal conditions.

    Args:
        calls: maps a name to a function; None if it is not available.
        rounds: the number of turns.
        repeat: the number of calls that are timed together.
        before: a function that is called before each turn, without timing.
    """
    times: dict[str, list[float]] = {name: [] for name, call in calls.items() if call is not None}
    for number in range(rounds + 1):
        for name, call in calls.items():
            if call is None:
                continue
            before()
            begin = time.perf_counter()
            for _ in range(repeat):
                call()
            if number:  # the first turn warms up
                times[name].append((time.perf_counter() - begin) / repeat)
    return {name: statistics.median(seconds) for name, seconds in times.items()}


def measure_commands(calls: Mapping[str, Sequence[str] | None], rounds: int, **environment: str) -> dict[str, float]:
    """Return the median seconds of commands, each in a new process with compiled bytecode."""
    known = {**os.environ, **environment}
    known.pop("PYTHONDONTWRITEBYTECODE", None)

    def start(words: Sequence[str]) -> Callable[[], object]:
        return lambda: subprocess.run(
            words, check=True, env=known, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL
        )

    return measure_side_by_side({name: start(words) if words else None for name, words in calls.items()}, rounds)


_PEAK_CODE = """
import resource, subprocess, sys
subprocess.run(sys.argv[1:], check=True, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
print(resource.getrusage(resource.RUSAGE_CHILDREN).ru_maxrss)
"""


def measure_peak_memory(words: Sequence[str], **environment: str) -> float:
    """Return the peak memory of a command in MB."""
    known = {**os.environ, **environment}
    result = subprocess.run(
        [sys.executable, "-c", _PEAK_CODE, *words], check=True, env=known, capture_output=True, text=True
    )
    return int(result.stdout) / (1000 if sys.platform != "darwin" else 1_000_000)
