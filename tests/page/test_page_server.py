"""The server delivers the page before the viewer exists, and connects pages afterwards."""

from __future__ import annotations

import asyncio
from collections.abc import AsyncIterator
from contextlib import asynccontextmanager

import aiohttp

from linkwright.page.page_server import PageServer
from tests.viewer.scene import World


@asynccontextmanager
async def running_server() -> AsyncIterator[tuple[PageServer, aiohttp.ClientSession]]:
    """Start a server that delivers the page, and return it with a browser."""
    server = PageServer("127.0.0.1", 0)
    await server.open()
    try:
        async with aiohttp.ClientSession() as browser:
            yield server, browser
    finally:
        await server.close()


def address_of(server: PageServer, path: str) -> str:
    return server.url.replace("/?", f"/{path}?")


async def test_page_is_served_before_viewer_and_socket_waits_for_it():
    async with running_server() as (server, browser):
        async with browser.get(server.url) as response:
            assert response.status == 200
        waiting = asyncio.ensure_future(browser.ws_connect(address_of(server, "ws")))
        async with browser.get(address_of(server, "nothing")) as response:
            assert response.status == 404
        assert not waiting.done()
        world = World(server=server)
        await world.viewer.start()
        assert world.viewer.url == server.url
        socket = await waiting
        assert (await socket.receive_json())["type"] == "hello"
        await socket.close()
        await world.viewer.close()
        await world.graph.close()


async def test_request_without_token_is_rejected_at_once():
    async with running_server() as (server, browser):
        url_without_token = server.url.partition("?")[0]
        async with browser.get(f"{url_without_token}ws") as response:
            assert response.status == 401
        async with browser.post(f"{url_without_token}recordings") as response:
            assert response.status == 401


async def test_waiting_page_gets_503_when_server_closes():
    async with running_server() as (server, browser):
        waiting = asyncio.ensure_future(browser.get(address_of(server, "ws")))
        async with browser.get(server.url) as response:
            assert response.status == 200
        await server.close()
        response = await waiting
        assert response.status == 503


async def test_server_without_uploads_has_no_recordings_url():
    world = World()
    await world.viewer.start()
    address = world.viewer.url.replace("/?", "/recordings?")
    try:
        async with aiohttp.ClientSession() as browser, browser.post(address, json={}) as response:
            assert response.status == 404
    finally:
        await world.viewer.close()
        await world.graph.close()
