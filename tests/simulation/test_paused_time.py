"""The time that a paused simulation publishes."""

from __future__ import annotations

import pytest

from linkwright.graph import Graph
from linkwright.nodes import NodeOptions
from linkwright.simulation.nodes.simulator import GzServer, Simulator
from linkwright.testing import Recording
from tests.waiting import eventually


@pytest.mark.parametrize(("node_type", "repeats"), [(GzServer, True), (Simulator, False)])
async def test_only_gz_repeats_the_time_while_paused(node_type, repeats):
    graph = Graph()
    simulator = node_type(graph, NodeOptions(parameters={"pause": True}))
    times = Recording(graph, simulator.node, "/clock")
    poses = Recording(graph, simulator.node, "/world_poses")  # at 30 Hz of real time, also while paused
    await eventually(lambda: len(poses) > 10)
    await graph.settle()
    assert (len(times) >= 2) == repeats
    assert all(time.clock.sec == time.clock.nanosec == 0 for time in times)
    simulator.close()
    await graph.close()
