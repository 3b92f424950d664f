from __future__ import annotations

import pytest

from tests.control.stand import Stand
from tests.graph.conftest import clock, graph, log  # noqa: F401  # fixtures


@pytest.fixture
def stand(graph, log) -> Stand:  # noqa: F811
    """A graph with controllers that are stepped by hand."""
    return Stand(graph, log)
