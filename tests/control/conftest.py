"""Fixtures of the controller tests: a test bench, and the texts of the log."""

from __future__ import annotations

import pytest

from linkwright.graph import LogLevel
from tests.control.bench import TestBench
from tests.graph.conftest import clock, graph, log  # noqa: F401  # fixtures


@pytest.fixture
def bench(graph, log) -> TestBench:  # noqa: F811
    """Return a test bench whose controllers are stepped by hand."""
    return TestBench(graph, log)


@pytest.fixture
def logged(log):  # noqa: F811
    """Return a function that returns the log's texts of a level."""

    def texts(level: str) -> list[str]:
        return [record.text for record in log if record.level is LogLevel[level]]

    return texts
