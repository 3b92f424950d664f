"""Pages that share displays, and pages that have their own."""

from __future__ import annotations

from contextlib import asynccontextmanager

import aiohttp

from linkwright.rviz.visualization import manager
from tests.viewer.configured import TEXT, PointStamped, open_configured
from tests.viewer.scene import Client, open_page
from tests.waiting import eventually


@asynccontextmanager
async def open_own_page(world, key: str = "0123456789abcdef"):
    address = world.viewer.url.replace("/?", "/ws?") + f"&own={key}"
    async with aiohttp.ClientSession() as session, session.ws_connect(address) as socket:
        yield Client(socket)


async def test_pages_share_displays():
    async with open_configured() as (world, first), open_page(world.viewer) as second:
        await second.opened()
        await first.send("remove_displays", displays=["display-1"])
        assert [display["name"] for display in (await second.until("tree"))["displays"]] == ["Marks", "Clicks", "Radar"]
        await second.send("undo")
        assert len((await first.until("tree", global_level="warn"))["displays"]) == 3
        assert len((await first.until("tree"))["displays"]) == 4


async def test_page_may_have_own_displays(monkeypatch):
    monkeypatch.setattr(manager, "LINGERING_S", 0.05)
    async with open_configured() as (world, shared):
        publisher = world.graph.create_node("clicks").create_publisher(PointStamped, "/clicked_point", 5)
        async with open_own_page(world) as own_client:
            opening = await own_client.opened()
            assert (opening["configuration"]["is_own"], opening["configuration"]["path"]) == (True, None)
            ids = [display["id"] for display in opening["tree"]["displays"]]
            assert ids == [f"display-{n}" for n in range(5, 9)]
            assert publisher.get_subscription_count() == 2
            await shared.drain()
            await own_client.set(f"{ids[0]}/Alpha", 0.125)
            await own_client.until("property_changed", id=f"{ids[0]}/Alpha")
            await own_client.set("global/Fixed Frame", "odom")
            await own_client.until("configuration")
            await own_client.set("display-1/Alpha", 0.9)  # the page does not have this shared display
            assert await shared.drain() == []
            assert world.viewer.config.text() == TEXT
            assert world.viewer._node.get_parameter("fixed_frame").value == "base"
        async with open_own_page(world) as reloaded_client:  # the page was reloaded
            opening = await reloaded_client.opened()
            assert [display["id"] for display in opening["tree"]["displays"]] == ids
        await eventually(lambda: publisher.get_subscription_count() == 1)
        async with open_own_page(world) as later:
            opening = await later.opened()
            assert [display["id"] for display in opening["tree"]["displays"]] != ids


async def test_number_of_lingering_own_displays_is_limited(monkeypatch):
    monkeypatch.setattr(manager, "MAX_LINGERING", 2)
    async with open_configured() as (world, _):
        publisher = world.graph.create_node("clicks").create_publisher(PointStamped, "/clicked_point", 5)
        for number in range(5):
            async with open_own_page(world, f"page-number-{number}") as client:
                await client.opened()
        await eventually(lambda: publisher.get_subscription_count() == 3)  # for all pages, and two closed pages
        async with open_own_page(world, "page-number-4") as client:
            opening = await client.opened()
            assert opening["tree"]["displays"][0]["id"] == "display-21"  # the page has new displays


async def test_page_with_invalid_key_shares_displays():
    async with open_configured() as (world, _):
        for key in ("short", "../../../etc/passwd", "x" * 100):
            async with open_own_page(world, key) as client:
                assert (await client.opened())["configuration"]["is_own"] is False
