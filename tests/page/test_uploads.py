"""Recordings that pages upload: the transfer, refusals, and the removal of the files."""

from __future__ import annotations

import asyncio
from collections.abc import AsyncIterator
from contextlib import asynccontextmanager
from pathlib import Path
from urllib.parse import parse_qs, urlsplit

import aiohttp
import pytest

from linkwright.page import uploads
from linkwright.viewer import guests
from linkwright.viewer.guests import GuestRecordings
from tests.panels.test_timeline import recorded
from tests.skipping import skipping
from tests.viewer.scene import Client, World

TIMEOUT_S = 5.0
"""The seconds after which an abandoned upload is removed; normally a minute."""

REFUSED_STATUS = -1
"""Replaces the HTTP status if the response has a problem for the user."""


@pytest.fixture(autouse=True)
def scratch(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """Return the folder for uploaded files."""
    folder = tmp_path / "scratch"
    folder.mkdir()
    monkeypatch.setenv("TMPDIR", str(folder))
    monkeypatch.setattr("tempfile.tempdir", None)
    return folder


@pytest.fixture(autouse=True)
def short_time_limits(monkeypatch: pytest.MonkeyPatch) -> None:
    """Shorten the time limits to seconds."""
    monkeypatch.setattr(uploads, "IDLE_TIMEOUT_S", TIMEOUT_S)
    monkeypatch.setattr(guests, "IDLE_TIMEOUT_S", TIMEOUT_S)


class Sender:
    """A page that sends recordings."""

    def __init__(self, session: aiohttp.ClientSession, url: str) -> None:
        parts = urlsplit(url)
        self.session = session
        self.base = f"{parts.scheme}://{parts.netloc}"
        self.token = parse_qs(parts.query)["token"][0]

    async def ask(self, method: str, path: str, language: str = "en", **options: object) -> tuple[int, dict[str, str]]:
        params = {"token": self.token, "language": language}
        async with self.session.request(method, f"{self.base}/{path}", params=params, **options) as response:
            if response.content_type != "application/json":
                return response.status, {"text": await response.text()}
            message = await response.json()
            return REFUSED_STATUS if "problem" in message else response.status, message

    async def announce(self, name: str, files: dict[str, int]) -> tuple[int, dict[str, str]]:
        listed = [{"name": name, "size": size} for name, size in files.items()]
        return await self.ask("POST", "recordings", json={"name": name, "files": listed})

    async def send(self, name: str, files: dict[str, bytes]) -> tuple[int, dict[str, str]]:
        """Send a whole recording, and return the last answer."""
        status, response = await self.announce(name, {name: len(data) for name, data in files.items()})
        if status != 200:
            return status, response
        key = response["key"]
        for number, data in enumerate(files.values()):
            status, _ = await self.ask("PUT", f"recordings/{key}/{number}", data=data)
            assert status == 204
        return await self.ask("POST", f"recordings/{key}")


@asynccontextmanager
async def upload_server() -> AsyncIterator[tuple[World, Sender]]:
    world = World()
    guests = GuestRecordings(world.viewer)
    world.viewer.make_guests = lambda: guests
    await world.viewer.start()
    try:
        async with aiohttp.ClientSession() as session:
            yield world, Sender(session, world.viewer.url)
    finally:
        await world.viewer.close()
        await world.graph.close()


@asynccontextmanager
async def recording_page(sender: Sender, recording: str) -> AsyncIterator[Client]:
    """Return a page that shows a recording."""
    address = f"{sender.base}/ws?token={sender.token}&recording={recording}"
    async with sender.session.ws_connect(address) as socket:
        yield Client(socket)


async def answer_pings(client: Client) -> None:
    """Read incoming messages, as an open page does."""
    while True:
        await client.socket.receive()


def file_contents(folder: Path) -> dict[str, bytes]:
    return {path.name: path.read_bytes() for path in folder.iterdir()}


def list_uploads(scratch: Path) -> list[str]:
    return [path.name for path in scratch.iterdir()]


@skipping
async def test_uploaded_folder_is_shown_with_own_timeline_and_graph(tmp_path: Path):
    files = file_contents(recorded(tmp_path))
    async with upload_server() as (world, sender):
        status, response = await sender.send("drive", files)
        assert status == 200, response
        async with recording_page(sender, response["recording"]) as client:
            assert (await client.until("hello"))["title"] == "drive"
            timeline = await client.until("timeline")
            assert (timeline["name"], timeline["live"], timeline["end"] - timeline["start"]) == ("drive", False, 10)
            await client.until("playhead", playing=True)
        assert "/p" not in dict(world.viewer.context.node.get_topic_names_and_types()), (
            "recordings have their own graph"
        )
        async with recording_page(sender, "no-such-recording") as client:
            assert (await client.until("hello"))["title"] == ""


@skipping
async def test_single_file_is_shown_with_its_name(tmp_path: Path):
    files = file_contents(recorded(tmp_path))
    name = next(file for file in files if file.endswith(".mcap"))
    async with upload_server() as (_, sender):
        _, response = await sender.send("anything", {name: files[name]})
        async with recording_page(sender, response["recording"]) as client:
            assert (await client.until("timeline"))["name"] == name


@skipping
async def test_upload_requires_token_and_same_origin(scratch: Path):
    async with upload_server() as (_, sender):
        for method, path in (
            ("POST", "recordings"),
            ("PUT", "recordings/k/0"),
            ("POST", "recordings/k"),
            ("DELETE", "recordings/k"),
        ):
            async with sender.session.request(method, f"{sender.base}/{path}") as response:
                assert response.status == 401
            headers = {"Origin": "http://elsewhere.example"}
            status, _ = await sender.ask(method, path, headers=headers)
            assert status == 403
        assert not list_uploads(scratch)


@skipping
@pytest.mark.parametrize(
    ("name", "files", "status"),
    [
        ("drive", {"../drive.mcap": 1}, REFUSED_STATUS),
        ("drive", {"a/b.mcap": 1}, REFUSED_STATUS),
        ("drive", {"notes.txt": 1}, REFUSED_STATUS),
        ("drive", {}, REFUSED_STATUS),
        ("..", {"a.mcap": 1, "b.mcap": 1}, 400),
        ("a/b", {"a.mcap": 1, "b.mcap": 1}, 400),
        ("drive", {"a.mcap": -1}, 400),
        ("drive", {"a.mcap": 10**18}, REFUSED_STATUS),
    ],
)
async def test_invalid_or_oversized_recording_is_rejected_before_upload(
    scratch: Path, name: str, files: dict[str, int], status: int
):
    async with upload_server() as (_, sender):
        received_status, response = await sender.announce(name, files)
        assert received_status == status, response
        assert status == 400 or response["problem"]
        assert not list_uploads(scratch)


@skipping
@pytest.mark.parametrize(
    "data", [b"", b"not a recording", b"\x89MCAP0\r\n"], ids=["empty", "other", "only its beginning"]
)
async def test_unreadable_recording_is_reported_without_server_path(scratch: Path, data: bytes):
    async with upload_server() as (_, sender):
        status, response = await sender.send("x", {"x.mcap": data})
        assert status == REFUSED_STATUS
        assert "'x.mcap'" in response["problem"]
        assert str(scratch) not in response["problem"]
        assert not list_uploads(scratch)


@skipping
async def test_rejection_is_translated_to_page_language():
    async with upload_server() as (_, sender):
        announced = {"name": "x", "files": [{"name": "x.txt", "size": 1}]}
        for language, words in (("en", "is not a recording file"), ("zh", "不是录制")):
            _, response = await sender.ask("POST", "recordings", language, json=announced)
            assert words in response["problem"], response


@skipping
async def test_recording_of_program_is_shown_and_kept(tmp_path: Path):
    (path,) = recorded(tmp_path).glob("*.mcap")
    async with upload_server() as (world, sender):
        url = world.viewer.context.downloads.offer_repeatedly(path).lstrip("/")
        status, response = await sender.ask("POST", url)
        assert status == 200, response
        async with recording_page(sender, response["recording"]) as client:
            assert not (await client.until("timeline"))["live"]
        await asyncio.sleep(4 * TIMEOUT_S)
        assert world.viewer.guests.audience(response["recording"]) is None
        assert path.exists()
        path.write_bytes(b"not a recording")
        assert (await sender.ask("POST", url))[0] == REFUSED_STATUS
        assert (await sender.ask("POST", "export/other/x.mcap"))[0] == 404
        sender.token = "another"
        assert (await sender.ask("POST", url))[0] == 401


@skipping
async def test_truncated_recording_is_shown_with_warning(tmp_path: Path):
    files = file_contents(recorded(tmp_path))
    name = next(file for file in files if file.endswith(".mcap"))
    async with upload_server() as (_, sender):
        status, response = await sender.send("x", {name: files[name][:-100]})
        assert status == 200, response
        async with recording_page(sender, response["recording"]) as client:
            assert "is truncated" in (await client.until("playhead"))["problem"]


@skipping
async def test_file_of_wrong_size_is_rejected_and_can_be_resent(tmp_path: Path):
    async with upload_server() as (_, sender):
        _, response = await sender.announce("x", {"x.mcap": 100})
        assert (await sender.ask("PUT", f"recordings/{response['key']}/0", data=b"x" * 50))[0] == 400
        assert (await sender.ask("POST", f"recordings/{response['key']}"))[0] == 404, "the file was removed"
        assert (await sender.ask("PUT", f"recordings/{response['key']}/0", data=b"x" * 200))[0] == 400
        assert (await sender.ask("PUT", f"recordings/{response['key']}/0", data=b"x" * 100))[0] == 204
        assert (await sender.ask("PUT", f"recordings/{response['key']}/0", data=b"x" * 100))[0] == 404, (
            "the file exists"
        )


@skipping
async def test_canceled_or_stalled_upload_is_removed(scratch: Path):
    async with upload_server() as (_, sender):
        _, given_up = await sender.announce("x", {"x.mcap": 100})
        _, forgotten = await sender.announce("x", {"x.mcap": 100})
        assert len(list_uploads(scratch)) == 2
        assert (await sender.ask("DELETE", f"recordings/{given_up['key']}"))[0] == 204
        assert len(list_uploads(scratch)) == 1
        await asyncio.sleep(2 * TIMEOUT_S)
        assert not list_uploads(scratch)
        assert (await sender.ask("PUT", f"recordings/{forgotten['key']}/0", data=b"x" * 100))[0] == 404


@skipping
async def test_number_of_simultaneous_uploads_is_limited(scratch: Path):
    async with upload_server() as (_, sender):
        for _ in range(4):
            assert (await sender.announce("x", {"x.mcap": 1}))[0] == 200
        status, response = await sender.announce("x", {"x.mcap": 1})
        assert status == REFUSED_STATUS
        assert "wait" in response["problem"]
    assert not list_uploads(scratch), "the end of the program removes the files"


@skipping
async def test_recording_is_closed_after_its_last_page(tmp_path: Path, scratch: Path):
    files = file_contents(recorded(tmp_path))
    async with upload_server() as (_, sender):
        _, response = await sender.send("drive", files)
        async with recording_page(sender, response["recording"]) as client:
            await client.until("timeline")
            answering = asyncio.create_task(answer_pings(client))
            await asyncio.sleep(3 * TIMEOUT_S)
            assert len(list_uploads(scratch)) == 1, "a page shows the recording"
            answering.cancel()
        await asyncio.sleep(2 * TIMEOUT_S)
        assert not list_uploads(scratch)


@skipping
async def test_open_recordings_are_limited_and_removed_at_exit(tmp_path: Path, scratch: Path, monkeypatch):
    monkeypatch.setattr(guests, "IDLE_TIMEOUT_S", 60.0)
    files = file_contents(recorded(tmp_path))
    async with upload_server() as (_, sender):
        for _ in range(4):
            assert (await sender.send("drive", files))[0] == 200
        status, response = await sender.send("drive", files)
        assert status == REFUSED_STATUS
        assert "already open" in response["problem"]
        assert len(list_uploads(scratch)) == 4
        await asyncio.sleep(11)
        status, response = await sender.send("drive", files)
        assert status == 200, "the upload that was abandoned first is removed"
        assert len(list_uploads(scratch)) == 4
    assert not list_uploads(scratch)
