"""The base class of lint rules."""

from __future__ import annotations

from collections.abc import Iterable
from enum import Enum

from linkwright.diagnostics import Diagnostic, Note, Phrase, Severity, SourceText, Span
from linkwright.lint.finding import Finding
from linkwright.lint.fix import Fix
from linkwright.lint.option import Option
from linkwright.lint.subject import Subject
from linkwright.loading.lean_typing import ClassVar, TypeVar
from linkwright.xmltree import Element

Value = TypeVar("Value", bool, int, float, str, list[str])


class Scope(Enum):
    """The kind of input that a rule checks."""

    DESCRIPTION = "description"
    """A robot description. The rule runs once for each description."""
    PACKAGE = "package"
    """The ROS package that contains a description. The rule runs once for each package."""
    COMMENTS = "comments"
    """The comments that suppress findings. The engine reports the rule's findings without running the rule."""


class Rule:
    """The base class of lint rules, whose docstrings are their pages in the documentation.

    Each rule is a small subclass. The first line of its docstring names the fault that the rule reports. The sections
    ``## Why``, ``## Example`` and ``## Use instead`` follow.

    Attributes:
        code: ``LW`` and three digits, never reused with another meaning. Rules of other packages use a different
            prefix.
        name: the name in kebab-case, which is accepted wherever a code is.
        severity: the default severity of the rule's findings.
        default: whether the rule is on by default; pedantic rules are not.
        scope: the kind of input that the rule checks.
        holds_for_parts: whether the findings hold for a description with missing parts, because the rule checks single
            elements or texts.
        holds_for_libraries: whether the rule also applies to a file that only defines macros, because it checks the
            unexpanded files. Rules that hold for parts also apply.
        of_sources: whether the findings depend only on the unexpanded files, their package and the names of the
            arguments. Such a rule runs once for all sets of arguments that read the same files.
        needs_all_sets: whether a finding is valid only if it occurs with every set of arguments, such as that a macro
            is never used.
        options: the options of the rule.
        replaces: the codes of the findings that a finding of this rule replaces at the same location.
    """

    code: ClassVar[str]
    name: ClassVar[str]
    severity: ClassVar[Severity] = Severity.WARNING
    default: ClassVar[bool] = True
    scope: ClassVar[Scope] = Scope.DESCRIPTION
    holds_for_parts: ClassVar[bool] = False
    holds_for_libraries: ClassVar[bool] = False
    of_sources: ClassVar[bool] = False
    needs_all_sets: ClassVar[bool] = False
    options: ClassVar[tuple[Option, ...]] = ()
    replaces: ClassVar[tuple[str, ...]] = ()

    def check(self, subject: Subject) -> Iterable[Diagnostic]:
        """Yield the findings of the rule.

        A rule must not raise an exception, whatever the description contains.
        """
        raise NotImplementedError(f"{self.code} cannot check {subject.path}")

    def option(self, subject: Subject, name: str, kind: type[Value]) -> Value:
        """Return the value of an option in the settings for a subject, or the default.

        Args:
            subject: the description under check.
            name: the name of the option, one of `options`.
            kind: the type of the value; ``float`` also accepts an integer.
        """
        declared_option = next(option for option in self.options if option.name == name)
        value = subject.settings.options.get(self.name, {}).get(name, declared_option.default)
        if kind is float and isinstance(value, int):
            return kind(value)
        assert isinstance(value, kind), "the settings were checked against the option's default"
        return value

    def report(
        self,
        message: Phrase,
        element: Element | None = None,
        attribute: str | None = None,
        *,
        span: Span | None = None,
        source: SourceText | None = None,
        notes: Iterable[Note] = (),
        hint: Phrase | None = None,
        fix: Fix | None = None,
        severity: Severity | None = None,
    ) -> Finding:
        """Return a finding of this rule.

        Args:
            message: one sentence without a full stop, with names as the user wrote them.
            element: the element that the finding is about. It provides the location, and the macro calls and includes
                that produced it.
            attribute: the attribute of the element whose value is the location.
            span: the location, if it differs from the location of the element or attribute.
            source: the text that contains `span`, for the excerpt.
            notes: facts that explain the finding, with their locations.
            hint: advice for fixing the problem.
            fix: a change to the source that fixes the problem.
            severity: the severity, if it differs from the rule's.
        """
        if element is not None:
            if span is None:
                span = element.attribute_span(attribute) if attribute else element.span()
            source = source or element.source
        return Finding(
            self.code, message, span, severity or self.severity, tuple(notes), hint, source, fix=fix, element=element
        )
