"""Counting what an expansion does, so that one that never ends is stopped."""

from __future__ import annotations

from linkwright.xacro.faults import Fault
from linkwright.xacro.limits import Limits

_CALL_DEPTH = 50

LONG = 1_000
"""From how many characters on a text is paid for."""


class Budget:
    """What is left to one expansion.

    Attributes:
        elements: how many elements may still be produced and macros called; who does counts it down, and calls
            `too_many_elements` below zero.
    """

    __slots__ = ("_call_depth", "_characters", "_limits", "_steps", "elements")

    def __init__(self, limits: Limits) -> None:
        self._limits = limits
        self.elements = limits.elements
        self._steps = limits.steps
        self._characters = limits.characters
        self._call_depth = 0

    def too_many_elements(self) -> Fault:
        """What is wrong when no elements are left: XAC602."""
        message = f"the expansion makes more than {self._limits.elements:,} elements and macro calls"
        return Fault("XAC602", message, hint="look for macros that call each other without end")

    def text(self, length: int) -> None:
        """Pay for a long text that comes out.

        Raises:
            Fault: XAC605 when they are too long together.
        """
        self._characters -= length
        if self._characters < 0:
            raise Fault("XAC605", f"the expansion has more than {self._limits.characters:,} characters")

    def step(self) -> None:
        """Pay for one more turn of a comprehension or call of a lambda.

        Raises:
            Fault: XAC603 when there were too many.
        """
        self._steps -= 1
        if self._steps < 0:
            message = f"the expressions take more than {self._limits.steps:,} steps"
            raise Fault("XAC603", message, hint="look for a comprehension over a long range")

    def enter_lambda(self) -> None:
        """Pay for a call of a lambda, which may call itself.

        Raises:
            Fault: XAC604 when lambdas call each other too deeply, XAC603 when there were too many calls.
        """
        self.step()
        self._call_depth += 1
        if self._call_depth > _CALL_DEPTH:
            raise Fault("XAC604", f"lambdas call each other more than {_CALL_DEPTH} deep")

    def leave_lambda(self) -> None:
        """The call that was entered last is over."""
        self._call_depth -= 1
