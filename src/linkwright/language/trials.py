"""The expansions of a description for the proof of edits, with arguments and gaps.

The callers of a description rarely reach all of its branches. Therefore, the arguments in conditions are also switched,
one at a time. A description that cannot be expanded, because a package is missing or a caller decides a value, is
expanded without the failing elements. Spaces replace these elements, so all offsets stay the same.
"""

from __future__ import annotations

import os
import time
from collections.abc import Iterator, Mapping
from dataclasses import dataclass, field
from pathlib import Path

from linkwright.descriptions.argument_sets import compared_values
from linkwright.diagnostics import LinkwrightError, Phrase, SourceText, Span
from linkwright.language.includes import real_path
from linkwright.language.source_elements import find_innermost_element, source_elements
from linkwright.language.workspace import Workspace
from linkwright.xacro import Expansion, expand
from linkwright.xacro.faults import Fault
from linkwright.xmltree import Overlay, parse
from linkwright.xmltree.tokens import Kind, tokens

Range = tuple[int, int]
Gaps = Mapping[Path, tuple[Range, ...]]

_UNDECLARED_ARGUMENT_CODE = "XAC211"
_PLACEHOLDERS = ("value", "1")
"""The values of an argument that only a caller sets."""
_MAX_GAPS = 60
_MAX_TRIALS_WITH_GAPS = 3
_MAX_SWITCHED_TRIALS = 10
_MAX_DURATION_S = 2.0
"""The time after which no further arguments are switched."""
_OPPOSITES = {"true": "false", "false": "true", "True": "False", "False": "True", "0": "1", "1": "0"}


@dataclass(frozen=True, slots=True)
class Trial:
    """An expansion of a description.

    Attributes:
        entry: the description.
        arguments: the values of its arguments.
        expansion: the result.
        gaps: the ranges of elements that were left out because they cannot be expanded, by file.
        reason: the error of the first omitted element, or None.
    """

    entry: Path
    arguments: Mapping[str, str]
    expansion: Expansion
    gaps: Gaps = field(default_factory=dict)
    reason: Phrase | None = None


def expand_with_gaps(
    workspace: Workspace, texts: Mapping[Path, str], entry: Path, arguments: Mapping[str, str], gaps: Gaps | None = None
) -> Expansion:
    """Return the expansion of a description without some elements.

    Args:
        workspace: the folders that the editor has opened.
        texts: the texts of the open files.
        entry: the description.
        arguments: the values of its arguments.
        gaps: the ranges of the elements to leave out, by file.

    Raises:
        LinkwrightError: the description cannot be expanded.
    """
    overlay_texts: dict[str | os.PathLike[str], str] = {str(path): text for path, text in texts.items()}
    for file, ranges in (gaps or {}).items():
        overlay_texts[str(file)] = blank_out(workspace.text(file, texts) or "", ranges)
    return expand(entry, arguments, packages=workspace.finder(entry), overlay=Overlay(overlay_texts))


def blank_out(text: str, ranges: tuple[Range, ...]) -> str:
    """Replace some ranges of a text with spaces, and keep its length and lines."""
    for start, end in ranges:
        blank = "".join(letter if letter == "\n" else " " for letter in text[start:end])
        text = text[:start] + blank + text[end:]
    return text


def run_trials(
    workspace: Workspace, texts: Mapping[Path, str], entry: Path, *, is_partial: bool, is_switched: bool = True
) -> tuple[list[Trial], LinkwrightError | None]:
    """Return the expansions of a description, and the last error, or None.

    Args:
        workspace: the folders that the editor has opened.
        texts: the texts of the open files.
        entry: the description.
        is_partial: whether elements that fail are left out if nothing can be expanded.
        is_switched: whether arguments are also switched, if `is_partial` is set.
    """
    distinct: dict[tuple[str, frozenset[str]], Trial] = {}
    error: LinkwrightError | None = None
    for arguments, _ in workspace.argument_calls(entry):
        try:
            expansion = expand_with_gaps(workspace, texts, entry, arguments)
        except LinkwrightError as reason:  # noqa: PERF203 - each may fail for itself
            error = reason
        else:
            distinct.setdefault((str(expansion), frozenset(arguments)), Trial(entry, arguments, expansion))
    expansions = [*distinct.values()]
    if is_partial and not expansions:
        expansions += _generate_trials_with_gaps(workspace, texts, entry)
    if is_partial and is_switched and expansions:
        expansions += _generate_trials_with_other_values(
            workspace, texts, expansions[0], {str(trial.expansion) for trial in expansions}
        )
    return expansions, error


def _generate_trials_with_gaps(workspace: Workspace, texts: Mapping[Path, str], entry: Path) -> Iterator[Trial]:
    """Yield at most `_MAX_TRIALS_WITH_GAPS` expansions without the failing elements."""
    count = 0
    for arguments in workspace.possible_arguments(entry):
        trial = _run_trial_with_gaps(workspace, texts, entry, arguments)
        if trial is not None:
            yield trial
            count += 1
        if count == _MAX_TRIALS_WITH_GAPS:
            return


def _run_trial_with_gaps(
    workspace: Workspace, texts: Mapping[Path, str], entry: Path, arguments: Mapping[str, str]
) -> Trial | None:
    """Return an expansion without the failing elements, or None if the description has none."""
    gaps: dict[Path, tuple[Range, ...]] = {}
    reason: Phrase | None = None
    values = dict(arguments)
    for _ in range(_MAX_GAPS):
        try:
            return Trial(entry, values, expand_with_gaps(workspace, texts, entry, values, gaps), gaps, reason)
        except (Fault, RecursionError):
            return None
        except LinkwrightError as raised:
            error = raised
        undeclared = [diagnostic for diagnostic in error.diagnostics if diagnostic.code == _UNDECLARED_ARGUMENT_CODE]
        names = [str(name) for finding in undeclared if (name := finding.message.arguments.get("name"))]
        added = {name: _PLACEHOLDERS[0] for name in names if name not in values}
        if added:
            values |= added
            continue
        first = error.diagnostics[0]
        numbers = {name: _PLACEHOLDERS[1] for name, value in values.items() if value == _PLACEHOLDERS[0]}
        if not gaps and numbers and not first.code.startswith(("PKG", "XML")):
            values |= numbers
            continue
        element_range = None if first.span is None else _find_element_around(workspace, texts, first.span, gaps)
        if element_range is None:
            return None
        reason = reason or first.message
        gaps[element_range[0]] = (*gaps.get(element_range[0], ()), element_range[1])
    return None


def _find_element_around(
    workspace: Workspace, texts: Mapping[Path, str], span: Span, gaps: Gaps
) -> tuple[Path, Range] | None:
    """Return the file and range of the element at a location, or None for the root."""
    file = real_path(span.file)
    text = workspace.text(file, texts)
    if text is None:
        return None
    offset = SourceText(span.file, text).offset(span.line, span.column)
    element = find_innermost_element(source_elements(text), offset)
    if element is None or element.parent is None or element.end < 0:
        return None
    element_range = element.start, element.end
    return None if element_range in gaps.get(file, ()) else (file, element_range)


def _generate_trials_with_other_values(
    workspace: Workspace, texts: Mapping[Path, str], base: Trial, seen_results: set[str]
) -> Iterator[Trial]:
    """Yield the new expansions that result from another value of a single argument."""
    begin = time.monotonic()
    for name, value in _list_other_values(workspace, texts, base.entry):
        if base.arguments.get(name) == value:
            continue
        if time.monotonic() - begin > _MAX_DURATION_S:
            return
        arguments = {**base.arguments, name: value}
        try:
            expansion = expand_with_gaps(workspace, texts, base.entry, arguments, base.gaps)
        except (LinkwrightError, Fault, RecursionError):
            continue
        text = str(expansion)
        if text not in seen_results:
            seen_results.add(text)
            yield Trial(base.entry, arguments, expansion, base.gaps, base.reason)


def _list_other_values(workspace: Workspace, texts: Mapping[Path, str], entry: Path) -> list[tuple[str, str]]:
    """Return other values of arguments: opposites of defaults, and values in conditions."""
    values: dict[tuple[str, str], None] = {}
    documents = []
    for file in workspace.index.related_files(entry, texts, computed=True):
        text = workspace.text(file, texts) or ""
        for token in tokens(text):
            if token.kind is Kind.START and token.name == "xacro:arg":
                attributes = {attribute.name: attribute.value or "" for attribute in token.attributes()}
                opposite = _OPPOSITES.get(attributes.get("default", "").strip())
                if opposite is not None and attributes.get("name"):
                    values[attributes["name"], opposite] = None
        try:
            documents.append(parse(text, str(file)))
        except LinkwrightError:
            continue
    for compared in compared_values(documents):
        values.update(dict.fromkeys(compared.values.items()))
    return [*values][:_MAX_SWITCHED_TRIALS]
