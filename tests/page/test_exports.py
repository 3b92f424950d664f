"""Files that pages request: each is fetched once, from a secret address."""

from __future__ import annotations

import base64

import pytest

from tests.page.test_files import write_file, write_package
from tests.page.test_security import MESHED, send_raw_request
from tests.viewer.scene import open_page, open_world


@pytest.fixture
async def served(tmp_path):
    share = write_package(tmp_path / "robot", "robot")
    write_file(share / "meshes" / "arm.stl", "solid arm")
    async with open_world(packages={"robot": share}) as world:
        yield world


async def wait_for_export(client, kind: str = "glb") -> dict:
    await client.send(
        "request_export", format=kind, view={"cls": "rviz_default_plugins/Orbit", "name": "", "values": {}}
    )
    while True:
        message = await client.receive()
        if isinstance(message, dict) and message["type"] in ("export_ready", "export_failed"):
            return message


async def test_export_is_fetched_once_from_secret_url(served):
    served.describe('<robot name="../../evil name"><link name="base"/></robot>')
    await served.settle()
    async with open_page(served.viewer) as client:
        ready = await wait_for_export(client)
        assert ready["name"] == "evil_name.glb"
        key = ready["url"].split("/")[2]
        assert len(base64.urlsafe_b64decode(f"{key}==")) >= 16
        assert (await send_raw_request(served.viewer, ready["url"].replace(key, key[:-1])))[0] == 404
        assert (await send_raw_request(served.viewer, ready["url"], host="evil.example"))[0] == 403
        status, body, head = await send_raw_request(served.viewer, ready["url"], token=False)
        assert (status, body[:4]) == (200, "glTF")
        assert "content-disposition: attachment" in head
        assert (await send_raw_request(served.viewer, ready["url"]))[0] == 404
        for guessed_path in ("/export/x/evil_name.glb", "/export/../server.py", "/export/%2e%2e/server.py", "/export/"):
            assert (await send_raw_request(served.viewer, guessed_path))[0] in (403, 404)


async def test_unfetched_exports_expire(served):
    served.describe('<robot name="arm"><link name="base"/></robot>')
    await served.settle()
    async with open_page(served.viewer) as client:
        ready = [await wait_for_export(client) for _ in range(6)]
        assert [(await send_raw_request(served.viewer, export["url"]))[0] for export in ready] == [
            404,
            404,
            200,
            200,
            200,
            200,
        ]


async def test_failed_export_reports_reason(served):
    served.describe(MESHED)
    await served.settle()
    async with open_page(served.viewer) as client:
        failed = await wait_for_export(client)
        assert failed["type"] == "export_failed"
        assert "arm.stl" in failed["message"]
