"""Boxes that tell when an entity enters or leaves them."""

from __future__ import annotations

from math import pi

import pytest

from linkwright.messages import get_message
from linkwright.testing import Recording
from tests.simulation.test_plugins import running_server
from tests.simulation.worlds import box

STEP_NS = 1_000_000


def contain(extra: str = "", pose: str = "<pose>1 0 0 0 0 0</pose>") -> str:
    return (
        '<plugin name="region" filename="libContainPlugin.so"><entity>block</entity><namespace>region</namespace>'
        f"{pose}<geometry><box><size>2 1 1</size></box></geometry>{extra}</plugin>"
    )


def move(server, x: float, y: float = 0.0, z: float = 0.0, model: str = "block") -> None:
    server.simulation.set_model_pose(model, (x, y, z, 0.0, 0.0, 0.0, 1.0))
    server.advance(STEP_NS)


async def test_entering_and_leaving_are_published_once():
    async with running_server(contain(), box("block", "9 0 0 0 0 0"), gravity="0 0 0") as (server, graph, log):
        recording = Recording(graph, server.node, "/region/contain")
        await graph.settle()
        for x, y in ((9.0, 0.0), (1.9, 0.0), (0.1, 0.0), (-0.1, 0.0), (1.0, 0.6), (1.0, 0.4)):
            move(server, x, y)
            await graph.settle()
        assert [message.data for message in recording] == [False, True, False, True]
        assert not log


@pytest.mark.parametrize(("x", "y", "contains"), [(0.0, 0.9, True), (0.9, 0.0, False)])
async def test_box_turns_with_its_pose(x, y, contains):
    world = contain(pose=f"<pose>0 0 0 0 0 {pi / 2}</pose>"), box("block", "9 0 0 0 0 0")
    async with running_server(*world, gravity="0 0 0") as (server, graph, _):
        recording = Recording(graph, server.node, "/region/contain")
        await graph.settle()
        move(server, x, y)
        await graph.settle()
        assert recording.last.data is contains


async def test_box_moves_with_its_frame():
    world = (
        contain(pose='<pose frame="cart">0 0 0 0 0 0</pose>'),
        box("block", "5 0 0 0 0 0"),
        box("cart", "0 3 0 0 0 0"),
    )
    async with running_server(*world, gravity="0 0 0") as (server, graph, _):
        recording = Recording(graph, server.node, "/region/contain")
        await graph.settle()
        server.advance(STEP_NS)
        move(server, 5.5, model="cart")
        await graph.settle()
        assert [message.data for message in recording] == [False, True]


async def test_service_switches_detection():
    world = contain("<enabled>false</enabled>"), box("block", "1 0 0 0 0 0")
    async with running_server(*world, gravity="0 0 0") as (server, graph, _):
        recording = Recording(graph, server.node, "/region/contain")
        client = graph.create_node("client").create_client("std_srvs/srv/SetBool", "/region/enable")
        await graph.settle()
        server.advance(STEP_NS)
        await graph.settle()
        assert len(recording) == 0
        results = []
        for _ in range(2):
            request = client.call_async(get_message("std_srvs/srv/SetBool_Request")(data=True))
            await graph.settle()
            server.advance(2 * STEP_NS)
            await graph.settle()
            results.append(request.result().success)
        assert results == [True, False]
        assert [message.data for message in recording] == [True]


@pytest.mark.parametrize(("old", "words"), [("<size>2 1 1</size>", "<size>"), ("<pose>1 0 0 0 0 0</pose>", "<pose>")])
async def test_missing_box_is_told(old, words):
    async with running_server(contain().replace(old, ""), box("block", "0 0 0 0 0 0")) as (_, graph, log):
        await graph.settle()
        assert [record.text for record in log if words in record.text]
