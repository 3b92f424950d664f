"""What is wrong with the description."""

from __future__ import annotations

from typing import Literal

from linkwright.viewer.protocol.message import Record, ServerMessage


class DiagnosticNote(Record):
    """A note of a diagnostic."""

    message: str
    file: str | None
    line: int | None
    column: int | None


class DiagnosticItem(Record):
    """A diagnostic for the page; `excerpt` is the source line, if there is one."""

    code: str
    severity: Literal["error", "warning", "info"]
    message: str
    file: str | None
    line: int | None
    column: int | None
    end_line: int | None
    end_column: int | None
    excerpt: str
    notes: list[DiagnosticNote]
    hints: list[str]


class Diagnostics(ServerMessage):
    """What is wrong with the description now; none clears the list."""

    items: list[DiagnosticItem]
