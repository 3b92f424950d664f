"""Fixtures of the node tests: a harness, and the texts of the log."""

from __future__ import annotations

import pytest

from linkwright.graph import LogLevel
from tests.graph.conftest import clock, graph, log  # noqa: F401  # fixtures
from tests.nodes.harness import NodeHarness


@pytest.fixture
def harness(graph, clock, log) -> NodeHarness:  # noqa: F811
    return NodeHarness(graph, clock, log)


@pytest.fixture
def logged(log):  # noqa: F811
    """Return a function that returns the log's texts of a level."""

    def texts(level: str) -> list[str]:
        return [record.text for record in log if record.level is LogLevel[level]]

    return texts
