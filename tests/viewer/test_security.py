"""The server against requests that no page of ours would send."""

from __future__ import annotations

import asyncio
from pathlib import Path
from urllib.parse import urlsplit

import aiohttp
import pytest

from linkwright.viewer.audience import MAXIMUM_PAGES
from linkwright.viewer.server import MAXIMUM_MESSAGE
from tests.viewer.scene import page, world
from tests.viewer.test_mesh_files import package, write

MESHED = """\
<robot name="meshed"><link name="base"><visual><geometry>
  <mesh filename="package://robot/meshes/arm.stl"/>
</geometry></visual></link></robot>
"""


@pytest.fixture
def robot(tmp_path) -> Path:
    share = package(tmp_path / "robot", "robot")
    write(share / "meshes" / "arm.stl", "solid arm")
    write(share / "meshes" / "arm.stl.gz", "never sent")
    write(share / "secret.py", "secret")
    write(tmp_path / "secret.png", "secret")
    return share


@pytest.fixture
async def served(robot):
    async with world(packages={"robot": robot}) as made:
        made.describe(MESHED)
        await made.settle()
        yield made


async def raw(viewer, target: str, *, host: str | None = None, method: str = "GET", token: bool = True, **headers):
    """Status and body of a request whose target is sent exactly as it is."""
    address = urlsplit(viewer.url)
    if token:
        target += ("&" if "?" in target else "?") + address.query
    lines = [f"{method} {target} HTTP/1.1", f"Host: {host or address.netloc}", "Connection: close"]
    lines += [f"{name.replace('_', '-')}: {value}" for name, value in headers.items()]
    reader, writer = await asyncio.open_connection(address.hostname, address.port)
    writer.write(("\r\n".join(lines) + "\r\n\r\n").encode())
    answer = await asyncio.wait_for(reader.read(), 3)
    writer.close()
    await writer.wait_closed()
    head, _, body = answer.partition(b"\r\n\r\n")
    return int(head.split(b" ")[1]), body.decode(errors="replace"), head.decode().lower()


def mesh_url(viewer) -> str:
    display = next(display for display in viewer.displays if display.CLASS.endswith("RobotModel"))
    return display.scene.links[0].visuals[0].url


async def test_the_mesh_is_served_and_comes_again_only_when_it_changed(served, robot):
    status, body, head = await raw(served.viewer, mesh_url(served.viewer))
    assert (status, body) == (200, "solid arm")
    assert "content-type: model/stl" in head
    assert "cache-control: private, no-cache" in head
    tag = next(line for line in head.split("\r\n") if line.startswith("etag")).partition(": ")[2]
    assert (await raw(served.viewer, mesh_url(served.viewer), If_None_Match=tag))[:2] == (304, "")
    write(robot / "meshes" / "arm.stl", "solid arms")
    assert (await raw(served.viewer, mesh_url(served.viewer), If_None_Match=tag))[1] == "solid arms"


async def test_compressed_neighbours_are_never_sent_instead(served):
    status, body, head = await raw(served.viewer, mesh_url(served.viewer), Accept_Encoding="gzip, br")
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
async def test_no_path_leads_out_of_the_package(served, path):
    base = mesh_url(served.viewer).split("meshes/")[0]
    status, body, _ = await raw(served.viewer, base + path)
    assert status in (400, 403, 404)
    assert "secret" not in body
    assert "root:" not in body


@pytest.mark.parametrize(
    "target", ["/mesh/", "/mesh/robot/meshes/arm.stl", "/mesh/../page/index.html", "/assets/", "/assets"]
)
async def test_there_are_no_listings_and_no_unnamed_folders(served, target):
    assert (await raw(served.viewer, target))[0] == 404


@pytest.mark.parametrize("target", ["/../server.py", "/assets/../../server.py", "/..%2fserver.py", "/%2e%2e/server.py"])
async def test_no_path_leads_out_of_the_page(served, target):
    status, body, _ = await raw(served.viewer, target)
    assert status in (400, 404)
    assert "import" not in body


async def test_without_the_token_there_is_nothing(served):
    for target in ("/", "/ws", "/assets/x.js", mesh_url(served.viewer), "/nothing"):
        status, body, head = await raw(served.viewer, target, token=False)
        assert status == 401
        assert "open the address that linkwright printed" in body
        assert "set-cookie" not in head


async def test_the_cookie_lets_the_page_in(served):
    token = urlsplit(served.viewer.url).query.partition("=")[2]
    port = urlsplit(served.viewer.url).port
    good, bad = f"linkwright_{port}={token}", f"linkwright_{port + 1}={token}"
    assert (await raw(served.viewer, mesh_url(served.viewer), token=False, Cookie=good))[0] == 200
    assert (await raw(served.viewer, mesh_url(served.viewer), token=False, Cookie=bad))[0] == 401


async def test_a_name_bent_to_this_machine_is_refused(served):
    status, body, _ = await raw(served.viewer, "/", host="evil.example:7447")
    assert status == 403
    assert "'evil.example:7447'" in body


async def test_every_answer_carries_the_security_headers(served):
    for target, token in (("/", True), ("/", False), ("/nothing", True), (mesh_url(served.viewer), True)):
        _, _, head = await raw(served.viewer, target, token=token)
        for header in ("content-security-policy: default-src 'none'", "x-content-type-options: nosniff",
                       "referrer-policy: no-referrer", "cross-origin-resource-policy: same-origin"):  # fmt: skip
            assert header in head
        assert "aiohttp" not in head


@pytest.mark.parametrize("method", ["POST", "PUT", "DELETE", "OPTIONS"])
async def test_only_reading_is_allowed(served, method):
    assert (await raw(served.viewer, "/", method=method, Content_Length="0"))[0] == 405


async def test_a_page_of_another_site_gets_no_socket(served):
    async with aiohttp.ClientSession() as session:
        for origin, status in (("http://evil.example", 403), ("null", 403)):
            with pytest.raises(aiohttp.WSServerHandshakeError) as caught:
                await session.ws_connect(served.viewer.url.replace("/?", "/ws?"), origin=origin)
            assert caught.value.status == status
        own = "http://" + urlsplit(served.viewer.url).netloc
        async with session.ws_connect(served.viewer.url.replace("/?", "/ws?"), origin=own) as socket:
            assert (await socket.receive_json())["type"] == "hello"


async def test_a_plain_request_to_the_socket_is_told_so(served):
    status, body, _ = await raw(served.viewer, "/ws")
    assert status == 400
    assert "WebSocket" in body


async def closed_with(client) -> int:
    with pytest.raises(ConnectionError):
        await client.until("nothing of this kind")
    return client.socket.close_code


async def test_a_message_too_long_ends_the_connection(served):
    async with page(served.viewer) as client:
        await client.socket.send_str("x" * (MAXIMUM_MESSAGE + 1))
        assert await closed_with(client) == 1009


async def test_a_binary_message_ends_the_connection(served):
    async with page(served.viewer) as client:
        await client.socket.send_bytes(b"\0")
        assert await closed_with(client) == 1003


async def test_nonsense_is_passed_over_and_logged_but_not_forever(served):
    async with page(served.viewer) as client:
        await client.socket.send_str('{"type": "set_joint", "name": 1}')
        await client.set("global/Fixed Frame", "tip")
        assert (await client.until("property_changed", id="global/Fixed Frame"))["value"] == "tip"
        assert "A page sent what is no message" in served.logged()
        for _ in range(30):
            await client.socket.send_str("nonsense")
        assert await closed_with(client) == 1008


async def test_more_pages_than_allowed_are_refused(served):
    address = served.viewer.url.replace("/?", "/ws?")
    async with aiohttp.ClientSession() as session:
        pages = [await session.ws_connect(address) for _ in range(MAXIMUM_PAGES)]
        with pytest.raises(aiohttp.WSServerHandshakeError) as caught:
            await session.ws_connect(address)
        assert caught.value.status == 503
        await pages[0].close()
        await asyncio.sleep(0.05)
        pages[0] = await session.ws_connect(address)
        for page in pages:
            await page.close()
