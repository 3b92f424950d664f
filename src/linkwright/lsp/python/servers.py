"""The router's connections: message streams and processes of language servers."""

from __future__ import annotations

import json
import os
import subprocess
import threading
from collections.abc import Callable, Mapping
from contextlib import suppress
from queue import SimpleQueue
from typing import IO, Any, Protocol

from linkwright.lsp.python.programs import Program
from linkwright.process.framing import add_header, read_content

Message = dict[str, Any]
"""A message of the protocol: a request, a response or a notification."""

INITIALIZE_ID = "linkwright-initialize"
_EXIT_TIMEOUT_S = 2.0


class Peer(Protocol):
    """A program that receives messages of the protocol.

    Attributes:
        name: its name.
    """

    name: str

    def send(self, message: Message) -> None:
        """Send a message without waiting for the program."""
        ...

    def close(self) -> None:
        """Close the connection after all messages were sent."""
        ...


class Stream:
    """A message stream to the editor or to Linkwright's own server.

    A separate thread writes, so that a peer that reads slowly does not delay the others.

    Args:
        name: the name of the peer.
        output: the stream that the peer reads.
    """

    def __init__(self, name: str, output: IO[bytes]) -> None:
        self.name = name
        self._waiting: SimpleQueue[Message | None] = SimpleQueue()
        self._thread = threading.Thread(target=self._write, args=(output,), daemon=True)
        self._thread.start()

    def send(self, message: Message) -> None:
        """Send a message."""
        self._waiting.put(message)

    def close(self) -> None:
        """Close the stream after all messages were written."""
        self._waiting.put(None)
        self._thread.join(_EXIT_TIMEOUT_S)

    def _write(self, output: IO[bytes]) -> None:
        with suppress(OSError, ValueError), output:  # The peer has ended.
            while (message := self._waiting.get()) is not None:
                output.write(add_header(json.dumps(message, ensure_ascii=False, separators=(",", ":")).encode()))
                output.flush()


def read_messages(stream: IO[bytes], receive: Callable[[Message | None], object]) -> threading.Thread:
    """Read messages in a thread, and pass each to a function, followed by None at the end."""

    def read() -> None:
        with suppress(OSError, ValueError), stream:
            while (content := read_content(stream)) is not None:
                message = json.loads(content)
                if isinstance(message, dict):
                    receive(message)
        receive(None)

    thread = threading.Thread(target=read, daemon=True)
    thread.start()
    return thread


class PythonServer:
    """A language server for Python files in a separate process.

    Messages wait until the server has been initialized.

    Args:
        program: its program.
        environment: the environment variables of its process.
        initialize: the parameters of its request ``initialize``.
        receive: called in a thread with each message, and with None when the process has ended.

    Attributes:
        name: the name of the program.
        capabilities: the capabilities that it has announced; None before it was initialized.

    Raises:
        OSError: the process cannot be started.
    """

    def __init__(
        self,
        program: Program,
        environment: Mapping[str, str],
        initialize: Message,
        receive: Callable[[PythonServer, Message | None], object],
    ) -> None:
        self.name = program.name
        self.capabilities: Message | None = None
        self._process = subprocess.Popen(  # noqa: S603 - a program that the user has installed
            program.command,
            env=dict(environment),
            stdin=subprocess.PIPE,
            stdout=subprocess.PIPE,
            stderr=subprocess.DEVNULL,
        )
        assert self._process.stdin is not None, "it is a pipe"
        assert self._process.stdout is not None, "it is a pipe"
        self._stream = Stream(program.name, self._process.stdin)
        self._waiting: list[Message] = []
        read_messages(self._process.stdout, lambda message: receive(self, message))
        parameters = {**initialize, "processId": os.getpid()}
        self._stream.send({"jsonrpc": "2.0", "id": INITIALIZE_ID, "method": "initialize", "params": parameters})

    @property
    def pid(self) -> int:
        """The process ID."""
        return self._process.pid

    def send(self, message: Message) -> None:
        """Send a message once the server has been initialized."""
        if self.capabilities is None:
            self._waiting.append(message)
        else:
            self._stream.send(message)

    def complete_initialization(self, capabilities: Message) -> None:
        """Complete the initialization, and send the queued messages."""
        self.capabilities = capabilities
        self._stream.send({"jsonrpc": "2.0", "method": "initialized", "params": {}})
        waiting, self._waiting = self._waiting, []
        for message in waiting:
            self.send(message)

    def close(self) -> None:
        """Close the input of the process, so that the process ends, or end it after a timeout."""
        self._stream.close()
        try:
            self._process.wait(_EXIT_TIMEOUT_S)
        except subprocess.TimeoutExpired:
            self._process.kill()
            self._process.wait()
