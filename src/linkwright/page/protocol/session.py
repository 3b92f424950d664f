"""The messages about the connection itself."""

from __future__ import annotations

from linkwright.page.protocol.message import PageMessage, ServerMessage

PROTOCOL_VERSION = 5
"""Increased on every change that an older page would misread; the page reloads itself if it differs."""


class Hello(ServerMessage):
    """First message on every connection; `run` changes when the program is started again."""

    protocol: int
    version: str
    title: str
    run: str


class ProgramIsLate(ServerMessage):
    """Whether this program's own delays, and not the line, are most of the time that answers of the page take."""

    late: bool


class Received(PageMessage):
    """Acknowledges the number of messages that the page has received, after the first one and after each large one."""

    count: int
