"""Joints that hold a link of another model until they are detached."""

from __future__ import annotations

import numpy as np
import pytest

from linkwright.geometry.single import compose, invert
from linkwright.messages import get_message
from linkwright.testing import Recording
from tests.simulation.test_plugins import SECOND_NS, running_server
from tests.simulation.worlds import GROUND, box, model

STATE, DETACH, ATTACH = (
    "/model/load/detachable_joint/state",
    *(f"/model/carrier/detachable_joint/{action}" for action in ("detach", "attach")),
)
POST = '<joint name="post" type="fixed"><parent>world</parent><child>link</child></joint>'
LOAD = box("load", "0.05 0 1.75 0 0.2 0", "0.2 0.2 0.2", 2.0)


def carrier_model(extra: str = "", child: str = "load", *, is_fixed: bool = True, pose: str = "0 0 2 0 0 0.3") -> str:
    """Return a box with the plugin."""
    plugin = (
        '<plugin filename="gz-sim-detachable-joint-system" name="gz::sim::systems::DetachableJoint">'
        f"<parent_link>link</parent_link><child_model>{child}</child_model><child_link>link</child_link>{extra}</plugin>"
    )
    return box("carrier", pose, "0.2 0.2 0.2", 5.0).replace("</model>", f"{POST if is_fixed else ''}{plugin}</model>")


async def publish_empty(server, graph, topic: str, seconds: float = 0.5) -> None:
    """Publish an empty message, and advance the time."""
    node = graph.create_node("operator")
    node.create_publisher(get_message("std_msgs/msg/Empty"), topic, 10).publish(get_message("std_msgs/msg/Empty")())
    await graph.settle()
    server.advance(round(seconds * SECOND_NS))
    await graph.settle()
    node.destroy_node()


def load_offset(server) -> np.ndarray:
    """Return the load's pose in the carrier's frame."""
    return np.array(
        compose(invert(server.simulation.link_pose("carrier::link")), server.simulation.link_pose("load::link"))
    )


async def test_attached_link_is_detached_and_attached_again():
    async with running_server(GROUND, carrier_model(), LOAD) as (server, graph, log):
        states = Recording(graph, server.node, STATE)
        server.advance(SECOND_NS)
        assert server.simulation.link_pose("load::link")[:3] == pytest.approx((0.05, 0, 1.75), abs=1e-3)
        await publish_empty(server, graph, DETACH)
        assert server.simulation.link_pose("load::link")[2] == pytest.approx(1.75 - 9.81 / 8, abs=0.01)
        await publish_empty(server, graph, DETACH, 2.0)
        rest_pose = server.simulation.link_pose("load::link")
        assert rest_pose[2] == pytest.approx(0.1, abs=1e-3)
        await publish_empty(server, graph, ATTACH, 1.0)
        assert server.simulation.link_pose("load::link") == pytest.approx(rest_pose, abs=1e-3)
        assert [state.data for state in states] == ["attached", "detached", "attached"]
        assert not log


async def test_attached_link_moves_with_parent():
    load = LOAD.replace("1.75", "1.9")
    async with running_server("<gravity>0 0 0</gravity>", carrier_model(is_fixed=False), load) as (server, _, log):
        start = load_offset(server)
        server.simulation.set_model_velocity("carrier", (0.5, 0.0, 0.0), (0.0, 0.0, 2.0))
        server.advance(SECOND_NS)
        assert load_offset(server) == pytest.approx(start, abs=1e-3)
        assert server.simulation.link_pose("load::link")[0] > 0.2
        assert not log


async def test_initial_attach_and_topic_names_can_be_configured():
    extra = (
        "<initial_attach>false</initial_attach><attach_topic>/grab</attach_topic><detach_topic>/drop</detach_topic>"
        "<output_topic>/grip</output_topic>"
    )
    detached_load = LOAD.replace("1.75", "1.5")
    async with running_server(GROUND, carrier_model(extra), detached_load) as (server, graph, log):
        states = Recording(graph, server.node, "/grip")
        server.advance(SECOND_NS // 5)
        height = server.simulation.link_pose("load::link")[2]
        assert height == pytest.approx(1.5 - 9.81 / 2 * 0.04, abs=0.01)
        await publish_empty(server, graph, "/grab")
        assert server.simulation.link_pose("load::link")[2] == pytest.approx(height, abs=0.05)
        await publish_empty(server, graph, "/drop", 0.2)
        assert server.simulation.link_pose("load::link")[2] < height - 0.1
        assert [state.data for state in states] == ["attached", "detached"]
        assert not log


async def test_late_model_is_attached_and_missing_model_reported_once():
    async with running_server(GROUND, carrier_model()) as (server, _, log):
        server.advance(SECOND_NS // 5)
        assert [record.text for record in log] == [
            "plugin 'gz::sim::systems::DetachableJoint': there is no link 'load::link'"
        ]
        server.spawn(model(LOAD), "load", (0.05, 0.0, 1.75, 0.0, 0.0, 0.0, 1.0))
        server.advance(SECOND_NS)
        assert server.simulation.link_pose("load::link")[2] == pytest.approx(1.75, abs=2e-3)
        server.delete("load")
        server.advance(SECOND_NS // 5)
        server.spawn(model(LOAD), "load", (0.05, 0.0, 1.7, 0.0, 0.0, 0.0, 1.0))
        server.advance(SECOND_NS)
        assert server.simulation.link_pose("load::link")[2] == pytest.approx(1.7, abs=2e-3)
        server.delete("carrier")
        server.advance(SECOND_NS // 2)
        assert server.simulation.link_pose("load::link")[2] < 1.0
        assert len(log) == 1


async def test_reset_attaches_load_again():
    async with running_server(GROUND, carrier_model(), LOAD) as (server, graph, _):
        await publish_empty(server, graph, DETACH, 1.0)
        server.reset()
        server.advance(SECOND_NS)
        assert server.simulation.link_pose("load::link")[:3] == pytest.approx((0.05, 0, 1.75), abs=1e-3)


async def test_missing_link_and_parameters_are_reported():
    async with running_server(GROUND, carrier_model().replace("<parent_link>link", "<parent_link>hand"), LOAD) as (
        server,
        _,
        log,
    ):
        assert not server.plugins("carrier")
        assert ["'hand'" in record.text for record in log] == [True]
    async with running_server(GROUND, carrier_model().replace("child_link>", "link_of_child>"), LOAD) as (
        server,
        _,
        log,
    ):
        assert not server.plugins("carrier")
        assert any("'child_link'" in record.text for record in log)


async def test_replaced_model_keeps_attachment_state():
    async with running_server(GROUND, carrier_model(), LOAD) as (server, graph, log):
        server.replace_model(model(carrier_model().replace("0.2 0.2 0.2", "0.2 0.2 0.1")), "carrier")
        server.advance(SECOND_NS)
        assert server.simulation.link_pose("load::link")[2] == pytest.approx(1.75, abs=1e-3)
        await publish_empty(server, graph, DETACH, 0.2)
        server.replace_model(model(carrier_model()), "carrier")
        server.advance(SECOND_NS // 2)
        assert server.simulation.link_pose("load::link")[2] < 1.0
        assert not log
