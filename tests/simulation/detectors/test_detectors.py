"""Plugins that report events."""

from __future__ import annotations

import pytest

from linkwright.messages import get_service
from linkwright.testing import Recording
from tests.simulation.fluids.server import running_server, weightless_server
from tests.simulation.test_plugins import SECOND_NS
from tests.simulation.worlds import GROUND, box


async def messages_after(server, graph, topic: str, seconds: float) -> list:
    """Return the messages of a topic within a time."""
    recording = Recording(graph, server.node, topic)
    server.advance(round(seconds * SECOND_NS))
    await graph.settle()
    return list(recording)


# --- kinetic energy ---------------------------------------------------------------------------------------------------


def monitored_model(parameters: str = "") -> str:
    plugin = (
        '<plugin name="gz::sim::systems::KineticEnergyMonitor" filename="gz-sim-kinetic-energy-monitor-system">'
        f"<link_name>link</link_name>{parameters}</plugin>"
    )
    return box("crate", "0 0 0.8 0 0 0", "0.6 0.6 0.6", 2.0).replace("</model>", f"{plugin}</model>")


async def test_loss_of_kinetic_energy_in_fall_is_published():
    async with running_server(GROUND, monitored_model()) as (server, graph, log):
        losses = await messages_after(server, graph, "/model/crate/kinetic_energy", 1.0)
        energy = 2.0 * 9.81 * 0.5  # of a fall of 0.5 m
        assert [message.data for message in losses] == pytest.approx([energy], rel=0.1)
        assert not log
    parameters = "<kinetic_energy_threshold>20</kinetic_energy_threshold><topic>/loss</topic>"
    async with running_server(GROUND, monitored_model(parameters)) as (server, graph, _):
        assert not await messages_after(server, graph, "/loss", 1.0)


async def test_kinetic_energy_has_parts_of_translation_and_rotation():
    text = monitored_model("<kinetic_energy_threshold>1</kinetic_energy_threshold>")
    async with weightless_server(text) as (server, graph, _):
        server.simulation.set_model_velocity("crate", (3.0, 0.0, 0.0), (0.0, 0.0, 5.0))
        server.advance(SECOND_NS // 10)
        server.simulation.set_model_velocity("crate", (0.0, 0.0, 0.0), (0.0, 0.0, 0.0))
        (message,) = await messages_after(server, graph, "/model/crate/kinetic_energy", 0.1)
        inertia = 2.0 * 0.36 / 6.0
        assert message.data == pytest.approx(0.5 * (2.0 * 9.0 + inertia * 25.0), rel=1e-3)


# --- touches ----------------------------------------------------------------------------------------------------------

SENSOR = '<sensor name="bumper" type="contact"><contact><collision>collision</collision></contact></sensor>'


def touching_model(parameters: str, sensor: str = SENSOR) -> str:
    plugin = (
        '<plugin name="gz::sim::systems::TouchPlugin" filename="gz-sim-touchplugin-system"><target>ground</target>'
        f"<time>0.5</time>{parameters}</plugin>"
    )
    text = box("crate", "0 0 0.3 0 0 0", "0.6 0.6 0.6", 2.0).replace("</link>", f"{sensor}</link>")
    return text.replace("</model>", f"{plugin}</model>")


ENABLED = "<enabled>true</enabled><namespace>feet</namespace>"


async def test_touch_is_reported_once_after_its_time():
    async with running_server(GROUND, touching_model(ENABLED)) as (server, graph, log):
        assert not await messages_after(server, graph, "/feet/touched", 0.4)
        (message,) = await messages_after(server, graph, "/feet/touched", 2.0)
        assert message.data
        server.reset()
        assert len(await messages_after(server, graph, "/feet/touched", 1.0)) == 1
        assert not log


async def test_service_enables_disabled_plugin():
    async with running_server(GROUND, touching_model("")) as (server, graph, _):
        assert not await messages_after(server, graph, "/model/crate/touch/touched", 1.0)
        client = graph.create_node("operator").create_client("std_srvs/srv/SetBool", "/model/crate/touch/enable")
        future = client.call_async(get_service("std_srvs/srv/SetBool").Request(data=True))
        await graph.settle()
        server.advance(SECOND_NS // 100)
        await graph.settle()
        assert future.result().success
        assert len(await messages_after(server, graph, "/model/crate/touch/touched", 1.0)) == 1


async def test_only_target_and_chosen_collisions_count():
    for text, count in (
        (touching_model(ENABLED).replace("<target>ground", "<target>wall"), 0),
        (touching_model(ENABLED).replace("<target>ground", "<target>ground/link"), 1),
        (touching_model(f"{ENABLED}<collision>crate::link::collision</collision>"), 1),
        (touching_model(f"{ENABLED}<collision>collision</collision>"), 1),
    ):
        async with running_server(GROUND, text) as (server, graph, _):
            assert len(await messages_after(server, graph, "/feet/touched", 1.0)) == count


async def test_missing_contact_sensor_is_reported_or_created():
    async with running_server(GROUND, touching_model(ENABLED, sensor="")) as (_, __, log):
        assert any("no such collision of 'crate' has a contact sensor" in record.text for record in log)
    create = "<create_contact_sensor_for_collision>true</create_contact_sensor_for_collision>"
    async with running_server(GROUND, touching_model(ENABLED + create, sensor="")) as (server, graph, _):
        assert len(await messages_after(server, graph, "/feet/touched", 1.0)) == 1


# --- performers -------------------------------------------------------------------------------------------------------


def gate_model(parameters: str = "", size: str = "<geometry><box><size>2 2 2</size></box></geometry>") -> str:
    return (
        '<model name="gate"><static>true</static><pose>5 0 0 0 0 1.5707963</pose><link name="link"/>'
        '<plugin name="gz::sim::systems::PerformerDetector" filename="gz-sim-performer-detector-system">'
        f"{size}{parameters}</plugin></model>"
    )


PERFORMERS = (
    '<plugin name="gz::sim" filename="dummy"><performer name="p"><ref>crate</ref><geometry><box>'
    "<size>1 1 1</size></box></geometry></performer></plugin>"
)
STATUS = "/model/gate/performer_detector/status"


async def test_performer_is_reported_when_it_enters_and_leaves():
    async with weightless_server(gate_model(), box("crate", "0 0 0 0 0 0"), PERFORMERS) as (server, graph, log):
        for x, count in ((3.4, 0), (3.6, 1), (6.4, 0), (6.6, 1)):
            server.simulation.set_model_pose("crate", (x, 0.0, 0.0, 0.0, 0.0, 0.0, 1.0))
            messages = await messages_after(server, graph, STATUS, 0.1)
            assert len(messages) == count, x
        (message,) = messages
        assert (message.header.frame_id, message.child_frame_id) == ("gate", "crate")
        assert message.transform.translation.y == pytest.approx(-1.6)
        assert not log


async def test_region_is_moved_by_pose_in_frame_of_model():
    parameters = "<pose>2 0 0 0 0 0</pose><topic>/seen</topic>"
    async with weightless_server(gate_model(parameters), box("crate", "5 3.4 0 0 0 0"), PERFORMERS) as (
        server,
        graph,
        _,
    ):
        assert len(await messages_after(server, graph, "/seen", 0.1)) == 1


async def test_missing_region_is_reported():
    async with weightless_server(gate_model(size="")) as (_, __, log):
        assert any("<geometry> needs a <box> with a <size>" in record.text for record in log)
