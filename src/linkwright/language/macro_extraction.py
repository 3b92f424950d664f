"""Extract elements to a macro with parameters for the names that they use."""

from __future__ import annotations

import re
from collections.abc import Iterator, Mapping, Sequence
from itertools import product
from pathlib import Path

from linkwright.diagnostics import phrase
from linkwright.language.definitions import NameKind
from linkwright.language.extraction import find_start_with_comments, make_insertion_before, make_unique_name
from linkwright.language.grammar import PREFIX
from linkwright.language.occurrences import Occurrence, occurrences_in
from linkwright.language.proof import Edit, ExpansionProof, UnprovedError
from linkwright.language.source_elements import SourceElement, source_elements
from linkwright.language.workspace import Workspace
from linkwright.xmltree.patches import indentation, line_ending
from linkwright.xmltree.tokens import Kind, tokens

_INDENTATION = "  "


def selected_elements(text: str, start: int, end: int) -> list[SourceElement]:
    """Return the sibling elements that make up a selection.

    Returns an empty list if the selection contains other text, a part of an element, the root, or a definition or
    include of xacro.

    Args:
        text: the text of a file.
        start: the character offset of the selection.
        end: the offset after the selection.
    """
    selected_text = text[start:end]
    start, end = (
        start + len(selected_text) - len(selected_text.lstrip()),
        end - len(selected_text) + len(selected_text.rstrip()),
    )
    if start >= end:
        return []
    selected_elements = [candidate for candidate in source_elements(text) if start <= candidate.start < end]
    if not selected_elements or any(candidate.end < 0 or candidate.end > end for candidate in selected_elements):
        return []
    first = selected_elements[0]
    siblings = [candidate for candidate in selected_elements if candidate.parent is first.parent]
    if first.parent is None or not all(_is_movable(candidate) for candidate in siblings):
        return []
    position = start
    for sibling in siblings:
        if not _is_blank(text[position : sibling.start]):
            return []
        position = sibling.end
    return siblings if position == end or _is_blank(text[position:end]) else []


def _is_blank(text: str) -> bool:
    """Return whether a text contains only comments and white space."""
    return all(
        token.kind is Kind.COMMENT or (token.kind is Kind.TEXT and not token.text.strip()) for token in tokens(text)
    )


def _is_movable(element: SourceElement) -> bool:
    return element.name not in ("xacro:macro", "xacro:arg", "xacro:include", "xacro:property")


def extract_macro(
    workspace: Workspace, texts: Mapping[Path, str], file: Path, text: str, siblings: Sequence[SourceElement]
) -> tuple[Edit, ...]:
    """Return the proved edits that move elements to a macro with parameters.

    Args:
        workspace: the folders that the editor has opened.
        texts: the texts of the open files.
        file: the file that contains the elements.
        text: its text.
        siblings: the elements, as `selected_elements` returns them.

    Raises:
        UnprovedError: the expansions would differ.
    """
    start, end, top = siblings[0].start, siblings[-1].end, siblings[0].top
    assert top is not None
    name = make_unique_name(workspace, texts, file, _choose_macro_name(siblings[0]))
    newline, blanks = line_ending(text), indentation(text, top.start) or ""
    proof = ExpansionProof(workspace, texts, file)
    error: UnprovedError | None = None
    starts = dict.fromkeys(
        (start, find_start_with_comments(text, start))
    )  # The definition goes above these comments, because xacro drops comments above calls.
    places = dict.fromkeys((find_start_with_comments(text, top.start), top.start))
    lists = _generate_parameter_lists(workspace, texts, file, text, (start, end))
    for parameters, begin, insertion_offset in product(lists, starts, places):
        if begin < insertion_offset:
            continue
        call = "".join(f' {parameter}="${{{parameter}}}"' for parameter in parameters)
        body = _reindent(text, begin, end, blanks + _INDENTATION)
        params = f' params="{" ".join(parameters)}"'
        lines = (f'<xacro:macro name="{name}"{params}>', f"{blanks}{_INDENTATION}{body}", f"{blanks}</xacro:macro>")
        definition = make_insertion_before(file, text, insertion_offset, newline.join(lines))
        edits = _merge_adjacent(definition, Edit(file, begin, end, f"<xacro:{name}{call}/>"))
        try:
            proof.check_equal(edits)
        except UnprovedError as reason:
            error = error or reason
        else:
            return edits
    raise error or UnprovedError(phrase("there is no place to define '{name}'", name=name))


def _merge_adjacent(first: Edit, second: Edit) -> tuple[Edit, ...]:
    """Merge two edits into one if they are adjacent, and return the edits."""
    if first.end == second.start:
        return (Edit(first.file, first.start, second.end, first.text + second.text),)
    return first, second


def _choose_macro_name(element: SourceElement) -> str:
    """Return a macro name that consists of the element's tag and the nearest name around it."""
    tag = element.name.removeprefix(PREFIX)
    for ancestor in element.ancestors_and_self():
        literal = re.sub(r"\$\{[^}]*\}|\$\([^)]*\)", "", ancestor.value("name")).strip("_- ")
        if literal and ancestor.parent is not None:
            return literal if literal.endswith(tag) else f"{literal}_{tag}"
    return f"{tag}_macro"


def _generate_parameter_lists(
    workspace: Workspace, texts: Mapping[Path, str], file: Path, text: str, selected: tuple[int, int]
) -> Iterator[list[str]]:
    """Yield the lists of parameters to try: all used names, only macro parameters, or none."""
    properties: set[str] = set()
    for other in workspace.index.related_files(file, texts):
        all_names = occurrences_in(workspace.text(other, texts) or "", other)
        properties |= {
            candidate.name for candidate in all_names if candidate.kind is NameKind.PROPERTY and candidate.is_definition
        }
    selected_names = [
        candidate for candidate in occurrences_in(text, file) if selected[0] <= candidate.start < selected[1]
    ]
    own_properties = {
        candidate.name
        for candidate in selected_names
        if candidate.kind is NameKind.PROPERTY and candidate.is_definition
    }
    blocks = {candidate.name for candidate in selected_names if _is_block_use(text, candidate)}
    names = [
        candidate
        for candidate in selected_names
        if candidate.name not in own_properties | blocks and not candidate.is_definition
    ]
    used_names = [
        candidate.name
        for candidate in names
        if (candidate.kind is NameKind.PARAMETER and _uses_value(text, candidate))
        or (candidate.kind is NameKind.PROPERTY and candidate.name in properties)
    ]
    local = [
        candidate.name for candidate in names if candidate.kind is NameKind.PARAMETER and _uses_value(text, candidate)
    ]
    lists = [[*dict.fromkeys(used_names)], [*dict.fromkeys(local)], []]
    for index, parameters in enumerate(lists):
        if parameters not in lists[:index]:
            yield parameters


def _is_block_use(text: str, name: Occurrence) -> bool:
    start_of_tag = text[: name.start].rpartition("<")[2]
    return start_of_tag.startswith("xacro:insert_block")


def _uses_value(text: str, name: Occurrence) -> bool:
    """Return whether an occurrence uses a value, and is not the name of a passed argument."""
    return re.match(r"\s*=\s*[\"']", text[name.end :]) is None


def _reindent(text: str, start: int, end: int, blanks: str) -> str:
    """Return a range of a text with new indentation, except inside values and comments."""
    old = indentation(text, start)
    body = text[start:end]
    if old is None or old == blanks:
        return body
    parts = []
    for token in tokens(body):
        moved = token.text
        if token.kind is Kind.TEXT and not moved.strip() and "\n" in moved:
            before, newline, last = moved.rpartition("\n")
            moved = before + newline + (blanks + last.removeprefix(old) if last.startswith(old) else last)
        parts.append(moved)
    return "".join(parts)
