from __future__ import annotations

from tests.nodes.conftest import clock, graph, log, logged  # noqa: F401  # fixtures
