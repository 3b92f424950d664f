from __future__ import annotations

from tests.nodes.conftest import clock, graph, log, logged, stage  # noqa: F401  # fixtures
