"""A router that presents several language servers as one.

The servers are Linkwright's own and the servers for Python files.
"""

from __future__ import annotations

import logging
import threading
import time
from collections.abc import Callable, Sequence
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass, field
from functools import partial
from pathlib import Path
from queue import Empty, SimpleQueue
from typing import Any

from linkwright.diagnostics import phrase
from linkwright.diagnostics.translation import localized
from linkwright.lsp.python.open_texts import OpenText
from linkwright.lsp.python.programs import Program, program_environment
from linkwright.lsp.python.responses import (
    CAPABILITIES,
    CODE_ACTION,
    OWN_SERVER,
    RENAME,
    combine_responses,
    find_server_of_action,
    is_final_response,
    mark_action,
)
from linkwright.lsp.python.servers import INITIALIZE_ID, Message, Peer, PythonServer
from linkwright.lsp.python.workspace_stubs import WorkspaceStubs
from linkwright.lsp.server import path_from_uri

_log = logging.getLogger(__name__)
_RESPONSE_TIMEOUT_S = 5.0
"""The time in which other servers must respond after Linkwright's own server has responded."""
_MAX_STARTS = 3
_METHOD_NOT_FOUND = -32601
_PUBLISH_DIAGNOSTICS = "textDocument/publishDiagnostics"
_TEXT_NOTIFICATIONS = ("textDocument/didChange", "textDocument/didSave", "textDocument/didClose")
_FILES_CHANGED = "workspace/didChangeWatchedFiles"
_FILE_CHANGED = 2
_WARNING = 2
_INTERFACE_FILES = (".msg", ".srv", ".action", ".idl", "package.xml")
_FORWARDED = ("window/showMessage",)
_CLIENT_FEATURES = (
    "completion",
    "hover",
    "definition",
    "references",
    "rename",
    "codeAction",
    "formatting",
    "rangeFormatting",
    "documentSymbol",
    "documentHighlight",
    "publishDiagnostics",
)


@dataclass(slots=True)
class _PendingRequest:
    """A request of the editor that is sent to several servers."""

    method: str
    parameters: Message
    text: OpenText
    responses: dict[str, Message] = field(default_factory=dict)
    awaited: list[str] = field(default_factory=list)
    deadline: float | None = None


class Router:
    """A router that forwards the messages of an editor to the language servers.

    Linkwright's own server receives all of them, except a request to resolve a code action of another server. The other
    servers receive the messages about Python files.

    The other servers start when the editor opens the first Python file. One thread handles all messages in the order
    of their arrival.

    Args:
        editor: the connection to the editor.
        own_server: Linkwright's own server.
        programs: the other servers.
    """

    def __init__(self, editor: Peer, own_server: Peer, programs: Sequence[Program]) -> None:
        self._editor = editor
        self._own_server = own_server
        self._programs = {program.name: program for program in programs}
        self._servers: dict[str, PythonServer] = {}
        self._starts: dict[str, int] = {}
        self._initialize: Message = {}
        self._initialize_id: Any = None
        self._encoding = "utf-16"
        self._environment: dict[str, str] | None = None
        self._stubs: WorkspaceStubs | None = None
        self._search = ThreadPoolExecutor(1, thread_name_prefix="modules")
        self._queued: list[tuple[str, Message]] | None = None
        self._texts: dict[str, OpenText] = {}
        self._requests: dict[Any, _PendingRequest] = {}
        self._resolving: dict[Any, str] = {}
        self._events: SimpleQueue[Callable[[], object] | None] = SimpleQueue()
        self._thread = threading.Thread(target=self._run, daemon=True)
        self._thread.start()

    def from_editor(self, message: Message | None) -> None:
        """Handle a message of the editor. None means that the editor has closed the connection."""
        self._events.put(self._own_server.close if message is None else partial(self._on_editor, message))

    def from_own(self, message: Message | None) -> None:
        """Handle a message of Linkwright's own server. None means that the server has ended."""
        if message is not None:
            self._events.put(partial(self._on_own, message))

    def close(self) -> None:
        """End the other servers."""
        self._events.put(None)
        self._thread.join()
        self._search.shutdown(cancel_futures=True)
        for server in self._servers.values():
            server.close()
        if self._stubs is not None:
            self._stubs.close()

    def _run(self) -> None:
        while True:
            deadlines = [request.deadline for request in self._requests.values() if request.deadline is not None]
            wait = max(0.0, min(deadlines) - time.monotonic()) if deadlines else None
            try:
                event = self._events.get(timeout=wait)
            except Empty:
                self._respond_without_late_servers()
                continue
            if event is None:
                return
            self._attempt(event)

    def _attempt(self, work: Callable[[], object]) -> None:
        try:
            work()
        except Exception:  # noqa: BLE001 - the editor continues to work, and the log has the reason
            _log.exception("A message about a Python file failed")

    # --- from the editor --------------------------------------------------------------------------------------

    def _on_editor(self, message: Message) -> None:
        method, parameters = message.get("method"), message.get("params") or {}
        if method == "codeAction/resolve":
            self._resolve(message)
            return
        text = self._texts.get(_find_uri(parameters))
        if "id" in message and method in CAPABILITIES and text is not None:
            self._send_to_all(message, text)
            return
        if method == "initialize":
            self._initialize, self._initialize_id = parameters, message["id"]
        self._own_server.send(message)
        if method == "exit":
            self._own_server.close()
        elif method == "textDocument/didOpen":
            self._open_text(parameters["textDocument"])
        elif method in _TEXT_NOTIFICATIONS and text is not None:
            self._on_text_changed(message, text)
        elif method == "$/cancelRequest":
            for name in self._requests[parameters["id"]].awaited if parameters["id"] in self._requests else ():
                self._send(name, message)
        elif method == _FILES_CHANGED:
            self._send_all(message)
            if any(change["uri"].endswith(_INTERFACE_FILES) for change in parameters["changes"]):
                self._renew_stubs()
        if method == "textDocument/didSave" and _find_uri(parameters).endswith(_INTERFACE_FILES):
            self._renew_stubs()

    def _open_text(self, item: Message) -> None:
        if item.get("languageId") != "python":
            return
        text = OpenText(item["uri"], item["text"], item["version"], self._encoding)
        self._texts[text.uri] = text
        if self._environment is None and self._queued is None:
            self._prepare()
        for server in self._servers.values():
            server.send(_make_open_notification(text))

    def _on_text_changed(self, message: Message, text: OpenText) -> None:
        self._send_all(message)
        if message["method"] == "textDocument/didChange":
            text.change(message["params"]["textDocument"]["version"], message["params"]["contentChanges"])
        elif message["method"] == "textDocument/didClose":
            del self._texts[text.uri]
            self._editor.send(
                _make_publish_notification({"uri": text.uri, "diagnostics": text.findings_of(OWN_SERVER)})
            )

    def _send_to_all(self, message: Message, text: OpenText) -> None:
        """Send a request to all servers, and record that their responses must be combined."""
        others = self._servers if self._queued is None else self._programs
        request = _PendingRequest(message["method"], message["params"], text, awaited=[OWN_SERVER, *others])
        self._requests[message["id"]] = request
        for name in tuple(request.awaited):
            self._send(name, _for_server(message, name))

    def _resolve(self, message: Message) -> None:
        """Send a code action to the server that offered it."""
        server_and_action = find_server_of_action(message["params"])
        if server_and_action is None or server_and_action[0] not in self._servers:
            self._own_server.send(message)
            return
        name, action = server_and_action
        self._resolving[message["id"]] = name
        self._send(name, {**message, "params": action})

    # --- from the servers -------------------------------------------------------------------------------------

    def _on_own(self, message: Message) -> None:
        if "method" not in message and message.get("id") in self._requests:
            self._on_response(OWN_SERVER, message)
            return
        if "method" not in message and message.get("id") == self._initialize_id and "result" in message:
            self._initialize_id = None
            self._encoding = message["result"]["capabilities"].get("positionEncoding", self._encoding)
            message = _add_python_features(message)
        if message.get("method") == _PUBLISH_DIAGNOSTICS and message["params"]["uri"] in self._texts:
            self._publish(OWN_SERVER, message["params"])
            return
        self._editor.send(message)

    def _on_server(self, server: PythonServer, message: Message | None) -> None:
        if self._servers.get(server.name) is not server:
            return
        if message is None:
            self._on_server_ended(server)
        elif "method" not in message:
            if message.get("id") == INITIALIZE_ID:
                server.complete_initialization(message.get("result", {}).get("capabilities", {}))
            elif self._resolving.pop(message.get("id"), None) is not None:
                self._editor.send(_with_marked_action(server.name, message))
            else:
                self._on_response(server.name, message)
        elif "id" in message:
            error = {"code": _METHOD_NOT_FOUND, "message": "not supported"}
            server.send({"jsonrpc": "2.0", "id": message["id"], "error": error})
        elif message["method"] == _PUBLISH_DIAGNOSTICS:
            self._publish(server.name, message["params"])
        elif message["method"] in _FORWARDED:
            self._editor.send(message)

    def _publish(self, name: str, published: Message) -> None:
        """Publish the findings of all servers about a text, unless the new ones are outdated."""
        text = self._texts.get(published["uri"])
        if text is None or published.get("version") not in (None, text.version):
            return
        text.set_findings(name, published["diagnostics"])
        self._publish_all(text)

    def _publish_all(self, text: OpenText) -> None:
        parameters = {"uri": text.uri, "version": text.version, "diagnostics": text.findings()}
        self._editor.send(_make_publish_notification(parameters))

    def _on_response(self, name: str, message: Message) -> None:
        """Store a response, and respond to the editor once all servers have responded."""
        identifier = message.get("id")
        request = self._requests.get(identifier)
        if request is None or name not in request.awaited:
            return
        request.awaited.remove(name)
        request.responses[name] = message
        if name == OWN_SERVER:
            request.deadline = time.monotonic() + _RESPONSE_TIMEOUT_S
            if "error" not in message and is_final_response(request.method, message.get("result")):
                request.awaited.clear()
            if "error" in message and request.method == RENAME:  # The other servers must not try a refused rename.
                request.awaited.clear()
        if not request.awaited:
            self._respond(identifier, request)

    def _respond(self, identifier: Any, request: _PendingRequest) -> None:
        del self._requests[identifier]
        names = [name for name in (OWN_SERVER, *self._programs) if name in request.responses]
        responses = [
            (name, request.responses[name].get("result")) for name in names if "error" not in request.responses[name]
        ]
        result = combine_responses(request.method, responses, request.text, request.parameters)
        own_response = request.responses.get(OWN_SERVER, {})
        if result is None and "error" in own_response:
            self._editor.send(own_response)
        else:
            self._editor.send({"jsonrpc": "2.0", "id": identifier, "result": result})

    def _respond_without_late_servers(self) -> None:
        """Respond to timed-out requests without the responses of the late servers."""
        now = time.monotonic()
        for identifier, request in list(self._requests.items()):
            if request.deadline is not None and request.deadline <= now:
                self._respond(identifier, request)

    # --- the other servers ------------------------------------------------------------------------------------

    def _prepare(self) -> None:
        """Search the workspace for modules and messages, and then start the servers."""
        self._queued = []
        folders = _list_folders(self._initialize)

        def search() -> None:
            # The attribute is set now, so that close() also removes the stubs during a search.
            self._stubs = stubs = WorkspaceStubs(folders)
            stubs.update()
            self._events.put(partial(self._on_prepared, program_environment(folders, stubs.folder)))

        self._search.submit(self._attempt, search)

    def _on_prepared(self, environment: dict[str, str]) -> None:
        self._environment = environment
        for program in self._programs.values():
            self._start(program)
        queued, self._queued = self._queued or [], None
        for name, message in queued:
            self._send(name, message)

    def _start(self, program: Program) -> None:
        """Start a server and open the texts in it, or notify the user after too many starts."""
        assert self._environment is not None, "it was prepared"
        self._starts[program.name] = starts = self._starts.get(program.name, 0) + 1
        if starts <= _MAX_STARTS:
            parameters = _make_initialize_parameters(self._initialize, self._encoding)
            try:
                server = PythonServer(program, self._environment, parameters, self._on_received)
            except OSError:
                self._starts[program.name] = _MAX_STARTS
            else:
                self._servers[program.name] = server
                for text in self._texts.values():
                    server.send(_make_open_notification(text))
                return
        for identifier in [pending for pending, request in self._requests.items() if program.name in request.awaited]:
            self._on_response(program.name, {"id": identifier, "result": None})
        message = phrase("'{program}' cannot be run, so Python files are edited without it", program=program.name)
        shown = {"type": _WARNING, "message": localized(message)}
        self._editor.send({"jsonrpc": "2.0", "method": "window/showMessage", "params": shown})

    def _on_received(self, server: PythonServer, message: Message | None) -> None:
        self._events.put(partial(self._on_server, server, message))

    def _on_server_ended(self, server: PythonServer) -> None:
        """Respond to the open requests of a server that has ended, and restart the server."""
        del self._servers[server.name]
        server.close()
        for identifier, request in list(self._requests.items()):
            if server.name in request.awaited:
                self._on_response(server.name, {"id": identifier, "result": None})
        for identifier in [pending for pending, name in self._resolving.items() if name == server.name]:
            del self._resolving[identifier]
            self._editor.send({"jsonrpc": "2.0", "id": identifier, "result": None})
        self._start(self._programs[server.name])
        if server.name not in self._servers:
            for text in self._texts.values():
                text.set_findings(server.name, ())
                self._publish_all(text)

    def _renew_stubs(self) -> None:
        """Write the stubs of changed messages, and notify the servers."""
        stubs = self._stubs
        if stubs is None:
            return

        def update() -> None:
            changes = [{"uri": file.as_uri(), "type": _FILE_CHANGED} for file in stubs.update()]
            message = {"jsonrpc": "2.0", "method": _FILES_CHANGED, "params": {"changes": changes}}
            self._events.put(partial(self._send_all, message))

        self._search.submit(self._attempt, update)

    def _send_all(self, message: Message) -> None:
        for server in self._servers.values():
            server.send(message)

    def _send(self, name: str, message: Message) -> None:
        """Send a message to a server. An unsupported request counts as answered."""
        if name == OWN_SERVER:
            self._own_server.send(message)
            return
        if self._queued is not None:
            self._queued.append((name, message))
            return
        server = self._servers.get(name)
        capability = CAPABILITIES.get(message.get("method", ""))
        if server is None or (
            capability and server.capabilities is not None and not server.capabilities.get(capability)
        ):
            self._on_response(name, {"id": message.get("id"), "result": None})
        else:
            server.send(message)


def _find_uri(parameters: Message) -> str:
    document = parameters.get("textDocument") if isinstance(parameters, dict) else None
    return str(document.get("uri", "")) if isinstance(document, dict) else ""


def _make_open_notification(text: OpenText) -> Message:
    document = {"uri": text.uri, "languageId": "python", "version": text.version, "text": text.text}
    return {"jsonrpc": "2.0", "method": "textDocument/didOpen", "params": {"textDocument": document}}


def _make_publish_notification(parameters: Message) -> Message:
    return {"jsonrpc": "2.0", "method": _PUBLISH_DIAGNOSTICS, "params": parameters}


def _for_server(message: Message, name: str) -> Message:
    """Return the form of a request for a server.

    A request for code actions contains only the server's own findings.
    """
    if message["method"] != CODE_ACTION:
        return message
    context = message["params"]["context"]
    findings = [
        diagnostic for diagnostic in context["diagnostics"] if str(diagnostic.get("source", OWN_SERVER)).lower() == name
    ]
    return {**message, "params": {**message["params"], "context": {**context, "diagnostics": findings}}}


def _with_marked_action(name: str, message: Message) -> Message:
    return {**message, "result": mark_action(name, message["result"])} if message.get("result") else message


def _add_python_features(message: Message) -> Message:
    """Return the response to ``initialize`` with the features of the servers for Python files."""
    capabilities = dict(message["result"]["capabilities"])
    completion, actions = capabilities["completionProvider"], capabilities["codeActionProvider"]
    characters, kinds = completion["triggerCharacters"], actions["codeActionKinds"]
    capabilities["completionProvider"] = {**completion, "triggerCharacters": [*characters, "."]}
    capabilities["codeActionProvider"] = {**actions, "codeActionKinds": [*kinds, "source.organizeImports"]}
    return {**message, "result": {**message["result"], "capabilities": capabilities}}


def _make_initialize_parameters(parameters: Message, encoding: str) -> Message:
    """Return the parameters of ``initialize`` for a server.

    They are the editor's parameters, without those that the router does not support.
    """
    capabilities = parameters.get("capabilities", {})
    document, workspace = capabilities.get("textDocument", {}), capabilities.get("workspace", {})
    folders = parameters.get("workspaceFolders") or [
        {"uri": folder.as_uri(), "name": folder.name} for folder in _list_folders(parameters)
    ]
    return {
        "rootUri": parameters.get("rootUri"),
        "workspaceFolders": folders,
        "capabilities": {
            "general": {**capabilities.get("general", {}), "positionEncodings": [encoding]},
            "textDocument": {name: document[name] for name in _CLIENT_FEATURES if name in document},
            "workspace": {name: workspace[name] for name in ("workspaceEdit",) if name in workspace},
        },
    }


def _list_folders(parameters: Message) -> list[Path]:
    """Return the folders that the editor has opened."""
    uris = [folder["uri"] for folder in parameters.get("workspaceFolders") or ()]
    root = parameters.get("rootUri")
    paths = [path_from_uri(uri) for uri in uris or ([root] if root else [])]
    return [path for path in paths if path is not None]
