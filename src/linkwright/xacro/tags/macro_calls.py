"""Definitions and calls of macros."""

from __future__ import annotations

from linkwright.diagnostics import Note, counted, did_you_mean, joined, phrase, quoted_names
from linkwright.loading.lean_typing import Any, NoReturn
from linkwright.xacro.expander import Container, Expander, Site, check_attributes, warn_of_global
from linkwright.xacro.expressions.scope import Scope
from linkwright.xacro.faults import Fault, Frame, attribute_name_span, inactive_definition
from linkwright.xacro.macros import Macro, MacroTable, Parameter, parse_parameters
from linkwright.xacro.plan import PREFIX
from linkwright.xmltree import Element


def define_macro(expander: Expander, site: Site) -> None:
    """Expand ``<xacro:macro name params>``: define a macro."""
    node = site.node
    expander.sweep(site)
    check_attributes(expander, node, ("name",), ("params",))
    name = node.attributes["name"]
    if name == "call":
        span = node.attribute_span("name")
        expander.fail_at(
            "XAC407",
            phrase("a macro cannot be named 'call'"),
            node,
            span,
            phrase("choose another name: 'xacro:call' is a tag of xacro"),
        )
    if "." in name:
        span = node.attribute_span("name")
        hint = phrase("a dot separates a namespace from a macro")
        expander.fail_at("XAC407", phrase("the name of the macro '{name}' has a dot", name=name), node, span, hint)
    if name.startswith(PREFIX):
        name = name[len(PREFIX) :]
        message = phrase(
            "the definition of the macro '{name}' has the prefix 'xacro:', but only calls have this prefix", name=name
        )
        expander.session.warn("XAC411", message, node.attribute_span("name"), phrase('write name="{name}"', name=name))
    try:
        parameters = parse_parameters(node.attributes.get("params", ""))
    except Fault as fault:
        fault.locate_in_attribute(node, "params")
        expander.fail(fault)
    macro = Macro(name, parameters, node)
    if len(macro.parameter_names) < len(parameters):
        names = [parameter.name for parameter in parameters]
        duplicate = next(candidate for candidate in names if names.count(candidate) > 1)
        message = phrase("the macro '{name}' declares its parameter '{twice}' twice", name=name, twice=duplicate)
        expander.session.warn("XAC413", message, node.attribute_span("params"))
    site.macros.define(name, macro)


def call_dynamically(expander: Expander, site: Site) -> None:
    """Expand ``<xacro:call macro>``: call the macro that the attribute names."""
    node = site.node
    if not node.attributes.get("macro"):
        expander.fail_at("XAC301", phrase("'xacro:call' needs the attribute 'macro'"), node, node.span())
    name = expander.text_value(node, "macro", site.scope)
    attributes = {attribute: value for attribute, value in node.attributes.items() if attribute != "macro"}
    call = Element(PREFIX + name, attributes, node.source, node.offset)
    call.children = node.children
    _MacroCall(expander, site._replace(node=call), name, name_attribute="macro").run()


def call_macro(expander: Expander, site: Site) -> None:
    """Expand ``<xacro:NAME ...>``: call a macro."""
    _MacroCall(expander, site, site.node.tag[len(PREFIX) :], name_attribute=None).run()


class _MacroCall:
    """One call of a macro.

    The arguments and then the blocks are evaluated in the caller's scope. Missing arguments receive their defaults.
    Finally, the body is expanded in a new scope.
    """

    def __init__(self, expander: Expander, site: Site, name: str, name_attribute: str | None) -> None:
        self._expander = expander
        self._site = site
        self._node = site.node
        self._name = name
        self._name_attribute = name_attribute

    def run(self) -> None:
        expander, site = self._expander, self._site
        macro, enclosing_scope, macros = self._resolve()
        scope = Scope(enclosing_scope, expander.session)
        missing = self._bind_arguments(macro, scope)
        missing = self._bind_blocks(macro, missing, scope)
        missing = self._bind_defaults(macro, missing, scope)
        if missing:
            self._report_missing_parameters(macro, missing)
        container = self._expand_body(macro, scope, MacroTable(macros))
        output = site.parent.children
        mark = expander.sweeper.sweep(output, has_followers=site.has_followers)
        expander.lift_namespaces(container, site)
        expander.splice(container, site)
        if mark:
            expander.sweeper.move_marker(output)

    # finding the macro

    def _resolve(self) -> tuple[Macro, Scope, MacroTable]:
        site, name = self._site, self._name
        definition = site.macros.find(name)
        if isinstance(definition, Macro):
            return definition, site.scope, site.macros
        *namespaces, macro_name = name.split(".")
        scope, macros = site.scope, site.macros
        for namespace in namespaces:
            entry = macros.find(namespace)
            if not isinstance(entry, MacroTable) or namespace not in scope:
                self._report_missing_macro()
            macros = entry
            scope = scope.lookup(namespace)
            if not isinstance(scope, Scope):
                self._report_missing_macro()
        definition = macros.find(macro_name) if namespaces else definition
        if not isinstance(definition, Macro):
            self._report_missing_macro()
        return definition, scope, macros

    def _report_missing_macro(self) -> NoReturn:
        node, name = self._node, self._name
        macro_names = list(self._site.macros.names())
        hint = (
            phrase("write xacro:{tag}", tag=_INTENDED_TAGS[name])
            if name in _INTENDED_TAGS
            else did_you_mean(name, macro_names)
        )
        if hint is None and macro_names:
            hint = phrase("the macros defined so far are {names}", names=joined(sorted(set(macro_names))[:10]))
        elif hint is None:
            hint = phrase("no macro is defined before this; does <xacro:include> stand above the call?")
        span = node.span() if self._name_attribute is None else node.attribute_span(self._name_attribute)
        other_definition = inactive_definition(node.source, "macro", name, used_at=node.offset) if node.source else None
        notes = () if other_definition is None else (other_definition.note,)
        if other_definition is not None and not macro_names:
            hint = other_definition.hint or phrase("move its definition above this call")
        self._expander.fail_at("XAC401", phrase("there is no macro '{name}'", name=name), node, span, hint, *notes)

    # binding the parameters

    def _bind_arguments(self, macro: Macro, scope: Scope) -> list[Parameter]:
        """Bind the attributes of the call to parameters, and return the unbound parameters."""
        expander, node, caller = self._expander, self._node, self._site.scope
        attributes = node.attributes
        for name, text in attributes.items():
            if name not in macro.parameter_names:
                self._report_unknown_parameter(macro, name)
            value = expander.value(node, name, caller) if "$" in text else text
            warn_of_global(expander, node, name, name)
            scope.define(name, value)
        unbound = [parameter for parameter in macro.parameters if parameter.name not in attributes]
        if len(macro.parameter_names) < len(
            macro.parameters
        ):  # of two parameters with one name, only the first is bound
            seen_names: set[str] = set()
            for parameter in macro.parameters:
                if parameter.name in seen_names and parameter.name in attributes:
                    unbound.append(parameter)
                seen_names.add(parameter.name)
        return unbound

    def _bind_blocks(self, macro: Macro, unbound: list[Parameter], scope: Scope) -> list[Parameter]:
        if not unbound and not self._node.children:
            return unbound
        blocks = self._expander.expand_blocks(self._node, self._site.scope, self._site.macros).elements()
        remaining = []
        for parameter in unbound:
            if not parameter.is_block:
                remaining.append(parameter)
                continue
            block = next(blocks, None)
            if block is None:
                self._report_missing_block(macro, parameter)
            scope.bind(parameter.name, block)
        surplus_block = next(blocks, None)
        if surplus_block is not None:
            self._report_unused_block(macro, surplus_block)
        return remaining

    def _bind_defaults(self, macro: Macro, unbound: list[Parameter], scope: Scope) -> list[Parameter]:
        remaining = []
        for parameter in unbound:
            if parameter.forward or parameter.default is not None:
                scope.define(parameter.name, self._evaluate_default(macro, parameter))
            else:
                remaining.append(parameter)
        return remaining

    def _evaluate_default(self, macro: Macro, parameter: Parameter) -> Any:
        caller, node = self._site.scope, self._node
        session = self._expander.session
        session.current_node, session.current_attribute = macro.body, "params"
        try:
            if parameter.forward and parameter.name in caller:
                return caller.lookup(parameter.name)
            if parameter.default is None:
                message = phrase(
                    "there is no property '{name}' to forward to the macro '{macro_name}'",
                    name=parameter.name,
                    macro_name=macro.name,
                )
                hint = phrase('define it before the call, or write {name}="..."', name=parameter.name)
                fault = Fault("XAC409", message, hint=hint)
                fault.notes.append(self._make_definition_note(macro, parameter))
                fault.locate_at(node)
                raise fault
            if "$" not in parameter.default:
                return parameter.default
            return session.evaluate(parameter.default, caller)
        except Fault as fault:
            if fault.span is None:
                if fault.start is None and parameter.default is not None:
                    fault.start, fault.end = 0, len(parameter.default)
                fault.locate_in_attribute(macro.body, "params", parameter.default_start)
                fault.next_note = phrase("the default of '{name}' is used by this call", name=parameter.name)
                fault.locate_at(node)
            self._expander.fail(fault)

    # the body

    def _expand_body(self, macro: Macro, scope: Scope, macros: MacroTable) -> Element:
        expander, session = self._expander, self._expander.session
        outer_frame = session.frame
        expander.enter(Frame(macro.name, self._node, outer_frame))
        try:
            body = macro.body
            container = Container(body.tag)
            for name, value in body.attributes.items():  # xacro evaluates `params` here, too, and fails if it cannot
                if name == "xmlns:xacro" or ("$" not in value and not name.startswith("xmlns:")):
                    continue
                evaluated_value = expander.text_value(body, name, scope)
                if name.startswith("xmlns:"):
                    container.attributes[name] = evaluated_value
            expander.expand_children(body, container, scope, macros)
        finally:
            session.frame = outer_frame
        return container

    # mistakes

    def _report_unknown_parameter(self, macro: Macro, name: str) -> NoReturn:
        node = self._node
        parameter_names = [parameter.name for parameter in macro.parameters if not parameter.is_block]
        hint = did_you_mean(name, [candidate for candidate in parameter_names if candidate not in node.attributes])
        if f"{name}," in parameter_names:
            hint = phrase("separate the parameters of the macro with spaces, not commas")
        if hint is None and f"*{name}" in {parameter.name.replace("**", "*") for parameter in macro.parameters}:
            hint = phrase("'{name}' is a block: write it as an element inside the call", name=name)
        if hint is None:
            hint = (
                phrase("its parameters are {known}", known=joined(parameter_names))
                if parameter_names
                else phrase("it has no parameters")
            )
        message = phrase("the macro '{name}' has no parameter '{other_name}'", name=macro.name, other_name=name)
        span = attribute_name_span(node, name)
        self._expander.fail_at("XAC402", message, node, span, hint, self._make_definition_note(macro))

    def _report_missing_parameters(self, macro: Macro, missing: list[Parameter]) -> None:
        node = self._node
        duplicate_names = [parameter.name for parameter in missing if parameter.name in node.attributes]
        if duplicate_names:
            message = phrase(
                "the macro '{name}' declares its parameter '{twice}' twice", name=macro.name, twice=duplicate_names[0]
            )
            span = node.span()
            self._expander.fail_at("XAC408", message, node, span, None, self._make_definition_note(macro, missing[0]))
        message = counted(
            "the call of the macro '{name}' lacks its parameter {parameters}",
            "the call of the macro '{name}' lacks its parameters {parameters}",
            len(missing),
            name=macro.name,
            parameters=quoted_names(parameter.name for parameter in missing),
        )
        hint = phrase("write {form}", form=" ".join(f'{parameter.name}="..."' for parameter in missing))
        if not all(parameter.name.lstrip("*").isidentifier() for parameter in missing):
            hint = phrase("a default that contains spaces ends at the first space; put it in quotes")
        note = self._make_definition_note(macro, missing[0])
        self._expander.fail_at("XAC403", message, node, node.span(), hint, note)

    def _report_missing_block(self, macro: Macro, parameter: Parameter) -> NoReturn:
        node = self._node
        name = parameter.name.lstrip("*")
        message = phrase(
            "the call of the macro '{name}' lacks an element for its block '{other_name}'",
            name=macro.name,
            other_name=name,
        )
        hint = phrase("write the element between the tags of the call")
        note = self._make_definition_note(macro, parameter)
        self._expander.fail_at("XAC404", message, node, node.span(), hint, note)

    def _report_unused_block(self, macro: Macro, block: Element) -> None:
        count = sum(parameter.is_block for parameter in macro.parameters)
        message = phrase(
            "the macro '{name}' has no block parameter for the element <{tag}>", tag=block.tag, name=macro.name
        )
        hint = counted("it takes one block", "it takes {count} blocks", count) if count else phrase("it takes no block")
        note = self._make_definition_note(macro)
        self._expander.fail_at("XAC405", message, block, block.span(), hint, note)

    def _make_definition_note(self, macro: Macro, parameter: Parameter | None = None) -> Note:
        body = macro.body
        if parameter is not None:
            fault = Fault("", phrase("a parameter"), parameter.start, parameter.start + len(parameter.name))
            fault.locate_in_attribute(body, "params")
            return Note(phrase("'{name}' is declared here", name=parameter.name), fault.span)
        return Note(phrase("the macro '{name}' is defined here", name=macro.name), body.span())


_INTENDED_TAGS = {"insert": "insert_block", "block": "insert_block", "prop": "property", "else": "unless", "elif": "if"}
