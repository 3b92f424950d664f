"""Programs in the terminals of a page, and only they, can show their pages in frames."""

from __future__ import annotations

import asyncio
import json
import socket
from collections.abc import AsyncIterator
from contextlib import asynccontextmanager
from pathlib import Path
from urllib.parse import urlsplit

import aiohttp
import pytest

from linkwright.page.access import PROGRAM_PAGES_VARIABLE as VARIABLE
from linkwright.page.page_server import PageServer
from linkwright.page.program_pages import Embedder
from linkwright.panels.terminal.feature import TerminalFeature
from tests.viewer.scene import World, open_page
from tests.waiting import TIMEOUT_S, eventually

FRAMES = "frame-src http://127.0.0.1:* http://localhost:*"


@asynccontextmanager
async def open_classroom(folder: Path, command: tuple[str, ...] = ("/bin/sh", "-i")) -> AsyncIterator[World]:
    """Start a viewer whose page has terminals."""
    world = World(server=PageServer("127.0.0.1", 0, only_loopback=True))
    await world.viewer.start()
    server = world.viewer._server
    world.viewer.add_feature(TerminalFeature).enable(folder, command, programs=server.program_pages)
    try:
        yield world
    finally:
        await world.viewer.close()
        await world.graph.close()


@asynccontextmanager
async def start_program_server() -> AsyncIterator[PageServer]:
    """Start the server of a program that would open its page in the browser."""
    server = PageServer("127.0.0.1", 0)
    await server.open()
    try:
        yield server
    finally:
        await server.close()


def program_environment(world: World) -> dict[str, str]:
    origin = world.viewer.url.partition("/?")[0]
    return world.viewer._server.program_pages.make_variables(origin)


async def content_security_policy(server: PageServer) -> str:
    async with aiohttp.ClientSession() as browser, browser.get(server.url) as response:
        return response.headers["Content-Security-Policy"]


async def post_line(address: str, line: bytes, **headers: str) -> int:
    async with aiohttp.ClientSession() as session, session.post(address, data=line, headers=headers) as response:
        return response.status


async def test_program_page_is_shown_until_program_ends(tmp_path):
    async with open_classroom(tmp_path) as world, open_page(world.viewer) as client, start_program_server() as server:
        await client.send("watch_program_pages")
        assert (await client.until("program_pages"))["pages"] == []
        assert "frame-ancestors 'none'" in await content_security_policy(server)
        assert await server.embed(program_environment(world), "a world")
        shown = await client.until("program_pages")
        assert shown["pages"] == [{"id": 1, "title": "a world", "url": server.url}]
        assert f"frame-ancestors {world.viewer.url.partition('/?')[0]};" in f"{await content_security_policy(server)};"
        assert FRAMES in await content_security_policy(world.viewer._server)
        assert "frame-ancestors 'none'" in await content_security_policy(world.viewer._server)
        await server.close()
        assert (await client.until("program_pages"))["pages"] == []


async def test_a_program_pauses_its_world_until_it_may_resume(tmp_path):
    pause_requests = []

    def pause(must_pause: bool) -> bool:
        pause_requests.append(must_pause)
        return must_pause

    async with (
        open_classroom(tmp_path) as world,
        open_page(world.viewer),
        start_program_server() as server,
        start_program_server() as other,
    ):
        programs = world.viewer._server.program_pages
        assert await server.embed(program_environment(world), "a world")
        server.on_pause(pause)
        assert await other.embed(program_environment(world), "a page without a world")
        programs.pause_worlds()
        await eventually(lambda: programs.is_world_paused)
        assert pause_requests == [True]
        programs.resume_worlds()
        assert not programs.is_world_paused
        await eventually(lambda: pause_requests == [True, False])
        programs.resume_worlds()
        programs.pause_worlds()
        await eventually(lambda: programs.is_world_paused)
        await server.close()
        await eventually(lambda: not programs.is_world_paused)


async def test_a_world_resumes_when_the_page_that_paused_it_is_gone(tmp_path):
    pause_requests = []
    async with start_program_server() as server:
        async with open_classroom(tmp_path) as world, open_page(world.viewer):
            assert await server.embed(program_environment(world), "a world")
            server.on_pause(lambda must_pause: pause_requests.append(must_pause) or must_pause)
            world.viewer._server.program_pages.pause_worlds()
            await eventually(lambda: pause_requests == [True])
        await eventually(lambda: pause_requests == [True, False])


async def test_terminal_has_variable_with_page_address(tmp_path):
    command = ("/bin/sh", "-c", f"echo ${VARIABLE}")
    async with open_classroom(tmp_path, command) as world, open_page(world.viewer) as client:
        await client.send("open_terminal", columns=200, rows=24)
        output = await client.until("terminal_output", is_replay=False)
        assert output["text"].strip() == program_environment(world)[VARIABLE]


async def test_wrong_key_and_foreign_origin_are_rejected(tmp_path):
    async with open_classroom(tmp_path) as world, open_page(world.viewer), start_program_server() as server:
        address = program_environment(world)[VARIABLE]
        line = json.dumps({"title": "", "url": server.url}).encode() + b"\n"
        assert await post_line(address[:-1], line) == 401
        assert await post_line(address, line, Origin="http://evil.example") == 403
        for url in ("http://evil.example/?token=abcdefgh", "https://127.0.0.1:1/?token=abc", "javascript:alert(1)", ""):
            assert await post_line(address, json.dumps({"title": "", "url": url}).encode() + b"\n") == 400
        for nonsense in (b"", b"[]", b"{", b"x" * 100_000, b"[" * 60_000 + b"\n"):
            assert await post_line(address, nonsense) == 400
        token = urlsplit(world.viewer.url).query
        assert await post_line(f"{address.rpartition('/')[0]}/?{token}", line) in (401, 404, 405)


async def test_page_without_terminals_receives_no_program_pages(tmp_path, monkeypatch):
    monkeypatch.setattr("linkwright.page.server.may_be_own_user", lambda _: False)
    async with open_classroom(tmp_path) as world, open_page(world.viewer) as client, start_program_server() as server:
        await client.send("watch_program_pages")
        assert "browser of the user" in (await client.until("terminals", folder=""))["refusal_reason"]
        assert not await server.embed(program_environment(world), "")
        assert "frame-ancestors 'none'" in await content_security_policy(server)


async def test_program_is_not_embedded_without_open_page(tmp_path):
    async with start_program_server() as server:
        async with open_classroom(tmp_path) as world:
            variables = program_environment(world)
            assert not await server.embed(variables, "")
        assert not await server.embed(variables, "")
        assert not server.is_embedded


async def test_page_with_terminals_is_never_embedded(tmp_path):
    async with open_classroom(tmp_path) as world, open_page(world.viewer), open_classroom(tmp_path) as other:
        assert not await other.viewer._server.embed(program_environment(world), "")
        assert "frame-ancestors 'none'" in await content_security_policy(other.viewer._server)


async def test_unresponsive_server_is_abandoned_after_timeout(monkeypatch):
    monkeypatch.setattr("linkwright.page.program_pages._TIMEOUT_S", 0.1)
    with socket.create_server(("127.0.0.1", 0)) as silent:
        address = f"http://127.0.0.1:{silent.getsockname()[1]}/programs/abc"
        async with start_program_server() as server:
            assert not await server.embed({VARIABLE: address}, "")
            assert "frame-ancestors 'none'" in await content_security_policy(server)


@pytest.mark.parametrize(
    "address",
    ["", "http://evil.example:80/programs/abc", "http://127.0.0.1@evil.example:80/programs/a", "file:///programs/a",
     "http://127.0.0.1:80/programs/a b", "http://127.0.0.1:80/programs/a\r\nX: y"],
)  # fmt: skip
def test_embedder_ignores_malformed_or_remote_addresses(address):
    assert Embedder.of({VARIABLE: address}) is None


def test_embedder_has_origin_and_path_of_address():
    embedder = Embedder.of({VARIABLE: "http://localhost:7448/programs/a-b_c"})
    assert embedder == Embedder("http://localhost:7448", "/programs/a-b_c")


async def test_closing_server_does_not_wait_for_programs(tmp_path, monkeypatch):
    monkeypatch.setattr("linkwright.page.server._CLOSE_TIMEOUT_S", 600.0)
    async with open_classroom(tmp_path) as world, start_program_server() as server:
        async with open_page(world.viewer):
            assert await server.embed(program_environment(world), "")
        await asyncio.wait_for(world.viewer._server.close(), TIMEOUT_S)
        assert world.viewer._server.program_pages.pages == []
