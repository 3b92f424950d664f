"""Findings of rules: diagnostics, some with a fix."""

from __future__ import annotations

from dataclasses import dataclass, field

from linkwright.diagnostics import Diagnostic
from linkwright.lint.fix import Fix
from linkwright.xmltree import Element


@dataclass(frozen=True, slots=True)
class Finding(Diagnostic):
    """A diagnostic of a rule.

    Attributes:
        fix: what would mend it, or None where only the author can know.
        element: the element it is about; the engine adds the macro calls and includes that produced it.
    """

    fix: Fix | None = None
    element: Element | None = field(default=None, compare=False, repr=False)
