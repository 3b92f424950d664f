"""Particles: how many there are, where they are, and how they look."""

from __future__ import annotations

import numpy as np
import pytest

from linkwright.messages import get_message
from linkwright.simulation.plugins.particles import PARTICLES_TOPIC, has_particles
from linkwright.testing import Recording
from tests.simulation.test_plugins import SECOND_NS, running_server
from tests.simulation.worlds import world

SYSTEM = '<plugin name="gz::sim::systems::ParticleEmitter" filename="gz-sim-particle-emitter-system"/>'
DELETE = 2


def chimney(parameters: str = "", shape: str = "point", pose: str = "0 0 1 0 -1.5707963267948966 0") -> str:
    """Return a static model that emits particles upward."""
    return (
        '<model name="chimney"><static>true</static><pose>1 2 0 0 0 0</pose><link name="link">'
        f'<particle_emitter name="smoke" type="{shape}"><pose>{pose}</pose>{parameters}</particle_emitter></link>'
        "</model>"
    )


def positions(message) -> np.ndarray:
    return np.array([(point.x, point.y, point.z) for marker in message.markers for point in marker.points])


async def last_message(*parts: str, seconds: float):
    async with running_server(SYSTEM, *parts, step=0.01) as (server, graph, log):
        recording = Recording(graph, server.node, PARTICLES_TOPIC)
        await graph.settle()
        server.advance(round(seconds * SECOND_NS))
        await graph.settle()
        assert not log, [record.text for record in log]
        return recording.last


async def test_particles_rise_at_their_speed_until_their_lifetime_ends():
    message = await last_message(
        chimney(
            "<rate>50</rate><lifetime>2</lifetime><min_velocity>0.5</min_velocity><max_velocity>0.5</max_velocity>"
        ),
        seconds=10,
    )
    points = positions(message)
    assert len(points) == pytest.approx(50 * 2, abs=5)
    assert points[:, :2] == pytest.approx(np.tile((1.0, 2.0), (len(points), 1)), abs=1e-6)
    assert points[:, 2].min() == pytest.approx(1.0, abs=0.05)
    assert points[:, 2].max() == pytest.approx(1.0 + 0.5 * 2, abs=0.05)
    assert {marker.header.frame_id for marker in message.markers} == {"world"}
    assert {marker.ns for marker in message.markers} == {"chimney::link::smoke"}


@pytest.mark.parametrize("shape", ["box", "cylinder", "ellipsoid"])
async def test_particles_start_in_shape(shape):
    parameters = "<rate>200</rate><lifetime>2</lifetime><min_velocity>0</min_velocity><max_velocity>0</max_velocity>"
    message = await last_message(chimney(parameters + "<size>2 4 1</size>", shape, "0 0 0 0 0 0"), seconds=5)
    x, y, z = ((positions(message) - (1.0, 2.0, 0.0)) / (2.0, 4.0, 1.0)).T
    radii = {"box": np.zeros_like(x), "cylinder": np.hypot(x, y), "ellipsoid": np.sqrt(x**2 + y**2 + z**2)}
    assert radii[shape].max() <= 0.5
    assert max(np.abs(x).max(), np.abs(y).max(), np.abs(z).max()) <= 0.5
    assert np.abs(x).max() > 0.45
    fractions = {"box": 1.0, "cylinder": np.pi / 4, "ellipsoid": np.pi / 6}
    corners = (np.abs(x) > 0.36) & (np.abs(y) > 0.36)  # outside of the circle
    assert bool(corners.any()) is (fractions[shape] == 1.0)


async def test_particles_grow_and_change_color():
    message = await last_message(
        chimney(
            "<rate>60</rate><lifetime>3</lifetime><particle_size>0.2 0.2 0.2</particle_size><scale_rate>1</scale_rate>"
            "<color_start>1 0 0</color_start><color_end>0 0 1 0</color_end>"
        ),
        seconds=5,
    )
    middles = (np.arange(6) + 0.5) / 6
    assert [marker.scale.x for marker in message.markers] == pytest.approx(0.2 * (1 + 3 * middles))
    assert [marker.color.r for marker in message.markers] == pytest.approx(1 - middles, abs=1e-6)
    assert [marker.color.a for marker in message.markers] == pytest.approx(1 - middles, abs=1e-6)


async def test_number_of_particles_is_limited():
    message = await last_message(chimney("<rate>10000</rate><lifetime>100</lifetime>"), seconds=1)
    assert len(positions(message)) == 500


@pytest.mark.parametrize(
    ("parameters", "topic"),
    [("", "/model/chimney/link/link/particle_emitter/smoke/cmd"), ("<topic>smoke</topic>", "/smoke")],
)
async def test_topic_switches_emitter_and_reset_restores_it(parameters, topic):
    async with running_server(
        SYSTEM, chimney(parameters + "<emitting>false</emitting><lifetime>1</lifetime>"), step=0.01
    ) as (server, graph, log):
        recording = Recording(graph, server.node, PARTICLES_TOPIC)
        publisher = graph.create_node("stoker").create_publisher("std_msgs/msg/Bool", topic, 10)
        for command, has_particles_now in ((None, False), (True, True), (False, False), (True, True)):
            if command is not None:
                publisher.publish(get_message("std_msgs/msg/Bool")(data=command))
            await graph.settle()
            server.advance(2 * SECOND_NS)
            await graph.settle()
            assert bool(len(positions(recording.last))) is has_particles_now
            assert has_particles_now or {marker.action for marker in recording.last.markers} == {DELETE}
        server.reset()
        server.advance(2 * SECOND_NS)
        await graph.settle()
        assert len(positions(recording.last)) == 0
        assert not log


async def test_emitter_stops_after_its_duration():
    parameters = "<duration>2</duration><lifetime>1</lifetime>"
    assert len(positions(await last_message(chimney(parameters), seconds=2))) > 0
    assert len(positions(await last_message(chimney(parameters), seconds=4))) == 0


async def test_particles_of_deleted_model_are_removed():
    async with running_server(SYSTEM, chimney(), step=0.01) as (server, graph, _):
        recording = Recording(graph, server.node, PARTICLES_TOPIC)
        await graph.settle()
        server.advance(2 * SECOND_NS)
        server.simulation.delete("chimney")
        server.advance(SECOND_NS)
        await graph.settle()
        assert {(marker.ns, marker.action) for marker in recording.last.markers} == {("chimney::link::smoke", DELETE)}
        count = len(recording)
        server.advance(SECOND_NS)
        await graph.settle()
        assert len(recording) == count


async def test_emitters_are_told_of_only_without_the_system():
    async with running_server(chimney()) as (_, __, log):
        assert [record.text for record in log] == ["these elements are not simulated: <particle_emitter>"]
    assert has_particles(world(SYSTEM, chimney()))
    assert has_particles(world(SYSTEM), "<particle_emitter/>")
    assert not has_particles(world(SYSTEM))
    assert not has_particles(world(chimney()))


@pytest.mark.parametrize(
    ("parameters", "text"),
    [
        ("<size>1 2</size>", "<particle_emitter> needs 3 numbers in <size>"),
        ("<color_end>red</color_end>", "<particle_emitter> needs 4 numbers in <color_end>"),
        ("<rate>many</rate>", "<particle_emitter> needs a number in <rate>"),
    ],
)
async def test_invalid_emitters_are_reported(parameters, text):
    async with running_server(SYSTEM, chimney(parameters)) as (_, __, log):
        assert any(text in record.text for record in log), [record.text for record in log]
