"""The terminals of the page.

The server owns the terminals, which remain when a page is reloaded. Each is shown in at most one page. A page
acknowledges the output that it has processed, and the server reads no more output until it does.
"""

from __future__ import annotations

from typing import ClassVar, Literal

from linkwright.page.protocol.message import PageMessage, Record, ServerMessage


class TerminalItem(Record):
    """A terminal.

    `shown` is the page that shows it: this one (``here``), another one (``elsewhere``), or none (``nowhere``).
    `status` is the exit status of its shell, which is negative if a signal ended the shell, or None while it runs.
    """

    id: int
    shown: Literal["here", "elsewhere", "nowhere"]
    status: int | None


class Terminals(ServerMessage):
    """All terminals of the program, sent when a page opens and after each change.

    `folder` is the folder in which shells start. `refusal_reason` is the reason why the last request of the page was
    refused, or empty.
    """

    folder: str
    terminals: list[TerminalItem]
    refusal_reason: str


class TerminalOutput(ServerMessage):
    """Output of a terminal that the page shows.

    `number` counts the messages of the terminal. No message replaces another. With `is_replay`, the text replaces the
    content of the terminal: it is the last output, which answers no queries to the terminal.
    """

    NEWEST_OF: ClassVar[tuple[str, ...]] = ("terminal", "number")

    terminal: int
    number: int
    text: str
    is_replay: bool


class TerminalInputLost(ServerMessage):
    """A notice that input was discarded because the program in the terminal does not read it."""

    NEWEST_OF: ClassVar[tuple[str, ...]] = ("terminal",)

    terminal: int
    size: int


class ProgramPage(Record):
    """The page of a program in a terminal. `url` contains its token."""

    id: int
    title: str
    url: str


class ProgramPages(ServerMessage):
    """The pages of the programs in terminals, oldest first.

    It is sent to pages that may use terminals, after `WatchProgramPages` and whenever it changes.
    """

    pages: list[ProgramPage]


class WatchProgramPages(PageMessage):
    """A request to receive the pages of programs in terminals."""


class OpenTerminal(PageMessage):
    """A request to start a shell in a new terminal, which the page then shows."""

    columns: int
    rows: int


class ShowTerminal(PageMessage):
    """A request to show a terminal in this page, with its last output.

    Another page that shows it leaves it.
    """

    terminal: int
    columns: int
    rows: int


class HideTerminal(PageMessage):
    """A notice that the page no longer shows a terminal, for example because its tab is hidden."""

    terminal: int


class WriteTerminal(PageMessage):
    """Input for the program in a terminal. In binary input, each character is a byte."""

    terminal: int
    text: str
    is_binary: bool


class ResizeTerminal(PageMessage):
    """The new size of a terminal in the page, in characters."""

    terminal: int
    columns: int
    rows: int


class AcknowledgeTerminal(PageMessage):
    """The acknowledgment of the output up to the message with this number."""

    terminal: int
    number: int


class RestartTerminal(PageMessage):
    """A request to start a shell again in a terminal whose shell has ended."""

    terminal: int
    columns: int
    rows: int


class CloseTerminal(PageMessage):
    """A request to end the programs in a terminal, and to remove it."""

    terminal: int
