"""Pausing and resuming of a running world, which respect the user's choice."""

from __future__ import annotations

from linkwright.graph import Graph
from linkwright.hosting.world_pause import WorldPause
from linkwright.testing import AsyncSteppedGraph
from tests.learning.simulator import FakeSimulator


def create_pause(graph: Graph) -> WorldPause:
    return WorldPause(graph.create_node("classroom"))


async def test_a_running_world_is_paused_and_resumed() -> None:
    async with AsyncSteppedGraph() as test:
        simulator, pause = FakeSimulator(test.graph), create_pause(test.graph)
        await test.advance(0.1)
        assert pause.set_active(True)
        await test.advance(0.1)
        assert not pause.set_active(False)
        await test.advance(0.1)
    assert simulator.calls == ["pause", "resume"]


async def test_a_world_that_the_user_has_paused_stays_paused() -> None:
    async with AsyncSteppedGraph() as test:
        simulator, pause = FakeSimulator(test.graph, paused=True), create_pause(test.graph)
        await test.advance(0.1)
        pause.begin()
        assert not pause.is_active
        pause.end()
        await test.advance(0.1)
    assert simulator.calls == []


async def test_a_world_that_the_user_has_resumed_is_left_alone() -> None:
    async with AsyncSteppedGraph() as test:
        simulator, pause = FakeSimulator(test.graph), create_pause(test.graph)
        await test.advance(0.1)
        pause.begin()
        await test.advance(0.1)
        simulator.set_paused(paused=False)
        await test.advance(0.1)
        pause.end()
        await test.advance(0.1)
    assert simulator.calls == ["pause"]


async def test_a_pause_without_a_world_does_nothing() -> None:
    async with AsyncSteppedGraph() as test:
        pause = create_pause(test.graph)
        pause.begin()
        assert not pause.is_active
        pause.end()
