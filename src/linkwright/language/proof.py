"""Edits of several files, and the proof that the expansions of the descriptions stay equal.

The edits are tried on the descriptions that include the edited files, with each set of arguments that their callers
pass.
"""

from __future__ import annotations

import re
from collections.abc import Collection, Iterator, Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import NamedTuple

from linkwright.diagnostics import LinkwrightError, Phrase, Span, display_path, phrase
from linkwright.language.includes import real_path
from linkwright.language.trials import Trial, blank_out, expand_with_gaps, run_trials
from linkwright.language.workspace import Workspace
from linkwright.lint.targets import DESCRIPTION_SUFFIXES
from linkwright.loading.deferred import lazy_pattern
from linkwright.xacro import Expansion
from linkwright.xmltree import Element

_COMMENT = lazy_pattern(r"\s*<!--.*?-->", re.DOTALL)


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


def apply_edits(text: str, edits: Collection[Edit]) -> str:
    """Apply edits, which must not overlap, to the text of their file."""
    for edit in sorted(edits, key=lambda edit: (edit.start, edit.end), reverse=True):
        text = text[: edit.start] + edit.text + text[edit.end :]
    return text


def apply_edits_to_texts(workspace: Workspace, texts: Mapping[Path, str], edits: Collection[Edit]) -> dict[Path, str]:
    """Return the texts of the open and edited files, with the edits applied.

    Args:
        workspace: the folders that the editor has opened.
        texts: the texts of the open files.
        edits: the edits, which must not overlap.
    """
    changed = dict(texts)
    for file in {edit.file for edit in edits}:
        text = workspace.text(file, texts) or ""
        changed[file] = apply_edits(text, [edit for edit in edits if edit.file == file])
    return changed


class ExpansionProof:
    """The expansions of the descriptions that include a file, for comparison after edits.

    Args:
        workspace: the folders that the editor has opened.
        texts: the texts of the open files.
        file: the file that is edited.
        is_partial: whether the comparison includes descriptions that can be expanded only without some elements, and
            arguments that no caller passes.

    Attributes:
        entries: the descriptions that are compared.
        data: the files that their expansions read.
        run_trials: the expansions without the edits.
    """

    def __init__(
        self, workspace: Workspace, texts: Mapping[Path, str], file: Path, *, is_partial: bool = False
    ) -> None:
        self.entries: set[Path] = set()
        self.data: set[Path] = set()
        self.trials: list[Trial] = []
        self._project, self._texts = workspace, texts
        self._is_partial = is_partial
        self._error: LinkwrightError | None = None
        self._names: dict[Path, set[str]] = {}
        self._add_entries(file)

    @property
    def gap_reason(self) -> Phrase | None:
        """The reason for omitted elements, or None if all descriptions are complete."""
        return next((trial.reason for trial in self.trials if trial.reason is not None), None)

    def add(self, entry: Path) -> None:
        """Add a description to the comparison."""
        self._add_entry(entry)

    def names_of(self, file: Path) -> set[str]:
        """Return the paths that the expansions use for a file."""
        return {str(file), *self._names.get(file, ())}

    def pairs(self, edits: Collection[Edit], renamed: Mapping[str, str] | None = None) -> Iterator[ExpansionPair]:
        """Yield the expansion of each description and argument set before and after edits.

        Args:
            edits: the edits, which must not overlap.
            renamed: the new names of arguments of the descriptions, by old name.

        Raises:
            UnprovedError: a file is outside the workspace, there is nothing to compare, or an edit causes an error.
        """
        for file in sorted({edit.file for edit in edits}):
            if not self._project.contains(file):
                raise UnprovedError(phrase("'{file}' is outside the workspace", file=display_path(str(file))))
            if file.name.endswith(DESCRIPTION_SUFFIXES):
                self._add_entries(file)
        if not self.trials:
            reason = self._error.diagnostics[0].message if self._error else phrase("no description includes the file")
            raise UnprovedError(phrase("no expansion can be compared: {reason}", reason=reason))
        names = renamed or {}
        for former in self.trials:
            arguments = {names.get(key, key): value for key, value in former.arguments.items()}
            try:
                edited = self._edited_expansion(former, arguments, edits)
            except LinkwrightError as error:
                first = error.diagnostics[0]
                raise UnprovedError(
                    phrase("the edit causes this error: {reason}", reason=first.message), first.span
                ) from None
            root = former.expansion.document.root
            yield ExpansionPair(former.entry, root, edited.document.root, str(former.expansion), str(edited))

    def check_equal(self, edits: Collection[Edit], renamed: Mapping[str, str] | None = None) -> None:
        """Compare the expansions before and after edits, which must be equal.

        Args:
            edits: the edits, which must not overlap.
            renamed: the new names of arguments of the descriptions, by old name.

        Raises:
            UnprovedError: the expansions differ, or cannot be compared.
        """
        for pair in self.pairs(edits, renamed):
            text_before, text_after, name = pair.text_before, pair.text_after, pair.entry.name
            if text_before != text_after and _COMMENT.sub("", text_before) == _COMMENT.sub("", text_after):
                raise UnprovedError(phrase("the comments in the expansion of '{file}' would change", file=name))
            if text_before != text_after:
                raise UnprovedError(phrase("the robot of '{file}' would change", file=name))

    def _add_entries(self, file: Path) -> None:
        """Expand the descriptions that include a file, without the edits."""
        for entry in self._project.index.entries(file, self._texts, computed=self._is_partial):
            self._add_entry(entry)

    def _add_entry(self, entry: Path) -> None:
        if entry in self.entries:
            return
        self.entries.add(entry)
        expansions, error = run_trials(self._project, self._texts, entry, is_partial=self._is_partial)
        self._error = error or self._error
        self.trials += expansions
        for path in (path for trial in expansions for path in trial.expansion.dependencies):
            self.data.add(real_path(path))
            self._names.setdefault(real_path(path), set()).add(str(path))

    def _edited_expansion(self, former: Trial, arguments: Mapping[str, str], edits: Collection[Edit]) -> Expansion:
        """Return the expansion of a trial with edits, except edits in its omitted elements."""
        texts = dict(self._texts)
        for file in {edit.file for edit in edits} | {*former.gaps}:
            gaps = former.gaps.get(file, ())
            edits_in_file = [edit for edit in edits if edit.file == file]
            remaining_edits = [
                edit for edit in edits_in_file if not any(start <= edit.start < end for start, end in gaps)
            ]
            texts[file] = apply_edits(blank_out(self._project.text(file, self._texts) or "", gaps), remaining_edits)
        return expand_with_gaps(self._project, texts, former.entry, arguments)
