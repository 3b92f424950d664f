"""Compare the results of a scenario that runs in both versions with the same parameters and seeds.

Runs are compared in pairs with equal parameters and seeds: the result of the new version with the result of the old
one. The interval of the mean difference is a bootstrap (Efron 1979) with fixed random numbers. Paths of robots are
compared point by point at the same times.
"""

from __future__ import annotations

import csv
import subprocess
import sys
from collections import defaultdict
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from linkwright.diagnostics import Phrase, counted, foreign, phrase
from linkwright.diagnostics.phrase import count_shown
from linkwright.files.scratch_folders import ScratchFolder
from linkwright.review.changes import Change, Effect, Problem, Subject, SubjectKind
from linkwright.review.paths import PathComparison, find_differing_paths, read_paths
from linkwright.review.versions import Version, Versions

_RESAMPLES = 4_000
_PERCENTILES = (2.5, 97.5)
"""The limits of the interval: it contains the mean difference with a probability of 95 %."""
_SEED, _ROW, _ERROR = "seed", "row", "error"
_MAX_DRAWN_COMPARISONS = 4
"""The number of comparisons of paths that a report draws."""
_BOOLEANS = {"true": 1.0, "false": 0.0}

Row = Mapping[str, str]
ParameterValues = tuple[str, ...]
Array = NDArray[np.float64]


@dataclass(frozen=True)
class _Run:
    """A run of the scenario.

    Attributes:
        row: the row of the table.
        paths: the points of paths by name, shape (points, 3).
    """

    row: Row
    paths: Mapping[str, Array]


@dataclass(frozen=True)
class _Runs:
    """The runs of a version.

    Attributes:
        parameters: the names of the parameters, without the seed.
        by_parameters: the runs by the values of their parameters and their seed.
    """

    parameters: Sequence[str]
    by_parameters: Mapping[ParameterValues, _Run]


def compare_behavior(versions: Versions, path: str, seeds: int | None = None) -> Subject:
    """Run a scenario in both versions, and compare its results.

    Each version of the file runs with the packages of the same version, so the code of both versions runs.

    Args:
        versions: both versions of the repository.
        path: the file of the scenario, relative to the root of the repository.
        seeds: the number of seeds; None for the number in the scenario.
    """
    problems: list[Problem] = []
    old = _run_scenario(versions.old, path, seeds, problems)
    new = _run_scenario(versions.new, path, seeds, problems)
    if old is None or new is None:
        return Subject(SubjectKind.SCENARIO, path, path, path, problems=problems)
    old_runs = old.by_parameters if old.parameters == new.parameters else {}
    paths = _compare_all_paths(old_runs, new)
    changes = [*_compare_results(old_runs, new.by_parameters), *_make_path_changes(paths)]
    return Subject(
        SubjectKind.SCENARIO, path, path, path, changes, problems=problems, paths=paths[:_MAX_DRAWN_COMPARISONS]
    )


def _run_scenario(version: Version, path: str, seeds: int | None, problems: list[Problem]) -> _Runs | None:
    """Return the runs of the scenario in a version, or None if there are none."""
    with ScratchFolder("sweep") as folder:
        table, paths_file = Path(folder) / "table.csv", Path(folder) / "paths.json"
        options = [] if seeds is None else ["--seeds", str(seeds)]
        outputs = ["--out", str(table), "--paths", str(paths_file)]
        command = [sys.executable, "-m", "linkwright", "sweep", str(version.file(path)), *outputs, *options]
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
        paths = read_paths(paths_file)
    names = list(rows[0]) if rows else [_ROW, _SEED]
    parameters = names[1 : names.index(_SEED) + 1]
    runs = {tuple(row[name] for name in parameters): _Run(row, paths[row[_ROW]]) for row in rows}
    return _Runs(parameters[:-1], runs)


def _compare_results(old: Mapping[ParameterValues, _Run], new: Mapping[ParameterValues, _Run]) -> Iterator[Change]:
    pairs = [(old[key].row, run.row) for key, run in new.items() if key in old]
    if not pairs:
        yield Change(phrase("the versions have no run with the same parameters and seed"))
        return
    failure_counts = [sum(bool(row[_ERROR]) for row in rows) for rows in zip(*pairs, strict=True)]
    if failure_counts[0] != failure_counts[1]:
        text = phrase(
            "{old} -> {new} of {count} runs failed", old=failure_counts[0], new=failure_counts[1], count=len(pairs)
        )
        reason = phrase("runs of the scenario end with an error") if failure_counts[1] > failure_counts[0] else None
        yield Change(text, Effect.CHANGED if reason is None else Effect.BREAKING, reason)
    names = [name for name in pairs[0][1] if name in pairs[0][0]]
    for name in names[names.index(_SEED) + 1 :]:
        if name != _ERROR:
            yield from _compare_result(name, [(old_row[name], new_row[name]) for old_row, new_row in pairs])


def _compare_result(name: str, pairs: Sequence[tuple[str, str]]) -> Iterator[Change]:
    """Yield the change in a result, if any of its values differs."""
    complete_pairs = [pair for pair in pairs if all(pair)]
    if all(old == new for old, new in complete_pairs):
        return
    if all(value in _BOOLEANS for pair in complete_pairs for value in pair):
        yield _compare_booleans(name, complete_pairs)
        return
    try:
        values = np.array([[float(value) for value in pair] for pair in complete_pairs])
    except ValueError:
        count = sum(old != new for old, new in complete_pairs)
        yield Change(
            phrase("{result}: {count} of {total} values differ", result=name, count=count, total=len(complete_pairs))
        )
        return
    low, high = _compute_confidence_interval(values[:, 1] - values[:, 0])
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


def _compare_booleans(name: str, pairs: Sequence[tuple[str, str]]) -> Change:
    """Return the change in a boolean result.

    A result that was always true in the old version counts as a requirement.
    """
    true_counts = [sum(value == "true" for value in values) for values in zip(*pairs, strict=True)]
    text = phrase(
        "{result}: true in {old} -> {new} of {count} runs",
        result=name,
        old=true_counts[0],
        new=true_counts[1],
        count=len(pairs),
    )
    if true_counts[0] < len(pairs) or true_counts[1] == len(pairs):
        return Change(text)
    return Change(text, Effect.BREAKING, phrase("it was true in all runs of the old version"))


def _compute_confidence_interval(differences: Array) -> tuple[float, float]:
    """Return the lower and upper limits of the mean of paired differences.

    Args:
        differences: a difference for each pair of runs, shape (runs,).
    """
    indexes = np.random.default_rng(0).integers(len(differences), size=(_RESAMPLES, len(differences)))
    low, high = np.percentile(differences[indexes].mean(axis=1), _PERCENTILES)
    return float(low), float(high)


# --- paths -----------------------------------------------------------------------------------------------------------


def _compare_all_paths(old: Mapping[ParameterValues, _Run], new: _Runs) -> list[PathComparison]:
    """Return the paths that differ, for each name and each set of parameters.

    Random parameters are ignored.
    """
    shared_keys = [key for key in new.by_parameters if key in old]
    fixed_indexes = [index for index in range(len(new.parameters)) if _is_fixed(shared_keys, index)]
    groups: dict[tuple[str, str], list[tuple[str, Array, Array]]] = defaultdict(list)
    for key in shared_keys:
        old_paths, new_paths = old[key].paths, new.by_parameters[key].paths
        values = " ".join(f"{new.parameters[index]}={key[index]}" for index in fixed_indexes)
        for name in (name for name in new_paths if name in old_paths):
            groups[name, values].append((key[-1], old_paths[name], new_paths[name]))
    return find_differing_paths(groups)


def _is_fixed(keys: Sequence[ParameterValues], index: int) -> bool:
    """Return whether a parameter has the same values for each seed, so that it is not random."""
    values: dict[str, set[str]] = defaultdict(set)
    for key in keys:
        values[key[-1]].add(key[index])
    return len({frozenset(texts) for texts in values.values()}) == 1


def _make_path_changes(comparisons: Sequence[PathComparison]) -> Iterator[Change]:
    shown = count_shown(len(comparisons), _MAX_DRAWN_COMPARISONS)
    yield from map(_make_path_change, comparisons[:shown])
    count = len(comparisons) - shown
    if count > 0:
        yield Change(
            counted(
                "{count} more set of paths differs, by smaller distances",
                "{count} more sets of paths differ, by smaller distances",
                count,
            )
        )


def _make_path_change(comparison: PathComparison) -> Change:
    farthest = comparison.farthest
    text: Phrase = phrase(
        "{result}: paths up to {distance:.3g} m apart (seed {seed}, after {time:.3g} s)",
        result=comparison.title,
        distance=farthest.distance,
        seed=farthest.seed,
        time=farthest.time,
    )
    if len(comparison.pairs) > 1:
        text = phrase(
            "{change}, median of {count} runs {distance:.3g} m",
            change=text,
            count=len(comparison.pairs),
            distance=comparison.typical.distance,
        )
    return Change(text)
