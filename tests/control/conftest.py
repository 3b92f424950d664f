from __future__ import annotations

import pytest

from linkwright.graph import LogLevel
from tests.control.stand import Stand
from tests.graph.conftest import clock, graph, log  # noqa: F401  # fixtures


@pytest.fixture
def stand(graph, log) -> Stand:  # noqa: F811
    """A graph with controllers that are stepped by hand."""
    return Stand(graph, log)


@pytest.fixture
def logged(log):  # noqa: F811
    """What was logged at a level."""

    def texts(level: str) -> list[str]:
        return [record.text for record in log if record.level is LogLevel[level]]

    return texts
