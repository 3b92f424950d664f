"""A filter of the TF display: a regular expression that frames are chosen with."""

from __future__ import annotations

from collections.abc import Collection
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from linkwright.graph.names.expressions import Expression

_NOT_USED = "This expression is not used"


class FrameFilter:
    """Says in which names its expression is found.

    Args:
        text: the expression, empty for none.

    Attributes:
        text: the same.
        problem: why there is no expression, for the status; None when nothing is wrong.
    """

    def __init__(self, text: str = "") -> None:
        self.text = text
        self.problem: str | None = None
        self._expression: Expression | None = None  # what reads one is imported for the few who write one
        self._known: set[str] = set()
        self._found: set[str] = set()
        if text:
            from linkwright.graph.names.expressions import Expression, ExpressionError

            try:
                self._expression = Expression(text)
            except ExpressionError as error:
                self.problem = f"{_NOT_USED}: {error}"

    @property
    def is_used(self) -> bool:
        """Whether there is an expression to look for."""
        return self._expression is not None

    def found_in(self, names: Collection[str]) -> set[str]:
        """Those names in which the expression is found; with one that takes too long there is none from now on."""
        if self._expression is not None:
            from linkwright.graph.names.expressions import TooCostlyError

            try:
                found = self._expression.among(name for name in names if name not in self._known)
                self._found = found | self._found.intersection(names)
                self._known = set(names)
            except TooCostlyError:
                self._expression, self._found = None, set()
                self.problem = f"{_NOT_USED}: it takes too long to look for it in the names of the frames"
        return self._found
