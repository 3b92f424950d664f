"""The provenance of elements as text for a terminal, and as JSON-ready data."""

from __future__ import annotations

from collections.abc import Iterator

from linkwright.diagnostics import Span, display_path
from linkwright.loading.lean_typing import Any
from linkwright.xacro.tracing.provenance import AttributeProvenance, Call, Provenance, TextProvenance
from linkwright.xacro.tracing.references import Value
from linkwright.xmltree import Element, write_element

_EXTERNAL_ORIGINS = {
    "argument": "given on the command line",
    "package": "where the package is",
    "variable": "from the environment",
}
"""The origins of values that are not written in a file, by kind of value."""


def provenance_text(provenance: Provenance) -> str:
    """Return a provenance as text: the element, its calls, and the evaluated texts."""
    return "\n".join([write_element(provenance.element).rstrip("\n"), "", *provenance_lines(provenance)]) + "\n"


def provenance_lines(provenance: Provenance) -> list[str]:
    """Return the lines of `provenance_text` that follow the element itself."""
    lines = [f"written at {format_location(provenance.span)}"]
    lines += [f"  {line}" for call in provenance.calls for line in _call_lines(call)]
    evaluated_lines = [line for descendant in provenance.walk() for line in _element_lines(descendant, provenance)]
    if evaluated_lines:
        lines += ["", *evaluated_lines]
    return lines


def provenance_data(provenance: Provenance) -> dict[str, Any]:
    """Return a provenance as JSON-ready data.

    Lines and columns start at 1, and are None if there is no location.
    """
    return {
        "tag": provenance.element.tag,
        "xml": write_element(provenance.element),
        **_span_data(provenance.span),
        "calls": [_call_data(call) for call in provenance.calls],
        "attributes": [_attribute_data(attribute, provenance) for attribute in provenance.attributes],
        "texts": [_text_data(text) for text in provenance.texts],
        "children": [provenance_data(child) for child in provenance.children],
    }


def format_location(span: Span | None) -> str:
    """Return a location as ``file:line:column``."""
    if span is None:
        return "(no file)"
    file = span.file if span.file.startswith("<") else display_path(span.file)
    return f"{file}:{span.line}:{span.column}"


# text


def _call_lines(call: Call) -> Iterator[str]:
    if call.macro is None:
        yield f"included at {format_location(call.span)}"
        return
    yield f"in macro '{call.macro}' called at {format_location(call.span)}"
    yield from (f"    {line}" for line in _align_rows([_value_row(value) for value in call.parameters]))


def _element_lines(provenance: Provenance, root: Provenance) -> Iterator[str]:
    attributes = [attribute for attribute in provenance.attributes if _is_shown(attribute, provenance)]
    texts = [text for text in provenance.texts if text.written != text.value]
    has_other_calls = provenance is not root and provenance.calls != root.calls
    if not attributes and not texts and not has_other_calls:
        return
    yield f"<{provenance.element.tag}> at {format_location(provenance.span)}"
    if has_other_calls:
        yield from (f"  {line}" for call in provenance.calls for line in _call_lines(call))
    for attribute in attributes:
        line = f"  {attribute.name}={_quoted(attribute.value)}"
        if attribute.calls != provenance.calls or not _is_written_on_element(attribute, provenance):
            line += f" set by <xacro:attribute> at {format_location(attribute.span)}"
        yield (line if attribute.written == attribute.value else f"{line} from {_quoted(attribute.written)}")
        yield from (f"    {row}" for row in _align_rows([_value_row(value) for value in attribute.values]))
    for text in texts:
        yield f"  text {_quoted(text.value)} from {_quoted(text.written)}"
        yield from (f"    {line}" for line in _align_rows([_value_row(value) for value in text.values]))


def _value_row(value: Value) -> tuple[str, str, str]:
    source = value.kind
    if value.span is not None:
        source += f" {format_location(value.span)}"
        if value.written is not None and "$" in value.written:
            source += f" {_quoted(value.written)}"
    elif value.kind in _EXTERNAL_ORIGINS:
        source += f", {_EXTERNAL_ORIGINS[value.kind]}"
    return value.name, value.value, source


def _align_rows(rows: list[tuple[str, str, str]]) -> Iterator[str]:
    name_width = max((len(name) for name, _, _ in rows), default=0)
    value_width = min(max((len(value) for _, value, _ in rows), default=0), 30)
    for name, value, source in rows:
        yield f"{name:{name_width}} = {value:{value_width}}  ({source})"


def _is_shown(attribute: AttributeProvenance, provenance: Provenance) -> bool:
    return attribute.written != attribute.value or not _is_written_on_element(attribute, provenance)


def _is_written_on_element(attribute: AttributeProvenance, provenance: Provenance) -> bool:
    """Return whether an attribute is written on its element instead of set by another tag."""
    element: Element = provenance.element
    return attribute.span is None or element.attribute_span(attribute.name) == attribute.span


def _quoted(text: str) -> str:
    return f'"{" ".join(text.split())}"'


# data


def _call_data(call: Call) -> dict[str, Any]:
    parameters = [_value_data(value) for value in call.parameters]
    return {"macro": call.macro, **_span_data(call.span), "parameters": parameters}


def _attribute_data(attribute: AttributeProvenance, provenance: Provenance) -> dict[str, Any]:
    return {
        "name": attribute.name,
        "value": attribute.value,
        "written": attribute.written,
        **_span_data(attribute.span),
        "values": [_value_data(value) for value in attribute.values],
        **({} if attribute.calls == provenance.calls else {"calls": [_call_data(call) for call in attribute.calls]}),
    }


def _text_data(text: TextProvenance) -> dict[str, Any]:
    values = [_value_data(value) for value in text.values]
    return {"value": text.value, "written": text.written, **_span_data(text.span), "values": values}


def _value_data(value: Value) -> dict[str, Any]:
    return {
        "name": value.name,
        "kind": value.kind,
        "value": value.value,
        "written": value.written,
        **_span_data(value.span),
    }


def _span_data(span: Span | None) -> dict[str, Any]:
    if span is None:
        return {"file": None, "line": None, "column": None}
    return {"file": span.file, "line": span.line, "column": span.column}
