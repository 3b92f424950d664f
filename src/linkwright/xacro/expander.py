"""The expander: one walk over the source tree in document order, which writes a new tree.

Source trees are never changed, so each file is parsed only once. The new tree shares texts and comments without
expressions with the source tree. Every element of the result has its position in the source, and the macro calls and
includes that contain it.

A comment directly above a property, macro, argument, include, condition or macro call describes this tag, and is
removed with it. The same comments are removed as in ros/xacro: all comments above the tag that are separated by blank
text with at most one newline. A marker is inserted there, at which the next such removal stops. A document has only
one marker, which moves. The marker is whitespace, so its only visible effect is that an element with text and a
marker is no longer written on one line.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping

from linkwright.diagnostics import Diagnostic, LinkwrightError, Note, Phrase, Span, did_you_mean, nearest, phrase
from linkwright.loading.lean_dataclasses import NamedTuple
from linkwright.loading.lean_typing import NoReturn
from linkwright.xacro.expressions.scope import Scope
from linkwright.xacro.faults import Fault, Frame, attribute_name_span, trail
from linkwright.xacro.limits import LONG_TEXT_LENGTH
from linkwright.xacro.macros import MacroTable
from linkwright.xacro.plan import (
    COMMENT,
    COPY,
    ELEMENT,
    KEEP,
    TAG,
    TEXT,
    Plan,
    Run,
    plan_of,
    steps_of,
)
from linkwright.xacro.session import Session
from linkwright.xmltree import Comment, Document, Element, Node, Text
from linkwright.xmltree.nodes import LazyCopy


class CommentSweeper:
    """A remover of the comments above expanded tags in one document."""

    def __init__(self) -> None:
        self._marker = Text("\n\n")
        self._marker_siblings: list[Node] | None = None

    def sweep(self, siblings: list[Node], *, has_followers: bool) -> bool:
        """Remove the comments directly above a tag from the end of a list of siblings.

        Args:
            siblings: the expanded nodes above the tag.
            has_followers: whether other nodes follow the tag.

        Returns:
            Whether the caller must call `move_marker` after expanding the tag.
        """
        index = len(siblings) - 1
        while index >= 0:
            node = siblings[index]
            if isinstance(node, Text) and node.data.isspace() and not node.cdata and node.data.count("\n") <= 1:
                index -= 1
            if index >= 0 and isinstance(siblings[index], Comment):
                del siblings[index]
                index -= 1
            else:
                return has_followers
        return False

    def move_marker(self, siblings: list[Node]) -> None:
        """Move the marker to the end of a list of siblings."""
        marked_siblings = self._marker_siblings
        if marked_siblings is not None:
            for index in range(len(marked_siblings) - 1, -1, -1):
                if marked_siblings[index] is self._marker:
                    del marked_siblings[index]
                    break
        siblings.append(self._marker)
        self._marker_siblings = siblings

    def on_nodes_moved(self, old: list[Node], new: list[Node]) -> None:
        """Update the marker after the nodes of a list were moved to the end of another list."""
        if self._marker_siblings is old:
            self._marker_siblings = new


_MAX_ERRORS = 20


class Container(Element):
    """A temporary element that receives the expansion of a tag.

    The element itself is not part of the result.
    """

    __slots__ = ()


class Site(NamedTuple):
    """A xacro tag and its context.

    Attributes:
        node: the tag.
        parent: the element that receives the expansion of the tag.
        scope: the properties that are visible at the tag.
        macros: the macros that are visible at the tag.
        has_followers: whether other nodes follow the tag.
    """

    node: Element
    parent: Element
    scope: Scope
    macros: MacroTable
    has_followers: bool


Directive = Callable[["Expander", Site], None]
"""A function that expands a xacro tag."""


class Expander:
    """The expander of one document.

    Args:
        session: the state of the expansion.
        directives: the functions that expand xacro's own tags, by tag.
        call: the function that expands macro calls: all other tags with the xacro prefix.

    Attributes:
        session: the state of the expansion.
        sweeper: the sweeper that removes comments above xacro tags.
    """

    def __init__(self, session: Session, directives: Mapping[str, Directive], call: Directive) -> None:
        self.session = session
        self._directives = directives
        self._call = call
        self.sweeper = CommentSweeper()
        self.unwritable: dict[tuple[int, str], tuple[Element, Diagnostic]] = {}
        """The elements and the warnings about attribute values, by element ID and attribute name."""
        self._errors: list[Diagnostic] = []
        self._nesting = 0
        self._max_nesting = session.limits.nesting
        self._root: Element | None = None

    def expand_document(self, document: Document) -> Document:
        """Return the expansion of a document.

        Raises:
            LinkwrightError: the errors found, each with its location.
        """
        expanded_nodes = self.walk(document)
        if expanded_nodes is None or self._errors:
            raise LinkwrightError(*self.errors, *self.session.diagnostics)
        return expanded_nodes

    @property
    def errors(self) -> tuple[Diagnostic, ...]:
        """The errors found, without repetitions."""
        return tuple(_without_repeats(self._errors))

    def walk(self, document: Document) -> Document | None:
        """Return the expansion of a document despite errors, or None if the walk had to stop.

        The errors are recorded in `errors`.
        """
        root = document.root
        container = Container("")
        target = root.attributes.get("xacro:targetNamespace")
        if target:
            root = _with_attribute(root, "xmlns", target)
        self._root = root
        try:
            scope = Scope(self.session.globals, self.session)
            self.expand_element(root, container.children, scope, MacroTable())
        except LinkwrightError as error:
            self._errors += error.diagnostics
            return None
        except RecursionError:
            self._errors.append(self._make_nesting_diagnostic())
            return None
        expanded_node = container.children[0]
        assert isinstance(expanded_node, Element), "the expansion of an ordinary element is an element"
        result = Document(expanded_node, document.source)
        result.prolog, result.epilog = list(document.prolog), list(document.epilog)
        result.doctype, result.doctype_index = document.doctype, document.doctype_index
        return result

    # the walk

    def expand_children(self, node: Element, parent: Element, scope: Scope, macros: MacroTable) -> None:
        """Expand the children of an element, and append the result to a parent.

        Raises:
            LinkwrightError: an error after which the walk cannot continue.
        """
        output, session, directives = parent.children, self.session, self._directives
        evaluate_comments = False
        self._nesting += 1
        if self._nesting > self._max_nesting:
            self._fail_too_deep(node)
        plan = node.plan
        steps = plan.steps if isinstance(plan, Plan) else None
        for action, item, flag in steps_of(node) if steps is None else steps:
            if action == KEEP:
                session.budget.elements -= len(item) >> 3
                output += item
            elif action == COPY:
                self._copy(item, output)
            elif action == ELEMENT:
                self.expand_element(item, output, scope, macros)
            elif action == TAG:
                session.budget.elements -= 2
                session.current_node, session.current_attribute = item, None
                directives.get(item.tag, self._call)(self, Site(item, parent, scope, macros, flag))
            elif action == TEXT:
                text = self._expand_text(item, scope)
                output.append(text)
                if text.data and not text.cdata and not text.data.isspace():
                    evaluate_comments = False
            elif action == COMMENT:
                output.append(self._expand_comment(item, scope) if evaluate_comments else item)
            else:
                evaluate_comments = flag
        self._nesting -= 1

    def _copy(self, run: Run, output: list[Node]) -> None:
        """Append adjacent nodes that need no expansion to a list of output nodes."""
        budget, frame = self.session.budget, self.session.frame
        if run.size > budget.elements or self._nesting + run.height > self._max_nesting:
            self._copy_singly(run, output)
            return
        budget.elements -= run.size
        output += [LazyCopy(node, frame) if isinstance(node, Element) else node for node in run.nodes]

    def _copy_singly(self, run: Run, output: list[Node]) -> None:
        """Append the nodes one by one, so that an error names the element that exceeds a limit."""
        budget, scope, macros = self.session.budget, Scope(None, self.session), MacroTable()
        uncounted_nodes = 0
        for node in run.nodes:
            if isinstance(node, Element):
                budget.elements -= uncounted_nodes >> 3
                self.expand_element(node, output, scope, macros)
                uncounted_nodes = 0
            else:
                output.append(node)
                uncounted_nodes += 1
        budget.elements -= uncounted_nodes >> 3

    def expand_element(self, node: Element, output: list[Node], scope: Scope, macros: MacroTable) -> None:
        """Expand an ordinary element and append it to the output.

        The attributes are evaluated before the content.
        """
        session = self.session
        plan = node.plan
        if not isinstance(plan, Plan):
            plan = plan_of(node)
        if plan.size and plan.size <= session.budget.elements and self._nesting + plan.height <= self._max_nesting:
            session.budget.elements -= plan.size
            output.append(LazyCopy(node, session.frame))
            return
        budget = session.budget
        budget.elements -= 1
        if budget.elements < 0:
            self._fail_too_many(node)
        attributes = self.attributes(node, scope) if plan.evaluated else plan.attributes.copy()
        element = Element(node.tag, attributes, node.source, node.offset, session.frame)
        output.append(element)
        if plan.steps or plan.steps is None:
            self.expand_children(node, element, scope, macros)

    def expand_blocks(self, node: Element, scope: Scope, macros: MacroTable) -> Element:
        """Return a container with the expanded content of a macro call."""
        container = Container(node.tag)
        if node.children:
            self.expand_children(node, container, scope, macros)
        return container

    def attributes(self, node: Element, scope: Scope) -> dict[str, str]:
        """Return the evaluated attributes of an element, without attributes with the xacro prefix."""
        session, plan = self.session, plan_of(node)
        result = plan.attributes.copy()
        for name in plan.evaluated:
            value = result[name]
            if "$" in value:
                session.current_node, session.current_attribute = node, name
                try:
                    value = result[name] = session.evaluate_text(value, scope)
                except Fault as fault:
                    fault.locate_in_attribute(node, name)
                    if fault.code == "XAC211" and node is self._root:
                        fault.hint = phrase(
                            "the attributes of the root are evaluated before its content; write "
                            '<xacro:attribute name="{name}" value="{value}"/> inside it instead',
                            name=name,
                            value=value,
                        )
                    self.record_fault(fault)
            if len(value) > LONG_TEXT_LENGTH:
                self._charge_text(node, value)
        return result

    def expand_tag(self, site: Site) -> None:
        """Expand a xacro tag or a macro call."""
        self.session.current_node, self.session.current_attribute = site.node, None
        self._directives.get(site.node.tag, self._call)(self, site)

    def _expand_text(self, node: Text, scope: Scope) -> Text:
        if len(node.data) > LONG_TEXT_LENGTH:
            self._charge_text(node, node.data)
        if node.cdata or "$" not in node.data:
            return node
        self.session.current_node, self.session.current_attribute = node, None
        try:
            data = self.session.evaluate_text(node.data, scope)
        except Fault as fault:
            fault.locate_in_text(node)
            self.record_fault(fault)
            data = ""
        if len(data) > LONG_TEXT_LENGTH:
            self._charge_text(node, data)
        return Text(data, node.source, node.offset)

    def _expand_comment(self, node: Comment, scope: Scope) -> Comment:
        if "$" not in node.data:
            return node
        try:
            data = self.session.evaluate_text(node.data, scope)
            _check_comment(data)
        except Fault as fault:
            content = Text(node.data, node.source, node.offset + len("<!--"))
            if fault.start is None:
                fault.start, fault.end = 0, len(node.data)
            fault.locate_in_text(content)
            self.record_fault(fault)
            data = ""
        return Comment(data, node.source, node.offset)

    # helpers for directives

    def value(self, node: Element, name: str, scope: Scope) -> object:
        """Return the evaluated value of an existing attribute, with its type."""
        text = node.attributes[name]
        if "$" not in text:
            return text
        self.session.current_node, self.session.current_attribute = node, name
        try:
            return self.session.evaluate(text, scope)
        except Fault as fault:
            fault.locate_in_attribute(node, name)
            self.fail(fault)

    def text_value(self, node: Element, name: str, scope: Scope) -> str:
        """Return the evaluated value of an existing attribute as text."""
        return self.output_text(node, name, self.value(node, name, scope))

    def output_text(self, node: Element, name: str, value: object) -> str:
        """Return the text that xacro writes for the value of an attribute."""
        try:
            return self.session.output_text(node.attributes[name], value)
        except Fault as fault:
            fault.locate_in_attribute(node, name)
            self.fail(fault)

    def sweep(self, site: Site) -> None:
        """Remove the comments above a tag that produces no output."""
        output = site.parent.children
        if self.sweeper.sweep(output, has_followers=site.has_followers):
            self.sweeper.move_marker(output)

    def splice(self, container: Element, site: Site) -> None:
        """Replace a tag with the content of a container.

        The attributes of the container, which `xacro:attribute` sets, become attributes of the parent.
        """
        output = site.parent.children
        output.extend(container.children)
        self.sweeper.on_nodes_moved(container.children, output)
        for name, value in container.attributes.items():
            if not name.startswith("xmlns:"):
                site.parent.attributes[name] = value

    def lift_namespaces(self, container: Element, site: Site) -> None:
        """Declare the namespace prefixes of an included root or of a macro on the parent.

        A prefix that the parent already declares with another URI causes a warning.
        """
        attributes = site.parent.attributes
        for name, value in container.attributes.items():
            if not name.startswith("xmlns:"):
                continue
            if attributes.setdefault(name, value) != value:
                message = phrase(
                    "'{name}' is declared as '{value}' here, but as '{other_value}' in an enclosing element",
                    name=name,
                    value=value,
                    other_value=attributes[name],
                )
                self.session.warn("XAC504", message, site.node.span())

    def enter(self, frame: Frame) -> None:
        """Enter a macro call or an include.

        Raises:
            LinkwrightError: XAC601 if calls and includes are nested too deeply; XAC602 if the expansion creates too
                many elements; XAC606 if it takes too long.
        """
        limit = self.session.limits.depth
        if frame.depth > limit:
            message = phrase("macro calls and includes are nested more than {limit} levels deep", limit=limit)
            fault = Fault("XAC601", message)
            fault.hint = phrase("end the recursion with xacro:if or xacro:unless")
            fault.locate_at(frame.site)
            self.fail(fault)
        try:
            self.session.budget.charge_macro()
        except Fault as fault:
            fault.locate_at(frame.site)
            self.fail(fault)
        self.session.frame = frame

    def _charge_text(self, node: Element | Text, text: str) -> None:
        try:
            self.session.budget.charge_text(len(text))
        except Fault as fault:
            if isinstance(node, Element):
                fault.locate_at(node)
            else:
                fault.locate_in_text(node)
            self.fail(fault)

    def _fail_too_many(self, node: Element) -> NoReturn:
        fault = self.session.budget.too_many_elements_fault()
        fault.locate_at(node)
        self.fail(fault)

    def _fail_too_deep(self, node: Element) -> NoReturn:
        fault = Fault("XAC601", phrase("elements are nested more than {count} levels deep", count=self._max_nesting))
        fault.locate_at(next(node.elements(), node))
        self.fail(fault)

    # errors

    def _make_nesting_diagnostic(self) -> Diagnostic:
        node = self.session.current_node
        span = node.span() if isinstance(node, Element) else None
        message = phrase("the description is nested too deeply")
        return Diagnostic(
            "XAC601", message, span, notes=trail(self.session.frame), source=node.source if node else None
        )

    def record_fault(self, fault: Fault) -> None:
        """Record an error after which the walk can continue.

        Raises:
            LinkwrightError: if there are too many errors, or if this error ends every walk.
        """
        self.record_error(self._to_diagnostic(fault))

    def record_error(self, diagnostic: Diagnostic) -> None:
        """Record the diagnostic of an error after which the walk can continue.

        Raises:
            LinkwrightError: if there are too many errors, or if this error ends every walk.
        """
        if is_final(diagnostic):
            raise LinkwrightError(diagnostic)
        self._errors.append(diagnostic)
        if self.has_too_many_errors:
            raise LinkwrightError(diagnostic)

    @property
    def has_too_many_errors(self) -> bool:
        """Whether there are so many errors that reporting more would not help the user."""
        return len(_without_repeats(self._errors)) >= _MAX_ERRORS

    def fail(self, fault: Fault) -> NoReturn:
        """Raise the error of a fault that has a location."""
        raise LinkwrightError(self._to_diagnostic(fault)) from None

    def fail_at(
        self, code: str, message: Phrase, node: Element, span: Span | None, hint: Phrase | None = None, *notes: Note
    ) -> NoReturn:
        """Raise an error at a location of a node."""
        notes = (*notes, *trail(self.session.frame))
        raise LinkwrightError(Diagnostic(code, message, span, notes=notes, hint=hint, source=node.source))

    def _to_diagnostic(self, fault: Fault) -> Diagnostic:
        other_definition = fault.find_inactive_definition()
        if other_definition is not None and other_definition.hint is not None:
            fault.hint = other_definition.hint
        elif other_definition is not None and fault.hint is None:
            fault.hint = phrase("move its definition above this line, and out of any macro that ends before it")
        definition_notes = () if other_definition is None else (other_definition.note,)
        notes = (*fault.notes, *definition_notes, *trail(self.session.frame))
        return Diagnostic(fault.code, fault.message, fault.span, notes=notes, hint=fault.hint, source=fault.source)


def is_final(diagnostic: Diagnostic) -> bool:
    """Return whether an error ends every walk, such as an exceeded expansion limit.

    An error that the description itself raises with ``xacro.fatal`` also ends every walk.
    """
    return diagnostic.code.startswith("XAC6") or diagnostic.code == "XAC701"


def _check_comment(data: str) -> None:
    if "--" in data or data.endswith("-"):
        raise Fault("XAC311", phrase("the comment would contain '--': '{comment}'", comment=data.strip()))


def _with_attribute(element: Element, name: str, value: str) -> Element:
    copy = Element(element.tag, {**element.attributes, name: value}, element.source, element.offset)
    copy.children = element.children
    return copy


def _without_repeats(diagnostics: list[Diagnostic]) -> list[Diagnostic]:
    """Return the diagnostics without duplicates.

    Each call of a macro reports the errors of its body again.
    """
    unique: dict[tuple[str, str, Span | None], Diagnostic] = {}
    for diagnostic in diagnostics:
        unique.setdefault((diagnostic.code, diagnostic.message, diagnostic.span), diagnostic)
    return list(unique.values())


def check_attributes(expander: Expander, node: Element, required: tuple[str, ...], optional: tuple[str, ...]) -> None:
    """Check that a tag has its required attributes, and warn about unknown attributes.

    Raises:
        LinkwrightError: XAC301 if a required attribute is missing.
    """
    attributes = node.attributes
    for name in required:
        if name not in attributes:
            similar_names = nearest(name, [attribute for attribute in attributes if attribute not in optional])
            hint = (
                phrase("write {name}=\"...\" for '{similar_name}'", name=name, similar_name=similar_names[0])
                if similar_names
                else phrase('write {name}="..."', name=name)
            )
            expander.fail_at(
                "XAC301",
                phrase("'{tag}' needs the attribute '{name}'", tag=node.tag, name=name),
                node,
                node.span(),
                hint,
            )
    if len(attributes) == len(required):
        return
    if optional and attributes.keys() <= {*required, *optional}:
        return
    for name in attributes:
        if name in required or name in optional or name.startswith("xmlns:"):
            continue
        message = phrase("'{tag}' does not accept the attribute '{name}'", tag=node.tag, name=name)
        correction = did_you_mean(name, required + optional)
        expander.session.warn("XAC302", message, attribute_name_span(node, name), correction)


def warn_of_global(expander: Expander, node: Element, name: str, attribute: str) -> None:
    """Warn if a definition hides a name that xacro provides."""
    if name in expander.session.globals.values:
        message = phrase("'{name}' is a name that xacro provides, and is redefined here", name=name)
        span = node.attribute_span(attribute) if attribute == "name" else attribute_name_span(node, attribute)
        expander.session.warn("XAC306", message, span)
