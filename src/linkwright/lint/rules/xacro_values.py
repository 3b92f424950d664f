"""Rules about misleading values in xacro files."""

from __future__ import annotations

from collections.abc import Iterator
from itertools import pairwise

from linkwright.diagnostics import Diagnostic, Note, Phrase, Span, phrase
from linkwright.lint.rules.xacro_rule import XacroRule
from linkwright.loading.lean_typing import TYPE_CHECKING
from linkwright.xacro.expressions.scope import parse_literal
from linkwright.xmltree import Element

if TYPE_CHECKING:
    from linkwright.lint.xacro_facts import Definition, FileFacts, XacroFacts

_NAME_ATTRIBUTES = frozenset(
    {"name", "link", "joint", "reference", "filename", "joint1", "joint2", "frame", "parent", "child"}
)


class LiteralChangesType(XacroRule):
    """A value that xacro turns into a number or a boolean before it becomes part of a name.

    ## Why

    xacro converts the values of properties and parameters that look like numbers or truth values: `007` becomes 7 and
    `true` becomes True. The conversion is useful in a sum, but not in the name of a link.

    ## Example

    ```xml
    <xacro:wheel id="01"/>  <!-- the macro writes <link name="wheel_${id}"/>: the link is called wheel_1 -->
    ```

    ## Use instead

    ```xml
    <xacro:wheel id="'01'"/>
    ```

    Quotes protect the value of a parameter from conversion. The value of a property needs two pairs of quotes:
    `value="''01''"`.
    """

    code = "LW710"
    name = "literal-changes-type"

    def check_xacro(self, facts: XacroFacts) -> Iterator[Diagnostic]:
        for file in facts.package_files.values():
            for call in file.calls:
                yield from self._call_findings(call, facts)
            for definition in file.properties:
                value = definition.element.attributes.get("value")
                if value is not None and _is_changed_by_literal_rule(value):
                    use = _find_use_in_name(definition.name, facts, None)
                    if use is not None:
                        yield self._finding(definition.element, "value", definition.name, value, use, quotes="''")

    def _call_findings(self, call: Definition, facts: XacroFacts) -> Iterator[Diagnostic]:
        macros = [
            (file, macro)
            for file in facts.files.values()
            for macro in file.macros_by_name.get(call.name.rpartition(".")[2], ())
        ]
        if len(macros) != 1:
            return
        _, macro = macros[0]
        for name, value in call.element.attributes.items():
            if _is_changed_by_literal_rule(value):
                use = _find_use_in_name(name, facts, macro.element)
                if use is not None:
                    yield self._finding(call.element, name, name, value, use, quotes="'")

    def _finding(
        self, element: Element, attribute: str, name: str, value: str, use: tuple[Element, str], quotes: str
    ) -> Diagnostic:
        converted = parse_literal(value)
        note = Note(phrase("'{name}' becomes part of a name here", name=name), use[0].attribute_span(use[1]))
        message = phrase(
            "xacro reads '{value}' as {kind} and writes '{changed}' into a name",
            value=value,
            kind=_describe_kind(converted),
            changed=converted,
        )
        hint = phrase(
            'write {attribute}="{quotes}{value}{quotes}" to keep it unchanged',
            attribute=attribute,
            quotes=quotes,
            value=value,
        )
        return self.report(message, element, attribute, notes=[note], hint=hint)


class PropertyDefinedTwice(XacroRule):
    """A property is redefined before anything has used its first value.

    ## Why

    The first value has no effect. If a user changes this value, the robot stays the same.

    ## Example

    ```xml
    <xacro:property name="wheel_radius" value="0.06"/>
    <xacro:property name="wheel_width" value="0.02"/>
    <xacro:property name="wheel_radius" value="0.08"/>
    ```

    ## Use instead

    Keep one of the definitions. If the first is intended as a default, write it last, with `default`:

    ```xml
    <xacro:property name="wheel_radius" default="0.06"/>
    ```
    """

    code = "LW711"
    name = "property-defined-twice"

    def check_xacro(self, facts: XacroFacts) -> Iterator[Diagnostic]:
        for file in facts.package_files.values():
            groups: dict[tuple[str, int], list[Definition]] = {}
            for definition in file.properties:
                if definition.name and "$" not in definition.name and "value" in definition.element.attributes:
                    groups.setdefault((definition.name, id(definition.parents[-1])), []).append(definition)
            for definitions in groups.values():
                for first, second in pairwise(definitions):
                    if self._is_lost(first, second, file, facts):
                        note = Note(
                            phrase("the value '{value}' has no effect here", value=first.element.attributes["value"]),
                            first.element.attribute_span("value"),
                        )
                        message = phrase(
                            "the property '{name}' gets another value before anything uses the first one",
                            name=first.name,
                        )
                        yield self.report(
                            message, second.element, "value", notes=[note], hint=phrase("keep one of the two")
                        )

    def _is_lost(self, first: Definition, second: Definition, file: FileFacts, facts: XacroFacts) -> bool:
        first_attributes, second_attributes = first.element.attributes, second.element.attributes
        if first_attributes["value"] == second_attributes["value"] or first_attributes.get(
            "scope"
        ) != second_attributes.get("scope"):
            return False
        name = first.name
        for use in file.uses:
            if first.order < use.order <= second.order and (name in use.mentions.names or use.mentions.is_open):
                return False
        calls_between = [
            call for call in (*file.calls, *file.includes) if first.order < call.order < second.order
        ]  # the content of a called macro or included file may use the name
        return not calls_between or not (facts.is_open or name in facts.names)


class ShadowedProperty(XacroRule):
    """A parameter or property inside a macro hides a property of the file.

    ## Why

    Inside the macro, the name has a different meaning than outside. Because scopes in xacro are dynamic, macros that
    are called inside also use the inner definition. Pedantic: a parameter often has the name of the property whose
    value it receives.

    ## Example

    ```xml
    <xacro:property name="radius" value="0.2"/>
    <xacro:macro name="wheel" params="prefix radius">
    ```

    ## Use instead

    ```xml
    <xacro:property name="base_radius" value="0.2"/>
    <xacro:macro name="wheel" params="prefix radius">
    ```
    """

    code = "LW712"
    name = "shadowed-property"
    default = False

    def check_xacro(self, facts: XacroFacts) -> Iterator[Diagnostic]:
        from linkwright.lint.xacro_facts import parameter_span

        outer_properties: dict[str, Definition] = {}
        for file in facts.files.values():
            for definition in file.properties:
                if definition.macro is None and "$" not in definition.name:
                    outer_properties.setdefault(definition.name, definition)
        for file in facts.package_files.values():
            for macro in file.macros:
                for parameter in file.parameters(macro.element):
                    if parameter.name in outer_properties and not parameter.forward:
                        span = parameter_span(macro.element, parameter)
                        subject = phrase(
                            "the parameter '{name}' of the macro '{macro_name}'",
                            name=parameter.name,
                            macro_name=macro.name,
                        )
                        yield self._finding(macro.element, span, subject, outer_properties[parameter.name])
            for inner_property in file.properties:
                if (
                    inner_property.macro is not None
                    and inner_property.name in outer_properties
                    and "scope" not in inner_property.element.attributes
                ):
                    span = inner_property.element.attribute_span("name")
                    yield self._finding(
                        inner_property.element,
                        span,
                        phrase("the property '{name}'", name=inner_property.name),
                        outer_properties[inner_property.name],
                    )

    def _finding(self, element: Element, span: Span | None, subject: str, outer_property: Definition) -> Diagnostic:
        note = Note(phrase("the outer property is defined here"), outer_property.element.attribute_span("name"))
        return self.report(
            phrase("{definition} hides a property of the same name", definition=subject),
            element,
            span=span,
            notes=[note],
        )


class ParameterHidesGlobal(XacroRule):
    """A parameter of a macro hides a name that xacro provides, such as ``pi`` or ``e``.

    ## Why

    Inside the macro, the name no longer refers to the constant or function, and expressions with this name have wrong
    values without any error. Pedantic: xacro already warns about calls of the macro.

    ## Example

    ```xml
    <xacro:macro name="pillar" params="name pi">
    ```

    ## Use instead

    ```xml
    <xacro:macro name="pillar" params="name pillar_index">
    ```
    """

    code = "LW713"
    name = "parameter-hides-global"
    holds_for_parts = True
    default = False

    def check_xacro(self, facts: XacroFacts) -> Iterator[Diagnostic]:
        from linkwright.lint.xacro_facts import is_global, parameter_span
        from linkwright.lint.xacro_names import DEPRECATED

        for file in facts.package_files.values():
            for macro in file.macros:
                for parameter in file.parameters(macro.element):
                    if is_global(parameter.name) or parameter.name in DEPRECATED:
                        message = phrase(
                            "the parameter '{name}' of the macro '{macro_name}' hides a name that xacro provides",
                            name=parameter.name,
                            macro_name=macro.name,
                        )
                        span = parameter_span(macro.element, parameter)
                        hint = phrase("give the parameter another name")
                        yield self.report(message, macro.element, "params", span=span, hint=hint)


def _is_changed_by_literal_rule(value: str) -> bool:
    """Return whether xacro's conversion of literals changes the text of a value."""
    return "$" not in value and "'" not in value and str(parse_literal(value)) != value


def _describe_kind(value: object) -> Phrase:
    return phrase("a boolean") if isinstance(value, bool) else phrase("a number")


def _find_use_in_name(name: str, facts: XacroFacts, macro: Element | None) -> tuple[Element, str] | None:
    """Return an element and its attribute that uses ``${name}`` as part of a name, or None.

    The element is inside `macro` or, if `macro` is None, outside all macros that hide the name.
    """
    for file in facts.files.values():
        for use in file.uses:
            if (
                use.attribute not in _NAME_ATTRIBUTES
                or use.element.tag.startswith("xacro:")
                or name not in use.mentions.names
            ):
                continue
            if f"${{{name}}}" not in use.element.attributes[use.attribute].replace(" ", ""):
                continue
            enclosing_macros = [parent for parent in use.parents if parent.tag == "xacro:macro"]
            is_hidden = any(
                name in {parameter.name for parameter in file.parameters(enclosing_macro)}
                for enclosing_macro in enclosing_macros
            )
            if (macro is not None and macro in enclosing_macros) or (macro is None and not is_hidden):
                return use.element, use.attribute
    return None
