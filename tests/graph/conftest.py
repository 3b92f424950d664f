"""Fixtures of the graph tests: a graph with a clock that the test advances, and its log."""

from __future__ import annotations

import asyncio
from collections.abc import AsyncIterator

import pytest

from linkwright.graph import Graph, JumpClock, LogRecord


@pytest.fixture
def clock() -> JumpClock:
    return JumpClock()


@pytest.fixture
def log() -> list[LogRecord]:
    return []


@pytest.fixture
async def graph(clock: JumpClock, log: list[LogRecord]) -> AsyncIterator[Graph]:
    """Return a graph on a stopped clock; nothing may be left on the loop afterwards."""
    graph = Graph(clock=clock, on_log=log.append)
    yield graph
    await graph.close()
    assert asyncio.all_tasks() == {asyncio.current_task()}
    assert graph.node_names() == []
    assert graph.topics() == {}
