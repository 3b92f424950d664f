"""Terminals in pages: permissions, visible terminals, and the amount of output."""

from __future__ import annotations

import asyncio
import os
import sys
from collections.abc import AsyncIterator
from contextlib import asynccontextmanager
from pathlib import Path
from typing import Any

import aiohttp
import pytest

from linkwright.diagnostics import LinkwrightError
from linkwright.page import server
from linkwright.page.page_server import PageServer
from linkwright.panels.terminal import feature as terminals
from linkwright.panels.terminal.feature import MAX_TERMINALS, TerminalFeature
from linkwright.panels.terminal.process_session import find_session_processes
from linkwright.panels.terminal.terminal import MAX_UNACKNOWLEDGED
from tests.viewer.scene import World, open_page, open_world
from tests.waiting import TIMEOUT_S, wait_until

pytestmark = pytest.mark.skipif(sys.platform == "win32", reason="Windows has no pseudoterminals")


def real_path(path: Path) -> str:
    """Return the path that `pwd -P` prints."""
    return os.path.realpath(path)


SIZE = {"columns": 80, "rows": 24}
SHELL = ("/bin/sh", "-i")


class Reader:
    """The output that a page receives, and normally acknowledges."""

    def __init__(self, client: Any, *, acknowledges: bool = True) -> None:
        self.client = client
        self.text = ""
        self.acknowledges = acknowledges

    async def until(self, part: str) -> None:
        try:
            await asyncio.wait_for(self._until(part), TIMEOUT_S)
        except asyncio.TimeoutError:
            pytest.fail(f"the terminal does not show {part!r}, but {self.text!r}")

    async def _until(self, part: str) -> None:
        while part not in self.text:
            await self.next()

    async def next(self) -> dict[str, Any]:
        message: dict[str, Any] = await self.client.until("terminal_output")
        self.text = message["text"] if message["is_replay"] else self.text + message["text"]
        if self.acknowledges:
            await self.client.send("acknowledge_terminal", terminal=message["terminal"], number=message["number"])
        return message

    async def type(self, text: str, terminal: int = 1) -> None:
        await self.client.send("write_terminal", terminal=terminal, text=text, is_binary=False)


@asynccontextmanager
async def open_world_with_terminals(folder: Path, command: tuple[str, ...] = SHELL) -> AsyncIterator[World]:
    async with open_world() as world:
        world.viewer.add_feature(TerminalFeature).enable(folder, command)
        yield world


async def open_terminal(client: Any) -> Reader:
    await client.send("open_terminal", **SIZE)
    await client.until("terminals", refusal_reason="")
    return Reader(client)


async def wait_for_state(client: Any, *, terminal: int = 1, **fields: Any) -> dict[str, Any]:
    """Wait until a terminal has these fields."""
    while True:
        message = await client.until("terminals")
        for item in message["terminals"]:
            if item["id"] == terminal and all(item[name] == value for name, value in fields.items()):
                return item  # type: ignore[no-any-return]


def leader_pid(world: World, number: int = 1) -> int:
    terminal = world.viewer.add_feature(TerminalFeature)._terminals[number]
    return terminal._pty._process.pid  # type: ignore[attr-defined,no-any-return]


async def test_terminal_runs_commands_in_folder(tmp_path: Path) -> None:
    async with open_world_with_terminals(tmp_path) as world, open_page(world.viewer) as client:
        assert (await client.until("terminals"))["folder"] == str(tmp_path)
        reader = await open_terminal(client)
        await reader.type("pwd -P; echo 'Wort 小车'; echo $TERM $COLORTERM\r")
        await reader.until(f"{real_path(tmp_path)}\r\nWort 小车\r\nxterm-256color truecolor\r\n")


async def test_requests_without_permission_are_rejected(tmp_path: Path) -> None:
    async with open_world() as world, open_page(world.viewer) as client:
        await client.send("open_terminal", **SIZE)
        refused = await client.until("terminals")
        assert "--terminal" in refused["refusal_reason"]
        assert (refused["folder"], refused["terminals"]) == ("", [])
        await client.send("write_terminal", terminal=1, text="touch /tmp/x\r", is_binary=False)
        assert "--terminal" in (await client.until("terminals"))["refusal_reason"]
        assert world.viewer.add_feature(TerminalFeature)._terminals == {}


async def test_page_without_permission_receives_no_terminal_messages() -> None:
    async with open_world() as world, open_page(world.viewer) as client:
        await client.until("frame_table")
        assert not any(isinstance(message, dict) and message["type"] == "terminals" for message in client.messages)


async def test_pages_on_other_machines_are_rejected(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(server, "is_local_connection", lambda _: False)
    async with open_world_with_terminals(tmp_path) as world, open_page(world.viewer) as client:
        await client.until("terminals")
        await client.send("open_terminal", **SIZE)
        assert "on the machine of the program" in (await client.until("terminals"))["refusal_reason"]
        assert world.viewer.add_feature(TerminalFeature)._terminals == {}


async def test_pages_of_other_users_are_rejected(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(server, "may_be_own_user", lambda _: False)
    async with open_world_with_terminals(tmp_path) as world, open_page(world.viewer) as client:
        await client.until("terminals")
        await client.send("open_terminal", **SIZE)
        assert "the user who started the program" in (await client.until("terminals"))["refusal_reason"]
        await client.send("write_terminal", terminal=1, text="touch x\r", is_binary=False)
        assert "the user who started the program" in (await client.until("terminals"))["refusal_reason"]
        assert world.viewer.add_feature(TerminalFeature)._terminals == {}


@pytest.mark.parametrize("query", ["", "?token=wrong"])
async def test_websocket_requires_token(tmp_path: Path, query: str) -> None:
    async with open_world_with_terminals(tmp_path) as world, aiohttp.ClientSession() as browser:
        url_without_token = world.viewer.url.partition("?")[0]
        with pytest.raises(aiohttp.WSServerHandshakeError) as refused:
            await browser.ws_connect(f"{url_without_token}ws{query}")
        assert refused.value.status == 401


async def test_websocket_rejects_other_origins(tmp_path: Path) -> None:
    async with open_world_with_terminals(tmp_path) as world, aiohttp.ClientSession() as browser:
        address = world.viewer.url.replace("/?", "/ws?")
        with pytest.raises(aiohttp.WSServerHandshakeError) as refused:
            await browser.ws_connect(address, origin="http://evil.example")
        assert refused.value.status == 403


@pytest.mark.parametrize("host", ["0.0.0.0", "::"])
async def test_terminal_requires_loopback_address(host: str) -> None:
    page_server = PageServer(host, 0, only_loopback=True)
    with pytest.raises(LinkwrightError) as refused:
        await page_server.open()
    (diagnostic,) = refused.value.diagnostics
    assert diagnostic.code == "VIEW104"
    assert host in diagnostic.message
    assert page_server.web is None
    assert "`--terminal`" in str(diagnostic.hint)
    with pytest.raises(LinkwrightError) as refused:
        await PageServer(host, 0, only_loopback=True, needs_terminal=True).open()
    assert refused.value.diagnostics[0].hint == "leave out `--host`, and reach the page through an SSH tunnel"
    local = PageServer("127.0.0.1", 0, only_loopback=True)
    await local.open()
    await local.close()


async def test_exited_shell_is_shown_and_restarted(tmp_path: Path) -> None:
    async with open_world_with_terminals(tmp_path) as world, open_page(world.viewer) as client:
        reader = await open_terminal(client)
        await reader.type("echo first; exit 4\r")
        await wait_for_state(client, status=4)
        await client.send("restart_terminal", terminal=1, columns=100, rows=30)
        await wait_for_state(client, status=None)
        await reader.type("stty size\r")
        await reader.until("30 100")


async def test_another_page_attaches_with_last_output(tmp_path: Path) -> None:
    async with open_world_with_terminals(tmp_path) as world, open_page(world.viewer) as first:
        reader = await open_terminal(first)
        await reader.type("echo remem'ber'\r")
        await reader.until("remember\r\n")
        async with open_page(world.viewer) as second:
            assert (await second.until("terminals"))["terminals"][0]["shown"] == "elsewhere"
            await second.send("show_terminal", terminal=1, columns=90, rows=20)
            other = Reader(second)
            assert (await other.next())["is_replay"]
            assert "remember\r\n" in other.text
            await wait_for_state(first, shown="elsewhere")
            await first.send("write_terminal", terminal=1, text="echo not'hing'\r", is_binary=False)
            await wait_for_state(first, shown="elsewhere")
            await other.type("stty size; echo do'ne'\r")
            await other.until("done\r\n")
            assert "20 90" in other.text
            assert "nothing" not in other.text


async def test_reloaded_page_shows_terminal_again(tmp_path: Path) -> None:
    async with open_world_with_terminals(tmp_path) as world:
        async with open_page(world.viewer) as client:
            reader = await open_terminal(client)
            await reader.type("x=4''2\r")
            await reader.until("x=4")
        async with open_page(world.viewer) as client:
            await wait_for_state(client, shown="nowhere")
            await client.send("show_terminal", terminal=1, **SIZE)
            reader = Reader(client)
            await reader.type("echo <$x>\r".replace("<$x>", '"<$x>"'))
            await reader.until("<42>")


async def test_endless_output_waits_for_acknowledgment(tmp_path: Path) -> None:
    async with open_world_with_terminals(tmp_path) as world, open_page(world.viewer) as client:
        reader = await open_terminal(client)
        reader.acknowledges = False
        await reader.type("yes\r")
        numbers = [(await reader.next())["number"] for _ in range(MAX_UNACKNOWLEDGED)]
        terminal = world.viewer.add_feature(TerminalFeature)._terminals[1]
        await asyncio.sleep(0.1)
        assert terminal._sent == numbers[-1]
        size = terminal._history._size
        await asyncio.sleep(0.1)
        assert terminal._history._size == size
        reader.acknowledges = True
        await client.send("acknowledge_terminal", terminal=1, number=numbers[-1])
        await reader.next()
        await reader.type("\x03echo do'ne'\r")
        await reader.until("done\r\n")


async def test_programs_continue_without_page(tmp_path: Path) -> None:
    async with open_world_with_terminals(tmp_path) as world:
        async with open_page(world.viewer) as client:
            reader = await open_terminal(client)
            await reader.type("seq 300000; touch finished\r")
        await asyncio.to_thread(wait_until, (tmp_path / "finished").exists, TIMEOUT_S)
        async with open_page(world.viewer) as client:
            await client.send("show_terminal", terminal=1, **SIZE)
            reader = Reader(client)
            await reader.until("\r\n300000\r\n")
            assert "\r\n1\r\n" not in reader.text


async def test_closing_terminal_ends_its_programs(tmp_path: Path) -> None:
    async with open_world_with_terminals(tmp_path) as world, open_page(world.viewer) as client:
        reader = await open_terminal(client)
        await reader.type("sleep 1000 & sleep 1000 & echo do'ne'\r")
        await reader.until("done\r\n")
        leader = leader_pid(world)
        await client.send("close_terminal", terminal=1)
        while (await client.until("terminals"))["terminals"]:
            pass
        await asyncio.to_thread(wait_until, lambda: not list(find_session_processes(leader)), TIMEOUT_S)


async def test_closing_server_ends_all_programs(tmp_path: Path) -> None:
    async with open_world_with_terminals(tmp_path) as world, open_page(world.viewer) as client:
        reader = await open_terminal(client)
        await reader.type("trap '' HUP; (trap '' HUP; sleep 1000) & echo do'ne'\r")
        await reader.until("done\r\n")
        leader = leader_pid(world)
        assert list(find_session_processes(leader))
    assert list(find_session_processes(leader)) == []


async def test_number_of_terminals_is_limited(tmp_path: Path) -> None:
    async with open_world_with_terminals(tmp_path, ("/bin/sleep", "1000")) as world, open_page(world.viewer) as client:
        for _ in range(MAX_TERMINALS + 1):
            await client.send("open_terminal", **SIZE)
        refused = await client.until(
            "terminals", refusal_reason=f"there are already {MAX_TERMINALS} terminals: close one first"
        )
        assert len(refused["terminals"]) == MAX_TERMINALS


async def test_shell_start_failure_is_reported(tmp_path: Path) -> None:
    async with open_world_with_terminals(tmp_path / "gone") as world, open_page(world.viewer) as client:
        await client.until("terminals")
        await client.send("open_terminal", **SIZE)
        assert "No such file" in (await client.until("terminals"))["refusal_reason"]


async def test_missing_package_is_named(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    def fail(*_: object) -> None:
        raise ModuleNotFoundError("no winpty", name="winpty")

    monkeypatch.setattr(terminals, "open_pty", fail)
    async with open_world_with_terminals(tmp_path) as world, open_page(world.viewer) as client:
        await client.until("terminals")
        await client.send("open_terminal", **SIZE)
        assert "[learn]" in (await client.until("terminals"))["refusal_reason"]


async def test_unread_input_is_limited(tmp_path: Path) -> None:
    script = "stty raw -echo; echo ready; exec sleep 1000"
    async with (
        open_world_with_terminals(tmp_path, ("/bin/sh", "-c", script)) as world,
        open_page(world.viewer) as client,
    ):
        reader = await open_terminal(client)
        await reader.until("ready")
        for _ in range(5):
            await reader.type("x" * 300_000)
        assert (await client.until("terminal_input_lost"))["size"] == 300_000
        assert world.viewer.add_feature(TerminalFeature)._terminals[1]._pty.unwritten_size <= 1024 * 1024


async def test_binary_input_reaches_program_as_bytes(tmp_path: Path) -> None:
    script = "stty raw -echo; echo ready; head -c 2 | od -An -tu1"
    async with (
        open_world_with_terminals(tmp_path, ("/bin/sh", "-c", script)) as world,
        open_page(world.viewer) as client,
    ):
        reader = await open_terminal(client)
        await reader.until("ready")
        await client.send("write_terminal", terminal=1, text="\xff\x80", is_binary=True)
        await reader.until("255 128")


async def test_split_utf8_character_arrives_complete(tmp_path: Path) -> None:
    script = r"stty raw -echo; printf 'ready\346'; read -r a; printf '\234\272<'"  # an echo would separate the bytes
    async with (
        open_world_with_terminals(tmp_path, ("/bin/sh", "-c", script)) as world,
        open_page(world.viewer) as client,
    ):
        reader = await open_terminal(client)
        await reader.until("ready")
        await reader.type("\n")
        await reader.until("机<")


async def test_terminal_has_commands_of_linkwright_shell(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("SHELL", "/bin/sh")
    async with open_world() as world, open_page(world.viewer) as client:
        world.viewer.add_feature(TerminalFeature).enable(tmp_path)
        reader = await open_terminal(client)
        await reader.type("command -v ros2; command -v linkwright\r")
        await reader.until("/ros2\r\n")
        await reader.until("/linkwright\r\n")
