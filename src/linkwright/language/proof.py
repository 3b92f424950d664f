"""Edits of several files, and the proof that the expansions of the descriptions stay equal.

The edits are tried on the descriptions that include the edited files, with each set of arguments that their callers
pass.
"""

from __future__ import annotations

from collections.abc import Collection, Iterator, Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import NamedTuple

from linkwright.diagnostics import LinkwrightError, Phrase, Span, display_path, phrase
from linkwright.language.includes import real
from linkwright.language.workspace import Workspace
from linkwright.lint.targets import DESCRIPTIONS
from linkwright.xacro import Expansion, expand
from linkwright.xmltree import Element, Overlay


@dataclass(frozen=True, slots=True, order=True)
class Edit:
    """A text that replaces the characters `start` to `end` (exclusive) of a file."""

    file: Path
    start: int
    end: int
    text: str


class UnprovedError(Exception):
    """Raised when edits cannot be proved.

    Args:
        reason: the reason, as a clause.
        span: the location of the reason, or None.
    """

    def __init__(self, reason: Phrase, span: Span | None = None) -> None:
        super().__init__(reason)
        self.reason = reason
        self.span = span


class ExpansionPair(NamedTuple):
    """The expansion of a description before and after the edits.

    Attributes:
        entry: the description.
        before: the root element of the former expansion.
        after: the root element of the new expansion.
        text_before: the text of the former expansion.
        text_after: the text of the new expansion.
    """

    entry: Path
    before: Element
    after: Element
    text_before: str
    text_after: str


class _Former(NamedTuple):
    """The expansion of a description for one argument set, without the edits."""

    entry: Path
    arguments: Mapping[str, str]
    root: Element
    text: str


def edited(text: str, edits: Collection[Edit]) -> str:
    """Return the text of a file with edits of this file, which must not overlap."""
    for edit in sorted(edits, key=lambda edit: (edit.start, edit.end), reverse=True):
        text = text[: edit.start] + edit.text + text[edit.end :]
    return text


def edited_texts(project: Workspace, texts: Mapping[Path, str], edits: Collection[Edit]) -> dict[Path, str]:
    """Return the texts of the open and the edited files, with edits.

    Args:
        project: the workspace.
        texts: the texts of the open files.
        edits: the edits, which must not overlap.
    """
    changed = dict(texts)
    for file in {edit.file for edit in edits}:
        text = project.text(file, texts) or ""
        changed[file] = edited(text, [edit for edit in edits if edit.file == file])
    return changed


class ExpansionProof:
    """The expansions of the descriptions that include a file, to compare with those after edits.

    Args:
        project: the workspace.
        texts: the texts of the open files.
        file: the file.

    Attributes:
        entries: the descriptions that are compared.
        data: the files that their expansions read.
    """

    def __init__(self, project: Workspace, texts: Mapping[Path, str], file: Path) -> None:
        self.entries: set[Path] = set()
        self.data: set[Path] = set()
        self._project, self._texts = project, texts
        self._before: list[_Former] = []
        self._error: LinkwrightError | None = None
        self._add_entries(file)

    def pairs(self, edits: Collection[Edit], renamed: Mapping[str, str] | None = None) -> Iterator[ExpansionPair]:
        """Yield the expansion of each description and argument set before and after edits.

        Args:
            edits: the edits.
            renamed: the new names of arguments of the descriptions, by old name.

        Raises:
            UnprovedError: a file is outside of the workspace, there is nothing to compare, or an edit causes an error.
        """
        for file in sorted({edit.file for edit in edits}):
            if not self._project.contains(file):
                raise UnprovedError(phrase("'{file}' is outside of the workspace", file=display_path(str(file))))
            if file.name.endswith(DESCRIPTIONS):
                self._add_entries(file)
        if not self._before:
            reason = self._error.diagnostics[0].message if self._error else phrase("no description includes its file")
            raise UnprovedError(phrase("no expansion can be compared: {reason}", reason=reason))
        texts, names = edited_texts(self._project, self._texts, edits), renamed or {}
        for former in self._before:
            arguments = {names.get(key, key): value for key, value in former.arguments.items()}
            try:
                after = self._expand(former.entry, arguments, texts)
            except LinkwrightError as error:
                first = error.diagnostics[0]
                raise UnprovedError(
                    phrase("the edit causes this error: {why}", why=first.message), first.span
                ) from None
            yield ExpansionPair(former.entry, former.root, after.document.root, former.text, str(after))

    def check_equal(self, edits: Collection[Edit], renamed: Mapping[str, str] | None = None) -> None:
        """Compare the expansions before and after edits, which must be equal.

        Args:
            edits: the edits.
            renamed: the new names of arguments of the descriptions, by old name.

        Raises:
            UnprovedError: they differ, or cannot be compared.
        """
        for pair in self.pairs(edits, renamed):
            if pair.text_before != pair.text_after:
                raise UnprovedError(phrase("the robot of '{file}' would change", file=pair.entry.name))

    def _add_entries(self, file: Path) -> None:
        """Expand the descriptions that include a file, without the edits."""
        for entry in self._project.index.entries(file, self._texts):
            if entry in self.entries:
                continue
            self.entries.add(entry)
            for arguments, _ in self._project.calls(entry):
                try:
                    expansion = self._expand(entry, arguments, self._texts)
                except LinkwrightError as error:  # noqa: PERF203 - each may fail for itself
                    self._error = error
                else:
                    self._before.append(_Former(entry, arguments, expansion.document.root, str(expansion)))
                    self.data.update(map(real, expansion.dependencies))

    def _expand(self, entry: Path, arguments: Mapping[str, str], texts: Mapping[Path, str]) -> Expansion:
        overlay = Overlay({str(path): text for path, text in texts.items()})
        return expand(entry, arguments, packages=self._project.finder(entry), overlay=overlay)
