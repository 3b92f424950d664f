"""The editor of source files: reading, writing, and the language server."""

from __future__ import annotations

import json
import os
from pathlib import Path
from typing import Any

import pytest

from linkwright.descriptions import examine
from linkwright.descriptions.editing import Workspace
from linkwright.diagnostics import extras
from linkwright.page.audience import Page
from linkwright.panels.source_editor.feature import SourceEditorFeature
from linkwright.panels.source_editor.files import SourceFiles, with_line_ends
from tests.viewer.scene import ARM, open_page, open_world

ROBOT = '<robot name="r">\n  <link name="base"/>\n</robot>\n'


@pytest.fixture
def file(tmp_path: Path) -> Path:
    package = tmp_path / "ws" / "src" / "arm_description"
    (package / "urdf").mkdir(parents=True)
    (package / "package.xml").write_text("<package/>")
    path = package / "urdf" / "arm.urdf"
    path.write_text(ROBOT)
    return path


def real_path(path: Path) -> str:
    return os.path.realpath(path)


def content(path: Path) -> bytes:
    return path.read_bytes()


def write(path: Path, text: str) -> None:
    path.write_text(text)


async def request(client: Any, request_kind: str, response_kind: str, **fields: Any) -> dict[str, Any]:
    await client.send(request_kind, **fields)
    response: dict[str, Any] = await client.until(response_kind)
    return response


async def open_file(world: Any, client: Any, file: Path) -> dict[str, Any]:
    world.describe(world.library.store(examine(file)))
    await client.until("description_changed")
    return await request(client, "open_editor", "editor_opened", file=str(file))


async def save(client: Any, path: Path, version: int, text: str) -> dict[str, Any]:
    return await request(
        client, "write_source_file", "source_file_written", number=version, path=str(path), version=version, text=text
    )


async def test_source_file_is_read_written_and_undone(file: Path) -> None:
    async with open_world() as world, open_page(world.viewer) as client:
        response = await open_file(world, client, file)
        assert (response["folder"], response["refusal_reason"]) == (str(file.parents[3]), "")
        shown = await request(client, "request_source_file", "source_file", path=str(file))
        assert (shown["text"], shown["version"], shown["refusal_reason"]) == (ROBOT, 1, "")
        assert shown["uri"] == file.as_uri()
        written = await save(client, file, 1, ROBOT.replace("base", "body"))
        assert (written["refusal"], written["version"]) == (None, 2)
        assert content(file) == ROBOT.replace("base", "body").encode()
        undone = await request(client, "undo_edit", "edit_written")
        assert undone["files"] == [str(file)]
        assert content(file) == ROBOT.encode()
        assert (await client.until("source_file"))["text"] == ROBOT


async def test_external_change_is_sent_and_not_overwritten(file: Path) -> None:
    async with open_world() as world, open_page(world.viewer) as client:
        await open_file(world, client, file)
        await request(client, "request_source_file", "source_file", path=str(file))
        write(file, ROBOT + "<!-- theirs -->")
        refused = await save(client, file, 1, "mine")
        assert refused["refusal"]["code"] == "EDIT107"
        assert content(file) == (ROBOT + "<!-- theirs -->").encode()
        shown = await client.until("source_file", version=2)
        assert shown["text"] == ROBOT + "<!-- theirs -->"
        assert (await save(client, file, 2, "mine"))["refusal"] is None
        assert content(file) == b"mine"


async def test_folder_is_listed_and_file_is_created(file: Path) -> None:
    folder = file.parents[1]
    (folder / "build").mkdir()
    (folder / ".git").mkdir()
    (folder / "arm.stl").write_bytes(b"")
    async with open_world() as world, open_page(world.viewer) as client:
        await open_file(world, client, file)
        listed = await request(client, "request_source_folder", "source_folder", path=str(folder))
        assert (listed["folders"], listed["files"]) == (["urdf"], ["package.xml"])
        new = folder / "config" / "arm.yaml"
        created = await request(client, "create_source_file", "source_file_written", number=1, path=str(new))
        assert created["refusal"] is None
        assert content(new) == b""
        second_reply = await request(client, "create_source_file", "source_file_written", number=2, path=str(new))
        assert "already exists" in second_reply["refusal"]["message"]


async def test_missing_file_is_created_with_first_text(file: Path) -> None:
    new, other = (file.parents[1] / "launch" / name for name in ("new.launch.py", "other.launch.py"))
    async with open_world() as world, open_page(world.viewer) as client:
        await open_file(world, client, file)
        first_text = await request(client, "request_source_file", "source_file", path=str(new))
        assert (first_text["text"], first_text["is_new"]) == (None, True)
        assert not new.parent.exists()
        written = await save(client, new, first_text["version"], "x = 1\n")
        assert (written["refusal"], new.read_text()) == (None, "x = 1\n")
        written = await save(client, new, written["version"], "x = 2\n")
        assert (written["refusal"], new.read_text()) == (None, "x = 2\n")
        first_text = await request(client, "request_source_file", "source_file", path=str(other))
        write(other, "of another program\n")
        written = await save(client, other, first_text["version"], "mine\n")
        assert written["refusal"] is not None
        assert other.read_text() == "of another program\n"


@pytest.mark.parametrize("path", ["/etc/passwd", "{ws}/.git/config", "{ws}/../outside.txt"])
async def test_files_outside_sources_are_neither_read_nor_created(file: Path, path: str) -> None:
    workspace = file.parents[3]
    (workspace / ".git").mkdir()
    (workspace / ".git" / "config").write_text("secret")
    path = path.format(ws=workspace)
    async with open_world() as world, open_page(world.viewer) as client:
        await open_file(world, client, file)
        shown = await request(client, "request_source_file", "source_file", path=path)
        assert shown["text"] is None
        assert "outside the workspace" in shown["refusal_reason"]
        created = await request(client, "create_source_file", "source_file_written", number=1, path=path + "x")
        assert created["refusal"]["code"] == "EDIT106"
        folder = await request(client, "request_source_folder", "source_folder", path=str(Path(path).parent))
        assert folder["files"] == []


def test_symlink_out_of_workspace_is_not_followed(file: Path, tmp_path: Path) -> None:
    (tmp_path / "secret.txt").write_text("secret")
    link = file.parent / "link.txt"
    link.symlink_to(tmp_path / "secret.txt")
    assert SourceFiles(Workspace(file)).read(link).text is None


async def test_workspace_can_be_edited_without_description(tmp_path: Path) -> None:
    async with open_world() as world, open_page(world.viewer) as client:
        world.viewer.add_feature(SourceEditorFeature).edit_workspace(tmp_path)
        response = await request(client, "open_editor", "editor_opened", file=str(tmp_path))
        assert (response["folder"], response["refusal_reason"]) == (real_path(tmp_path), "")
        new = tmp_path / "src" / "new.py"
        created = await request(client, "create_source_file", "source_file_written", number=1, path=str(new))
        assert (created["refusal"], new.read_text()) == (None, "")
        outside = await request(client, "create_source_file", "source_file_written", number=2, path="/tmp/x.py")
        assert outside["refusal"]["code"] == "EDIT106"


async def test_page_on_another_machine_cannot_edit(file: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(Page, "is_local", False, raising=False)
    monkeypatch.setattr("linkwright.page.server.is_local_connection", lambda _: False)
    async with open_world() as world, open_page(world.viewer) as client:
        response = await open_file(world, client, file)
        assert "only in pages that are open on the machine" in response["refusal_reason"]


async def test_missing_lsp_extra_is_reported(file: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setitem(extras.EXTRAS, "lsp", "no_such_module")
    async with open_world() as world, open_page(world.viewer) as client:
        response = await open_file(world, client, file)
        assert response["refusal_reason"].startswith("the editor needs the language server: run ")


async def test_description_without_file_cannot_be_edited() -> None:
    async with open_world() as world, open_page(world.viewer) as client:
        world.describe(ARM)
        await client.until("description_changed")
        response = await request(client, "open_editor", "editor_opened", file="<robot_description>")
        assert "linkwright view FILE" in response["refusal_reason"]


async def test_language_server_answers_through_page(file: Path) -> None:
    async with open_world() as world, open_page(world.viewer) as client:
        response = await open_file(world, client, file)
        request = {"jsonrpc": "2.0", "id": 1, "method": "initialize"}
        params = {"processId": None, "rootUri": response["uri"], "capabilities": {}}
        await client.send("language_server_input", content=json.dumps({**request, "params": params}))
        reply = json.loads((await client.until("language_server_output"))["content"])
        assert reply["id"] == 1
        assert reply["result"]["capabilities"]["hoverProvider"]


@pytest.mark.parametrize(
    ("before", "text", "after"),
    [
        ("a\nb\n", "a\nc\n", "a\nc\n"),
        ("a\r\nb\r\n", "a\nc\nd\n", "a\r\nc\r\nd\r\n"),
        ("a\r\nb\nc\r\n", "a\nb\nx\n", "a\r\nb\nx\r\n"),
        ("a\nb\r\nc\r\nd\r\n", "a\nd\n", "a\nd\r\n"),
        ("a\rb", "a\nb\nc", "a\rb\rc"),
        ("a\r\n", "", ""),
    ],
)
def test_line_endings_are_preserved(before: str, text: str, after: str) -> None:
    assert with_line_ends(text, before) == after
