"""Expand the valid parts of a description that has errors.

`linkwright.xacro.expand` stops at the first error after which the result is not reliable. An editor needs the rest of
the result, too. Here, a tag that fails is left out, and the walk continues. Two rules keep the result correct:

- **Gaps are known.** An element is left out of the result if its attribute or text failed, or if a tag inside was
  left out. The enclosing elements are also left out.
- **Consequences are not reported.** A part that is left out may have defined names. After this part, a missing name
  is not an error, and a value may differ from the intended one. Therefore, each part that depends on a name or value
  is also left out, without a message.
"""

from __future__ import annotations

from collections.abc import Mapping

from linkwright.diagnostics import Diagnostic, LinkwrightError
from linkwright.loading.deferred import lazy_pattern
from linkwright.xacro.expander import Directive, Expander, Site, is_final
from linkwright.xacro.expansion import Expansion
from linkwright.xacro.expressions.scope import Scope
from linkwright.xacro.faults import Fault
from linkwright.xacro.limits import recursion_limit_for
from linkwright.xacro.macros import MacroTable
from linkwright.xacro.plan import PREFIX, plan_of
from linkwright.xacro.session import Inputs, Session, read_main_document
from linkwright.xacro.tags.directives import DIRECTIVES
from linkwright.xacro.tags.macro_calls import call_macro
from linkwright.xmltree import Document, Element, Text

_GAP = "\0"
"""Name of the attribute, and content of the text, that mark a gap. XML allows neither."""
_VALUE_INDEPENDENT_TAGS = frozenset({"xacro:arg", "xacro:insert_block", "xacro:macro", "xacro:property"})
"""Tags whose effect does not depend on the values of properties or arguments."""
_FIXED_SUBSTITUTION = lazy_pattern(r"\$\((?:find|env|optenv|cwd|dirname)\b[^()$]*\)")
"""Substitutions whose values do not depend on properties or arguments."""
_NAME_DEFINING_TAGS = frozenset({"xacro:arg", "xacro:include", "xacro:macro", "xacro:property"})
"""Tags that define names for later tags."""
_SELF_CONTAINED_CODES = frozenset({"XAC101", "XAC102", "XAC301", "XAC304", "XAC407", "XAC412"})
"""Codes of mistakes in the text of a tag or expression, which do not depend on the values of names."""
_DEFINITION_CODES = frozenset({"XAC402", "XAC403", "XAC404", "XAC405", "XAC408", "XAC409"})
"""Codes of mistakes in a call that the macro definition may have caused. Only the first such call is reported."""
_SCOPED_PROPERTY = lazy_pattern(r"""<xacro:property\s[^>]*?\bscope\s*=""")


def expand_parts(inputs: Inputs, error: LinkwrightError) -> Expansion:
    """Expand a description without the parts that have errors.

    Args:
        inputs: the inputs of the expansion.
        error: the error of the complete expansion.

    Returns:
        An expansion whose `problems` describe the errors. Its document contains those children of the root that would
        be the same in the complete expansion.

    Raises:
        LinkwrightError: `error`, if there is no result because the file is not XML or because the walk had to stop.
    """
    if any(map(is_final, error.diagnostics)):
        raise error
    session = inputs.create_session()
    try:
        document = read_main_document(session, inputs.text)
    except LinkwrightError:
        raise error from None
    expander = _PartsExpander(session)
    with recursion_limit_for(inputs.limits):
        expanded_document = expander.walk(document)
    if expanded_document is None:
        raise error
    trusted_warnings = session.diagnostics[: expander.trusted_warning_count]
    session.close()
    return Expansion(
        _without_gaps(expanded_document),
        session.dependencies,
        session.arguments,
        tuple(trusted_warnings),
        inputs,
        expander.errors,
    )


class _OmittedPartError(Exception):
    """Raised when a tag depends on a part that was left out."""


class _PartsExpander(Expander):
    """An expander that leaves out parts with errors.

    Attributes:
        is_trusted: whether all names still have the values of the complete expansion.
        trusted_warning_count: the number of warnings that were recorded while `is_trusted` was true, or None for all.
    """

    def __init__(self, session: Session) -> None:
        directives: Mapping[str, Directive] = {
            tag: self._skip_on_failure(directive) for tag, directive in DIRECTIVES.items()
        }
        super().__init__(session, directives, self._skip_on_failure(call_macro))
        self.is_trusted = True
        self.trusted_warning_count: int | None = None
        self._failures = 0
        self._reported_definitions: set[tuple[str, str]] = set()

    def attributes(self, node: Element, scope: Scope) -> dict[str, str]:
        """Return the attributes that could be evaluated, and a gap mark if others could not."""
        failures_before = self._failures
        result = super().attributes(node, scope)
        if self._failures > failures_before or not self.is_trusted:
            for name in plan_of(node).evaluated:
                if "$" in node.attributes[name]:
                    result[_GAP] = ""
                    if result[name] == node.attributes[name]:
                        del result[name]
        return result

    def expand_blocks(self, node: Element, scope: Scope, macros: MacroTable) -> Element:
        """Return the expanded content of a macro call.

        Raises:
            _OmittedPartError: if the content has a gap.
        """
        container = super().expand_blocks(node, scope, macros)
        if _GAP in container.attributes:
            raise _OmittedPartError
        return container

    def record_fault(self, fault: Fault) -> None:
        """Record the error of an attribute or text, unless an earlier gap may have caused it."""
        self._failures += 1
        diagnostic = self._to_diagnostic(fault)
        if self.is_trusted or diagnostic.code in _SELF_CONTAINED_CODES or is_final(diagnostic):
            self.record_error(diagnostic)

    def _expand_text(self, node: Text, scope: Scope) -> Text:
        failures_before = self._failures
        text = super()._expand_text(node, scope)
        if self._failures == failures_before and (self.is_trusted or text is node):
            return text
        return Text(_GAP, node.source, node.offset)

    def _skip_on_failure(self, directive: Directive) -> Directive:
        """Return a directive that leaves a gap mark in the parent if the given directive fails."""

        def expand(expander: Expander, site: Site) -> None:
            session, nesting = self.session, self._nesting
            frame, file = session.frame, session.file
            reported_diagnostics: list[Diagnostic] = []
            if self.is_trusted or not _depends_on_values(site.node):
                try:
                    directive(expander, site)
                except LinkwrightError as error:
                    if self.has_too_many_errors or any(map(is_final, error.diagnostics)):
                        raise
                    reported_diagnostics = [
                        diagnostic for diagnostic in error.diagnostics if self._is_reported(diagnostic, site.node)
                    ]
                except _OmittedPartError:
                    pass
                else:
                    return
            self._nesting, session.frame, session.file = nesting, frame, file
            site.parent.attributes[_GAP] = ""
            if self._may_define_names(site.node):
                self._stop_trusting()
            for diagnostic in reported_diagnostics:
                self.record_error(diagnostic)

        return expand

    def _is_reported(self, diagnostic: Diagnostic, node: Element) -> bool:
        if diagnostic.code in _DEFINITION_CODES:
            if (diagnostic.code, diagnostic.message) in self._reported_definitions:
                return False
            self._reported_definitions.add((diagnostic.code, diagnostic.message))
        if self.is_trusted or diagnostic.code in _SELF_CONTAINED_CODES:
            return True
        return diagnostic.code.startswith(("XML", "PKG")) and node.tag == "xacro:include"

    def _stop_trusting(self) -> None:
        if self.is_trusted:
            self.is_trusted = False
            self.trusted_warning_count = len(self.session.diagnostics)

    def _may_define_names(self, node: Element) -> bool:
        """Return whether a tag that was left out might have defined names for later tags."""
        tags = {element.tag for element in node.walk()}
        if tags & _NAME_DEFINING_TAGS:
            return True
        has_macro_calls = any(tag.startswith(PREFIX) and tag not in DIRECTIVES for tag in tags)
        return (has_macro_calls or "xacro:call" in tags) and self._macros_define_outside()

    def _macros_define_outside(self) -> bool:
        """Return whether a macro in the files read so far defines properties in its caller's scope."""
        for path in self.session.dependencies:
            try:
                source = self.session.read(path).source
            except LinkwrightError:
                continue  # a YAML file, or a file that is missing
            if source is not None and _SCOPED_PROPERTY.search(source.text):
                return True
        return False


def _depends_on_values(node: Element) -> bool:
    """Return whether the effect of a tag depends on the values of properties or arguments.

    Definitions do not depend on values until they are used.
    """
    if node.tag not in DIRECTIVES or node.tag in _VALUE_INDEPENDENT_TAGS:
        return False
    return any("$" in _FIXED_SUBSTITUTION.sub("", value) for value in node.attributes.values())


def _without_gaps(document: Document) -> Document:
    """Return the document with only those children of the root that have no gap."""
    root = document.root
    root.attributes.pop(_GAP, None)
    root.children = [child for child in root.children if not (isinstance(child, Element) and _has_gap(child))]
    root.children = [child for child in root.children if not _is_gap(child)]
    return document


def _has_gap(element: Element) -> bool:
    return any(_GAP in inner.attributes or any(map(_is_gap, inner.children)) for inner in element.walk())


def _is_gap(node: object) -> bool:
    return isinstance(node, Text) and node.data == _GAP
