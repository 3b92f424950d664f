"""World plugins whose services fix links to each other."""

from __future__ import annotations

import pytest

from tests.simulation.test_classic_services import call_service
from tests.simulation.test_plugins import SECOND_NS, running_server
from tests.simulation.worlds import GROUND, box

CRATES = box("high", "0 0 2 0 0 0").replace('<link name="link">', '<link name="link"><gravity>0</gravity>') + box(
    "low", "0 0 0.6 0 0 0"
)
WORLD_PLUGIN = '<plugin name="attacher" filename="libgazebo_link_attacher.so"/>'
OLD_PLUGIN = '<plugin name="attacher" filename="libgazebo_ros_link_attacher.so"/>'
PAIR = {"model1_name": "high", "link1_name": "link", "model2_name": "low", "link2_name": "link"}
OLD_PAIR = {"model_name_1": "high", "link_name_1": "link", "model_name_2": "low", "link_name_2": "link"}
ATTACH, DETACH = "linkattacher_msgs/srv/AttachLink", "linkattacher_msgs/srv/DetachLink"
OLD_TYPE = "gazebo_ros_link_attacher/srv/Attach"
NAMES = "{MODEL , LINK} -> {high , link} -- {low , link}."


def height(server, model: str) -> float:
    return server.simulation.model_pose(model)[2]


async def test_attached_link_moves_with_the_other_until_detached():
    async with running_server(GROUND, CRATES, WORLD_PLUGIN) as (server, graph, log):
        answer = await call_service(graph, server, ATTACH, "/ATTACHLINK", **PAIR)
        assert (answer.success, answer.message) == (True, f"ATTACHED: {NAMES}")
        server.simulation.set_model_velocity("high", (0.0, 0.0, 3.0), (0.0, 0.0, 0.0))
        server.advance(SECOND_NS // 2)
        rise = height(server, "high") - 2.0
        assert rise > 0.1
        assert height(server, "low") - 0.6 == pytest.approx(rise, abs=0.01)
        answer = await call_service(graph, server, DETACH, "/DETACHLINK", **PAIR)
        assert (answer.success, answer.message) == (True, f"DETACHED: {NAMES}")
        server.advance(2 * SECOND_NS)
        assert height(server, "low") == pytest.approx(0.5, abs=0.01)
        assert not log


async def test_second_attachment_and_unknown_names_are_refused():
    async with running_server(GROUND, CRATES, WORLD_PLUGIN) as (server, graph, _):
        answer = await call_service(graph, server, ATTACH, "/ATTACHLINK", **{**PAIR, "model2_name": "lo"})
        assert (answer.success, answer.message) == (False, "Failed to find model with name: lo")
        answer = await call_service(graph, server, ATTACH, "/ATTACHLINK", **{**PAIR, "link1_name": "tip"})
        assert (answer.success, answer.message) == (False, "Failed to find link with name: tip")
        assert (await call_service(graph, server, ATTACH, "/ATTACHLINK", **PAIR)).success
        answer = await call_service(graph, server, ATTACH, "/ATTACHLINK", **PAIR)
        assert answer.message == "Both links have already been attached, aborting new attachment."
        answer = await call_service(graph, server, DETACH, "/DETACHLINK", **{**PAIR, "link1_name": "tip"})
        assert not answer.success
        assert answer.message.startswith("DETACHED -- ERROR (Joint does not exist!)")


async def test_another_pair_can_be_attached_after_a_model_is_deleted():
    async with running_server(GROUND, CRATES, box("other", "3 0 0.6 0 0 0"), WORLD_PLUGIN) as (server, graph, _):
        assert (await call_service(graph, server, ATTACH, "/ATTACHLINK", **PAIR)).success
        server.simulation.delete("low")
        answer = await call_service(graph, server, ATTACH, "/ATTACHLINK", **{**PAIR, "model2_name": "other"})
        assert answer.success


@pytest.mark.parametrize("prefix", ["/link_attacher_node", ""])
async def test_old_attacher_has_services_of_both_versions_of_ros(prefix):
    async with running_server(GROUND, CRATES, OLD_PLUGIN) as (server, graph, _):
        assert (await call_service(graph, server, OLD_TYPE, f"{prefix}/attach", **OLD_PAIR)).ok
        server.advance(SECOND_NS)
        assert height(server, "high") - height(server, "low") == pytest.approx(1.4, abs=0.01)
        assert (await call_service(graph, server, OLD_TYPE, f"{prefix}/detach", **OLD_PAIR)).ok
        assert not (await call_service(graph, server, OLD_TYPE, f"{prefix}/detach", **OLD_PAIR)).ok
        absent = {**OLD_PAIR, "model_name_1": "absent"}
        assert not (await call_service(graph, server, OLD_TYPE, f"{prefix}/attach", **absent)).ok
