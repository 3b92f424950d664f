"""The limits at which an expansion is stopped.

Descriptions often come from unknown sources. The expansion of any description must end after a short time.
"""

from __future__ import annotations

import sys
from _thread import allocate_lock  # This is the lock of threading, without the slow import of threading.
from time import thread_time

from linkwright.diagnostics import phrase
from linkwright.loading.lean_dataclasses import NamedTuple
from linkwright.xacro.faults import Fault
from linkwright.xmltree.nodes import seldom_collected


class Limits(NamedTuple):
    """The limits of one expansion.

    The defaults are far above the needs of any real robot.

    Attributes:
        depth: the maximum number of nested macro calls and includes.
        nesting: the maximum nesting depth of elements, including the elements of enclosing macro calls.
        elements: the maximum number of produced elements. A macro call counts as ten, any other xacro tag as two.
        steps: the maximum number of steps of all expressions. An iteration of a comprehension or a call of a function
            counts as two, a call of a lambda as eight, and a pass over two items or 32 characters of a value as one.
        characters: the maximum total length of all long texts and attributes of the result.
        seconds: the maximum processor time in seconds.
    """

    depth: int = 200
    nesting: int = 1000
    elements: int = 500_000
    steps: int = 1_000_000
    characters: int = 50_000_000
    seconds: float = 20.0


_FRAMES_PER_LEVEL = 6
_lock = allocate_lock()
_active = 0
_previous_limit = 0


class recursion_limit_for:  # noqa: N801 - it is called in a ``with`` statement, as a function is
    """A context in which Python's recursion limit is so high that our own limits apply first.

    The limit is restored when the last context ends.
    """

    def __init__(self, limits: Limits) -> None:
        self._limits = limits
        self._collection = seldom_collected()

    def __enter__(self) -> None:
        global _active, _previous_limit  # noqa: PLW0603 - the recursion limit is one for the whole process
        with _lock:
            if _active == 0:
                _previous_limit = sys.getrecursionlimit()
            _active += 1
            limit = _previous_limit + self._limits.nesting * _FRAMES_PER_LEVEL
            if limit > sys.getrecursionlimit():
                sys.setrecursionlimit(limit)
        self._collection.__enter__()

    def __exit__(self, *_: object) -> None:
        global _active  # noqa: PLW0603 - see above
        self._collection.__exit__()
        with _lock:
            _active -= 1
            if _active == 0:
                sys.setrecursionlimit(_previous_limit)


# --- counting the steps of an expansion -------------------------------------------------------------------------------

_MAX_CALL_DEPTH = 50
_LAMBDA_COST = 8
_MACRO_COST = 10
_STEPS_PER_CLOCK_CHECK = 1_000
_MACROS_PER_CLOCK_CHECK = 32

LONG_TEXT_LENGTH = 1_000
"""The maximum number of characters of a text that is not charged to the budget."""


class Budget:
    """The remaining budget of one expansion: elements, steps, characters, calls and seconds.

    Attributes:
        elements: the number of elements that may still be produced. The code that produces an element decrements it,
            and raises `too_many_elements_fault` if it becomes negative.
    """

    __slots__ = (
        "_call_depth",
        "_characters",
        "_clock_check_at",
        "_end_time",
        "_limits",
        "_macros",
        "_steps",
        "elements",
    )

    def __init__(self, limits: Limits) -> None:
        self._limits = limits
        self.elements = limits.elements
        self._steps = limits.steps
        self._characters = limits.characters
        self._call_depth = 0
        self._macros = 0
        self._clock_check_at = limits.steps  # The number of remaining steps at which the clock is read next.
        self._end_time = thread_time() + limits.seconds

    def too_many_elements_fault(self) -> Fault:
        """Return the error for an expansion that exceeds the element limit (XAC602)."""
        message = phrase(
            "the expansion creates more than {limit:,} elements; a macro call counts as {cost}",
            limit=self._limits.elements,
            cost=_MACRO_COST,
        )
        return Fault("XAC602", message, hint=phrase("look for macros that call each other endlessly"))

    def charge_text(self, length: int) -> None:
        """Count the characters of a long text in the result toward the limit.

        Raises:
            Fault: XAC605 if the total length is too large.
        """
        self._characters -= length
        if self._characters < 0:
            raise Fault(
                "XAC605",
                phrase("the expansion has more than {characters:,} characters", characters=self._limits.characters),
            )

    def charge_macro(self) -> None:
        """Charge a macro call or an include.

        Raises:
            Fault: XAC602 if there were too many, or XAC606 if the expansion took too long.
        """
        self.elements -= _MACRO_COST
        if self.elements < 0:
            raise self.too_many_elements_fault()
        self._macros += 1
        if not self._macros % _MACROS_PER_CLOCK_CHECK:
            self._check_clock()

    def charge_steps(self, count: int = 2) -> None:
        """Charge steps of an expression.

        The default is one iteration of a comprehension.

        Raises:
            Fault: XAC603 if there were too many steps, or XAC606 if the expansion took too long.
        """
        self._steps -= count
        if self._steps < self._clock_check_at:
            if self._steps < 0:
                message = phrase("the expressions take more than {steps:,} steps", steps=self._limits.steps)
                raise Fault(
                    "XAC603", message, hint=phrase("look for a comprehension or function over a long list or range")
                )
            self._clock_check_at = max(0, self._steps - _STEPS_PER_CLOCK_CHECK)
            self._check_clock()

    def enter_lambda(self) -> None:
        """Charge a call of a lambda, and count its nesting depth.

        Raises:
            Fault: XAC604 if lambda calls are nested too deeply, or XAC603 if there were too many steps.
        """
        self.charge_steps(_LAMBDA_COST)
        self._call_depth += 1
        if self._call_depth > _MAX_CALL_DEPTH:
            message = phrase("lambdas call each other more than {count} levels deep", count=_MAX_CALL_DEPTH)
            raise Fault("XAC604", message)

    def leave_lambda(self) -> None:
        """Leave the innermost lambda call."""
        self._call_depth -= 1

    def _check_clock(self) -> None:
        if thread_time() > self._end_time:
            message = phrase("the expansion takes more than {seconds:g} seconds", seconds=self._limits.seconds)
            raise Fault(
                "XAC606",
                message,
                hint=phrase("look for macros that call each other repeatedly, or for nested comprehensions"),
            )
