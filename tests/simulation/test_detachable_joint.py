"""Joints that hold a link of another model until they are told to let go."""

from __future__ import annotations

import numpy as np
import pytest

from linkwright.geometry.single import compose, invert
from linkwright.messages import get_message
from linkwright.testing import Recording
from tests.simulation.test_plugins import SECOND, served
from tests.simulation.worlds import GROUND, box, model

STATE, DETACH, ATTACH = (
    "/model/load/detachable_joint/state",
    *(f"/model/carrier/detachable_joint/{each}" for each in ("detach", "attach")),
)
POST = '<joint name="post" type="fixed"><parent>world</parent><child>link</child></joint>'
LOAD = box("load", "0.05 0 1.75 0 0.2 0", "0.2 0.2 0.2", 2.0)


def carrier(more: str = "", child: str = "load", *, held: bool = True, pose: str = "0 0 2 0 0 0.3") -> str:
    """A box with the plugin."""
    plugin = (
        '<plugin filename="gz-sim-detachable-joint-system" name="gz::sim::systems::DetachableJoint">'
        f"<parent_link>link</parent_link><child_model>{child}</child_model><child_link>link</child_link>{more}</plugin>"
    )
    return box("carrier", pose, "0.2 0.2 0.2", 5.0).replace("</model>", f"{POST if held else ''}{plugin}</model>")


async def tell(server, graph, topic: str, seconds: float = 0.5) -> None:
    """Send an empty message, and let time pass."""
    node = graph.create_node("operator")
    node.create_publisher(get_message("std_msgs/msg/Empty"), topic, 10).publish(get_message("std_msgs/msg/Empty")())
    await graph.settle()
    server.advance(round(seconds * SECOND))
    await graph.settle()
    node.destroy_node()


def offset(server) -> np.ndarray:
    """Where the load is in the frame of the carrier."""
    return np.array(
        compose(invert(server.simulation.link_pose("carrier::link")), server.simulation.link_pose("load::link"))
    )


async def test_what_is_attached_hangs_until_it_is_let_go_and_can_be_taken_up_again():
    async with served(GROUND, carrier(), LOAD) as (server, graph, log):
        states = Recording(graph, server.node, STATE)
        server.advance(SECOND)
        assert server.simulation.link_pose("load::link")[:3] == pytest.approx((0.05, 0, 1.75), abs=1e-3)
        await tell(server, graph, DETACH)
        assert server.simulation.link_pose("load::link")[2] == pytest.approx(1.75 - 9.81 / 8, abs=0.01)
        await tell(server, graph, DETACH, 2.0)
        resting = server.simulation.link_pose("load::link")
        assert resting[2] == pytest.approx(0.1, abs=1e-3)
        await tell(server, graph, ATTACH, 1.0)
        assert server.simulation.link_pose("load::link") == pytest.approx(resting, abs=1e-3)
        assert [state.data for state in states] == ["attached", "detached", "attached"]
        assert not log


async def test_what_is_held_moves_along():
    within = LOAD.replace("1.75", "1.9")
    async with served("<gravity>0 0 0</gravity>", carrier(held=False), within) as (server, _, log):
        before = offset(server)
        server.simulation.set_model_velocity("carrier", (0.5, 0.0, 0.0), (0.0, 0.0, 2.0))
        server.advance(SECOND)
        assert offset(server) == pytest.approx(before, abs=1e-3)
        assert server.simulation.link_pose("load::link")[0] > 0.2
        assert not log


async def test_what_is_not_to_be_held_at_the_start_falls_and_topics_have_the_names_that_are_said():
    more = (
        "<initial_attach>false</initial_attach><attach_topic>/grab</attach_topic><detach_topic>/drop</detach_topic>"
        "<output_topic>/grip</output_topic>"
    )
    apart = LOAD.replace("1.75", "1.5")
    async with served(GROUND, carrier(more), apart) as (server, graph, log):
        states = Recording(graph, server.node, "/grip")
        server.advance(SECOND // 5)
        height = server.simulation.link_pose("load::link")[2]
        assert height == pytest.approx(1.5 - 9.81 / 2 * 0.04, abs=0.01)
        await tell(server, graph, "/grab")
        assert server.simulation.link_pose("load::link")[2] == pytest.approx(height, abs=0.05)
        await tell(server, graph, "/drop", 0.2)
        assert server.simulation.link_pose("load::link")[2] < height - 0.1
        assert [state.data for state in states] == ["attached", "detached"]
        assert not log


async def test_a_model_that_comes_later_is_taken_and_one_that_is_missing_is_told_once():
    async with served(GROUND, carrier()) as (server, _, log):
        server.advance(SECOND // 5)
        assert [each.text for each in log] == [
            "plugin 'gz::sim::systems::DetachableJoint': there is no link 'load::link'"
        ]
        server.spawn(model(LOAD), "load", (0.05, 0.0, 1.75, 0.0, 0.0, 0.0, 1.0))
        server.advance(SECOND)
        assert server.simulation.link_pose("load::link")[2] == pytest.approx(1.75, abs=2e-3)
        server.delete("load")
        server.advance(SECOND // 5)
        server.spawn(model(LOAD), "load", (0.05, 0.0, 1.7, 0.0, 0.0, 0.0, 1.0))
        server.advance(SECOND)
        assert server.simulation.link_pose("load::link")[2] == pytest.approx(1.7, abs=2e-3)
        server.delete("carrier")
        server.advance(SECOND // 2)
        assert server.simulation.link_pose("load::link")[2] < 1.0
        assert len(log) == 1


async def test_a_reset_brings_the_load_back():
    async with served(GROUND, carrier(), LOAD) as (server, graph, _):
        await tell(server, graph, DETACH, 1.0)
        server.reset()
        server.advance(SECOND)
        assert server.simulation.link_pose("load::link")[:3] == pytest.approx((0.05, 0, 1.75), abs=1e-3)


async def test_a_link_that_is_not_there_and_parameters_that_lack_are_told():
    async with served(GROUND, carrier().replace("<parent_link>link", "<parent_link>hand"), LOAD) as (server, _, log):
        assert not server.plugins("carrier")
        assert ["'hand'" in each.text for each in log] == [True]
    async with served(GROUND, carrier().replace("child_link>", "link_of_child>"), LOAD) as (server, _, log):
        assert not server.plugins("carrier")
        assert any("'child_link'" in each.text for each in log)


async def test_a_model_that_comes_anew_holds_what_it_held_and_nothing_else():
    async with served(GROUND, carrier(), LOAD) as (server, graph, log):
        server.replace_model(model(carrier().replace("0.2 0.2 0.2", "0.2 0.2 0.1")), "carrier")
        server.advance(SECOND)
        assert server.simulation.link_pose("load::link")[2] == pytest.approx(1.75, abs=1e-3)
        await tell(server, graph, DETACH, 0.2)
        server.replace_model(model(carrier()), "carrier")
        server.advance(SECOND // 2)
        assert server.simulation.link_pose("load::link")[2] < 1.0
        assert not log
