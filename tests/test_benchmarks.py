"""Benchmarks are run only by hand, so these tests check that their imports exist."""

from __future__ import annotations

import importlib
import pkgutil

import benchmarks
import numpy as np
import pytest
from benchmarks import report
from benchmarks.reachable import has_path
from numpy.typing import NDArray

NODES = {"soak_parts"}
"""Programs that need importable modules of ROS 2."""
MODULES = {iter_module.name for iter_module in pkgutil.iter_modules(benchmarks.__path__)} - NODES - {"__main__"}


@pytest.mark.parametrize("name", sorted(MODULES))
def test_benchmark_can_be_imported(name: str) -> None:
    importlib.import_module(f"benchmarks.{name}")


def test_each_measurement_has_a_section_of_its_own_in_the_page() -> None:
    measured = {name.removeprefix("bench_") for name in MODULES if name.startswith("bench_")}
    assert measured == set(report.TITLES)
    for titles in zip(*report.TITLES.values(), strict=True):
        assert len(set(titles)) == len(titles)


@pytest.mark.parametrize("gap", [0.3, 0.0])
def test_path_is_found_exactly_if_the_wall_has_a_gap(gap: float) -> None:
    random = np.random.default_rng(1)

    def is_free(point: NDArray[np.float64]) -> bool:
        return abs(point[0]) > 0.05 or 1.0 - gap < point[1] <= 1.0

    ends = np.array((-0.5, -0.5)), np.array((0.5, -0.5))
    assert has_path(*ends, lambda: random.uniform(-1.0, 1.0, 2), is_free, 10.0 if gap else 0.2) is (gap > 0.0)
