from __future__ import annotations

import pytest

from tests.nodes.conftest import clock, graph, log, logged  # noqa: F401  # fixtures
from tests.planning.nodes.bench import START, Bench


@pytest.fixture
async def bench(graph):  # noqa: F811
    bench = Bench(graph)
    await bench.set_state(**START)
    yield bench
    bench.move_group.close()
