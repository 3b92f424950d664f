"""Requests to the server that Linkwright's page never sends."""

from __future__ import annotations

import asyncio
import random
import re
from contextlib import suppress
from pathlib import Path
from urllib.parse import urlsplit

import aiohttp
import psutil
import pytest

from linkwright.page import files
from linkwright.page.access import MAX_CONNECTIONS
from linkwright.page.audience import MAX_PAGES
from linkwright.page.protocol.configuration import DisplayStatus, StatusRow
from linkwright.page.server import MAX_MESSAGE_SIZE
from tests.leaving import UPGRADE, request_and_reset
from tests.page.test_files import write_file, write_package
from tests.viewer.scene import open_page, open_world
from tests.waiting import TIMEOUT_S, eventually

MESHED = """\
<robot name="meshed"><link name="base"><visual><geometry>
  <mesh filename="package://robot/meshes/arm.stl"/>
</geometry></visual></link></robot>
"""


@pytest.fixture
def robot(tmp_path) -> Path:
    share = write_package(tmp_path / "robot", "robot")
    write_file(share / "meshes" / "arm.stl", "solid arm")
    write_file(share / "meshes" / "arm.stl.gz", "never sent")
    write_file(share / "secret.py", "secret")
    write_file(tmp_path / "secret.png", "secret")
    return share


@pytest.fixture
async def served(robot):
    async with open_world(packages={"robot": robot}) as world:
        world.describe(MESHED)
        await world.settle()
        yield world


async def send_raw_request(
    viewer, target: str, *, host: str | None = None, method: str = "GET", token: bool = True, **headers
):
    """Return the status and body for a request whose target is sent unchanged."""
    address = urlsplit(viewer.url)
    if token:
        target += ("&" if "?" in target else "?") + address.query
    lines = [f"{method} {target} HTTP/1.1", f"Host: {host or address.netloc}", "Connection: close"]
    lines += [f"{name.replace('_', '-')}: {value}" for name, value in headers.items()]
    reader, writer = await asyncio.open_connection(address.hostname, address.port)
    writer.write(("\r\n".join(lines) + "\r\n\r\n").encode())
    response = await asyncio.wait_for(reader.read(), TIMEOUT_S)
    writer.close()
    await writer.wait_closed()
    head, _, body = response.partition(b"\r\n\r\n")
    return int(head.split(b" ")[1]), body.decode(errors="replace"), head.decode().lower()


def mesh_url(viewer) -> str:
    display = next(display for display in viewer.displays if display.CLASS.endswith("RobotModel"))
    return display.scene.links[0].visuals[0].url


async def test_mesh_is_compressed_for_browser_that_accepts_it(served, robot):
    url, mesh = mesh_url(served.viewer), robot / "meshes" / "arm.stl"
    text = "facet normal 0 0 1\n" * 1000
    write_file(mesh, text)
    _, uncompressed, head = await send_raw_request(served.viewer, url)
    assert uncompressed == text
    assert "content-encoding" not in head
    status, packed, head = await send_raw_request(served.viewer, url, Accept_Encoding="gzip, br")
    assert (status, len(packed) < len(text) / 10) == (200, True)
    for line in ("content-encoding: gzip", "vary: accept-encoding", f"x-unpacked-length: {len(text)}"):
        assert line in head
    tag = next(line for line in head.split("\r\n") if line.startswith("etag")).partition(": ")[2]
    assert (await send_raw_request(served.viewer, url, Accept_Encoding="gzip", If_None_Match=tag))[:2] == (304, "")
    mesh.write_bytes(random.Random(1).randbytes(20_000))
    assert "content-encoding" not in (await send_raw_request(served.viewer, url, Accept_Encoding="gzip"))[2], (
        "compression would not make the mesh smaller"
    )


async def test_mesh_is_sent_again_only_after_change(served, robot):
    status, body, head = await send_raw_request(served.viewer, mesh_url(served.viewer))
    assert (status, body) == (200, "solid arm")
    assert "content-type: model/stl" in head
    assert "cache-control: private, no-cache" in head
    tag = next(line for line in head.split("\r\n") if line.startswith("etag")).partition(": ")[2]
    assert (await send_raw_request(served.viewer, mesh_url(served.viewer), If_None_Match=tag))[:2] == (304, "")
    write_file(robot / "meshes" / "arm.stl", "solid arms")
    assert (await send_raw_request(served.viewer, mesh_url(served.viewer), If_None_Match=tag))[1] == "solid arms"


async def test_compressed_files_beside_mesh_are_not_served(served):
    status, body, head = await send_raw_request(served.viewer, mesh_url(served.viewer), Accept_Encoding="gzip, br")
    assert (status, body) == (200, "solid arm")
    assert "content-encoding" not in head


@pytest.mark.parametrize(
    "path",
    [
        "../secret.png",
        "..%2fsecret.png",
        "..%2Fsecret.png",
        "%2e%2e/secret.png",
        "%2e%2e%2fsecret.png",
        "%252e%252e%252fsecret.png",
        "meshes/../../secret.png",
        "meshes/..%5c..%5csecret.png",
        "/etc/passwd",
        "%2fetc%2fpasswd",
        "//etc/hosts.png",
        "meshes/arm.stl%00.png",
        "secret.py",
        "package.xml",
        "meshes/",
        "meshes",
        "",
    ],
)
async def test_paths_do_not_lead_out_of_package(served, path):
    base = mesh_url(served.viewer).split("meshes/")[0]
    status, body, _ = await send_raw_request(served.viewer, base + path)
    assert status in (400, 403, 404)
    assert "secret" not in body
    assert "root:" not in body


async def test_symlink_out_of_package_is_rejected(served, robot):
    for name in ("link.stl", "folder"):
        target = robot.parent / "secret.png" if name == "link.stl" else robot.parent
        (robot / "meshes" / name).symlink_to(target)
    base = mesh_url(served.viewer).split("meshes/")[0] + "meshes/"
    for path in ("link.stl", "folder/secret.png"):
        status, body, _ = await send_raw_request(served.viewer, base + path)
        assert status == 403
        assert "secret" not in body


@pytest.mark.parametrize(
    "target", ["/mesh/", "/mesh/robot/meshes/arm.stl", "/mesh/../page/index.html", "/assets/", "/assets"]
)
async def test_folder_listings_and_unknown_folders_are_not_found(served, target):
    assert (await send_raw_request(served.viewer, target))[0] == 404


@pytest.mark.parametrize("target", ["/../server.py", "/assets/../../server.py", "/..%2fserver.py", "/%2e%2e/server.py"])
async def test_paths_do_not_lead_out_of_page_folder(served, target):
    status, body, _ = await send_raw_request(served.viewer, target)
    assert status in (400, 404)
    assert "import" not in body


async def test_only_static_page_is_served_without_token(served):
    """These are files that every wheel contains, without data of the viewer."""
    for query in ("", "?token=", "?token=wrong"):
        status, body, _ = await send_raw_request(served.viewer, f"/ws{query}", token=False)
        assert status == 401
        assert "open the address that linkwright printed" in body
    assert (await send_raw_request(served.viewer, "/", token=False))[0] in (200, 503)  # 503 if the page is not built
    assert (await send_raw_request(served.viewer, "/assets/gone.js", token=False))[0] == 404


async def test_web_socket_requires_token(served):
    base = served.viewer.url.partition("?")[0]
    async with aiohttp.ClientSession() as session:
        for query in ("", "?token=", "?token=wrong"):
            for text in ({}, {"Cookie": f"linkwright={urlsplit(served.viewer.url).query}"}):
                with pytest.raises(aiohttp.WSServerHandshakeError) as caught:
                    await session.ws_connect(f"{base}ws{query}", headers=text)
                assert caught.value.status == 401


async def test_responses_set_no_cookies(served):
    """Browsers would send a cookie to all ports of this host."""
    for target in ("/", "/ws", "/nothing", mesh_url(served.viewer)):
        for proto in ("http", "https"):
            assert "set-cookie" not in (await send_raw_request(served.viewer, target, X_Forwarded_Proto=proto))[2]


async def test_mesh_url_contains_secret(served, robot, monkeypatch):
    """Image elements fetch textures without a token, so only pages get the URLs."""
    address = mesh_url(served.viewer)
    assert (await send_raw_request(served.viewer, address, token=False))[:2] == (200, "solid arm")
    label, _, secret = address.split("/")[2].partition("~")
    assert re.fullmatch("[0-9a-f]{32}", secret)
    for key in (label, f"{label}~", f"{label}~{'0' * 32}", f"{label}~{secret[:-1]}", "robot", ""):
        assert (await send_raw_request(served.viewer, f"/mesh/{key}/meshes/arm.stl"))[0] == 404
    # Another run of the program has another secret.
    monkeypatch.setattr(files, "_SECRET", bytes(32))
    other = files.ServedFolder(robot, "robot").key
    assert other.startswith(f"{label}~")
    assert other != f"{label}~{secret}"


async def test_dns_rebinding_host_is_rejected(served):
    status, body, _ = await send_raw_request(served.viewer, "/", host="evil.example:7447")
    assert status == 403
    assert "'evil.example:7447'" in body


async def test_responses_have_security_headers(served):
    for target, token in (("/", True), ("/", False), ("/nothing", True), (mesh_url(served.viewer), True)):
        _, _, head = await send_raw_request(served.viewer, target, token=token)
        for header in ("content-security-policy: default-src 'none'", "x-content-type-options: nosniff",
                       "referrer-policy: no-referrer", "cross-origin-resource-policy: same-origin"):  # fmt: skip
            assert header in head
        assert "aiohttp" not in head


@pytest.mark.parametrize("method", ["POST", "PUT", "DELETE", "OPTIONS"])
async def test_methods_other_than_get_are_rejected(served, method):
    assert (await send_raw_request(served.viewer, "/", method=method, Content_Length="0"))[0] == 405


async def test_web_socket_of_other_origin_is_rejected(served):
    async with aiohttp.ClientSession() as session:
        for origin, status in (("http://evil.example", 403), ("null", 403)):
            with pytest.raises(aiohttp.WSServerHandshakeError) as caught:
                await session.ws_connect(served.viewer.url.replace("/?", "/ws?"), origin=origin)
            assert caught.value.status == status
        own_origin = "http://" + urlsplit(served.viewer.url).netloc
        async with session.ws_connect(served.viewer.url.replace("/?", "/ws?"), origin=own_origin) as socket:
            assert (await socket.receive_json())["type"] == "hello"


async def test_plain_request_to_web_socket_is_rejected(served):
    status, body, _ = await send_raw_request(served.viewer, "/ws")
    assert status == 400
    assert "WebSocket" in body


async def wait_for_close_code(client) -> int:
    with pytest.raises(ConnectionError):
        await client.until("nothing of this kind")
    return client.socket.close_code


async def test_oversized_message_closes_connection(served):
    async with open_page(served.viewer) as client:
        await client.socket.send_str("x" * (MAX_MESSAGE_SIZE + 1))
        assert await wait_for_close_code(client) == 1009


async def test_binary_message_closes_connection(served):
    async with open_page(served.viewer) as client:
        await client.socket.send_bytes(b"\0")
        assert await wait_for_close_code(client) == 1003


async def test_invalid_messages_are_logged_and_finally_close_connection(served):
    async with open_page(served.viewer) as client:
        await client.socket.send_str('{"type": "set_joint", "name": 1}')
        await client.set("global/Fixed Frame", "tip")
        assert (await client.until("property_changed", id="global/Fixed Frame"))["value"] == "tip"
        assert "A page sent an invalid message" in served.logged()
        for _ in range(30):
            await client.socket.send_str("nonsense")
        assert await wait_for_close_code(client) == 1008


async def test_pages_beyond_maximum_are_rejected(served):
    address = served.viewer.url.replace("/?", "/ws?")
    async with aiohttp.ClientSession() as session:
        pages = [await session.ws_connect(address) for _ in range(MAX_PAGES)]
        with pytest.raises(aiohttp.WSServerHandshakeError) as caught:
            await session.ws_connect(address)
        assert caught.value.status == 503
        await pages[0].close()
        await eventually(lambda: len(served.viewer._audience) < MAX_PAGES)
        pages[0] = await session.ws_connect(address)
        for page in pages:
            await page.close()


# --- many, slow and half connections -------------------------------------------------------------------------------


def resident_memory() -> int:
    """Return the resident memory of this process in bytes."""
    return psutil.Process().memory_info().rss


async def open_raw_connection(viewer, request_text: bytes = b"") -> asyncio.StreamWriter:
    address = urlsplit(viewer.url)
    _, writer = await asyncio.open_connection(address.hostname, address.port)
    writer.write(request_text)
    return writer


async def expect_response(client) -> None:
    """Assert that the open page still receives responses."""
    expected_link = "tip" if client.messages and "base" in str(client.messages[-1]) else "base"
    await client.set("global/Fixed Frame", expected_link)
    await client.until("property_changed", id="global/Fixed Frame", value=expected_link)


async def test_thousand_idle_connections_do_not_disturb_pages(served):
    async with open_page(served.viewer) as client:
        await client.opened()
        before = resident_memory()
        knocking = [await open_raw_connection(served.viewer) for _ in range(1000)]
        await expect_response(client)
        # Silent connections are closed for a client with the token.
        assert (await send_raw_request(served.viewer, mesh_url(served.viewer)))[:2] == (200, "solid arm")
        await eventually(lambda: served.viewer._server.web._admission._count <= MAX_CONNECTIONS)
        assert resident_memory() - before < 64 << 20
        for connection in knocking:
            connection.close()
        await expect_response(client)


async def test_web_sockets_beyond_maximum_are_rejected(served):
    address = served.viewer.url.replace("/?", "/ws?")
    statuses: list[int] = []
    sockets: list[aiohttp.ClientWebSocketResponse | None] = []
    async with (
        open_page(served.viewer) as client,
        aiohttp.ClientSession(connector=aiohttp.TCPConnector(limit=0)) as session,
    ):

        async def connect() -> aiohttp.ClientWebSocketResponse | None:
            try:
                return await session.ws_connect(address)
            except aiohttp.WSServerHandshakeError as error:
                statuses.append(error.status)
            except aiohttp.ClientConnectionError:
                statuses.append(0)
            return None

        await client.opened()
        for _ in range(10):
            sockets += await asyncio.gather(*(connect() for _ in range(100)))
            await expect_response(client)
        assert set(statuses) <= {0, 503}
        assert len(statuses) >= 1000 - MAX_PAGES
        assert len(served.viewer._audience) <= MAX_PAGES


async def test_incomplete_request_times_out(served, monkeypatch):
    monkeypatch.setattr("linkwright.page.access.FIRST_REQUEST_TIMEOUT_S", 0.2)
    address = urlsplit(served.viewer.url)
    for text in (b"", b"GET / HT", b"GET / HTTP/1.1\r\nHost: localhost\r\nX-Slow: "):
        reader, writer = await asyncio.open_connection(address.hostname, address.port)
        writer.write(text)
        ended = asyncio.ensure_future(reader.read())
        while not ended.done():
            writer.write(b"a")  # single bytes do not extend the time limit
            await asyncio.wait([ended], timeout=0.02)
        assert isinstance(ended.exception(), (ConnectionError, type(None)))
        writer.close()


async def test_connected_page_does_not_time_out(served, monkeypatch):
    monkeypatch.setattr("linkwright.page.access.FIRST_REQUEST_TIMEOUT_S", 0.1)
    async with open_page(served.viewer) as client:
        await client.opened()
        address = urlsplit(served.viewer.url)
        silent, writer = await asyncio.open_connection(address.hostname, address.port)
        with suppress(ConnectionError):
            await silent.read()  # a newer, silent connection has timed out
        writer.close()
        await expect_response(client)


async def test_clients_that_read_nothing_use_little_memory(served, tmp_path, monkeypatch):
    """Clients that read nothing use little memory.

    The page's public files are in memory once, and their readers are dropped in favor of clients with the token.
    """
    (tmp_path / "assets").mkdir()
    (tmp_path / "assets" / "index-abc.js").write_bytes(b"a" * (4 << 20))
    server = served.viewer._server.web
    monkeypatch.setattr(server, "_page_folder", tmp_path)
    # The client answers heartbeats only while it reads.
    monkeypatch.setattr("linkwright.page.server._HEARTBEAT_PERIOD_S", 600.0)
    address = urlsplit(served.viewer.url)
    asking = f"GET /assets/index-abc.js HTTP/1.1\r\nHost: {address.netloc}\r\n\r\n".encode()
    async with open_page(served.viewer) as client:
        await client.opened()
        readers = [await asyncio.open_connection(address.hostname, address.port) for _ in range(MAX_CONNECTIONS)]
        for _, writer in readers:
            writer.write(asking)
        for reader, _ in readers[1:]:
            await reader.readexactly(100)
        await expect_response(client)
        assert len(server._page_contents) == 1
        waiting = [
            connection._transport.get_write_buffer_size()
            for connection in server._admission._unadmitted_connections.values()
        ]
        assert len(waiting) > MAX_CONNECTIONS - 5
        assert max(waiting) < 256 << 10
        status, body, _ = await send_raw_request(served.viewer, "/assets/index-abc.js", token=False)
        assert (status, len(body)) == (200, 4 << 20)
        for _, writer in readers:
            writer.close()
        await expect_response(client)


async def test_slow_download_of_page_does_not_time_out(served, tmp_path, monkeypatch):
    """A slow download of the page does not time out.

    Its files are fetched without the token, and a slow line takes longer than the limit for other clients.
    """
    monkeypatch.setattr("linkwright.page.access.FIRST_REQUEST_TIMEOUT_S", 0.1)
    (tmp_path / "assets").mkdir()
    (tmp_path / "assets" / "index-abc.js").write_bytes(b"a" * (16 << 20))
    monkeypatch.setattr(served.viewer._server.web, "_page_folder", tmp_path)
    address = urlsplit(served.viewer.url)
    reader, writer = await asyncio.open_connection(address.hostname, address.port)
    writer.write(f"GET /assets/index-abc.js HTTP/1.1\r\nHost: {address.netloc}\r\nConnection: close\r\n\r\n".encode())
    await reader.readuntil(b"\r\n\r\n")
    silent, other = await asyncio.open_connection(address.hostname, address.port)
    with suppress(ConnectionError):
        await silent.read()  # a newer, silent connection has timed out
    assert len(await reader.read()) == 16 << 20
    writer.close()
    other.close()


async def test_rejected_request_closes_connection(served):
    address = urlsplit(served.viewer.url)
    reader, writer = await asyncio.open_connection(address.hostname, address.port)
    writer.write(f"GET /ws HTTP/1.1\r\nHost: {address.netloc}\r\n\r\n".encode())
    response = await reader.read()
    assert response.startswith(b"HTTP/1.1 401")
    writer.close()


@pytest.mark.parametrize(
    "message",
    [
        b"GET /" + b"a" * 100_000 + b" HTTP/1.1\r\n\r\n",
        b"GET / HTTP/1.1\r\nHost: localhost\r\nX: " + b"a" * 100_000 + b"\r\n\r\n",
        b"GET / HTTP/1.1\r\n" + b"".join(b"X-%d: 1\r\n" % i for i in range(20_000)) + b"\r\n",
        b"\x16\x03\x01\x02\x00\x01\x00" * 100,
        b"POST / HTTP/1.1\r\nHost: localhost\r\nContent-Length: 99999999999\r\n\r\n",
        b"POST / HTTP/1.1\r\nHost: localhost\r\nTransfer-Encoding: chunked\r\n\r\nFFFFFFFFFFFFFFFF\r\n",
    ],
    ids=["path", "header", "headers", "tls", "length", "chunk"],
)
async def test_oversized_requests_are_rejected(served, message):
    before = resident_memory()
    address = urlsplit(served.viewer.url)
    reader, writer = await asyncio.open_connection(address.hostname, address.port)
    with suppress(ConnectionError):
        writer.write(message)
        response = await reader.read(4096)
        assert response == b"" or response.split(b" ")[1][:1] == b"4"
    writer.close()
    assert resident_memory() - before < 16 << 20
    assert (await send_raw_request(served.viewer, mesh_url(served.viewer)))[0] == 200


@pytest.mark.parametrize(
    "message",
    [
        b"\x00\xff\xfe nonsense\r\n\r\n",
        bytes.fromhex("16030100c8010000c40303") + bytes(range(200)) + b"\r\n\r\n",
        b"GET / HTTP/1.1\r\nHost: localhost\r\nX: " + b"a" * 1_000_000 + b"\r\n\r\n",
        b"GET / HTTP/9.9\r\n\r\n",
        b"GET / HTTP/1.1\r\n\r\n",
        b"G@T / HTTP/1.1\r\nHost: localhost\r\n\r\n",
        b"GET http://[::1 HTTP/1.1\r\nHost: localhost\r\n\r\n",
        b"GET / HTTP/1.1\r\nHost: localhost\r\nContent-Length: -5\r\n\r\n",
        b"GET / HTTP/1.1\r\nHost: localhost\r\nCookie: \x01\r\n\r\n",
        b"POST / HTTP/1.1\r\nHost: localhost\r\nTransfer-Encoding: chunked\r\n\r\nZZZ\r\nnonsense\r\n",
        b"POST / HTTP/1.1\r\nHost: localhost\r\nContent-Length: 5\r\nTransfer-Encoding: chunked\r\n\r\n0\r\n\r\n",
        b"POST / HTTP/1.1\r\nHost: localhost\r\nContent-Encoding: gzip\r\nContent-Length: 4\r\n\r\nabcd",
        b"GET /ws HTTP/1.1\r\nHost: localhost\r\nUpgrade: websocket\r\nConnection: Upgrade\r\n\r\n",
        b"PRI * HTTP/2.0\r\n\r\nSM\r\n\r\n",
    ],
    ids=[
        "bytes",
        "tls",
        "header",
        "version",
        "no-host",
        "method",
        "url",
        "length",
        "cookie",
        "chunk",
        "both",
        "gzip",
        "ws",
        "h2",
    ],
)
async def test_malformed_requests_are_not_logged(served, message, caplog):
    address = urlsplit(served.viewer.url)
    reader, writer = await asyncio.open_connection(address.hostname, address.port)
    with suppress(ConnectionError):
        writer.write(message)
        response = await reader.read(4096)
        assert response == b"" or response.split(b" ")[1][:1] == b"4"
    writer.close()
    assert (await send_raw_request(served.viewer, mesh_url(served.viewer)))[0] == 200
    assert [record.getMessage() for record in caplog.records] == []


@pytest.mark.parametrize("target", ["/", "/ws", "/mesh/none/none.stl"])
async def test_disconnected_client_is_not_logged(served, target, caplog):
    address = urlsplit(served.viewer.url)
    for headers in ("", UPGRADE):
        await request_and_reset(address.port, f"{target}?{address.query}", headers)
    assert (await send_raw_request(served.viewer, mesh_url(served.viewer)))[0] == 200
    assert [record.getMessage() for record in caplog.records] == []


async def test_message_flood_slows_only_its_sender(served):
    async with open_page(served.viewer) as flooding, open_page(served.viewer) as client:
        await client.opened()

        sent = 0

        async def flood() -> None:
            nonlocal sent
            for number in range(100_000):
                sent = number
                await flooding.socket.send_str(f'{{"type":"received","count":{number}}}' + 500 * " ")

        task = asyncio.ensure_future(flood())
        await eventually(lambda: sent > 100)
        for _ in range(5):
            await expect_response(client)
        assert not task.done()
        task.cancel()
        await asyncio.gather(task, return_exceptions=True)


async def test_page_that_reads_nothing_uses_little_memory(served):
    """Its outbox keeps only the newest message of each kind."""
    address = urlsplit(served.viewer.url)
    reader, writer = await asyncio.open_connection(address.hostname, address.port)
    key = "dGhlIHNhbXBsZSBub25jZQ=="
    lines = [f"GET /ws?{address.query} HTTP/1.1", f"Host: {address.netloc}", "Connection: Upgrade"]
    lines += ["Upgrade: websocket", "Sec-WebSocket-Version: 13", f"Sec-WebSocket-Key: {key}"]
    writer.write(("\r\n".join(lines) + "\r\n\r\n").encode())
    await reader.readuntil(b"\r\n\r\n")
    before = resident_memory()
    for number in range(3000):
        served.move_arm(x=number / 1000)
        served.viewer.manager.publish(
            DisplayStatus("display-1", "ok", [StatusRow("Topic", "ok", "x" * 2000 + str(number))])
        )
        if number % 100 == 0:
            await asyncio.sleep(0)
    assert resident_memory() - before < 16 << 20
    writer.close()


# --- files from pages ----------------------------------------------------------------------------------------------


@pytest.mark.parametrize(
    "name", ["notes.txt", ".bashrc", "x.rviz/../notes.txt", "a.rviz\0.txt", "link.rviz", "dir.rviz"]
)
async def test_pages_can_write_configurations_only(served, tmp_path, name):
    (tmp_path / "notes.txt").write_text("mine")
    (tmp_path / ".bashrc").write_text("mine")
    (tmp_path / "link.rviz").symlink_to(tmp_path / "notes.txt")
    (tmp_path / "dir.rviz").mkdir()
    async with open_page(served.viewer) as client:
        await client.send("save_configuration", path=f"{tmp_path}/{name}", replace=True)
        assert (await client.until("configuration_refused"))["question"] is None
    assert (tmp_path / "notes.txt").read_text() == (tmp_path / ".bashrc").read_text() == "mine"
    assert sorted(path.name for path in tmp_path.iterdir() if path.is_file()) == [
        ".bashrc", "link.rviz", "notes.txt", "secret.png"]  # fmt: skip
