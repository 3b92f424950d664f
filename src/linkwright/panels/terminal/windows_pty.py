"""A program in a pseudoconsole of Windows, which pywinpty provides."""

from __future__ import annotations

import asyncio
import codecs
import subprocess
import threading
import time
from contextlib import suppress
from queue import SimpleQueue
from typing import Any

from linkwright.panels.terminal.pty import ExitCallback, OutputCallback, TerminalProgram, TerminalSize

_POLL_S = 0.1
_DRAIN_S = 0.3
"""Seconds for which output is still read after the end of the program."""


class WindowsPty:
    """A program in a pseudoconsole; see `linkwright.panels.terminal.pty.Pty`.

    Calls of pywinpty may block, so separate threads read output, write input, and wait for the end of the program.
    Closing a pseudoconsole ends the console programs in it.

    Raises:
        ModuleNotFoundError: pywinpty, of the extra `learn`, is not installed.
    """

    def __init__(
        self, program: TerminalProgram, size: TerminalSize, receive: OutputCallback, ended: ExitCallback
    ) -> None:
        from winpty import PTY  # type: ignore[import-not-found,unused-ignore]  # only for Windows

        self._receive = receive
        self._ended = ended
        self._loop = asyncio.get_running_loop()
        self._requests = threading.Semaphore(0)
        self._input: SimpleQueue[str | None] = SimpleQueue()
        self._decode = codecs.getincrementaldecoder("utf-8")("replace").decode
        self._is_open = True
        self._has_ended = threading.Event()
        self.unwritten_size = 0
        path, *arguments = program.command
        variables = "".join(f"{name}={value}\0" for name, value in program.environment.items())
        self._pty: Any = PTY(size.columns, size.rows)
        command_line = " " + subprocess.list2cmdline(arguments)
        self._pty.spawn(path, cmdline=command_line, cwd=str(program.folder), env=variables)
        for target in (self._read, self._write, self._wait):
            threading.Thread(target=target, name="linkwright-terminal", daemon=True).start()

    def request_output(self) -> None:
        """Request the next block of output."""
        self._requests.release()

    def write(self, data: bytes) -> None:
        """Write input for the program, which may take it later."""
        self.unwritten_size += len(data)
        self._input.put(self._decode(data))

    def resize(self, size: TerminalSize) -> None:
        """Set the size of the terminal."""
        if self._is_open:
            self._pty.set_size(size.columns, size.rows)

    def hang_up(self) -> None:
        """Close the pseudoconsole."""
        if self._is_open:
            self._is_open = False
            self._input.put(None)
            self._requests.release()
            with suppress(Exception):  # If the program has ended, pywinpty raises various errors.
                self._pty.cancel_io()

    def wait_until_ended(self, grace: float) -> None:
        """End the process and its children if they do not end by themselves within `grace` seconds."""
        process = self._pty.pid
        if not self._has_ended.wait(grace) and process is not None:
            subprocess.run(  # noqa: S603 - the ID of our own process
                ["taskkill", "/T", "/F", "/PID", str(process)],  # noqa: S607 - a program of the system
                stdout=subprocess.DEVNULL,
                stderr=subprocess.DEVNULL,
                check=False,
            )

    def _read(self) -> None:
        while True:
            self._requests.acquire()
            if not self._is_open:
                return
            try:
                text = ""
                while not text:
                    text = self._pty.read(blocking=True)
            except Exception:  # noqa: BLE001 - the output has ended, for which pywinpty has several errors
                return
            self._call(self._receive, text.encode(errors="replace"))

    def _write(self) -> None:
        while (text := self._input.get()) is not None:
            with suppress(Exception):  # The program has ended.
                self._pty.write(text)
            self._call(self._write_pending, len(text.encode()))

    def _write_pending(self, size: int) -> None:
        self.unwritten_size = max(0, self.unwritten_size - size)

    def _wait(self) -> None:
        while self._is_open and self._pty.isalive():
            time.sleep(_POLL_S)
        self._has_ended.set()
        status = self._pty.get_exitstatus()
        time.sleep(_DRAIN_S)
        self._call(self._finish, 0 if status is None else status)

    def _finish(self, status: int) -> None:
        self.hang_up()
        self._ended(status)

    def _call(self, callback: Any, *arguments: object) -> None:
        """Call a function on the event loop, unless the terminal was closed."""
        with suppress(RuntimeError):  # The event loop has ended.
            self._loop.call_soon_threadsafe(lambda: self._is_open and callback(*arguments))
