from __future__ import annotations

import pytest

from linkwright.graph import LogLevel
from tests.graph.conftest import clock, graph, log  # noqa: F401  # fixtures
from tests.nodes.stage import Stage


@pytest.fixture
def stage(graph, clock, log) -> Stage:  # noqa: F811
    return Stage(graph, clock, log)


@pytest.fixture
def logged(log):  # noqa: F811
    """Return a function that returns the log's texts of a level."""

    def texts(level: str) -> list[str]:
        return [record.text for record in log if record.level is LogLevel[level]]

    return texts
