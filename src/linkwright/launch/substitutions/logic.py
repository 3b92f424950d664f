"""Substitutions that compute: Python expressions, comparisons, boolean logic."""

from __future__ import annotations

import importlib
import math
from collections.abc import Iterable
from typing import Any

from linkwright.diagnostics import LinkwrightError
from linkwright.launch.context import LaunchContext
from linkwright.launch.places import error_at
from linkwright.launch.substitution import (
    SomeSubstitutionsType,
    Substitution,
    describe,
    normalize_to_list_of_substitutions,
    perform_substitutions,
)


class PythonExpression(Substitution):
    """The value of a Python expression, as text.

    Args:
        expression: the expression.
        python_modules: modules whose names the expression may use, ``math`` by default (its members also
        bare).
    """

    def __init__(
        self,
        expression: SomeSubstitutionsType,
        python_modules: SomeSubstitutionsType | Iterable[SomeSubstitutionsType] = ("math",),
    ) -> None:
        self._expression = normalize_to_list_of_substitutions(expression)
        if isinstance(python_modules, (str, Substitution)):
            python_modules = [python_modules]
        self._modules = [normalize_to_list_of_substitutions(module) for module in python_modules]

    @property
    def expression(self) -> list[Substitution]:
        """The expression, as substitutions."""
        return self._expression

    @property
    def python_modules(self) -> list[list[Substitution]]:
        """The modules, as substitutions."""
        return self._modules

    def describe(self) -> str:
        """The expression."""
        return f"PythonExpr({describe(self._expression)})"

    def perform(self, context: LaunchContext) -> str:
        """The value.

        The expression runs with all the rights of the launch file it is written in: that is a program anyway.

        Raises:
            LinkwrightError: LAUNCH126, with what Python says.
        """
        expression = perform_substitutions(context, self._expression)
        names: dict[str, Any] = {}
        try:
            for module in self._modules:
                name = perform_substitutions(context, module)
                names[name] = importlib.import_module(name)
            if "math" in names:
                names.update({name: value for name, value in vars(math).items() if not name.startswith("_")})
            return str(eval(expression, {}, names))  # noqa: S307 - launch files are programs by design
        except LinkwrightError:
            raise
        except Exception as error:
            problem = f"{type(error).__name__}: {error}"
            message = f"Python expression '{expression}' cannot be evaluated ({problem})"
            hint = None
            if isinstance(error, NameError):
                hint = "put quotes around the parts that are text: [\"'\", LaunchConfiguration('x'), \"' == 'y'\"]"
            raise error_at(self.place, "LAUNCH126", message, hint) from error


class _TwoSided(Substitution):
    """What compares or joins two sides."""

    def __init__(self, left: list[Substitution], right: list[Substitution]) -> None:
        self._left = left
        self._right = right

    @property
    def left(self) -> list[Substitution]:
        """The left side, as substitutions."""
        return self._left

    @property
    def right(self) -> list[Substitution]:
        """The right side, as substitutions."""
        return self._right

    def describe(self) -> str:
        """Both sides."""
        return f"{type(self).__name__}({describe(self._left)} {describe(self._right)})"


class EqualsSubstitution(_TwoSided):
    """``true`` if two texts are equal, by number or truth value where both are such."""

    def __init__(self, left: Any, right: Any) -> None:
        super().__init__(_operand(left), _operand(right))

    def perform(self, context: LaunchContext) -> str:
        """``true`` or ``false``."""
        return _text(self._equal(context))

    def _equal(self, context: LaunchContext) -> bool:
        left = perform_substitutions(context, self._left)
        right = perform_substitutions(context, self._right)
        if left == right:
            return True
        truths = [_truth(text) for text in (left, right)]
        if None not in truths:
            return truths[0] == truths[1]
        try:
            return math.isclose(float(left), float(right))
        except ValueError:
            return False


class NotEqualsSubstitution(EqualsSubstitution):
    """``true`` if two texts differ."""

    def perform(self, context: LaunchContext) -> str:
        """``true`` or ``false``."""
        return _text(not self._equal(context))


class NotSubstitution(Substitution):
    """The opposite of a truth value."""

    def __init__(self, value: SomeSubstitutionsType) -> None:
        self._value = normalize_to_list_of_substitutions(value)

    @property
    def value(self) -> list[Substitution]:
        """The value, as substitutions."""
        return self._value

    def describe(self) -> str:
        """The value."""
        return f"NotSubstitution({describe(self._value)})"

    def perform(self, context: LaunchContext) -> str:
        """``true`` or ``false``."""
        return _text(not _boolean(self, context, self._value))


class AndSubstitution(_TwoSided):
    """Whether both values are true."""

    def __init__(self, left: SomeSubstitutionsType, right: SomeSubstitutionsType) -> None:
        super().__init__(normalize_to_list_of_substitutions(left), normalize_to_list_of_substitutions(right))

    def perform(self, context: LaunchContext) -> str:
        """``true`` or ``false``."""
        return _text(all(self._truths(context)))

    def _truths(self, context: LaunchContext) -> list[bool]:
        return [_boolean(self, context, side) for side in (self._left, self._right)]


class OrSubstitution(AndSubstitution):
    """Whether one of two values is true."""

    def perform(self, context: LaunchContext) -> str:
        """``true`` or ``false``."""
        return _text(any(self._truths(context)))


class AnySubstitution(Substitution):
    """Whether any of several values is true."""

    def __init__(self, *values: SomeSubstitutionsType) -> None:
        self._values = [normalize_to_list_of_substitutions(value) for value in values]

    @property
    def substitutions(self) -> list[list[Substitution]]:
        """The values, as substitutions."""
        return self._values

    def describe(self) -> str:
        """The values."""
        return f"{type(self).__name__}({', '.join(map(describe, self._values))})"

    def perform(self, context: LaunchContext) -> str:
        """``true`` or ``false``."""
        return _text(any(_boolean(self, context, value) for value in self._values))


class AllSubstitution(AnySubstitution):
    """Whether all of several values are true."""

    def perform(self, context: LaunchContext) -> str:
        """``true`` or ``false``."""
        return _text(all(_boolean(self, context, value) for value in self._values))


class IfElseSubstitution(Substitution):
    """One text or another, by a truth value."""

    def __init__(
        self,
        condition: SomeSubstitutionsType,
        if_value: SomeSubstitutionsType = "",
        else_value: SomeSubstitutionsType = "",
    ) -> None:
        self._condition = normalize_to_list_of_substitutions(condition)
        self._if_value = normalize_to_list_of_substitutions(if_value)
        self._else_value = normalize_to_list_of_substitutions(else_value)

    def describe(self) -> str:
        """All three parts."""
        parts = (self._condition, self._if_value, self._else_value)
        return f"IfElseSubstitution({', '.join(map(describe, parts))})"

    def perform(self, context: LaunchContext) -> str:
        """The text chosen."""
        chosen = self._if_value if _boolean(self, context, self._condition) else self._else_value
        return perform_substitutions(context, chosen)


def _operand(value: Any) -> list[Substitution]:
    if value is None:
        value = ""
    if isinstance(value, (bool, int, float)):
        value = str(value).lower() if isinstance(value, bool) else str(value)
    return normalize_to_list_of_substitutions(value)


def _truth(text: str) -> bool | None:
    return {"true": True, "1": True, "false": False, "0": False}.get(text.strip().lower())


def _boolean(substitution: Substitution, context: LaunchContext, value: list[Substitution]) -> bool:
    text = perform_substitutions(context, value)
    truth = _truth(text)
    if truth is None:
        name = type(substitution).__name__
        raise error_at(substitution.place, "LAUNCH127", f"{name} needs 'true' or 'false', not '{text}'")
    return truth


def _text(value: bool) -> str:
    return "true" if value else "false"
