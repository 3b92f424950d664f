from __future__ import annotations

from tests.graph.conftest import clock, graph, log  # noqa: F401  # fixtures
