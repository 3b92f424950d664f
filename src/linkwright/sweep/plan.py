"""The runs of a scenario, each with parameter values and a seed."""

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
        parameters: the values by parameter name.
        seed: the seed of the random numbers.
    """

    row: int
    parameters: Mapping[str, Value]
    seed: int


def plan_runs(scenario: Scenario) -> list[Run]:
    """Return all runs of a scenario; runs with the same values and different seeds are adjacent.

    A drawn value depends only on the seed and the name of the parameter. It does not change if other parameters or
    seeds are added.
    """
    lists = {name: values for name, values in scenario.parameters.items() if not isinstance(values, Uniform | Normal)}
    drawn = {seed: _drawn(scenario, seed) for seed in scenario.seeds}
    runs: list[Run] = []
    for chosen in product(*lists.values()):
        together = dict(zip(lists, chosen, strict=True))
        for seed in scenario.seeds:
            values = {**together, **drawn[seed]}
            runs.append(Run(len(runs) + 1, {name: values[name] for name in scenario.parameters}, seed))
    return runs


def with_values(scenario: Scenario, texts: Mapping[str, str], seeds: int | None) -> Scenario:
    """Return a copy of a scenario with other parameter values or seeds.

    Args:
        scenario: the scenario.
        texts: for each parameter name, YAML values separated by commas.
        seeds: the number of seeds; None for the seeds of the file.

    Raises:
        LinkwrightError: SWEEP106, there is no such parameter; SWEEP105, the values are not valid.
    """
    parameters = dict(scenario.parameters)
    for name, text in texts.items():
        if name not in parameters:
            message = phrase("the scenario has no parameter '{name}'", name=name)
            raise LinkwrightError(Diagnostic("SWEEP106", message, hint=did_you_mean(name, parameters)))
        parameters[name] = _values(name, text)
    return replace(scenario, parameters=parameters, seeds=scenario.seeds if seeds is None else range(seeds))


def fingerprint(scenario: Scenario, runs: Sequence[Run]) -> str:
    """Return a hash of the scenario's file and runs."""
    plan = json.dumps([(run.parameters, run.seed) for run in runs])
    return hashlib.sha256(scenario.path.read_bytes() + plan.encode()).hexdigest()


def _values(name: str, text: str) -> list[Value]:
    try:
        values = yaml.safe_load(f"[{text}]")
    except yaml.YAMLError:
        values = None
    check_values(name, values)
    return list(values)


def _drawn(scenario: Scenario, seed: int) -> dict[str, float]:
    values = {}
    for name, law in scenario.parameters.items():
        random = np.random.default_rng([seed, crc32(name.encode())])
        if isinstance(law, Uniform):
            values[name] = float(random.uniform(law.low, law.high))
        elif isinstance(law, Normal):
            values[name] = float(random.normal(law.mean, law.stddev))
    return values
