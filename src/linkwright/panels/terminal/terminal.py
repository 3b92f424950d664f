"""A terminal of the page: its shell, its recent output, and the page that shows it."""

from __future__ import annotations

import asyncio
import codecs
from collections.abc import Callable

from linkwright.page.audience import Page
from linkwright.page.protocol.terminal import TerminalInputLost, TerminalItem, TerminalOutput
from linkwright.panels.terminal.history import TerminalHistory
from linkwright.panels.terminal.pty import ExitCallback, OutputCallback, Pty, TerminalSize

MAX_UNACKNOWLEDGED = 16
"""The maximum number of unacknowledged messages with output. No more output is read until pages acknowledge some."""

_PAUSE_S = 0.005
"""Seconds between two blocks of output.

It joins the output of programs that write a few bytes at a time, and leaves time for the rest of the event loop.
"""

_MAX_UNWRITTEN_SIZE = 1024 * 1024
"""The maximum size in bytes of input that the program has not read yet."""

StartShell = Callable[[TerminalSize, OutputCallback, ExitCallback], Pty]


class Terminal:
    """A terminal with a shell, which pages show one after the other.

    Without a page, output is read and stored, so that programs continue. With a page, output is read only as fast as
    the page processes it.

    Args:
        number: the number of the terminal, which pages use to identify it.
        start_shell: starts the shell in a pseudoterminal of a size, see `linkwright.panels.terminal.opening.open_pty`.
        size: the initial size.
        on_change: called when the shell has ended.

    Attributes:
        page: the page that shows the terminal; None if there is none.
        status: the exit status of the shell; None while it runs.

    Raises:
        OSError: the shell cannot be started.
        ModuleNotFoundError: a package of the extra `learn` is missing.
    """

    def __init__(
        self, number: int, start_shell: StartShell, size: TerminalSize, on_change: Callable[[], object]
    ) -> None:
        self.number = number
        self.page: Page | None = None
        self.status: int | None = None
        self._start_shell = start_shell
        self._size = size
        self._on_change = on_change
        self._history = TerminalHistory()
        self._sent = 0
        self._acknowledged = 0
        self._pause: asyncio.TimerHandle | None = None
        self._pty = self._start()

    def _start(self) -> Pty:
        self._decoder = codecs.getincrementaldecoder("utf-8")("replace")
        pty = self._start_shell(self._size, self._receive, self._on_ended)
        pty.request_output()
        return pty

    def make_item(self, page: Page | None) -> TerminalItem:
        """Return the description of the terminal for a page. Pass None for a page that opens."""
        if self.page is None:
            return TerminalItem(self.number, "nowhere", self.status)
        return TerminalItem(self.number, "here" if self.page is page else "elsewhere", self.status)

    def show(self, page: Page, size: TerminalSize) -> None:
        """Show the terminal in a page, beginning with its recent output."""
        self.page = page
        self.resize(size)
        self._acknowledged = self._sent
        self._send(self._history.text(), is_replay=True)
        self._continue()

    def detach(self) -> None:
        """Detach the terminal from its page."""
        self.page = None
        self._continue()

    def acknowledge(self, number: int) -> None:
        """Record that the page has processed the output up to a message."""
        self._acknowledged = max(self._acknowledged, min(number, self._sent))
        self._continue()

    def write(self, data: bytes) -> None:
        """Write input for the program, or discard it if the program does not read its input."""
        if self.status is not None:
            return
        if self._pty.unwritten_size + len(data) <= _MAX_UNWRITTEN_SIZE:
            self._pty.write(data)
        elif self.page is not None:
            self.page.send(TerminalInputLost(self.number, len(data)))

    def resize(self, size: TerminalSize) -> None:
        """Set the size of the terminal."""
        if size != self._size:
            self._size = size
            self._pty.resize(size)

    def restart(self, size: TerminalSize) -> None:
        """Start a shell again after the previous one has ended.

        Raises:
            OSError: the shell cannot be started.
        """
        if self.status is not None:
            self._size = size
            self._pty = self._start()
            self.status = None

    def hang_up(self) -> None:
        """Close the terminal; its programs receive SIGHUP."""
        if self._pause is not None:
            self._pause.cancel()
        self._pty.hang_up()

    def wait_until_ended(self, grace: float) -> None:
        """Wait after `hang_up` until all programs have ended, and kill them after `grace` seconds."""
        self._pty.wait_until_ended(grace)

    def _receive(self, block: bytes) -> None:
        self._add(self._decoder.decode(block))
        self._pause = asyncio.get_running_loop().call_later(_PAUSE_S, self._end_pause)

    def _end_pause(self) -> None:
        self._pause = None
        self._continue()

    def _continue(self) -> None:
        """Request more output, unless the page has not processed the previous output.

        If the previous request is too recent, the next one is scheduled.
        """
        is_page_late = self.page is not None and self._sent - self._acknowledged >= MAX_UNACKNOWLEDGED
        if self._pause is None and not is_page_late and self.status is None:
            self._pty.request_output()

    def _add(self, text: str) -> None:
        if text:
            self._history.add(text)
            if self.page is not None:
                self._send(text, is_replay=False)

    def _send(self, text: str, *, is_replay: bool) -> None:
        if self.page is not None:
            self._sent += 1
            self.page.send(TerminalOutput(self.number, self._sent, text, is_replay))

    def _on_ended(self, status: int) -> None:
        self._add(self._decoder.decode(b"", final=True))
        self.status = status
        self._on_change()
