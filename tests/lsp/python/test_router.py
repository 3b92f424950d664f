"""Messages between an editor and several servers, also when a server fails."""

from __future__ import annotations

import sys
import tempfile
import threading
import time
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

import pytest

from linkwright.lsp.python import router as router_module
from linkwright.lsp.python.programs import Program
from linkwright.lsp.python.router import Router
from linkwright.lsp.python.servers import Message
from linkwright.lsp.python.workspace_stubs import WorkspaceStubs
from tests.waiting import TIMEOUT_S, wait_until

SERVER = """
import json, sys
from linkwright.process.framing import add_header, read_content

def send(message):
    sys.stdout.buffer.write(add_header(json.dumps(message).encode()))
    sys.stdout.buffer.flush()

while content := read_content(sys.stdin.buffer):
    message = json.loads(content)
    method, params = message.get("method"), message.get("params")
    if method == "initialize":
        send({"id": message["id"], "result": {"capabilities": {"hoverProvider": True}}})
        send({"id": 7, "method": "workspace/configuration", "params": {}})
    elif method == "textDocument/didOpen":
        uri, version = params["textDocument"]["uri"], params["textDocument"]["version"]
        for number in (version - 1, version):
            finding = {"message": str(number), "range": {"start": POINT, "end": POINT}}
            send({"method": "textDocument/publishDiagnostics",
                  "params": {"uri": uri, "version": number, "diagnostics": [finding]}})
    elif method == "textDocument/hover":
        if "hang" in params: continue
        if params.get("die") == NAME: sys.exit()
        send({"id": message["id"], "result": {"contents": NAME}})
    elif "result" not in message and "error" in message:
        send({"method": "window/showMessage", "params": {"type": 1, "message": message["error"]["message"]}})
"""
URI = "file:///ws/a.py"


class Peer:
    """A peer that stores its messages."""

    def __init__(self, name: str) -> None:
        self.name = name
        self.messages: list[Message] = []
        self.is_closed = False

    def send(self, message: Message) -> None:
        self.messages.append(message)

    def close(self) -> None:
        self.is_closed = True

    def until(self, condition: Callable[[Message], object]) -> Message:
        """Wait for a message."""
        wait_until(lambda: any(map(condition, list(self.messages))), what=lambda: self.messages)
        return next(message for message in self.messages if condition(message))

    def answer(self, identifier: int) -> Message:
        """Wait for the answer to a request."""
        return self.until(lambda message: message.get("id") == identifier and "method" not in message)


class Connection:
    """An editor and Linkwright's own server, whose messages go through a router."""

    def __init__(self, programs: list[Program], folder: Path) -> None:
        self.editor, self.own = Peer("editor"), Peer("own")
        self.router = Router(self.editor, self.own, programs)
        self.request(1, "initialize", {"rootUri": folder.as_uri(), "capabilities": {}})
        capabilities = {
            "completionProvider": {"triggerCharacters": ["<"]},
            "codeActionProvider": {"codeActionKinds": ["quickfix"]},
        }
        self.router.from_own({"id": 1, "result": {"capabilities": capabilities}})

    def request(self, identifier: int | None, method: str, parameters: Message) -> None:
        """Send a request, or a notification without an identifier, as the editor."""
        message = {"method": method, "params": parameters}
        self.router.from_editor(message if identifier is None else {**message, "id": identifier})

    def open(self, uri: str = URI, language: str = "python") -> None:
        """Open a file."""
        document = {"uri": uri, "languageId": language, "version": 3, "text": "a = 1\n"}
        self.request(None, "textDocument/didOpen", {"textDocument": document})

    def hover(self, identifier: int, has_own_result: Any = None, **options: Any) -> None:
        """Request a hover, which Linkwright's own server answers."""
        place = {"textDocument": {"uri": URI}, "position": {"line": 0, "character": 0}}
        self.request(identifier, "textDocument/hover", {**place, **options})
        self.own.until(lambda message: message.get("id") == identifier)
        self.router.from_own({"id": identifier, "result": has_own_result})

    def findings(self, count: int) -> list[str]:
        """Wait until so many findings were published, and return their messages."""

        def is_published(message: Message) -> bool:
            is_findings = message.get("method") == "textDocument/publishDiagnostics"
            return is_findings and len(message["params"]["diagnostics"]) == count

        return [finding["message"] for finding in self.editor.until(is_published)["params"]["diagnostics"]]


def is_shown_message(message: Message) -> bool:
    text = "'ty' cannot be run, so Python files are edited without it"
    return message.get("method") == "window/showMessage" and message["params"]["message"] == text


def server_program(name: str, text: str = SERVER) -> Program:
    names = f"NAME = {name!r}\nPOINT = {{'line': 0, 'character': 0}}\n"
    return Program(name, (sys.executable, "-c", names + text))


@pytest.fixture
def connect(tmp_path: Path) -> Iterator[Callable[..., Connection]]:
    connections: list[Connection] = []

    def connected(*programs: Program) -> Connection:
        connections.append(Connection(list(programs), tmp_path))
        return connections[-1]

    yield connected
    for connection in connections:
        connection.router.close()


def test_servers_start_with_first_python_file(connect: Callable[..., Connection]) -> None:
    connection = connect(server_program("ty"), server_program("ruff"))
    capabilities = connection.editor.answer(1)["result"]["capabilities"]
    assert capabilities["completionProvider"]["triggerCharacters"] == ["<", "."]
    connection.open("file:///ws/a.xacro", "xml")
    connection.own.until(lambda message: message["method"] == "textDocument/didOpen")
    assert connection.router._servers == {}
    connection.open()
    assert connection.findings(2) == ["3", "3"]
    published = {"uri": URI, "version": 3, "diagnostics": [{"message": "own"}]}
    connection.router.from_own({"method": "textDocument/publishDiagnostics", "params": published})
    assert sorted(connection.findings(3)) == ["3", "3", "own"]


def test_early_request_waits_for_servers(connect: Callable[..., Connection]) -> None:
    connection = connect(server_program("ty"))
    connection.open()
    connection.hover(5)
    assert connection.editor.answer(5)["result"] == {"contents": "ty"}


def test_linkwright_answer_is_returned_immediately(connect: Callable[..., Connection]) -> None:
    connection = connect(server_program("ty"))
    connection.open()
    connection.hover(5, has_own_result={"contents": "own"}, hang=True)
    assert connection.editor.answer(5)["result"] == {"contents": "own"}


def test_unresponsive_server_is_skipped(connect: Callable[..., Connection], monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(router_module, "_RESPONSE_TIMEOUT_S", 0.1)
    connection = connect(server_program("ty"))
    connection.open()
    connection.hover(5, hang=True)
    assert connection.editor.answer(5)["result"] is None


def test_crashed_server_is_restarted_until_reported_once(connect: Callable[..., Connection]) -> None:
    connection = connect(server_program("ty"), server_program("ruff"))
    connection.open()
    assert connection.findings(2) == ["3", "3"]
    for identifier in (5, 6, 7):
        connection.hover(identifier, die="ty")
        connection.editor.answer(identifier)
    connection.editor.until(is_shown_message)
    assert connection.findings(1) == ["3"]
    connection.hover(8)
    assert connection.editor.answer(8)["result"] == {"contents": "ruff"}
    assert sum(map(is_shown_message, connection.editor.messages)) == 1


def test_program_that_cannot_start_is_reported_and_others_work(connect: Callable[..., Connection]) -> None:
    connection = connect(Program("ty", ("/no/such/program",)), server_program("ruff"))
    connection.open()
    connection.hover(5)
    assert connection.editor.answer(5)["result"] == {"contents": "ruff"}
    connection.editor.until(is_shown_message)


def test_server_requests_are_declined_and_messages_shown(connect: Callable[..., Connection]) -> None:
    connection = connect(server_program("ty"))
    connection.open()
    shown = connection.editor.until(lambda message: message.get("method") == "window/showMessage")
    assert shown["params"]["message"] == "not supported"


def test_closed_file_keeps_linkwright_findings(connect: Callable[..., Connection]) -> None:
    connection = connect(server_program("ty"))
    connection.open()
    connection.findings(1)
    connection.request(None, "textDocument/didClose", {"textDocument": {"uri": URI}})
    assert connection.findings(0) == []
    connection.hover(5, has_own_result={"contents": "own"})
    assert connection.editor.answer(5)["result"] == {"contents": "own"}


def test_exit_ends_linkwright(connect: Callable[..., Connection]) -> None:
    connection = connect()
    connection.request(None, "exit", {})
    wait_until(lambda: connection.own.is_closed)


def test_close_during_the_search_removes_the_stubs(
    connect: Callable[..., Connection], monkeypatch: pytest.MonkeyPatch, tmp_path: Path
) -> None:
    started = threading.Event()

    def update_slowly(_: WorkspaceStubs) -> None:
        started.set()
        time.sleep(0.3)  # until the router's thread has ended

    monkeypatch.setattr(tempfile, "tempdir", str(tmp_path))
    monkeypatch.setattr(WorkspaceStubs, "update", update_slowly)
    connection = connect(server_program("ty"))
    connection.open()
    assert started.wait(TIMEOUT_S)
    assert list(tmp_path.glob("linkwright_stubs_*"))
    connection.router.close()
    assert not list(tmp_path.glob("linkwright_stubs_*"))
