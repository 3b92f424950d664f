"""Benchmarks are run only by hand, so these tests check that their imports exist."""

from __future__ import annotations

import importlib
import pkgutil

import benchmarks
import pytest
from benchmarks import report

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
