"""Extract a value to a property."""

from __future__ import annotations

import builtins
import keyword
import re
from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from pathlib import Path

from linkwright.diagnostics import phrase
from linkwright.language.definitions import NameKind
from linkwright.language.expressions import expressions_in, is_subexpression
from linkwright.language.grammar import PREFIX
from linkwright.language.occurrences import occurrences_in
from linkwright.language.proof import Edit, ExpansionProof, UnprovedError
from linkwright.language.source_elements import MACRO, SourceElement, find_innermost_element, source_elements
from linkwright.language.workspace import Workspace
from linkwright.loading.deferred import lazy_pattern
from linkwright.xacro.expressions.builtin_names import MATHEMATICS
from linkwright.xmltree.patches import indentation, line_ending
from linkwright.xmltree.tokens import Kind, TokenAttribute, tokens

_NUMBER = lazy_pattern(r"[-+]?(?:\d+\.?\d*|\.\d+)(?:[eE][-+]?\d+)?")
_COMPONENTS = {"xyz": ("x", "y", "z"), "rpy": ("roll", "pitch", "yaw"), "size": ("x", "y", "z")}
"""The attributes that contain several numbers, and the names of these numbers."""
_UNEVALUATED_ATTRIBUTES = frozenset({(MACRO, "params"), ("xacro:include", "ns"), ("xacro:property", "scope")})
"""The attributes whose values xacro does not evaluate as text."""
_UNEVALUATED_NAMES = frozenset({"xacro:macro", "xacro:property", "xacro:arg", "xacro:insert_block"})
"""The elements whose ``name`` xacro does not evaluate as text."""
_NAMESPACES = ("math", "python", "xacro")
"""The namespaces of functions in xacro expressions."""


@dataclass(frozen=True, slots=True)
class ValueSelection:
    """A value, or a part of a value, that can become a property.

    Attributes:
        element: the element that has the value as an attribute or text.
        attribute: the name of the attribute, or empty for the text of the element.
        start: the character offset of the selection.
        end: the offset after the selection.
        in_expression: whether the selection is inside ``${...}``.
        component: the name of the number, such as ``x``, or empty if it is not one of several.
    """

    element: SourceElement
    attribute: str
    start: int
    end: int
    in_expression: bool
    component: str = ""


def find_selected_value(text: str, start: int, end: int) -> ValueSelection | None:
    """Return the selected value, or the number at a cursor.

    Args:
        text: the text of a file.
        start: the character offset of the selection.
        end: the offset after the selection, equal to `start` for a cursor.

    Returns:
        The value, or None if it cannot become a property.
    """
    elements = source_elements(text)
    element = find_innermost_element(elements, start)
    if element is None or element.top is None:
        return None
    if start < element.tag.end:
        attribute = next(
            (
                candidate
                for candidate in element.tag.attributes()
                if candidate.value_start <= start <= candidate.value_end
            ),
            None,
        )
        if attribute is None or attribute.value is None or not _is_evaluated(element, attribute):
            return None
        return _select_part(element, attribute.name, attribute.value, attribute.value_start, (start, end))
    for token in tokens(text[element.tag.end : element.end]):
        first = element.tag.end + token.start
        if token.kind is Kind.TEXT and first <= start <= first + len(token.text) and not element.children:
            return _select_part(element, "", token.text, first, (start, end))
    return None


def _is_evaluated(element: SourceElement, attribute: TokenAttribute) -> bool:
    key = attribute.name
    if (element.name, key) in _UNEVALUATED_ATTRIBUTES or key.startswith("xmlns") or not attribute.quote:
        return False
    return key != "name" or element.name not in _UNEVALUATED_NAMES


def _select_part(
    element: SourceElement, attribute: str, value: str, value_start: int, selected: tuple[int, int]
) -> ValueSelection | None:
    """Return the selected part of a value without surrounding spaces, or None.

    Args:
        element: the element that has the value.
        attribute: the name of the attribute, or empty for the text of the element.
        value: the whole value, as written.
        value_start: the offset of the value in the file.
        selected: the start and end offset of the selection in the file.
    """
    start, end = selected[0] - value_start, selected[1] - value_start
    if start == end:
        number = next((match for match in _NUMBER.finditer(value) if match.start() <= start <= match.end()), None)
        if number is None:
            return None
        start, end = number.span()
    if not 0 <= start < end <= len(value):
        return None
    selected_text = value[start:end]
    start, end = (
        start + len(selected_text) - len(selected_text.lstrip()),
        end - len(selected_text) + len(selected_text.rstrip()),
    )
    if start >= end:
        return None
    enclosing = next(
        (
            expression
            for expression in expressions_in(value)
            if expression.inner_range[0] <= start and end <= expression.inner_range[1]
        ),
        None,
    )
    if enclosing is not None:
        low = enclosing.inner_range[0]
        is_valid = is_subexpression(enclosing.source, start - low, end - low)
    else:
        is_valid = _is_plain_part(value, start, end)
    if not is_valid:
        return None
    return ValueSelection(
        element,
        attribute,
        value_start + start,
        value_start + end,
        enclosing is not None,
        _component_name(attribute, value, start, end),
    )


def _is_plain_part(value: str, start: int, end: int) -> bool:
    """Return whether a range of a value splits no expression, substitution or number."""
    if "$" in value and any(
        expression.start < edge < expression.end for edge in (start, end) for expression in expressions_in(value)
    ):
        return False
    part = value[start:end]
    if part.count("$(") != part.count(")") or part.count("${") != part.count("}") or "$$" in value:
        return False
    if re.search(r"\$\([^()]*$", value[:start]):
        return False
    ends_in_number = re.search(r"[\w.]$", value[:start]) and re.match(r"[\d.+-]", part)
    return not ends_in_number and not (re.search(r"[\w.]$", part) and re.match(r"[\d.]", value[end:]))


def _component_name(attribute: str, value: str, start: int, end: int) -> str:
    names, words = _COMPONENTS.get(attribute, ()), value.split()
    if "$" in value or len(words) != len(names) or value.split() == [value[start:end]]:
        return ""
    index = len(value[:start].split())
    return names[index] if index < len(names) and value[start:end] == words[index] else ""


def extract_property(
    workspace: Workspace, texts: Mapping[Path, str], file: Path, text: str, selection: ValueSelection
) -> tuple[Edit, ...]:
    """Return the proved edits that replace a value by a new property.

    Args:
        workspace: the folders that the editor has opened.
        texts: the texts of the open files.
        file: the file that contains the value.
        text: its text.
        selection: the value that becomes a property.

    Raises:
        UnprovedError: the expansions would differ wherever the property is defined.
    """
    element, tag = selection.element, selection.element.name.removeprefix(PREFIX)
    name = make_unique_name(
        workspace, texts, file, "_".join(filter(None, (tag, selection.component or selection.attribute or "value")))
    )
    value = text[selection.start : selection.end]
    is_number = _NUMBER.fullmatch(value.lstrip("+-")) is not None
    content = f"${{{value}}}" if selection.in_expression and not is_number else value
    quote = "'" if '"' in content and "'" not in content else '"'
    definition = f"<xacro:property name={quote}{name}{quote} value={quote}{_quote(content, quote)}{quote}/>"
    use = Edit(file, selection.start, selection.end, name if selection.in_expression else f"${{{name}}}")
    names = occurrences_in(text, file)
    is_local = any(
        name.kind is NameKind.PARAMETER and selection.start <= name.start < selection.end and not name.is_definition
        for name in names
    )
    proof = ExpansionProof(workspace, texts, file)
    error: UnprovedError | None = None
    for insertion_offset in _definition_offsets(text, element, is_local=is_local):
        edits = (make_insertion_before(file, text, insertion_offset, definition), use)
        try:
            proof.check_equal(edits)
        except UnprovedError as reason:
            error = error or reason
        else:
            return edits
    raise error or UnprovedError(phrase("there is no place to define '{name}'", name=name))


def _quote(content: str, quote: str) -> str:
    return content.replace(quote, "&quot;" if quote == '"' else "&apos;")


def _definition_offsets(text: str, element: SourceElement, *, is_local: bool) -> Iterator[int]:
    """Yield the offsets at which a definition can be inserted, the best first.

    A comment directly above an element belongs to it, so a definition is inserted above the comment.
    """
    places: list[SourceElement] = []
    macro, top = element.macro, element.top
    if top is not None and not (is_local and macro is not None):
        places.append(top)
    if macro is not None:
        places.append(element.child_of(macro))
    places.append(element)
    offsets = [offset for anchor in places for offset in (find_start_with_comments(text, anchor.start), anchor.start)]
    yield from dict.fromkeys(offsets)


def find_start_with_comments(text: str, start: int) -> int:
    """Return the start of an element, including the comments directly above it.

    Args:
        text: the text of a file.
        start: the character offset of the element.
    """
    while True:
        prefix = text[:start].rstrip(" \t")
        text_above = prefix.rstrip()
        begin = text_above.rfind("<!--")
        is_attached = text_above.endswith("-->") and begin >= 0 and prefix[len(text_above) :].count("\n") == 1
        if not is_attached or indentation(text, begin) is None:
            return start
        start = begin


def make_insertion_before(file: Path, text: str, start: int, new: str) -> Edit:
    """Return the edit that inserts lines before an offset, with the indentation of that line."""
    blanks = indentation(text, start)
    separator = "" if blanks is None else f"{line_ending(text)}{blanks}"
    return Edit(file, start, start, new + separator)


def make_unique_name(workspace: Workspace, texts: Mapping[Path, str], file: Path, preferred: str) -> str:
    """Return a name for a property or macro that no file of the description contains.

    Args:
        workspace: the folders that the editor has opened.
        texts: the texts of the open files.
        file: a file of the description.
        preferred: the name to which a number is appended if a file contains it.
    """
    base = re.sub(r"\W+", "_", preferred).strip("_") or "value"
    if base[0].isdigit():
        base = f"_{base}"
    used_names = {*keyword.kwlist, *dir(builtins), *MATHEMATICS, *_NAMESPACES}
    for other in workspace.index.related_files(file, texts):
        used_names.update(re.findall(r"\w+", workspace.text(other, texts) or ""))
    name, count = base, 1
    while name in used_names:
        count += 1
        name = f"{base}_{count}"
    return name
