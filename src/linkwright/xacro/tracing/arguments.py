"""The arguments of a description, found even if it cannot be expanded without them.

The file is expanded with a session in which no argument is missing: a missing argument gets the default that some
file declares, or else an empty string, and is recorded as required. All files that were read are then searched,
including branches that were not taken and macros that were not called. If the expansion did not finish, the includes
that it did not reach are read, too, as far as their names are known.
"""

from __future__ import annotations

import re
from collections.abc import Iterator, Mapping
from dataclasses import dataclass, field, replace

from linkwright.diagnostics import Diagnostic, LinkwrightError, Severity, Span, did_you_mean, phrase
from linkwright.loading.deferred import lazy_pattern
from linkwright.loading.lean_typing import Any
from linkwright.xacro.expander import Directive, Expander, Site
from linkwright.xacro.expressions.scope import Scope
from linkwright.xacro.faults import Fault, attribute_span, text_part_span
from linkwright.xacro.session import Inputs, read_main_document
from linkwright.xacro.tags.directives import DIRECTIVES
from linkwright.xacro.tracing.traced import TracedSession, expand_traced
from linkwright.xmltree import Document, Element, Text

_MAX_FILES = 1_000
_ARGUMENT_USE = lazy_pattern(
    r"\$\(\s*arg\s+(?P<plain>[^\s()$]+)\s*\)|\bxacro\.arg\(\s*(['\"])(?P<called>[^'\"]*)\2\s*\)"
)


@dataclass(frozen=True, slots=True)
class Argument:
    """An argument of a description.

    Attributes:
        name: the name of the argument.
        default: the unevaluated default, or None if the files do not declare one.
        span: the location of the declaration, or of the first use if no file declares the argument.
        required: whether the description cannot be expanded without the argument. An argument may be required despite
            its default, because the attributes of the root are evaluated before any declaration.
        used: whether any text uses the argument.
        value: the value with the passed arguments, or None if it is not known.
        is_given: whether the argument was passed.
    """

    name: str
    default: str | None
    span: Span | None
    required: bool
    used: bool = True
    value: str | None = None
    is_given: bool = False


@dataclass(frozen=True, slots=True)
class Arguments:
    """The arguments of a description, as found by `examine_arguments`.

    Attributes:
        arguments: the arguments, declared arguments first.
        unused_warnings: a warning for each passed argument that no file declares or uses.
        problems: the errors that stopped the expansion. If there are any, `arguments` may be incomplete.
    """

    arguments: tuple[Argument, ...]
    unused_warnings: tuple[Diagnostic, ...]
    problems: tuple[Diagnostic, ...]


def examine_arguments(inputs: Inputs) -> Arguments:
    """Return the arguments of a description, with warnings about unused passed arguments.

    Raises:
        LinkwrightError: if the file cannot be read or is not XML.
    """
    session = _ArgumentSession(inputs)
    main = read_main_document(session, inputs.text)
    session.documents[inputs.name] = main
    session.record_defaults(main)
    problems: tuple[Diagnostic, ...] = ()
    directives: dict[str, Directive] = {**DIRECTIVES, "xacro:arg": session.declare}
    try:
        expand_traced(inputs, session, directives)
    except LinkwrightError as error:
        problems = error.diagnostics
        _follow_includes(session)
    findings = _Findings(inputs, session, is_complete=not problems)
    return Arguments(findings.arguments(), findings.unused_warnings(), problems)


class _ArgumentSession(TracedSession):
    """A session without missing arguments.

    Attributes:
        documents: the document of every file that was read, by path.
        declared: the first element that declares each argument, by name.
        missing: the names of arguments that were used before they had a value.
        used_names: the names of arguments that were used.
    """

    def __init__(self, inputs: Inputs) -> None:
        super().__init__(inputs, probes=False)
        self.documents: dict[str, Document] = {}
        self.declared: dict[str, Element] = {}
        self.missing: dict[str, None] = {}
        self.used_names: dict[str, None] = {}
        self._defaults: dict[str, str] = {}

    def read(self, path: str) -> Document:
        """Return the document of a file, and record its declarations of arguments."""
        document = super().read(path)
        if path not in self.documents:
            self.documents[path] = document
            self.record_defaults(document)
        return document

    def record_defaults(self, document: Document) -> None:
        """Record the defaults in a document for arguments that are used before their declaration."""
        for element in document.root.walk():
            if element.tag == "xacro:arg" and "name" in element.attributes:
                default = element.attributes.get("default", "")
                self._defaults.setdefault(element.attributes["name"], "" if "$" in default else default)

    def argument(self, name: str) -> str:
        """Return the value of an argument, or a substitute if it is missing."""
        self.used_names[name] = None
        if name not in self.arguments:
            self.missing[name] = None
            return self._defaults.get(name, "")
        return super().argument(name)

    def declare(self, expander: Expander, site: Site) -> None:
        """Expand ``<xacro:arg>`` and record the declaration."""
        DIRECTIVES["xacro:arg"](expander, site)
        self.declared.setdefault(site.node.attributes["name"], site.node)


@dataclass
class _Findings:
    """The uses and declarations of arguments in all files that were read.

    Attributes:
        is_complete: whether the expansion finished, so that each required argument was used.
    """

    inputs: Inputs
    session: _ArgumentSession
    is_complete: bool
    uses: dict[str, Span | None] = field(default_factory=dict)
    other_declarations: dict[str, Element] = field(default_factory=dict)

    def __post_init__(self) -> None:
        for document in self.session.documents.values():
            for element in document.root.walk():
                if element.tag == "xacro:arg" and "name" in element.attributes:
                    self.other_declarations.setdefault(element.attributes["name"], element)
                for name, span in _find_used_arguments(element):
                    self.uses.setdefault(name, span)

    def arguments(self) -> tuple[Argument, ...]:
        """Return all arguments, declared arguments first."""
        session = self.session
        declarations = {**session.declared, **self.other_declarations, **session.declared}
        missing_names = dict(session.missing)
        if not self.is_complete:
            missing_names.update(dict.fromkeys(name for name in self.uses if name not in declarations))
        results = [self._declared_argument(name, element, missing_names) for name, element in declarations.items()]
        results += [self._undeclared_argument(name) for name in missing_names if name not in declarations]
        passed_arguments = self.inputs.arguments
        results += [
            replace(self._undeclared_argument(name), required=False)
            for name in self.uses
            if name in passed_arguments and name not in declarations and name not in missing_names
        ]
        return tuple(results)

    def unused_warnings(self) -> tuple[Diagnostic, ...]:
        """Return a warning for each passed argument that no file declares or uses."""
        known_names = {**self.uses, **self.other_declarations, **self.session.declared, **self.session.used_names}
        return tuple(
            Diagnostic(
                "XAC215",
                phrase(
                    "the argument '{name}' is given, but '{file}' does not use it",
                    name=name,
                    file=self.inputs.name,
                ),
                severity=Severity.WARNING,
                hint=did_you_mean(name, known_names),
            )
            for name in self.inputs.arguments
            if name not in known_names
        )

    def _declared_argument(self, name: str, element: Element, missing_names: Mapping[str, None]) -> Argument:
        default = element.attributes.get("default")
        is_passed = name in self.inputs.arguments
        value = self.session.arguments.get(name)
        if value is None and default is not None and "$" not in default:
            value = default
        return Argument(
            name=name,
            default=default,
            span=element.attribute_span("name"),
            required=not is_passed and (name in missing_names or default is None),
            used=name in self.uses or name in self.session.used_names,
            value=None if name in missing_names else value,
            is_given=is_passed,
        )

    def _undeclared_argument(self, name: str) -> Argument:
        is_passed = name in self.inputs.arguments
        value = self.inputs.arguments.get(name)
        return Argument(name, None, self.uses.get(name), not is_passed, True, value, is_passed)


def _follow_includes(session: _ArgumentSession) -> None:
    """Read the files of includes that an expansion did not reach, if their names are known."""
    scope = Scope(session.globals, session)
    pending = list(session.documents.items())
    read_paths = set(session.documents)
    while pending and len(read_paths) < _MAX_FILES:
        file, document = pending.pop()
        session.file = file
        for element in document.root.walk():
            if element.tag != "xacro:include":
                continue
            try:
                path = session.relative_to_current_file(
                    session.evaluate_text(element.attributes.get("filename", ""), scope)
                )
                if path not in read_paths:
                    read_paths.add(path)
                    pending.append((path, session.read(path)))
            except (Fault, LinkwrightError):
                continue  # the name of the included file depends on properties of the files


def _find_used_arguments(element: Element) -> Iterator[tuple[str, Span | None]]:
    """Yield the arguments that an element's attributes and own texts use, with locations."""
    for attribute, value in element.attributes.items():
        for match in _find_uses(value):
            name = match["plain"] or match["called"]
            yield name, attribute_span(element, attribute, *match.span())
    for child in element.children:
        if isinstance(child, Text) and not child.cdata:
            for match in _find_uses(child.data):
                yield match["plain"] or match["called"], text_part_span(child, *match.span())


def _find_uses(text: str) -> Iterator[re.Match[str]]:
    return _ARGUMENT_USE.finditer(text) if "arg" in text else iter(())


def arguments_data(arguments: tuple[Argument, ...]) -> list[dict[str, Any]]:
    """Return arguments as JSON-ready data.

    Lines and columns start at 1, and are None if there is no location.
    """
    return [
        {
            "name": argument.name,
            "default": argument.default,
            "value": argument.value,
            "required": argument.required,
            "used": argument.used,
            "given": argument.is_given,
            "file": argument.span.file if argument.span else None,
            "line": argument.span.line if argument.span else None,
            "column": argument.span.column if argument.span else None,
        }
        for argument in arguments
    ]
