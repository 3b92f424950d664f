"""The recorder of the expansion steps that produced each element of the result."""

from __future__ import annotations

from collections.abc import Collection, Mapping
from dataclasses import dataclass, field

from linkwright.diagnostics import LinkwrightError, Span
from linkwright.loading.lean_typing import Any
from linkwright.xacro.expander import Directive, Expander, Site
from linkwright.xacro.expressions.scope import Lazy, Scope, parse_literal
from linkwright.xacro.faults import Fault, Frame, attribute_span
from linkwright.xacro.macros import Parameter, parse_parameters
from linkwright.xacro.tags.directives import DIRECTIVES
from linkwright.xacro.tags.macro_calls import call_macro
from linkwright.xacro.tracing.references import Reference, Value, format_value, references, written_attribute
from linkwright.xacro.tracing.traced import PROBE, recorded_probe
from linkwright.xmltree import Element, Text


@dataclass
class ElementRecord:
    """The record of the production of an element.

    Attributes:
        node: the element in the source.
        frame: the innermost macro call or include at that time.
        values: the names in each attribute's value, by attribute.
        texts: the unevaluated texts with expressions, each with the names in it.
    """

    node: Element
    frame: Frame | None
    values: dict[str, tuple[Value, ...]] = field(default_factory=dict)
    texts: list[tuple[Text, tuple[Value, ...]]] = field(default_factory=list)


@dataclass(frozen=True)
class AttributeUse:
    """A use of ``<xacro:attribute>``: element, active call or include, and names in the value."""

    node: Element
    name: str
    value: str
    frame: Frame | None
    values: tuple[Value, ...]


class Recorder:
    """An observer that records one expansion.

    Args:
        passed_names: the names of the arguments that were passed.

    Attributes:
        directives: the functions that expand and record xacro's own tags, by tag.
    """

    def __init__(self, passed_names: Collection[str] = ()) -> None:
        self._passed_names = passed_names
        self.directives: Mapping[str, Directive] = {
            **{tag: self._recording_directive(directive) for tag, directive in DIRECTIVES.items()},
            "xacro:property": self._define_property,
            "xacro:attribute": self._set_attribute,
            PROBE: self._record_probe,
        }
        self._records: dict[int, tuple[Element, ElementRecord]] = {}
        self._settings: list[AttributeUse] = []
        self._settings_by_attribute: dict[tuple[int, str], AttributeUse] = {}
        self._properties: dict[tuple[int, str], Element] = {}
        self._parameters: dict[int, dict[str, Value]] = {}
        self._frame_parameters: dict[int, tuple[Value, ...]] = {}
        self._arguments: dict[str, Element] = {}
        self._keepalive: list[Any] = []  # These objects must stay alive because their `id` is a key.

    def call(self, expander: Expander, site: Site) -> None:
        """Expand a macro call, and record the attributes that it sets."""
        self._recording_directive(call_macro)(expander, site)

    # access to the records

    def record_of(self, element: Element) -> ElementRecord | None:
        """Return the record of the production of an element, or None."""
        record = self._records.get(id(element))
        return record[1] if record else None

    def attribute_use(self, element: Element, name: str) -> AttributeUse | None:
        """Return the ``<xacro:attribute>`` that set an attribute of an element, or None."""
        return self._settings_by_attribute.get((id(element), name))

    def parameters(self, frame: Frame) -> tuple[Value, ...]:
        """Return the recorded parameters of a macro call with their values."""
        return self._frame_parameters.get(id(frame), ())

    # watching

    def _recording_directive(self, directive: Directive) -> Directive:
        """Return a directive that records argument declarations and ``<xacro:attribute>`` uses.

        A use inside the directive is recorded for the parent element if the element has the attribute with that value.
        """

        def expand(expander: Expander, site: Site) -> None:
            setting_count = len(self._settings)
            directive(expander, site)
            for setting in self._settings[setting_count:]:
                if site.parent.attributes.get(setting.name) == setting.value:
                    self._settings_by_attribute[id(site.parent), setting.name] = setting
            if site.node.tag == "xacro:arg" and site.node.attributes.get("name"):
                self._arguments.setdefault(site.node.attributes["name"], site.node)

        return expand

    def _set_attribute(self, expander: Expander, site: Site) -> None:
        node, session = site.node, expander.session
        DIRECTIVES["xacro:attribute"](expander, site)
        name = _evaluate_again(expander, node, "name", site.scope)
        if name is None or name not in site.parent.attributes:
            return
        values = self._evaluate_references(expander, node.attributes["value"], site.scope)
        setting = AttributeUse(node, name, site.parent.attributes[name], session.frame, values)
        self._settings.append(setting)
        self._keepalive.append(site.parent)
        self._settings_by_attribute[id(site.parent), name] = setting

    def _define_property(self, expander: Expander, site: Site) -> None:
        DIRECTIVES["xacro:property"](expander, site)
        name = _evaluate_again(expander, site.node, "name", site.scope)
        scope_kind = site.node.attributes.get("scope")
        if name is None:
            return
        if "remove" in site.node.attributes and name not in site.scope:
            self._forget_property(name, site.scope)
            return
        scope: Scope | None = site.scope if scope_kind is None else site.scope.parent
        if scope_kind == "global":
            scope = site.scope.document_scope()
        while scope is not None and name not in scope.values:
            scope = scope.parent
        if scope is not None and ("default" not in site.node.attributes or (id(scope), name) not in self._properties):
            self._keepalive.append(scope)
            self._properties[id(scope), name] = site.node

    def _forget_property(self, name: str, scope: Scope | None) -> None:
        while scope is not None:
            self._properties.pop((id(scope), name), None)
            scope = scope.parent

    def _record_probe(self, expander: Expander, site: Site) -> None:
        element, target = site.parent, site.node.origin
        if isinstance(target, ElementRecord):  # the second expansion of a block, whose elements already have a record
            self._add_record(element, target)
        elif isinstance(target, Text):
            record = self.record_of(element)
            if record is not None:
                record.texts.append((target, self._evaluate_references(expander, target.data, site.scope)))
            return
        elif isinstance(target, Element) and target.tag == "xacro:macro":
            self._begin_macro(expander, target, site.scope)
            return
        elif isinstance(target, Element):
            record = ElementRecord(target, expander.session.frame)
            for name, text in target.attributes.items():
                if "$" in text:
                    record.values[name] = self._evaluate_references(expander, text, site.scope)
            target = record
            self._add_record(element, record)
        element.children.append(recorded_probe(target))

    def _add_record(self, element: Element, record: ElementRecord) -> None:
        self._records[id(element)] = (element, record)

    def _begin_macro(self, expander: Expander, macro: Element, scope: Scope) -> None:
        frame = expander.session.frame
        if frame is None:
            return
        values = {}
        for parameter in parse_parameters(macro.attributes.get("params", "")):
            if not parameter.is_block and parameter.name in scope.values:
                values[parameter.name] = _make_parameter_value(
                    parameter, scope.values[parameter.name], frame.site, macro
                )
        self._keepalive += [scope, frame]
        self._parameters[id(scope)] = values
        self._frame_parameters[id(frame)] = tuple(values.values())

    # values

    def _evaluate_references(self, expander: Expander, text: str, scope: Scope) -> tuple[Value, ...]:
        if "$" not in text:
            return ()
        values = (self._evaluate_reference(expander, reference, scope) for reference in references(text))
        return tuple(value for value in values if value is not None)

    def _evaluate_reference(self, expander: Expander, reference: Reference, scope: Scope) -> Value | None:
        if reference.command is not None:
            return self._evaluate_substitution(expander, reference, scope)
        owner = _find_defining_scope(scope, reference.name)
        if owner is None or owner.parent is None:
            return None  # the language provides this name
        value = _try_evaluate(expander, f"${{{reference.path}}}", scope)
        if value is _UNEVALUATED or callable(value) or isinstance(value, Scope):
            return None
        node = self._properties.get((id(owner), reference.name))
        if node is not None:
            attribute = "value" if "value" in node.attributes else "default"
            span, source_text = node.attribute_span(attribute), written_attribute(node, attribute)
            return Value(reference.path, "property", format_value(value), span, source_text)
        parameter = self._parameters.get(id(owner), {}).get(reference.name)
        if parameter is not None:
            return Value(reference.path, "parameter", format_value(value), parameter.span, parameter.written)
        member = self._member_source(owner.values.get(reference.name), reference.path)
        span, source_text = member or (None, None)
        return Value(reference.path, "property", format_value(value), span, source_text)

    def _member_source(self, namespace: object, path: str) -> tuple[Span | None, str | None] | None:
        """Return the location and text of a namespace's property, such as ``A.B.radius``, or None."""
        *_, name = parts = path.split(".")
        for segment in parts[1:-1]:
            namespace = namespace.values.get(segment) if isinstance(namespace, Scope) else None
        node = self._properties.get((id(namespace), name))
        if node is None:
            return None
        attribute = "value" if "value" in node.attributes else "default"
        return node.attribute_span(attribute), written_attribute(node, attribute)

    def _evaluate_substitution(self, expander: Expander, reference: Reference, scope: Scope) -> Value | None:
        value = _try_evaluate(expander, reference.path, scope)
        if value is _UNEVALUATED:
            return None
        if reference.command == "arg":
            node = self._arguments.get(reference.name)
            if node is None or reference.name in self._passed_names:
                return Value(reference.path, "argument", format_value(value))
            span, source_text = node.attribute_span("default"), written_attribute(node, "default")
            return Value(reference.path, "argument", format_value(value), span, source_text)
        return Value(reference.path, "package" if reference.command == "find" else "variable", format_value(value))


_UNEVALUATED = object()


def _try_evaluate(expander: Expander, text: str, scope: Scope) -> Any:
    try:
        return expander.session.evaluate(text, scope)
    except (Fault, LinkwrightError, KeyError):
        return _UNEVALUATED


def _evaluate_again(expander: Expander, node: Element, attribute: str, scope: Scope) -> str | None:
    """Return a directive's attribute, evaluated again, or None if this might change a value."""
    text = node.attributes.get(attribute)
    if text is None or ("$" in text and expander.session.may_change_values(text)):
        return None
    return expander.text_value(node, attribute, scope)


def _find_defining_scope(scope: Scope, name: str) -> Scope | None:
    """Return the innermost enclosing scope that defines a name, or None."""
    enclosing_scope: Scope | None = scope
    while enclosing_scope is not None and name not in enclosing_scope.values:
        enclosing_scope = enclosing_scope.parent
    return enclosing_scope


def _make_parameter_value(parameter: Parameter, value: Any, call: Element, macro: Element) -> Value:
    """Return a parameter's value in a call, and the location of the argument or default."""
    text = format_value(value.text if isinstance(value, Lazy) else parse_literal(value))
    if parameter.name in call.attributes:
        span, source_text = call.attribute_span(parameter.name), written_attribute(call, parameter.name)
        return Value(parameter.name, "parameter", text, span, source_text)
    default = parameter.default
    if default is None:
        span = attribute_span(macro, "params", parameter.start, parameter.start + len(parameter.name))
        return Value(parameter.name, "parameter", text, span, None)
    span = attribute_span(macro, "params", parameter.default_start, parameter.default_start + len(default))
    return Value(parameter.name, "parameter", text, span, default)
