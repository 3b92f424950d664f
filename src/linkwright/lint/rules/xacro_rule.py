"""The base class of rules about xacro files."""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Iterator

from linkwright.diagnostics import Diagnostic
from linkwright.lint.rule import Rule
from linkwright.lint.subject import Subject
from linkwright.loading.lean_typing import TYPE_CHECKING

if TYPE_CHECKING:
    from linkwright.lint.xacro_facts import XacroFacts


class XacroRule(Rule, ABC):
    """The base class of rules about the xacro files of a description.

    In plain URDF, such rules report nothing.
    """

    holds_for_libraries = True
    of_sources = True

    def check(self, subject: Subject) -> Iterator[Diagnostic]:
        if subject.expansion is not None:
            yield from self.check_xacro(subject.xacro)

    @abstractmethod
    def check_xacro(self, facts: XacroFacts) -> Iterator[Diagnostic]:
        """Yield the findings of the rule in the xacro files of a description."""
