"""Tests of rules on Markdown pages: files, and the expected findings.

A page begins with a comment that selects rules, ``<!-- rules: LW2 -->``: all rules whose codes begin with LW2 run, also
pedantic ones. A case has:

- a ``##`` heading;
- code blocks with the files: ```` ```xml ```` is ``robot.urdf``, ```` ```xml file=name ```` is another file in any
  language, and ```` ```toml ```` is ``linkwright.toml``; the first block is the file that is checked;
- a ```` ```text ```` block with the findings by location, ``LINE:COLUMN CODE message`` (``FILE:LINE:COLUMN`` in files
  other than the first, ``-`` without a location), then indented ``note: ...`` (with its location in parentheses) and
  ``hint: ...``; the block is empty if there are no findings;
- optionally a ```` ```xml fixed ```` block: the checked file after all fixes, including unsafe ones.
"""

from __future__ import annotations

import re
from dataclasses import dataclass, replace
from pathlib import Path

from linkwright.diagnostics import Diagnostic, Span
from linkwright.lint.apply import fix_file
from linkwright.lint.configuration import find_settings
from linkwright.lint.engine import examine
from linkwright.lint.settings import Settings
from tests.markdown import Block, read_sections

FOLDER = Path(__file__).parent
_RULES = re.compile(r"<!-- rules: ([A-Z0-9 ]+?) -->")


@dataclass(frozen=True)
class Case:
    """One case of a page."""

    page: str
    title: str
    selectors: tuple[str, ...]
    files: dict[str, str]
    expected: str
    fixed: str | None

    @property
    def name(self) -> str:
        """The name of the test."""
        return f"{self.page}: {self.title}"

    def run(self, folder: Path) -> str:
        """Write the files, check the first, and return the findings in the form of the page."""
        for name, text in self.files.items():
            (folder / name).parent.mkdir(parents=True, exist_ok=True)
            (folder / name).write_text(text, encoding="utf-8")
        main = folder / next(iter(self.files))
        findings = examine(main, settings=self._settings(main)).diagnostics
        selected_findings = [finding for finding in findings if finding.code.startswith(self.selectors)]
        return "".join(
            f"{line}\n" for finding in selected_findings for line in _format_diagnostic(finding, folder, main)
        )

    def fixed_text(self, folder: Path) -> str:
        """Return the checked file, written by `run`, after all its fixes."""
        main = folder / next(iter(self.files))
        settings = self._settings(main)
        fix_file(main, lambda _text: examine(main, settings=settings).diagnostics, unsafe=True)
        return main.read_text(encoding="utf-8")

    def _settings(self, main: Path) -> Settings:
        settings, trouble = find_settings(main)
        assert not trouble
        return settings if settings.select is not None else replace(settings, select=self.selectors)


def load_cases() -> list[Case]:
    """Return the cases of all pages in this folder."""
    return [case for page in sorted(FOLDER.glob("*.md")) for case in _read_cases(page)]


def _read_cases(page: Path) -> list[Case]:
    text = page.read_text(encoding="utf-8")
    rules = _RULES.search(text)
    assert rules, f"{page.name} does not select rules"
    selectors = tuple(rules[1].split())
    return [_read_case(page.stem, title, selectors, blocks) for title, blocks in read_sections(page)]


def _read_case(page: str, title: str, selectors: tuple[str, ...], blocks: list[Block]) -> Case:
    files: dict[str, str] = {}
    result = fixed = None
    for language, label, text in blocks:
        if language == "text" and not label:
            result = text
        elif label == "fixed":
            fixed = text
        else:
            files[label.removeprefix("file=") or {"xml": "robot.urdf", "toml": "linkwright.toml"}[language]] = text
    assert result is not None, f"{page}.md: '{title}' has no text block"
    assert files, f"{page}.md: '{title}' has no file"
    return Case(page, title, selectors, files, result, fixed)


def _format_diagnostic(diagnostic: Diagnostic, root: Path, main: Path) -> list[str]:
    lines = [
        f"{_format_place(diagnostic.span, root, main)} {diagnostic.code} {_to_relative_text(diagnostic.message, root)}"
    ]
    for note in diagnostic.notes:
        place = f" ({_format_place(note.span, root, main)})" if note.span else ""
        lines.append(f"  note: {_to_relative_text(note.message, root)}{place}")
    if diagnostic.hint:
        lines.append(f"  hint: {_to_relative_text(diagnostic.hint, root)}")
    return lines


def _format_place(span: Span | None, root: Path, main: Path) -> str:
    if span is None:
        return "-"
    path = Path(span.file)
    shown = path.relative_to(root).as_posix() if path.is_relative_to(root) else span.file
    return f"{span.line}:{span.column}" if path == main else f"{shown}:{span.line}:{span.column}"


def _to_relative_text(text: str, root: Path) -> str:
    return text.replace(f"{root}/", "").replace("\n", "\\n")
