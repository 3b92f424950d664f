"""The provenance of an element of an expansion: locations, calls and values."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

from linkwright.diagnostics import Diagnostic, LinkwrightError, Span, phrase
from linkwright.xacro.faults import Frame, frames
from linkwright.xacro.limits import recursion_limit_for
from linkwright.xacro.session import Inputs
from linkwright.xacro.tracing.recorder import ElementRecord, Recorder
from linkwright.xacro.tracing.references import Value, written_attribute
from linkwright.xacro.tracing.traced import TracedSession, expand_traced
from linkwright.xmltree import Element, Text


@dataclass(frozen=True, slots=True)
class Call:
    """A macro call or an include that led to an element.

    Attributes:
        macro: the macro's name, or None for an include.
        span: the location of the calling or including tag.
        parameters: the parameters of the call with their values, without blocks.
    """

    macro: str | None
    span: Span | None
    parameters: tuple[Value, ...] = ()


@dataclass(frozen=True, slots=True)
class AttributeProvenance:
    """The provenance of an attribute.

    Attributes:
        name: the name of the attribute.
        value: the value in the result.
        written: the text in the source, such as ``${prefix}_link``.
        span: the location of this text.
        values: the names in the text, with their values.
        calls: the calls and includes that contain the text, innermost first. They differ from the calls of the element
            if ``<xacro:attribute>`` has set the attribute.
    """

    name: str
    value: str
    written: str
    span: Span | None
    values: tuple[Value, ...]
    calls: tuple[Call, ...]


@dataclass(frozen=True, slots=True)
class TextProvenance:
    """The provenance of a text inside an element.

    Attributes:
        value: the text in the result, without surrounding whitespace.
        written: the text in the source.
        span: the location of the text in the source.
        values: the names in the text, with their values.
    """

    value: str
    written: str
    span: Span | None
    values: tuple[Value, ...]


@dataclass(frozen=True, slots=True)
class Provenance:
    """The provenance of an element of an expansion.

    Attributes:
        element: the element in the result.
        span: the location where the element is written.
        calls: the macro calls and includes that contain the element, innermost first.
        attributes: the provenance of each attribute, in document order.
        texts: the provenance of each text directly in the element, except texts of only whitespace.
        children: the provenance of the child elements.
    """

    element: Element
    span: Span | None
    calls: tuple[Call, ...]
    attributes: tuple[AttributeProvenance, ...]
    texts: tuple[TextProvenance, ...]
    children: tuple[Provenance, ...]

    def walk(self) -> Iterator[Provenance]:
        """Yield this provenance and the provenance of all elements inside, in document order."""
        pending = [self]
        while pending:
            provenance = pending.pop()
            yield provenance
            pending.extend(reversed(provenance.children))


def provenance_of(inputs: Inputs, root: Element, element: Element) -> Provenance:
    """Return an element's provenance; see `linkwright.xacro.Expansion.provenance`."""
    return Tracer(inputs, root).trace(element)


class Tracer:
    """A tracer that finds the provenance of elements in a second expansion of the same inputs.

    Args:
        inputs: the inputs of the expansion.
        root: the root of the first result.
    """

    def __init__(self, inputs: Inputs, root: Element) -> None:
        self._inputs = inputs
        self._recorder = Recorder(inputs.arguments)
        session = TracedSession(inputs)
        self._second_document = expand_traced(inputs, session, self._recorder.directives, self._recorder.call)
        self._counterparts: dict[int, Element] = {}
        for first_element, second_element in zip(root.walk(), self._second_document.root.walk(), strict=False):
            if first_element.tag != second_element.tag or first_element.attributes != second_element.attributes:
                break
            self._counterparts[id(first_element)] = second_element

    def trace(self, element: Element) -> Provenance:
        """Return the provenance of an element of the first result.

        Raises:
            LinkwrightError: XAC802 if the second result differs from the first.
        """
        with recursion_limit_for(self._inputs.limits):
            return self._trace(element)

    def _trace(self, element: Element) -> Provenance:
        counterpart = self._counterparts.get(id(element))
        if counterpart is None:
            message = phrase(
                "the element '{tag}' does not match the expansion of '{name}'", tag=element.tag, name=self._inputs.name
            )
            hint = phrase("the file has changed; expand it again")
            raise LinkwrightError(Diagnostic("XAC802", message, element.span(), hint=hint, source=element.source))
        record = self._recorder.record_of(counterpart) or ElementRecord(element, None)
        calls = self._list_calls(record.frame)
        return Provenance(
            element=element,
            span=element.span(),
            calls=calls,
            attributes=tuple(self._trace_attribute(counterpart, name, record, calls) for name in element.attributes),
            texts=tuple(_trace_texts(element, record)),
            children=tuple(self._trace(child) for child in element.elements()),
        )

    def _trace_attribute(
        self, element: Element, name: str, record: ElementRecord, calls: tuple[Call, ...]
    ) -> AttributeProvenance:
        value = element.attributes[name]
        setting = self._recorder.attribute_use(element, name)
        node, attribute = (setting.node, "value") if setting else (record.node, name)
        source_text = written_attribute(node, attribute)
        return AttributeProvenance(
            name=name,
            value=value,
            written=value if source_text is None else source_text,
            span=node.attribute_span(attribute),
            values=setting.values if setting else record.values.get(name, ()),
            calls=self._list_calls(setting.frame) if setting else calls,
        )

    def _list_calls(self, frame: Frame | None) -> tuple[Call, ...]:
        return tuple(Call(call.macro, call.site.span(), self._recorder.parameters(call)) for call in frames(frame))


def _trace_texts(element: Element, record: ElementRecord) -> Iterator[TextProvenance]:
    texts_by_position = {_source_position(text): (text, values) for text, values in record.texts}
    for child in element.children:
        if isinstance(child, Text) and not child.data.isspace() and child.data:
            text, values = texts_by_position.get(_source_position(child), (child, ()))
            start = text.offset + len(text.data) - len(text.data.lstrip())
            span = text.source.span(start, start + len(text.data.strip())) if text.source else None
            yield TextProvenance(child.data.strip(), text.data.strip(), span, values)


def _source_position(text: Text) -> tuple[str, int]:
    return (text.source.name if text.source else "", text.offset)
