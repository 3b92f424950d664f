"""The comparison of the results of a scenario, which runs in both versions with the same parameters and seeds.

Runs are compared in pairs: of each set of parameters and each seed, the result of the new version with that of the old
one. The interval of the mean difference is a bootstrap (Efron 1979) with fixed random numbers.
"""

from __future__ import annotations

import csv
import subprocess
import sys
from collections.abc import Iterator, Mapping, Sequence
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from linkwright.diagnostics import foreign, phrase
from linkwright.files.scratch_folders import ScratchFolder
from linkwright.review.changes import Change, Effect, Problem, Subject, SubjectKind
from linkwright.review.versions import Version, Versions

_RESAMPLES = 4_000
_PERCENTILES = (2.5, 97.5)
"""The limits of the interval: it contains the mean difference with a probability of 95 %."""
_SEED, _ROW, _ERROR = "seed", "row", "error"
_TRUTH = {"true": 1.0, "false": 0.0}

Row = Mapping[str, str]
Parameters = tuple[str, ...]
Array = NDArray[np.float64]


def compare_behavior(versions: Versions, path: str, seeds: int | None = None) -> Subject:
    """Run a scenario in both versions, and compare its results.

    The file of each version is run with the packages of that version. So the code of both versions runs.

    Args:
        versions: the versions.
        path: the file of the scenario, relative to the root of the repository.
        seeds: the number of seeds; None for those of the scenario.
    """
    problems: list[Problem] = []
    old = _run(versions.old, path, seeds, problems)
    new = _run(versions.new, path, seeds, problems)
    changes = [] if old is None or new is None else list(_changes(old, new))
    return Subject(SubjectKind.SCENARIO, path, path, path, changes, problems=problems)


def _run(version: Version, path: str, seeds: int | None, problems: list[Problem]) -> dict[Parameters, Row] | None:
    """Return the rows of the scenario's table by their parameters and seeds, or None if there are none."""
    with ScratchFolder("sweep") as folder:
        table = Path(folder) / "table.csv"
        options = [] if seeds is None else ["--seeds", str(seeds)]
        command = [sys.executable, "-m", "linkwright", "sweep", str(version.file(path)), "--out", str(table), *options]
        result = subprocess.run(  # noqa: S603 - our own program
            command, cwd=version.file(path).parent, capture_output=True, encoding="utf-8", errors="replace", check=False
        )
        if not table.is_file():
            lines = result.stderr.strip().splitlines() or [f"{result.returncode}"]
            text = phrase("the scenario cannot run in the new version: {reason}", reason=foreign(lines[0]))
            if version.is_old:
                text = phrase("the scenario cannot run in the old version: {reason}", reason=foreign(lines[0]))
            problems.append(Problem(text, version.is_old))
            return None
        with table.open(encoding="utf-8", newline="") as file:
            rows = list(csv.DictReader(file))
    names = list(rows[0]) if rows else [_ROW, _SEED]
    parameters = names[1 : names.index(_SEED) + 1]
    return {tuple(row[name] for name in parameters): row for row in rows}


def _changes(old: Mapping[Parameters, Row], new: Mapping[Parameters, Row]) -> Iterator[Change]:
    pairs = [(old[key], row) for key, row in new.items() if key in old]
    if not pairs:
        yield Change(phrase("the versions have no run with the same parameters and seed"))
        return
    failed = [sum(bool(row[_ERROR]) for row in rows) for rows in zip(*pairs, strict=True)]
    if failed[0] != failed[1]:
        text = phrase("{old} -> {new} of {count} runs failed", old=failed[0], new=failed[1], count=len(pairs))
        reason = phrase("runs of the scenario end with an error") if failed[1] > failed[0] else None
        yield Change(text, Effect.CHANGED if reason is None else Effect.BREAKING, reason)
    names = [name for name in pairs[0][1] if name in pairs[0][0]]
    for name in names[names.index(_SEED) + 1 :]:
        if name != _ERROR:
            yield from _result(name, [(old_row[name], new_row[name]) for old_row, new_row in pairs])


def _result(name: str, pairs: Sequence[tuple[str, str]]) -> Iterator[Change]:
    """Yield the change of a result, if any of its values differs."""
    known = [pair for pair in pairs if all(pair)]
    if all(old == new for old, new in known):
        return
    if all(value in _TRUTH for pair in known for value in pair):
        yield _bound(name, known)
        return
    try:
        values = np.array([[float(value) for value in pair] for pair in known])
    except ValueError:
        count = sum(old != new for old, new in known)
        yield Change(phrase("{result}: {count} of {total} values differ", result=name, count=count, total=len(known)))
        return
    low, high = _interval(values[:, 1] - values[:, 0])
    old_mean, new_mean = values.mean(axis=0)
    text = phrase(
        "{result}: mean {old:.4g} -> {new:.4g}, difference {low:.3g} to {high:.3g}",
        result=name,
        old=float(old_mean),
        new=float(new_mean),
        low=low,
        high=high,
    )
    yield Change(phrase("{change}, within the noise", change=text) if low <= 0.0 <= high else text)


def _bound(name: str, pairs: Sequence[tuple[str, str]]) -> Change:
    """Return the change of a result that is true or false. One that was always true is a bound."""
    counts = [sum(value == "true" for value in values) for values in zip(*pairs, strict=True)]
    text = phrase(
        "{result}: true in {old} -> {new} of {count} runs", result=name, old=counts[0], new=counts[1], count=len(pairs)
    )
    if counts[0] < len(pairs) or counts[1] == len(pairs):
        return Change(text)
    return Change(text, Effect.BREAKING, phrase("it was true in all runs of the old version"))


def _interval(differences: Array) -> tuple[float, float]:
    """Return the limits between which the mean of paired differences is.

    Args:
        differences: a difference for each pair of runs, shape (runs,).
    """
    indexes = np.random.default_rng(0).integers(len(differences), size=(_RESAMPLES, len(differences)))
    low, high = np.percentile(differences[indexes].mean(axis=1), _PERCENTILES)
    return float(low), float(high)
