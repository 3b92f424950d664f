"""Plan the runs of a scenario, each with parameter values and a seed."""

from __future__ import annotations

import hashlib
import json
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from itertools import product
from zlib import crc32

import numpy as np
import yaml

from linkwright.diagnostics import Diagnostic, LinkwrightError, did_you_mean, phrase
from linkwright.sweep.scenario import Normal, Scenario, Uniform, Value, check_values


@dataclass(frozen=True, slots=True)
class Run:
    """One run of a scenario.

    Attributes:
        row: the row number, starting at 1.
        parameters: the value of each parameter.
        seed: the seed for random numbers.
        records_paths: whether the outcome has the paths of robots.
    """

    row: int
    parameters: Mapping[str, Value]
    seed: int
    records_paths: bool = False


def plan_runs(scenario: Scenario, *, records_paths: bool = False) -> list[Run]:
    """Return all runs of a scenario.

    Runs with the same listed values and different seeds are adjacent. A drawn value depends only on the seed and the
    name of its parameter. It does not change if other parameters or seeds are added.
    """
    lists = {name: values for name, values in scenario.parameters.items() if not isinstance(values, Uniform | Normal)}
    values_by_seed = {seed: _draw_values(scenario, seed) for seed in scenario.seeds}
    runs: list[Run] = []
    for combination in product(*lists.values()):
        listed_values = dict(zip(lists, combination, strict=True))
        for seed in scenario.seeds:
            values = {**listed_values, **values_by_seed[seed]}
            parameters = {name: values[name] for name in scenario.parameters}
            runs.append(Run(len(runs) + 1, parameters, seed, records_paths))
    return runs


def replace_values(scenario: Scenario, texts: Mapping[str, str], seeds: int | None) -> Scenario:
    """Return a copy of a scenario with other parameter values or seeds.

    Args:
        scenario: the scenario.
        texts: for the name of each changed parameter, YAML values separated by commas.
        seeds: the number of seeds, starting at 0; None for the seeds of the file.

    Raises:
        LinkwrightError: SWEEP106, there is no such parameter; SWEEP105, the values are not valid.
    """
    parameters = dict(scenario.parameters)
    for name, text in texts.items():
        if name not in parameters:
            message = phrase("the scenario has no parameter '{name}'", name=name)
            raise LinkwrightError(Diagnostic("SWEEP106", message, hint=did_you_mean(name, parameters)))
        parameters[name] = _parse_values(name, text)
    return replace(scenario, parameters=parameters, seeds=scenario.seeds if seeds is None else range(seeds))


def compute_fingerprint(scenario: Scenario, runs: Sequence[Run]) -> str:
    """Return a hash of the scenario's file and of the runs' parameters, seeds and recordings."""
    plan = json.dumps([(run.parameters, run.seed, run.records_paths) for run in runs])
    return hashlib.sha256(scenario.path.read_bytes() + plan.encode()).hexdigest()


def _parse_values(name: str, text: str) -> list[Value]:
    try:
        values = yaml.safe_load(f"[{text}]")
    except yaml.YAMLError:
        values = None
    check_values(name, values)
    return list(values)


def _draw_values(scenario: Scenario, seed: int) -> dict[str, float]:
    values = {}
    for name, distribution in scenario.parameters.items():
        generator = np.random.default_rng([seed, crc32(name.encode())])
        if isinstance(distribution, Uniform):
            values[name] = float(generator.uniform(distribution.low, distribution.high))
        elif isinstance(distribution, Normal):
            values[name] = float(generator.normal(distribution.mean, distribution.stddev))
    return values
