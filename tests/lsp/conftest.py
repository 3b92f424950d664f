"""The client of an editor, and a package to edit."""

from __future__ import annotations

import asyncio
import os
import socket
import sys
from collections.abc import AsyncIterator, Iterator, Sequence
from contextlib import asynccontextmanager
from functools import cache
from pathlib import Path

import pytest
import pytest_asyncio
from lsprotocol import types
from pygls.lsp.client import LanguageClient

from linkwright.process import forked
from tests.measuring import coverage_options
from tests.waiting import TIMEOUT_S

MAIN = """<robot name="arm" xmlns:xacro="http://www.ros.org/wiki/xacro">
  <xacro:include filename="parts.xacro"/>
  <link name="base"/>
  <xacro:bar name="upper" length="0.4"/>
</robot>
"""
PARTS = """<robot xmlns:xacro="http://www.ros.org/wiki/xacro">
  <xacro:macro name="bar" params="name length">
    <link name="${name}"/>
    <joint name="${name}_joint" type="continuous">
      <parent link="base"/>
      <child link="${name}"/>
      <axis xyz="0 0 1"/>
    </joint>
  </xacro:macro>
</robot>
"""
MANIFEST = """<?xml version="1.0"?>
<package format="3">
  <name>arm_description</name>
  <version>0.1.0</version>
  <description>An arm.</description>
  <maintainer email="a@example.org">A</maintainer>
  <license>Apache-2.0</license>
  <buildtool_depend>ament_cmake</buildtool_depend>
  <export><build_type>ament_cmake</build_type></export>
</package>
"""


class Editor:
    """An editor with open files.

    Args:
        client: its connection.
        folder: the folder that it has opened.

    Attributes:
        server_id: the ID of the process of the language server.
    """

    server_id: int

    def __init__(self, client: LanguageClient, folder: Path) -> None:
        self.client = client
        self.diagnostics: dict[str, Sequence[types.Diagnostic]] = {}
        self.messages: list[str] = []
        self.folder = folder
        self._versions: dict[str, int] = {}

        @client.feature(types.TEXT_DOCUMENT_PUBLISH_DIAGNOSTICS)
        def _(published: types.PublishDiagnosticsParams) -> None:
            self.diagnostics[published.uri] = published.diagnostics

        @client.feature(types.WINDOW_SHOW_MESSAGE)
        def _(shown: types.ShowMessageParams) -> None:
            self.messages.append(shown.message)

    def uri(self, name: str) -> str:
        """Return the URI of a file."""
        return (self.folder / name).as_uri()

    def document(self, name: str) -> types.TextDocumentIdentifier:
        """Return how requests name a file."""
        return types.TextDocumentIdentifier(self.uri(name))

    def open(self, name: str, text: str | None = None, language: str = "xml") -> None:
        """Open a file with its text from the disk or another text."""
        uri = self.uri(name)
        self._versions[uri] = 1
        content = (self.folder / name).read_text(encoding="utf-8") if text is None else text
        self.client.text_document_did_open(
            types.DidOpenTextDocumentParams(types.TextDocumentItem(uri, language, 1, content))
        )

    def change(self, name: str, text: str) -> None:
        """Replace the text of an open file."""
        uri = self.uri(name)
        self._versions[uri] += 1
        self.client.text_document_did_change(
            types.DidChangeTextDocumentParams(
                types.VersionedTextDocumentIdentifier(version=self._versions[uri], uri=uri),
                [types.TextDocumentContentChangeWholeDocument(text)],
            )
        )

    def codes(self, name: str) -> list[str]:
        """Return the codes of the current findings about a file."""
        return [str(diagnostic.code) for diagnostic in self.diagnostics.get(self.uri(name), ())]

    async def until(self, name: str, *codes: str) -> list[types.Diagnostic]:
        """Wait until a file has exactly these findings, and return them."""
        for _ in range(int(TIMEOUT_S / 0.02)):
            if self.uri(name) in self.diagnostics and sorted(self.codes(name)) == sorted(codes):
                return list(self.diagnostics[self.uri(name)])
            await asyncio.sleep(0.02)
        raise AssertionError(f"{name} has {self.codes(name)}")


@pytest.fixture
def package(tmp_path: Path) -> Path:
    folder = tmp_path / "arm_description"
    folder.mkdir()
    (folder / "package.xml").write_text(MANIFEST)
    (folder / "CMakeLists.txt").write_text(
        "cmake_minimum_required(VERSION 3.8)\nproject(arm_description)\nfind_package(ament_cmake REQUIRED)\n"
        "install(DIRECTORY urdf DESTINATION share/${PROJECT_NAME})\nament_package()\n"
    )
    (folder / "linkwright.toml").write_text('select = ["LW802"]\n')
    (folder / "urdf").mkdir()
    (folder / "urdf" / "arm.urdf.xacro").write_text(MAIN)
    (folder / "urdf" / "parts.xacro").write_text(PARTS)
    return folder


_IMPORTED = (
    "linkwright.cli.command",
    "linkwright.cli.lsp",
    "linkwright.descriptions.*",
    "linkwright.language.*",
    "linkwright.launch.frontend.*",
    "linkwright.lint.*",
    "linkwright.lsp.*",
    "linkwright.messages.*",
    "linkwright.packages.*",
    "linkwright.sdf.*",
    "linkwright.urdf.*",
    "linkwright.xacro.*",
)


@cache
def _fork_server() -> forked.ForkServer:
    """Return the process from which language servers are forked; see docs/decisions/0081."""
    return forked.ForkServer(_IMPORTED, [sys.executable, *coverage_options()])


@pytest.fixture(autouse=True, scope="session")
def _end_of_fork_server() -> Iterator[None]:
    yield
    _fork_server().close()


async def _start_forked(client: LanguageClient) -> forked.Program:
    """Fork a language server, and connect a client with its standard input and output."""
    with socket.create_server(("127.0.0.1", 0)) as listener:
        await client.start_tcp(*listener.getsockname())
        connection, _ = listener.accept()
    with connection:
        streams = (connection.fileno(), connection.fileno(), sys.__stderr__.fileno())
        return _fork_server().start("linkwright", ["lsp"], cwd=Path.cwd(), env=os.environ, streams=streams)


@asynccontextmanager
async def connect_editor(
    package: Path,
    capabilities: types.ClientCapabilities,
    registrations: asyncio.Queue[types.Registration] | None = None,
    *options: str,
) -> AsyncIterator[Editor]:
    """Start the language server for an editor with some capabilities that has opened a package.

    Capabilities that the server registers go into the queue. The options are options of the command; with options, the
    server starts as in an editor, without options it is forked where the system supports that.
    """
    client = LanguageClient("test", "1")
    editor = Editor(client, package)

    @client.feature(types.CLIENT_REGISTER_CAPABILITY)
    def _(parameters: types.RegistrationParams) -> None:
        for registration in parameters.registrations:
            if registrations is not None:
                registrations.put_nowait(registration)

    program = None
    if options or not forked.IS_POSSIBLE:
        await client.start_io(sys.executable, *coverage_options(), "-m", "linkwright", "lsp", *options)
        assert client._server is not None
        editor.server_id = client._server.pid
    else:
        program = await _start_forked(client)
        editor.server_id = program.pid
    await client.initialize_async(
        types.InitializeParams(capabilities, workspace_folders=[types.WorkspaceFolder(package.as_uri(), package.name)])
    )
    client.initialized(types.InitializedParams())
    yield editor
    await client.shutdown_async(None)
    client.exit(None)
    await client.stop()
    if program is not None:
        writer = client.protocol.writer
        assert isinstance(writer, asyncio.StreamWriter)
        writer.close()
        await writer.wait_closed()
        assert program.wait(TIMEOUT_S) == 0


@pytest_asyncio.fixture
async def editor(package: Path) -> AsyncIterator[Editor]:
    async with connect_editor(package, types.ClientCapabilities()) as editor:
        yield editor


OPENS_PAGES = types.ClientCapabilities(
    workspace=types.WorkspaceClientCapabilities(text_document_content=types.TextDocumentContentClientCapabilities()),
    text_document=types.TextDocumentClientCapabilities(
        publish_diagnostics=types.PublishDiagnosticsClientCapabilities(code_description_support=True)
    ),
)
"""An editor that opens virtual documents."""


@pytest_asyncio.fixture
async def editor_with_pages(package: Path) -> AsyncIterator[Editor]:
    async with connect_editor(package, OPENS_PAGES) as editor:
        yield editor


@pytest_asyncio.fixture
async def editor_with_commands(package: Path) -> AsyncIterator[Editor]:
    commands = ["linkwright.showReferences", "linkwright.openInPage"]
    async with connect_editor(package, types.ClientCapabilities(experimental={"commands": commands})) as editor:
        yield editor
