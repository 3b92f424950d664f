"""A language server for one page, in a separate process to avoid delays of the viewer."""

from __future__ import annotations

import asyncio
import subprocess
import sys
import threading
from collections.abc import Callable
from contextlib import suppress
from queue import SimpleQueue
from typing import IO

from linkwright.process.framing import add_header, read_content


class LanguageProcess:
    """The language server of a page.

    Args:
        language: the language of its texts, one of `LANGUAGES`; None for the language of the environment.
        on_message: called on the event loop with each message of the server, as JSON.
        on_end: called on the event loop when the server has ended without `close`.

    Raises:
        OSError: the process cannot be started.
    """

    def __init__(self, language: str | None, on_message: Callable[[str], object], on_end: Callable[[], object]) -> None:
        options = () if language is None else ("--lang", language)
        self._process = subprocess.Popen(  # noqa: S603 - Linkwright's own program
            [sys.executable, "-m", "linkwright", *options, "lsp", "--stdio", "--python"],
            stdin=subprocess.PIPE,
            stdout=subprocess.PIPE,
            stderr=subprocess.DEVNULL,
        )
        assert self._process.stdin is not None, "it is a pipe"
        assert self._process.stdout is not None, "it is a pipe"
        self._loop = asyncio.get_running_loop()
        self._is_closed = False
        self._outgoing: SimpleQueue[str | None] = SimpleQueue()
        work = ((self._write, (self._process.stdin,)), (self._read, (self._process.stdout, on_message, on_end)))
        self._threads = [threading.Thread(target=target, args=arguments, daemon=True) for target, arguments in work]
        for thread in self._threads:
            thread.start()

    def send(self, content: str) -> None:
        """Send a message to the server, as JSON. Messages wait until the server has started."""
        self._outgoing.put(content)

    def close(self) -> None:
        """End the server, which has no unsaved data."""
        self._is_closed = True
        self._process.kill()
        self._outgoing.put(None)
        self._process.wait()
        for thread in self._threads:
            thread.join()

    def _write(self, server_input: IO[bytes]) -> None:
        with suppress(OSError), server_input:  # The reading thread also notices the end of the process.
            while (message := self._outgoing.get()) is not None:
                server_input.write(add_header(message.encode()))
                server_input.flush()

    def _read(
        self, server_output: IO[bytes], on_message: Callable[[str], object], on_end: Callable[[], object]
    ) -> None:
        with server_output:
            while (content := read_content(server_output)) is not None:
                self._call(on_message, content.decode(errors="replace"))
        self._call(on_end)

    def _call(self, callback: Callable[..., object], *arguments: object) -> None:
        """Call a function on the event loop, unless the server was closed."""
        with suppress(RuntimeError):  # The event loop has ended.
            self._loop.call_soon_threadsafe(lambda: self._is_closed or callback(*arguments))
