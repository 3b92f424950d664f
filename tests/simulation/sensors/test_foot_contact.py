"""Contact forces of feet: the weight of a leg, in the axes of its link."""

from __future__ import annotations

import pytest

from linkwright.testing import Recording
from tests.simulation.test_plugins import SECOND_NS, running_server
from tests.simulation.worlds import GROUND

SENSOR = (
    '<sensor name="FL_foot_contact" type="contact"><update_rate>100</update_rate>'
    '<plugin name="contactPlugin" filename="libunitreeFootContactPlugin.so"/>'
    "<contact><collision>box</collision></contact></sensor>"
)


def leg(pose: str) -> str:
    return (
        f'<model name="leg"><pose>{pose}</pose><link name="foot"><inertial><mass>2</mass></inertial>'
        '<collision name="box"><geometry><box><size>0.2 0.2 0.2</size></box></geometry></collision>'
        f"{SENSOR}</link></model>"
    )


@pytest.mark.parametrize(
    ("pose", "force"), [("0 0 0.1 0 0 0", (0.0, 0.0, 19.62)), ("0 0 0.1 1.5707963 0 0", (0.0, 19.62, 0.0))]
)
async def test_force_is_in_the_axes_of_the_link(pose, force):
    async with running_server(GROUND, leg(pose)) as (server, graph, log):
        recording = Recording(graph, server.node, "/visual/FL_foot_contact/the_force")
        server.advance(SECOND_NS)
        await graph.settle()
        wrench = recording.last.wrench.force
        assert (wrench.x, wrench.y, wrench.z) == pytest.approx(force, abs=0.3)
        assert recording.last.header.frame_id == "foot"
        assert len(recording) == 100
        assert not log, [record.text for record in log]


async def test_force_in_the_air_is_zero():
    async with running_server(GROUND, leg("0 0 9 0 0 0")) as (server, graph, _):
        recording = Recording(graph, server.node, "/visual/FL_foot_contact/the_force")
        server.advance(SECOND_NS // 10)
        await graph.settle()
        wrench = recording.last.wrench.force
        assert (wrench.x, wrench.y, wrench.z) == (0.0, 0.0, 0.0)


async def test_feet_with_plugins_of_the_same_name_are_all_measured():
    other = leg("3 0 0.1 0 0 0").replace('"leg"', '"other"').replace("FL_foot", "FR_foot")
    async with running_server(GROUND, leg("0 0 0.1 0 0 0"), other) as (server, graph, log):
        recordings = [Recording(graph, server.node, f"/visual/{name}_foot_contact/the_force") for name in ("FL", "FR")]
        server.advance(SECOND_NS)
        await graph.settle()
        assert [recording.last.wrench.force.z for recording in recordings] == pytest.approx([19.62] * 2, abs=0.3)
        assert not log, [record.text for record in log]
