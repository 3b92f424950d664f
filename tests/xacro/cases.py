"""Test cases written in Markdown: a heading is a case, its fenced blocks are files, arguments and what must come out.

Fences: ``xacro`` is what stands inside the root element of ``main.xacro``; ``document`` is the whole of it;
``file NAME`` is a file beside it; ``arguments`` holds ``name:=value`` lines; ``urdf`` is the expansion without its
banner, ``diagnostics`` what is reported.
"""

from __future__ import annotations

import re
from dataclasses import dataclass, field
from pathlib import Path

from linkwright.diagnostics import Diagnostic, Span

ROOT = '<robot xmlns:xacro="http://www.ros.org/wiki/xacro">'
BANNER_LINES = 5

_CASE = re.compile(r"^## (?P<title>.+)\n(?P<body>(?:(?!^## ).*\n?)*)", re.MULTILINE)
_FENCE = re.compile(r"^```(?P<kind>\w+)(?: (?P<name>\S+))?\n(?P<text>(?:(?!^```$).*\n)*)^```$", re.MULTILINE)


@dataclass
class Case:
    """One case of a Markdown file."""

    title: str
    main: str = ""
    files: dict[str, str] = field(default_factory=dict)
    arguments: dict[str, str] = field(default_factory=dict)
    expected: str = ""

    def write(self, folder: Path) -> None:
        """Write the files of the case into a folder."""
        for name, text in {"main.xacro": self.main, **self.files}.items():
            path = folder / name
            path.parent.mkdir(parents=True, exist_ok=True)
            path.write_text(text, encoding="utf-8", newline="")


def read_cases(path: Path) -> list[Case]:
    """The cases of a Markdown file."""
    cases = []
    for match in _CASE.finditer(path.read_text(encoding="utf-8")):
        case = Case(match["title"])
        for fence in _FENCE.finditer(match["body"]):
            kind, text = fence["kind"], fence["text"].removesuffix("\n")
            if kind == "xacro":
                case.main = f"{ROOT}{text}</robot>"
            elif kind == "document":
                case.main = text
            elif kind == "file":
                case.files[fence["name"]] = text
            elif kind == "arguments":
                case.arguments = dict(line.split(":=", 1) for line in text.splitlines())
            else:
                assert kind in ("urdf", "diagnostics"), f"{path}: unknown fence {kind}"
                case.expected = text
        assert case.main, f"{path}: '{case.title}' has no document"
        cases.append(case)
    assert cases, path
    return cases


def without_banner(text: str) -> str:
    """An expansion without its XML declaration and banner."""
    return "".join(text.splitlines(keepends=True)[BANNER_LINES:]).removesuffix("\n")


def described(diagnostic: Diagnostic, folder: Path) -> str:
    """A diagnostic as the Markdown files write it."""
    where = f"{_place(diagnostic.span, folder)}: " if diagnostic.span else ""
    lines = [f"{where}{diagnostic.severity.value} {diagnostic.code}: {diagnostic.message}"]
    lines += [f"  note: {note.message}{_in_brackets(note.span, folder)}" for note in diagnostic.notes]
    if diagnostic.hint:
        lines.append(f"  hint: {diagnostic.hint}")
    return "\n".join(lines).replace(f"{folder}/", "")


def _in_brackets(span: Span | None, folder: Path) -> str:
    return f" ({_place(span, folder)})" if span else ""


def _place(span: Span, folder: Path) -> str:
    end = span.end_column if span.end_line == span.line else f"{span.end_line}:{span.end_column}"
    return f"{span.file.replace(f'{folder}/', '')}:{span.line}:{span.column}-{end}"
