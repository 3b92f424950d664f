"""Joint states of vehicles of uuv_simulator."""

from __future__ import annotations

import pytest

from linkwright.testing import Recording
from tests.simulation.test_plugins import SECOND_NS, robot, running_server


@pytest.mark.parametrize(
    ("parameters", "topic", "count"),
    [
        ("", "/mbot/joint_states", 50),
        ("<robotNamespace>uuv</robotNamespace><updateRate>20</updateRate>", "/uuv/joint_states", 20),
    ],
)
async def test_all_joints_are_published_in_namespace_of_plugin(parameters, topic, count):
    plugin = f'<plugin name="j" filename="libuuv_joint_state_publisher.so">{parameters}</plugin>'
    async with running_server(robot(plugin)) as (server, graph, log):
        recording = Recording(graph, server.node, topic)
        await graph.settle()
        server.simulation.set_joint_position("mbot::left_joint", 0.25)
        server.advance(SECOND_NS)
        await graph.settle()
        assert not log, [record.text for record in log]
        assert len(recording) == count
        assert {"left_joint", "right_joint"} <= set(recording.last.name)
        assert len(recording.last.position) == len(recording.last.velocity) == len(recording.last.name)
        assert recording[0].position[recording[0].name.index("left_joint")] == pytest.approx(0.25, abs=0.05)
