"""Stories of elements as text for a terminal and as plain data."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

from linkwright.diagnostics import Span, display_path
from linkwright.xacro.references import Value
from linkwright.xacro.story import AttributeStory, Call, Story, TextStory
from linkwright.xmltree import Element, write_element

_OUTSIDE = {
    "argument": "given on the command line",
    "package": "where the package is",
    "variable": "from the environment",
}
"""What is said of a value that no file gives."""


def story_text(story: Story) -> str:
    """A story for a terminal: the element as it comes out, the calls that brought it there, and what was evaluated."""
    return "\n".join([write_element(story.element).rstrip("\n"), "", *story_lines(story)]) + "\n"


def story_lines(story: Story) -> list[str]:
    """What `story_text` says after the element itself."""
    lines = [f"written at {place(story.span)}"]
    lines += [f"  {line}" for call in story.calls for line in _call_lines(call)]
    evaluated = [line for part in story.walk() for line in _element_lines(part, story)]
    if evaluated:
        lines += ["", *evaluated]
    return lines


def story_data(story: Story) -> dict[str, Any]:
    """A story as JSON-ready data; places are 1-based, absent ones are None."""
    return {
        "tag": story.element.tag,
        "xml": write_element(story.element),
        **_span_data(story.span),
        "calls": [_call_data(call) for call in story.calls],
        "attributes": [_attribute_data(attribute, story) for attribute in story.attributes],
        "texts": [_text_data(text) for text in story.texts],
        "children": [story_data(child) for child in story.children],
    }


def place(span: Span | None) -> str:
    """A place as ``file:line:column``."""
    if span is None:
        return "(no file)"
    file = span.file if span.file.startswith("<") else display_path(span.file)
    return f"{file}:{span.line}:{span.column}"


# text


def _call_lines(call: Call) -> Iterator[str]:
    if call.macro is None:
        yield f"included at {place(call.span)}"
        return
    yield f"in macro '{call.macro}' called at {place(call.span)}"
    yield from (f"    {line}" for line in _table([_value_row(value) for value in call.parameters]))


def _element_lines(story: Story, around: Story) -> Iterator[str]:
    attributes = [attribute for attribute in story.attributes if _is_told(attribute, story)]
    texts = [text for text in story.texts if text.written != text.value]
    other = story is not around and story.calls != around.calls
    if not attributes and not texts and not other:
        return
    yield f"<{story.element.tag}> at {place(story.span)}"
    if other:
        yield from (f"  {line}" for call in story.calls for line in _call_lines(call))
    for attribute in attributes:
        what = f"  {attribute.name}={_quoted(attribute.value)}"
        if attribute.calls != story.calls or not _is_inside(attribute, story):
            what += f" set by <xacro:attribute> at {place(attribute.span)}"
        yield what if attribute.written == attribute.value else f"{what} from {_quoted(attribute.written)}"
        yield from (f"    {line}" for line in _table([_value_row(value) for value in attribute.values]))
    for text in texts:
        yield f"  text {_quoted(text.value)} from {_quoted(text.written)}"
        yield from (f"    {line}" for line in _table([_value_row(value) for value in text.values]))


def _value_row(value: Value) -> tuple[str, str, str]:
    told = value.kind
    if value.span is not None:
        told += f" {place(value.span)}"
        if value.written is not None and "$" in value.written:
            told += f" {_quoted(value.written)}"
    elif value.kind in _OUTSIDE:
        told += f", {_OUTSIDE[value.kind]}"
    return value.name, value.value, told


def _table(rows: list[tuple[str, str, str]]) -> Iterator[str]:
    first = max((len(name) for name, _, _ in rows), default=0)
    second = min(max((len(value) for _, value, _ in rows), default=0), 30)
    for name, value, told in rows:
        yield f"{name:{first}} = {value:{second}}  ({told})"


def _is_told(attribute: AttributeStory, story: Story) -> bool:
    return attribute.written != attribute.value or not _is_inside(attribute, story)


def _is_inside(attribute: AttributeStory, story: Story) -> bool:
    """Whether an attribute is written on its element, and not by a tag elsewhere."""
    element: Element = story.element
    return attribute.span is None or element.attribute_span(attribute.name) == attribute.span


def _quoted(text: str) -> str:
    return f'"{" ".join(text.split())}"'


# data


def _call_data(call: Call) -> dict[str, Any]:
    parameters = [_value_data(value) for value in call.parameters]
    return {"macro": call.macro, **_span_data(call.span), "parameters": parameters}


def _attribute_data(attribute: AttributeStory, story: Story) -> dict[str, Any]:
    return {
        "name": attribute.name,
        "value": attribute.value,
        "written": attribute.written,
        **_span_data(attribute.span),
        "values": [_value_data(value) for value in attribute.values],
        **({} if attribute.calls == story.calls else {"calls": [_call_data(call) for call in attribute.calls]}),
    }


def _text_data(text: TextStory) -> dict[str, Any]:
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
