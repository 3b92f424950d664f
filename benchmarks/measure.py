"""Measuring: what a row of a table says, and times and memory of calls and commands."""

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
        """What stands in the table of the page."""

    def line(self) -> str:
        """What is printed to the terminal."""


@dataclass
class Row:
    """One measured thing.

    Attributes:
        what: what was measured.
        ours: our figure.
        unit: its unit.
        target: what was promised, in words, or empty.
        peers: name of a peer -> its figure; None for one that is not installed here or cannot do it.
    """

    what: str
    ours: float
    unit: str
    target: str = ""
    peers: dict[str, float | None] = field(default_factory=dict)

    def cells(self) -> tuple[str, str, str, str]:
        """What, ours, promised, and peers with how many times as much they take."""
        others = [
            f"{name} not measured" if value is None else f"{name} {value:.4g} {self.unit}{self._compared(value)}"
            for name, value in self.peers.items()
        ]
        shown = f"{self.ours:.3g}" if abs(self.ours) < 1000 else f"{self.ours:.0f}"
        return self.what, f"{shown} {self.unit}", self.target, ", ".join(others)

    def line(self) -> str:
        """The row on a terminal."""
        what, ours, target, others = self.cells()
        return f"{what:58} {ours:>12}   {f'(promised: {target})  ' if target else ''}{others}"

    def _compared(self, value: float) -> str:
        return f" ({value / self.ours:.1f}x)" if self.ours else ""


def show(rows: Sequence[Measured]) -> None:
    """Print rows to the terminal."""
    for row in rows:
        print(row.line())


def side_by_side(
    calls: Mapping[str, Callable[[], object] | None],
    rounds: int,
    repeat: int = 1,
    before: Callable[[], object] = gc.collect,
) -> dict[str, float]:
    """The median seconds of one call of each, called in turns so that all meet the same machine.

    Args:
        calls: name -> what to call; None for what cannot be.
        rounds: how many turns.
        repeat: how many calls are timed together.
        before: what is done before each turn of each, untimed.
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


def commands(calls: Mapping[str, Sequence[str] | None], rounds: int, **environment: str) -> dict[str, float]:
    """The median seconds of whole commands, each a process of its own with compiled bytecode at hand."""
    known = {**os.environ, **environment}
    known.pop("PYTHONDONTWRITEBYTECODE", None)

    def start(words: Sequence[str]) -> Callable[[], object]:
        return lambda: subprocess.run(
            words, check=True, env=known, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL
        )

    return side_by_side({name: start(words) if words else None for name, words in calls.items()}, rounds)


_PEAK = """
import resource, subprocess, sys
subprocess.run(sys.argv[1:], check=True, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
print(resource.getrusage(resource.RUSAGE_CHILDREN).ru_maxrss)
"""


def peak_memory(words: Sequence[str], **environment: str) -> float:
    """The most memory (MB) that a command has at once."""
    known = {**os.environ, **environment}
    done = subprocess.run([sys.executable, "-c", _PEAK, *words], check=True, env=known, capture_output=True, text=True)
    return int(done.stdout) / (1000 if sys.platform != "darwin" else 1_000_000)
