"""The page feature for terminals, which a program must enable."""

from __future__ import annotations

import asyncio
import os
import sys
from collections.abc import Callable, Mapping
from functools import partial
from itertools import count
from pathlib import Path
from typing import Any

from linkwright.diagnostics import Phrase, foreign, phrase
from linkwright.diagnostics.extras import install_hint
from linkwright.page.audience import Page
from linkwright.page.program_pages import ProgramPages
from linkwright.page.protocol import terminal as messages
from linkwright.page.protocol.message import PageMessage, ServerMessage
from linkwright.panels.page_feature import FeatureHost, PageFeature
from linkwright.panels.terminal.environment import make_terminal_environment
from linkwright.panels.terminal.opening import open_pty
from linkwright.panels.terminal.pty import TerminalProgram, TerminalSize
from linkwright.panels.terminal.terminal import Terminal

MAX_TERMINALS = 16

_GRACE_S = 0.5
"""Seconds for which the programs in a terminal may continue after it was closed."""

_MAX_COLUMNS_OR_ROWS = 1000
"""The largest number of columns or rows."""

_SHELL = (sys.executable, "-m", "linkwright", "shell")
"""The command of `linkwright shell`, which knows the user's shell and its environment."""

_Sized = messages.OpenTerminal | messages.ShowTerminal | messages.ResizeTerminal | messages.RestartTerminal


class _NotShownError(Exception):
    """Raised if a terminal was closed, or another page shows it."""


class TerminalFeature(PageFeature):
    """The feature that runs shells for pages, in terminals that remain when a page is reloaded.

    All requests are refused before `enable`, and requests of pages on other machines or of other users always.
    """

    def __init__(self, viewer: FeatureHost) -> None:
        super().__init__(viewer)
        self._folder: Path | None = None
        self._command: tuple[str, ...] = _SHELL
        self._terminals: dict[int, Terminal] = {}
        self._numbers = count(1)
        self._programs: ProgramPages | None = None
        self._endings: set[asyncio.Task[None]] = set()
        self._handlers: Mapping[type[PageMessage], Callable[[Page, Any], object]] = {
            messages.WatchProgramPages: self._send_program_pages,
            messages.OpenTerminal: self._open,
            messages.ShowTerminal: self._show,
            messages.HideTerminal: self._hide,
            messages.WriteTerminal: self._write,
            messages.ResizeTerminal: lambda page, message: self._find_own_terminal(page, message).resize(
                _size(message)
            ),
            messages.AcknowledgeTerminal: lambda page, message: self._find_own_terminal(page, message).acknowledge(
                message.number
            ),
            messages.RestartTerminal: self._restart,
            messages.CloseTerminal: self._close,
        }

    def enable(self, folder: Path, command: tuple[str, ...] = _SHELL, *, programs: ProgramPages | None = None) -> None:
        """Let this user's pages on this machine run a shell.

        Call it only for a server that no other machine can reach.

        Args:
            folder: the folder in which shells start.
            command: the absolute path of the program to run in terminals, and its arguments.
            programs: the pages of programs in terminals, which pages show; None to show none.
        """
        self._folder, self._command, self._programs = folder, command, programs
        if programs is not None:
            programs.is_shown = lambda: bool(self._find_trusted_pages())
            programs.on_change = self._report_program_pages
        self._report()

    @property
    def programs(self) -> ProgramPages:
        """The pages of programs in terminals. There are none before `enable` is called."""
        return self._programs or ProgramPages()

    def opening_messages(self) -> list[ServerMessage]:
        """Return the list of terminals, if pages may run shells."""
        return [] if self._folder is None else [self._make_state(None)]

    def receive(self, page: Page, message: Any) -> None:
        """Handle a request, or refuse it."""
        refusal = self._find_refusal_reason(page)
        if refusal is not None:
            page.send(messages.Terminals("", [], refusal))
            return
        try:
            self._handlers[type(message)](page, message)
        except _NotShownError:
            page.send(self._make_state(page))
        except OSError as error:
            problem = phrase("the shell cannot be started: {reason}", reason=foreign(error.strerror or str(error)))
            page.send(self._make_state(page, problem))
        except ModuleNotFoundError:
            problem = phrase("the terminal needs a package that is not installed: {hint}", hint=install_hint("learn"))
            page.send(self._make_state(page, problem))

    def remove_page(self, page: Page) -> None:
        """Keep the terminals of a page that was closed."""
        left = [terminal for terminal in self._terminals.values() if terminal.page is page]
        for terminal in left:
            terminal.detach()
        if left:
            self._report()

    def close(self) -> None:
        """End the programs in all terminals."""
        terminals = list(self._terminals.values())
        self._terminals.clear()
        for terminal in terminals:
            terminal.hang_up()
        for terminal in terminals:
            terminal.wait_until_ended(_GRACE_S)

    def _find_refusal_reason(self, page: Page) -> Phrase | None:
        if self._folder is None:
            return phrase("this program was started without a terminal in the page: start it again with `--terminal`")
        if not page.is_local:
            return phrase("the terminal can be used only in pages on the machine of the program")
        if not page.may_be_own_user():
            return phrase("the terminal can be used only in a browser of the user who started the program")
        return None

    def _open(self, page: Page, message: messages.OpenTerminal) -> None:
        if len(self._terminals) >= MAX_TERMINALS:
            problem = phrase("there are already {count} terminals: close one first", count=MAX_TERMINALS)
            page.send(self._make_state(page, problem))
            return
        assert self._folder is not None, "checked by _refusal"
        variables = {} if self._programs is None else self._programs.make_variables(page.origin)
        program = TerminalProgram(self._command, self._folder, make_terminal_environment(os.environ) | variables)
        number, size = next(self._numbers), _size(message)
        terminal = Terminal(number, partial(open_pty, program), size, self._report)
        self._terminals[number] = terminal
        terminal.show(page, size)
        self._report()

    def _show(self, page: Page, message: messages.ShowTerminal) -> None:
        self._find_terminal(message.terminal).show(page, _size(message))
        self._report()

    def _hide(self, page: Page, message: messages.HideTerminal) -> None:
        self._find_own_terminal(page, message).detach()
        self._report()

    def _write(self, page: Page, message: messages.WriteTerminal) -> None:
        encoding = "latin-1" if message.is_binary else "utf-8"
        self._find_own_terminal(page, message).write(message.text.encode(encoding, "replace"))

    def _restart(self, page: Page, message: messages.RestartTerminal) -> None:
        self._find_own_terminal(page, message).restart(_size(message))
        self._report()

    def _close(self, page: Page, message: messages.CloseTerminal) -> None:
        terminal = self._find_terminal(message.terminal)
        del self._terminals[terminal.number]
        terminal.hang_up()
        ending = asyncio.get_running_loop().create_task(asyncio.to_thread(terminal.wait_until_ended, _GRACE_S))
        self._endings.add(ending)
        ending.add_done_callback(self._endings.discard)
        self._report()

    def _find_own_terminal(self, page: Page, message: Any) -> Terminal:
        """Return the terminal that a message names, if the sending page shows this terminal.

        Raises:
            _NotShownError: there is no such terminal, or the page does not show it.
        """
        terminal = self._find_terminal(message.terminal)
        if terminal.page is not page:
            raise _NotShownError
        return terminal

    def _find_terminal(self, number: int) -> Terminal:
        if number not in self._terminals:
            raise _NotShownError
        return self._terminals[number]

    def _make_state(self, page: Page | None, refusal_reason: Phrase | str = "") -> messages.Terminals:
        items = [terminal.make_item(page) for terminal in self._terminals.values()]
        return messages.Terminals(str(self._folder), items, refusal_reason)

    def _find_trusted_pages(self) -> list[Page]:
        """Return the open pages that may use terminals."""
        return [page for page in self.context.pages if self._find_refusal_reason(page) is None]

    def _send_program_pages(self, page: Page, _: object = None) -> None:
        if self._programs is not None:
            page.send(messages.ProgramPages(self._programs.pages))

    def _report_program_pages(self) -> None:
        """Send the pages of programs to all pages that may use terminals."""
        for page in self._find_trusted_pages():
            self._send_program_pages(page)

    def _report(self) -> None:
        """Send all pages the state of the terminals."""
        for page in self.context.pages:
            page.send(self._make_state(page))


def _size(message: _Sized) -> TerminalSize:
    """Return the terminal size in a message, clipped to sensible limits."""
    columns, rows = (min(max(side, 2), _MAX_COLUMNS_OR_ROWS) for side in (message.columns, message.rows))
    return TerminalSize(columns, rows)
