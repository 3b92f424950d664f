"""Test cases in Markdown.

Each heading is a case, with blocks for files, arguments and the expected result.

Fences: ``xacro`` is the content of the root element of ``main.xacro``; ``document`` is the whole of this file;
``file NAME`` is another file in the folder; ``arguments`` holds ``name:=value`` lines; ``urdf`` is the expansion
without its banner, and ``diagnostics`` the expected diagnostics.
"""

from __future__ import annotations

from dataclasses import dataclass, field
from pathlib import Path

import pytest

from linkwright.diagnostics import Diagnostic, Span
from tests.markdown import read_sections

ROOT = '<robot xmlns:xacro="http://www.ros.org/wiki/xacro">'
BANNER_LINES = 5
PACKAGES = {"pkg_a": "/share/pkg_a"}
"""The packages that cases may name."""
ENVIRONMENT = {"LINKWRIGHT_TEST": "env value", "LINKWRIGHT_UNSET": None}
"""The environment variables that cases may name; a variable with None must not be set."""


@dataclass
class Case:
    """One case of a Markdown file."""

    title: str
    main: str = ""
    files: dict[str, str] = field(default_factory=dict)
    arguments: dict[str, str] = field(default_factory=dict)
    expected: str = ""

    def write(self, folder: Path) -> None:
        """Write the files of the case to a new folder."""
        for name, text in {"main.xacro": self.main, **self.files}.items():
            path = folder / name
            path.parent.mkdir(parents=True, exist_ok=True)
            path.write_text(text, encoding="utf-8", newline="")


def read_cases(path: Path) -> list[Case]:
    """Return the cases of a Markdown file."""
    cases = []
    for title, blocks in read_sections(path):
        case = Case(title)
        for kind, name, lines in blocks:
            text = lines.removesuffix("\n")
            if kind == "xacro":
                case.main = f"{ROOT}{text}</robot>"
            elif kind == "document":
                case.main = text
            elif kind == "file":
                case.files[name] = text
            elif kind == "arguments":
                case.arguments = dict(line.split(":=", 1) for line in text.splitlines())
            else:
                assert kind in ("urdf", "diagnostics"), f"{path}: unknown fence {kind}"
                case.expected = text
        assert case.main, f"{path}: '{case.title}' has no document"
        cases.append(case)
    assert cases, path
    return cases


def set_environment(monkeypatch: pytest.MonkeyPatch) -> None:
    """Set the environment variables that cases may use."""
    for name, value in ENVIRONMENT.items():
        if value is None:
            monkeypatch.delenv(name, raising=False)
        else:
            monkeypatch.setenv(name, value)


def without_banner(text: str) -> str:
    """Return an expansion without its XML declaration and banner."""
    return "".join(text.splitlines(keepends=True)[BANNER_LINES:]).removesuffix("\n")


def format_diagnostic(diagnostic: Diagnostic, folder: Path) -> str:
    """Return a diagnostic in the notation of the Markdown files."""
    location = f"{_format_place(diagnostic.span, folder)}: " if diagnostic.span else ""
    lines = [f"{location}{diagnostic.severity.value} {diagnostic.code}: {diagnostic.message}"]
    lines += [f"  note: {note.message}{_format_span(note.span, folder)}" for note in diagnostic.notes]
    if diagnostic.hint:
        lines.append(f"  hint: {diagnostic.hint}")
    return "\n".join(lines).replace(f"{folder}/", "")


def _format_span(span: Span | None, folder: Path) -> str:
    return f" ({_format_place(span, folder)})" if span else ""


def _format_place(span: Span, folder: Path) -> str:
    end = span.end_column if span.end_line == span.line else f"{span.end_line}:{span.end_column}"
    return f"{span.file.replace(f'{folder}/', '')}:{span.line}:{span.column}-{end}"
