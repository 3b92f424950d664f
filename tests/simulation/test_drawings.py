"""What plugins draw: forces as arrows, and the paths of links."""

from __future__ import annotations

import numpy as np
import pytest

from linkwright.messages import get_message
from linkwright.simulation.plugins.drawings import find_color, has_drawings
from linkwright.simulation.plugins.particles import PARTICLES_TOPIC
from linkwright.testing import Recording
from tests.simulation.test_plugins import SECOND_NS, running_server
from tests.simulation.worlds import world

WRENCH = "geometry_msgs/msg/WrenchStamped"


def foot(plugin: str, model_plugin: str = "") -> str:
    return (
        '<model name="dog"><pose>1 0 1 0 0 1.5707963</pose><link name="foot"><inertial><mass>1</mass></inertial>'
        '<visual name="ball"><pose>0 0 -0.1 0 0 0</pose><geometry><sphere><radius>0.02</radius></sphere></geometry>'
        f"{plugin}</visual></link>{model_plugin}</model>"
    )


async def draw(text: str, topic: str) -> tuple:
    """Return the last marker after a force of 10 N along x, and the log."""
    async with running_server(text, gravity="0 0 0") as (server, graph, log):
        recording = Recording(graph, server.node, PARTICLES_TOPIC)
        message = get_message(WRENCH)()
        message.wrench.force.x = 10.0
        graph.create_node("foot").create_publisher(WRENCH, topic, 10).publish(message)
        await graph.settle()
        server.advance(SECOND_NS // 10)
        await graph.settle()
        return recording.last.markers[-1], [record.text for record in log]


def points(marker) -> np.ndarray:
    return np.array([(point.x, point.y, point.z) for point in marker.points])


async def test_force_of_a_foot_is_drawn_at_its_visual():
    plugin = '<plugin name="d" filename="libunitreeDrawForcePlugin.so"><topicName>FR_foot_contact</topicName></plugin>'
    marker, log = await draw(foot(plugin), "/visual/FR_foot_contact/the_force")
    assert points(marker) == pytest.approx(np.array(((1.0, 0.0, 0.9), (1.0, 0.5, 0.9))), abs=1e-6)
    assert (marker.color.r, marker.color.g, marker.color.b) == (1.0, 0.0, 1.0)
    assert not log


async def test_force_visual_draws_at_the_named_link_with_its_scale():
    plugin = (
        '<plugin name="f" filename="libForceVisual.so"><topic_name>lift_force/left</topic_name>'
        "<link_name>foot</link_name><scale>0.1</scale><color>Gazebo/Red</color></plugin>"
    )
    marker, log = await draw(foot(plugin), "/dog/lift_force/left")
    assert points(marker) == pytest.approx(np.array(((1.0, 0.0, 1.0), (1.0, 1.0, 1.0))), abs=1e-6)
    assert (marker.color.r, marker.color.g, marker.color.b) == (1.0, 0.0, 0.0)
    assert not log


PLOT = (
    '<plugin name="3dplot" filename="libLinkPlot3DPlugin.so"><frequency>10</frequency><plot><link>foot</link>'
    "<pose>0 0 0.5 0 0 0</pose><material>Gazebo/Green</material></plot></plugin>"
)


async def test_path_of_a_link_is_drawn():
    async with running_server(foot("", PLOT), gravity="0 0 0") as (server, graph, log):
        recording = Recording(graph, server.node, PARTICLES_TOPIC)
        server.simulation.set_model_velocity("dog", (1.0, 0.0, 0.0), (0.0, 0.0, 0.0))
        server.advance(SECOND_NS)
        await graph.settle()
        path = points(recording.last.markers[-1])
        assert len(path) == 10
        assert path[:, 0] == pytest.approx(1.0 + np.arange(1, 11) / 10, abs=0.01)
        assert path[:, 2] == pytest.approx(np.full(10, 1.5), abs=0.01)
        assert not log


def test_worlds_and_models_that_draw_are_recognized():
    visual = '<plugin name="f" filename="libForceVisual.so"><topic_name>t</topic_name></plugin>'
    assert has_drawings(world(foot(visual)))
    assert has_drawings(world(foot("", PLOT)))
    assert not has_drawings(world(foot("")))
    assert has_drawings(world(), '<plugin filename="libunitreeDrawForcePlugin.so"/>')


@pytest.mark.parametrize(
    ("material", "color"),
    [("Gazebo/BlueLaser", (0.0, 0.0, 1.0)), ("Gazebo/PurpleGlow", (1.0, 0.0, 1.0)), ("Wood", (0.7, 0.7, 0.7))],
)
def test_colors_of_materials(material, color):
    assert find_color(material) == color
