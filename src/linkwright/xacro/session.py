"""The inputs and the state of one expansion, with its packages, files, warnings and limits."""

from __future__ import annotations

import os
import re
from collections.abc import Callable, Iterable, Mapping

from linkwright.diagnostics import (
    Diagnostic,
    LinkwrightError,
    Phrase,
    Severity,
    SourceText,
    did_you_mean,
    foreign,
    phrase,
)
from linkwright.loading.lean_dataclasses import NamedTuple
from linkwright.loading.lean_typing import TYPE_CHECKING, Any, Protocol
from linkwright.xacro.cache import read_document
from linkwright.xacro.expressions import builtin_names, sandbox
from linkwright.xacro.expressions.bounded import RefusalError, checked_keys
from linkwright.xacro.expressions.expression import compile_expression
from linkwright.xacro.expressions.sandbox import Module
from linkwright.xacro.expressions.scope import Namespace, Scope
from linkwright.xacro.expressions.template import compile_template, package_fault, templates
from linkwright.xacro.expressions.yaml_data import YamlDict, YamlError
from linkwright.xacro.faults import Fault, Frame, attribute_span, find_xml_hint, text_part_span, trail
from linkwright.xacro.limits import Budget, Limits
from linkwright.xacro.plan import plan_document
from linkwright.xmltree import Document, Element, Overlay, Text, parse
from linkwright.xmltree.decoding import UTF_8

if TYPE_CHECKING:
    from pathlib import Path

    from linkwright.diagnostics import Span
    from linkwright.xacro.expressions.scope import Environment


class Packages(Protocol):
    """The interface of a package finder, such as `linkwright.packages.PackageFinder`."""

    def share(self, name: str) -> Path:
        """Return the share folder of a package.

        Raises:
            LinkwrightError: if the package is not found.
        """
        ...


PackageSource = Mapping[str, Any] | Packages | None


class Session:
    """The state of one expansion, apart from the tree.

    Attributes:
        arguments: the value of every argument passed or declared so far, by name.
        known_arguments: the names of the arguments that the files declare or use.
        limits: the limits of the expansion.
        budget: the remaining budget.
        file: the file being processed, whose folder is the base of relative paths.
        frame: the innermost macro call or include being processed, or None.
        current_node: the element or text being processed, which is the location of warnings.
        current_attribute: the attribute of `current_node` that is being evaluated, or None.
        property_stack: the names of the nested properties being evaluated, outermost first.
        dependencies: the files read so far, starting with the main file.
        root_dir: the base of relative paths; empty for the current folder.
        diagnostics: the warnings so far.
    """

    def __init__(
        self,
        file: str,
        arguments: Mapping[str, str],
        packages: PackageSource,
        limits: Limits,
        root_dir: str = "",
        overlay: Overlay | None = None,
    ) -> None:
        self.arguments: dict[str, str] = {name: str(value) for name, value in arguments.items()}
        self.known_arguments: set[str] = set()
        self.limits = limits
        self.budget = Budget(limits)
        self.file = file
        self.frame: Frame | None = None
        self.current_node: Element | Text | None = None
        self.current_attribute: str | None = None
        self.property_stack: list[str] = []
        self.dependencies: dict[str, None] = {file: None}
        self.root_dir = root_dir
        self._overlay = overlay or Overlay()
        self.diagnostics: list[Diagnostic] = []
        self._reported: set[tuple[str, str, Span | None]] = set()
        self._packages = packages
        self._package_paths: dict[str, str] = {}
        self._main_file = file
        self.globals = Scope(None, self, builtin_names.global_names(self))

    def close(self) -> None:
        """Break the reference cycle of the session and its scopes, which frees memory at once."""
        self.globals.values.clear()
        del self.globals

    # texts

    def evaluate(self, text: str, scope: Scope) -> Any:
        """Return the value of a text in a scope.

        Raises:
            Fault: if the evaluation fails.
        """
        template = templates.get(text) or compile_template(text)
        return template.evaluate(scope)

    def evaluate_text(self, text: str, scope: Scope) -> str:
        """Return the value of a text in a scope as the text that xacro writes.

        Raises:
            Fault: if the evaluation fails.
        """
        template = templates.get(text) or compile_template(text)
        value = template.evaluate(scope)
        if value.__class__ is str and value.isprintable():
            return value
        if value.__class__ is float:
            return str(value)
        return self.output_text(text, value)

    def output_text(self, text: str, value: Any) -> str:
        """Return the text that xacro writes for the value of a text with expressions.

        Raises:
            Fault: if XML cannot represent the result, or if it is too long.
        """
        if value.__class__ is str:
            if not value.isprintable():
                _check_characters(value)
            return value
        try:
            return sandbox.as_text(value)
        except (RefusalError, ValueError) as error:
            raise Fault(
                "XAC202", phrase("cannot write the value of '{text}': {error}", text=text, error=foreign(error))
            ) from None

    def may_change_values(self, text: str) -> bool:
        """Return whether the evaluation of a text may change a value, as ``${items.pop(0)}`` does."""
        return compile_template(text).may_change_values

    # names

    def undefined_name_fault(self, name: str, environment: Environment, start: int, end: int) -> Fault:
        """Return the fault for a name that no scope defines."""
        provided_names = self.globals.values
        python = provided_names["python"].values
        if name in ("true", "false"):
            hint: Phrase | None = phrase("write {form}", form=name.capitalize())
        elif name in python:
            hint = phrase("write python.{name}", name=name)
        elif name in self.arguments:
            hint = phrase("'{name}' is an argument: write $(arg {name})", name=name)
        elif name.lower() in provided_names:
            hint = phrase("write {form}", form=name.lower())
        elif f"**{name}" in set(environment.blocks()):
            hint = phrase(
                '\'{name}\' is defined without a value; write <xacro:property name="{name}" value="..."/>', name=name
            )
        else:
            hint = did_you_mean(name, [other for other in environment.names() if other not in provided_names])
            if hint is None and len(name) > len("pi"):
                hint = did_you_mean(name, provided_names)
        fault = Fault("XAC201", phrase("the property '{name}' is not defined", name=name), start, end, hint)
        fault.missing_name = name
        return fault

    def attribute_hint(self, owner: Any, name: str) -> Phrase | None:
        """Return a hint with a similar name for an attribute that a value does not have, or None."""
        candidates: Iterable[Any] = ()
        if isinstance(owner, Module):
            candidates = owner.values
        elif isinstance(owner, Namespace):
            candidates = owner.names()
        elif isinstance(owner, dict):
            candidates = owner
        return did_you_mean(name, [candidate for candidate in candidates if isinstance(candidate, str)])

    def argument(self, name: str) -> str:
        """Return the value of an argument.

        Raises:
            Fault: XAC211 if the argument is neither declared nor passed.
        """
        value = self.arguments.get(name) if isinstance(name, str) else None
        if value is None:
            hint = did_you_mean(str(name), self.arguments)
            if hint is None:
                hint = phrase('declare it before this: <xacro:arg name="{name}" default="..."/>', name=name)
            raise Fault("XAC211", phrase("the argument '{name}' is not declared", name=name), hint=hint)
        self.known_arguments.add(name)
        return value

    def package(self, name: str) -> str:
        """Return the share folder of a package.

        Raises:
            Fault: if the package is not found.
        """
        cached_path = self._package_paths.get(name)
        if cached_path is None:
            cached_path = self._package_paths[name] = self._find_package(name)
        return cached_path

    def _find_package(self, name: str) -> str:
        packages = self._packages
        if isinstance(packages, Mapping) and name in packages:
            return str(packages[name])
        if packages is None or isinstance(packages, Mapping):
            from pathlib import Path

            from linkwright.packages import PackageFinder

            start = Path(self.resolve_path(self._main_file)).resolve().parent
            packages = self._packages = PackageFinder(start=start, extra=packages)
        try:
            return str(packages.share(name))
        except LinkwrightError as error:
            raise package_fault(error) from None

    # files

    @property
    def working_directory(self) -> str:
        """The working directory: the value of ``$(cwd)``."""
        return os.path.abspath(self.root_dir)  # noqa: PTH100 - a string is needed

    def resolve_path(self, path: str) -> str:
        """Return the path on disk for a path that may be relative to `root_dir`."""
        return os.path.join(self.root_dir, path)  # noqa: PTH118 - kept as it is written

    def read(self, path: str) -> Document:
        """Return the document of a file; see `read_document`."""
        document = read_document(self.resolve_path(path), self._overlay)
        plan_document(document)
        if document.encoding != UTF_8 and document.source is not None:
            self._warn_of_encoding(document.source, document.encoding)
        return document

    def relative_to_current_file(self, name: str) -> str:
        """Return the path of a file whose name is relative to the file being processed."""
        return os.path.join(os.path.dirname(self.file), name)  # noqa: PTH118, PTH120 - kept as it is written

    def add_dependency(self, file: str) -> None:
        """Record that a file was read, as a dependency of the result."""
        self.dependencies.setdefault(file, None)

    def load_yaml(self, name: str) -> Any:
        """Return the value of a YAML file whose name is relative to the file being processed.

        Raises:
            Fault: XAC506 if the file cannot be read or is not YAML.
        """
        from linkwright.xacro.expressions import yaml_data

        path = self.relative_to_current_file(name)
        self.add_dependency(path)
        try:
            text, encoding = self._overlay.read(self.resolve_path(path))
        except LinkwrightError as error:
            diagnostic = error.diagnostics[0]
            fault = Fault(
                "XAC506",
                diagnostic.message,
                hint=diagnostic.hint if diagnostic.code == "XML106" else _suggest_file(self.resolve_path(path)),
            )
            raise fault from None
        try:
            return yaml_data.load(text, self._evaluate_unit)
        except YamlError as error:
            raise _make_yaml_fault(path, text, error) from None
        finally:
            if encoding != UTF_8:
                self._warn_of_encoding(SourceText(path, text), encoding)

    def _evaluate_unit(self, expression: str) -> Any:
        return compile_expression(expression).evaluate(self.globals)

    def dotify(self, mapping: Any = (), **items: Any) -> YamlDict:
        """Return a mapping whose items are also accessible with a dot."""
        return YamlDict(checked_keys(mapping), **items)

    # findings

    def warn_of_unused_arguments(self) -> None:
        """Warn about passed arguments that no file declares or uses."""
        self.current_node = self.frame = None
        for name in self.arguments:
            if name not in self.known_arguments:
                hint = did_you_mean(name, self.known_arguments)
                self.warn(
                    "XAC215",
                    phrase("the argument '{name}' is given, but '{file}' does not use it", name=name, file=self.file),
                    None,
                    hint,
                )

    def warn(
        self,
        code: str,
        message: Phrase,
        span: Span | None = None,
        hint: Phrase | None = None,
        severity: Severity = Severity.WARNING,
        called: str | None = None,
    ) -> Diagnostic | None:
        """Record a finding that does not stop the expansion, at most once for each location.

        Args:
            code: the code of the diagnostic.
            message: the message of the diagnostic.
            span: the location, or None for the location of the text being evaluated.
            hint: advice for fixing the problem.
            severity: the severity of the diagnostic.
            called: the function that the finding is about, if the text being evaluated calls one.

        Returns:
            The finding, or None if it was recorded before.
        """
        node = self.current_node
        if span is None and node is not None:
            span = self._find_call_span(node, called)
        if (code, message, span) in self._reported:
            return None
        self._reported.add((code, message, span))
        source = node.source if node is not None and span is not None else None
        diagnostic = Diagnostic(code, message, span, severity, trail(self.frame), hint, source)
        self.diagnostics.append(diagnostic)
        return diagnostic

    def withdraw(self, diagnostic: Diagnostic) -> None:
        """Remove a recorded finding that a later definition made obsolete."""
        self.diagnostics.remove(diagnostic)
        self._reported.discard((diagnostic.code, diagnostic.message, diagnostic.span))

    def _find_call_span(self, node: Element | Text, function: str | None) -> Span | None:
        attribute = self.current_attribute
        if isinstance(node, Element) and attribute is None:
            return node.span()
        text = node.data if isinstance(node, Text) else node.attributes.get(attribute or "", "")
        match = re.search(rf"(?<![\w.]){re.escape(function)}(?=\s*\()", text) if function else None
        start, end = match.span() if match else (None, None)
        if isinstance(node, Text):
            return text_part_span(node, start, end)
        return attribute_span(node, attribute or "", start, end) or node.span()

    def _warn_of_encoding(self, source: SourceText, encoding: str) -> None:
        key = ("XAC905", source.name, None)
        if key in self._reported:
            return
        self._reported.add(key)
        message = phrase(
            "ros/xacro cannot read '{path}': it is in {encoding}, not in UTF-8",
            path=source.name,
            encoding=encoding.upper(),
        )
        hint = phrase("save it as UTF-8, without another encoding in its XML declaration")
        notes = trail(self.frame)
        self.diagnostics.append(Diagnostic("XAC905", message, source.span(0), Severity.WARNING, notes, hint, source))

    def with_deprecation_warning(self, qualified_name: str, function: Callable[..., Any]) -> Callable[..., Any]:
        """Return a function that warns when it is called by its deprecated bare name."""
        bare = qualified_name.partition(".")[2]

        def warning(*arguments: Any, **keywords: Any) -> Any:
            self.warn(
                "XAC507",
                phrase("calling '{name}' by its bare name is deprecated", name=bare),
                hint=phrase("write {form}", form=qualified_name),
                called=bare,
            )
            return function(*arguments, **keywords)

        return warning

    def reporter(self, name: str, code: str, severity: Severity) -> Callable[..., str]:
        """Return the function that shows messages, such as ``xacro.message`` or ``xacro.error``."""

        def report(*words: Any, **_options: Any) -> str:
            text = foreign(" ".join(map(sandbox.as_text, words))) or phrase("here")
            self.warn(code, text, severity=severity, called=f"xacro.{name}")
            return ""

        return report


# Compiled on first use: most values are printable and have none of these characters.
_FORBIDDEN_CHARACTERS = "[\x00-\x08\x0b\x0c\x0e-\x1f\ud800-\udfff\ufffe\uffff]"


def _check_characters(text: str) -> None:
    match = None if text.isprintable() else re.search(_FORBIDDEN_CHARACTERS, text)
    if match:
        message = phrase("the value contains a character that XML cannot represent: U+{ord:04X}", ord=ord(match[0]))
        raise Fault("XAC206", message, hint=phrase("write '\\\\' for a backslash: '\\' in a string begins an escape"))


def _make_yaml_fault(path: str, text: str, error: YamlError) -> Fault:
    fault = Fault("XAC506", phrase("'{path}' is not valid YAML: {message}", path=path, message=foreign(error.message)))
    if error.line:
        fault.source = source = SourceText(path, text)
        offset = source.offset(error.line, error.column)
        if text[offset - 1 : offset] == "\t":
            offset -= 1
        fault.span = source.span(offset)
        fault.next_note = phrase("the file is loaded here")
        if text[offset : offset + 1] == "\t":
            fault.hint = phrase("indent YAML with spaces, not tabs")
    return fault


def _suggest_file(path: str) -> Phrase | None:
    folder, name = os.path.split(path)
    try:
        return did_you_mean(name, os.listdir(folder or "."))  # noqa: PTH208 - names are needed, not paths
    except (OSError, ValueError):
        return None


class Inputs(NamedTuple):
    """The inputs of an expansion; see `linkwright.xacro.expand`."""

    name: str
    arguments: Mapping[str, str]
    packages: PackageSource = None
    text: str | None = None
    limits: Limits = Limits()
    root_dir: str = ""
    overlay: Overlay | None = None

    def create_session(self) -> Session:
        """Create a session for these inputs."""
        return Session(self.name, self.arguments, self.packages, self.limits, self.root_dir, self.overlay)


def read_main_document(session: Session, text: str | None = None) -> Document:
    """Return the parsed document of a session's file, or of a text that replaces it.

    Raises:
        LinkwrightError: if the file cannot be read, or is not XML.
    """
    try:
        document = session.read(session.file) if text is None else parse(text, session.file)
    except LinkwrightError as error:
        first = error.diagnostics[0]
        hint = find_xml_hint(first)
        if hint == first.hint:
            raise
        raise LinkwrightError(
            Diagnostic(first.code, first.message, first.span, notes=first.notes, hint=hint, source=first.source)
        ) from None
    plan_document(document)
    return document
