"""Mistakes of learners in Markdown.

Each is a change to a file of mbot's package, with the findings of ``linkwright check``.

A ``##`` heading is a case. Its ```` ```diff FILE ```` blocks change files of the package: ``+`` lines replace the ``-``
lines before them, which must occur exactly once in the file. A block with only ``+`` lines creates a file. An
```` ```arguments ```` block holds ``name:=value``.

The ```` ```text ```` block has the findings, from the JSON output of the command: location with the end of the marked
text, severity, code, the marked text in brackets, message; then notes with their locations, and hints.
"""

from __future__ import annotations

import io
import json
import re
import shutil
from contextlib import redirect_stderr, redirect_stdout
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from linkwright.cli.command import main
from tests.markdown import read_sections
from tests.places import PACKAGE

_RUN = re.compile(r"(?P<old>(?:^-.*\n)*)(?P<new>(?:^\+.*\n)*)", re.MULTILINE)


@dataclass
class Case:
    """One mistake."""

    title: str
    changes: list[tuple[str, str]]
    arguments: list[str]
    expected: str

    @property
    def file(self) -> str:
        """Return the checked file, which is the first changed one."""
        return self.changes[0][0]

    def check(self, folder: Path) -> str:
        """Make the mistake in a copy of the package below a folder, and return the findings."""
        package = folder / PACKAGE.name
        shutil.copytree(PACKAGE, package, ignore=shutil.ignore_patterns("__pycache__"))
        for name, change in self.changes:
            _change(package / name, change)
        output = io.StringIO()
        with redirect_stdout(output), redirect_stderr(io.StringIO()):
            status = main(["check", "--format", "json", str(package / self.file), *self.arguments])
        findings = json.loads(output.getvalue())["diagnostics"]
        assert status == any(finding["severity"] == "error" for finding in findings)
        return (
            "\n".join(line for finding in findings for line in _lines(finding, package))
            .replace(f"{package}/", "")
            .replace(f"{folder}", "FOLDER")
        )


def read_cases(path: Path) -> list[Case]:
    """Return the cases of a Markdown file."""
    cases = []
    for title, blocks in read_sections(path):
        changes, arguments, expected = [], [], ""
        for block in blocks:
            if block.kind == "diff":
                changes.append((block.label, block.text))
            elif block.kind == "arguments":
                arguments = block.text.splitlines()
            else:
                expected = block.text.rstrip("\n")
        cases.append(Case(title, changes, arguments, expected))
    return cases


def _change(path: Path, change: str) -> None:
    text = path.read_text(encoding="utf-8") if path.exists() else ""
    for run in _RUN.finditer(change):
        old, new = ("".join(f"{line[1:]}\n" for line in run[side].splitlines()) for side in ("old", "new"))
        if old:
            count = f"\n{text}".count(f"\n{old}")
            assert count == 1, f"{path.name} contains {old!r} {count} times"
            text = f"\n{text}".replace(f"\n{old}", f"\n{new}")[1:]
        elif new:
            text += new
    path.parent.mkdir(parents=True, exist_ok=True)
    path.write_text(text, encoding="utf-8")


def _lines(finding: dict[str, Any], package: Path) -> list[str]:
    lines = [f"{_place(finding)} {finding['severity']} {finding['code']} [{_marked(finding)}] {finding['message']}"]
    for note in finding["notes"]:
        place = f" ({note['file']}:{note['line']}:{note['column']})" if note["file"] else ""
        lines.append(f"  note: {note['message']}{place}")
    lines += [f"  hint: {hint}" for hint in finding["hints"]]
    return lines


def _place(finding: dict[str, Any]) -> str:
    if finding["file"] is None:
        return "-"
    return f"{finding['file']}:{finding['line']}:{finding['column']}"


def _marked(finding: dict[str, Any]) -> str:
    """Return the text that a finding marks, without its further lines."""
    if finding["file"] is None or not Path(finding["file"]).is_file():
        return ""
    lines = Path(finding["file"]).read_text(encoding="utf-8").splitlines()
    line = lines[finding["line"] - 1] if finding["line"] <= len(lines) else ""
    end = finding["end_column"] - 1 if finding["end_line"] == finding["line"] else len(line)
    return line[finding["column"] - 1 : end]
