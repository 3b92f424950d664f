"""Counting what an expansion does, so that one that never ends is stopped."""

from __future__ import annotations

from time import thread_time

from linkwright.diagnostics import phrase
from linkwright.xacro.faults import Fault
from linkwright.xacro.limits import Limits

_CALL_DEPTH = 50
_LAMBDA = 8
_MACRO = 10
_STEPS_BETWEEN_LOOKS = 1_000
_MACROS_BETWEEN_LOOKS = 32

LONG = 1_000
"""From how many characters on a text is paid for."""


class Budget:
    """What is left to one expansion.

    Attributes:
        elements: how many elements may still be produced; who does counts it down, and calls `too_many_elements`
            below zero.
    """

    __slots__ = ("_call_depth", "_characters", "_ends", "_limits", "_look_at", "_macros", "_steps", "elements")

    def __init__(self, limits: Limits) -> None:
        self._limits = limits
        self.elements = limits.elements
        self._steps = limits.steps
        self._characters = limits.characters
        self._call_depth = 0
        self._macros = 0
        self._look_at = limits.steps  # when so many steps are left, the clock is looked at
        self._ends = thread_time() + limits.seconds

    def too_many_elements(self) -> Fault:
        """What is wrong when no elements are left: XAC602."""
        message = phrase(
            "the expansion makes more than {limit:,} elements, macro calls counting as {macro}",
            limit=self._limits.elements,
            macro=_MACRO,
        )
        return Fault("XAC602", message, hint=phrase("look for macros that call each other without end"))

    def text(self, length: int) -> None:
        """Pay for a long text that comes out.

        Raises:
            Fault: XAC605 when they are too long together.
        """
        self._characters -= length
        if self._characters < 0:
            raise Fault(
                "XAC605",
                phrase("the expansion has more than {characters:,} characters", characters=self._limits.characters),
            )

    def macro(self) -> None:
        """Pay for a call of a macro or an include.

        Raises:
            Fault: XAC602 or XAC606 when there were too many or they took too long.
        """
        self.elements -= _MACRO
        if self.elements < 0:
            raise self.too_many_elements()
        self._macros += 1
        if not self._macros % _MACROS_BETWEEN_LOOKS:
            self._look_at_clock()

    def step(self, count: int = 2) -> None:
        """Pay for what an expression does, by default one more turn of a comprehension.

        Raises:
            Fault: XAC603 or XAC606 when it was too much or took too long.
        """
        self._steps -= count
        if self._steps < self._look_at:
            if self._steps < 0:
                message = phrase("the expressions take more than {steps:,} steps", steps=self._limits.steps)
                raise Fault(
                    "XAC603", message, hint=phrase("look for a comprehension or function over a long list or range")
                )
            self._look_at = max(0, self._steps - _STEPS_BETWEEN_LOOKS)
            self._look_at_clock()

    def enter_lambda(self) -> None:
        """Pay for a call of a lambda, which may call itself.

        Raises:
            Fault: XAC604 when lambdas call each other too deeply, XAC603 when there were too many calls.
        """
        self.step(_LAMBDA)
        self._call_depth += 1
        if self._call_depth > _CALL_DEPTH:
            raise Fault("XAC604", phrase("lambdas call each other more than {call_depth} deep", call_depth=_CALL_DEPTH))

    def leave_lambda(self) -> None:
        """The call that was entered last is over."""
        self._call_depth -= 1

    def _look_at_clock(self) -> None:
        if thread_time() > self._ends:
            message = phrase("the expansion takes more than {seconds:g} seconds", seconds=self._limits.seconds)
            raise Fault("XAC606", message, hint=phrase("look for macros or comprehensions that multiply"))
