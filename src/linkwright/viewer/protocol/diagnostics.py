"""What is wrong with the description."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal


@dataclass(slots=True)
class DiagnosticNote:
    """A note of a diagnostic."""

    message: str
    file: str | None
    line: int | None
    column: int | None


@dataclass(slots=True)
class DiagnosticItem:
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


@dataclass(slots=True)
class Diagnostics:
    """What is wrong with the description now; none clears the list."""

    items: list[DiagnosticItem]
    type: Literal["diagnostics"] = "diagnostics"
