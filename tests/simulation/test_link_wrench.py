"""Forces and torques that topics and the world file apply to links."""

from __future__ import annotations

import pytest

from linkwright.messages import get_message
from tests.simulation.fluids.server import running_server, weightless_server
from tests.simulation.test_plugins import SECOND_NS
from tests.simulation.worlds import box, model

WRENCH, ENTITY = "ros_gz_interfaces/msg/EntityWrench", "ros_gz_interfaces/msg/Entity"
ENTITY_LINK, ENTITY_MODEL = 3, 2


def wrench_plugin(parameters: str = "") -> str:
    return (
        '<plugin name="gz::sim::systems::ApplyLinkWrench" filename="gz-sim-apply-link-wrench-system">'
        f"{parameters}</plugin>"
    )


def persistent_wrench(name: str, kind: str, force: str = "-10 0 0", torque: str = "0 0 0.5") -> str:
    return (
        f"<persistent><entity_name>{name}</entity_name><entity_type>{kind}</entity_type><force>{force}</force>"
        f"<torque>{torque}</torque></persistent>"
    )


def make_wrench(name: str, kind: int, force: float, torque: float = 0.0):
    message = get_message(WRENCH)()
    message.entity.name, message.entity.type = name, kind
    message.wrench.force.x, message.wrench.torque.z = force, torque
    return message


async def publish_message(graph, topic: str, message) -> None:
    type_name = ENTITY if topic.endswith("clear") else WRENCH
    graph.create_node("operator").create_publisher(type_name, topic, 10).publish(message)
    await graph.settle()


def planar_motion(server, name: str = "crate") -> tuple[float, float]:
    """Return the speed along x and the turning rate about z."""
    linear, angular = server.simulation.link_velocity(f"{name}::link")
    return linear[0], angular[2]


CRATE = box("crate", "0 0 5 0 0 0", "1 1 1", 6.0)  # an inertia of 1 kg m2


@pytest.mark.parametrize(("name", "kind"), [("crate", "model"), ("crate::link", "link"), ("link", "link")])
async def test_persistent_wrench_of_world_file_acts_all_the_time(name, kind):
    async with weightless_server(wrench_plugin(persistent_wrench(name, kind)), CRATE) as (server, _, log):
        server.advance(SECOND_NS)
        assert planar_motion(server) == pytest.approx((-10.0 / 6.0, 0.5), rel=0.02)
        assert not log


async def test_wrench_acts_for_one_step():
    async with weightless_server(wrench_plugin(), CRATE) as (server, graph, log):
        await publish_message(graph, "/world/test/wrench", make_wrench("crate", ENTITY_MODEL, 600.0, 20.0))
        server.advance(SECOND_NS)
        assert planar_motion(server) == pytest.approx((600.0 * 0.01 / 6.0, 20.0 * 0.01), rel=1e-3)
        assert not log


async def test_persistent_wrenches_add_up_until_they_are_cleared():
    async with weightless_server(wrench_plugin(), CRATE) as (server, graph, _):
        await publish_message(graph, "/world/test/wrench/persistent", make_wrench("crate", ENTITY_MODEL, 6.0))
        await publish_message(graph, "/world/test/wrench/persistent", make_wrench("crate::link", ENTITY_LINK, 6.0))
        server.advance(SECOND_NS)
        assert planar_motion(server)[0] == pytest.approx(2.0, rel=0.02)
        message = get_message(ENTITY)(name="crate", type=ENTITY_MODEL)
        await publish_message(graph, "/world/test/wrench/clear", message)
        server.advance(SECOND_NS)
        assert planar_motion(server)[0] == pytest.approx(3.0, rel=0.02)  # the wrench on the link remains
        message = get_message(ENTITY)(name="link", type=ENTITY_LINK)
        await publish_message(graph, "/world/test/wrench/clear", message)
        server.advance(SECOND_NS)
        assert planar_motion(server)[0] == pytest.approx(3.0, rel=0.03)


async def test_persistent_wrench_awaits_model():
    async with weightless_server(wrench_plugin(persistent_wrench("late", "model")), CRATE) as (server, _, log):
        server.advance(SECOND_NS // 10)
        server.simulation.spawn(model(box("late", "9 0 5 0 0 0", "1 1 1", 6.0)), "late")
        server.advance(SECOND_NS)
        assert planar_motion(server, "late")[0] == pytest.approx(-10.0 / 6.0, rel=0.03)
        server.delete("late")
        server.advance(SECOND_NS // 10)
        assert not log


async def test_unknown_entity_and_wrong_type_are_reported():
    async with running_server(wrench_plugin(), CRATE) as (server, graph, log):
        await publish_message(graph, "/world/test/wrench", make_wrench("ghost", ENTITY_MODEL, 6.0))
        server.advance(SECOND_NS // 10)
        assert [record.text for record in log] == ["there is no model or link 'ghost'"]
    async with running_server(wrench_plugin(persistent_wrench("crate", "visual")), CRATE) as (_, __, log):
        assert any("<persistent> needs" in record.text for record in log)


async def test_force_acts_at_origin_of_link():
    text = CRATE.replace("<inertial>", "<inertial><pose>0 1 0 0 0 0</pose>")
    async with weightless_server(wrench_plugin(persistent_wrench("crate", "model", torque="0 0 0")), text) as (
        server,
        _,
        __,
    ):
        server.advance(SECOND_NS // 10)
        torque = server.simulation.data.body("crate::link").xfrc_applied[5]
        assert torque == pytest.approx(-10.0, rel=0.01)


async def test_topics_are_parameters_and_reset_restores_wrenches():
    parameters = "<topic>/a</topic><topic_persistent>/b</topic_persistent><topic_clear>/c</topic_clear>"
    async with weightless_server(wrench_plugin(parameters + persistent_wrench("crate", "model")), CRATE) as (
        server,
        graph,
        _,
    ):
        await publish_message(graph, "/b", make_wrench("crate", ENTITY_MODEL, 60.0))
        await publish_message(graph, "/a", make_wrench("crate", ENTITY_MODEL, 60.0))
        server.advance(SECOND_NS // 10)
        assert planar_motion(server)[0] > 0.0
        server.reset()
        server.advance(SECOND_NS)
        assert planar_motion(server)[0] == pytest.approx(-10.0 / 6.0, rel=0.02)
