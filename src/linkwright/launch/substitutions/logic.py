"""Substitutions that compare and combine truth values."""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import Any

from linkwright.launch.context import LaunchContext
from linkwright.launch.frontend.expose import expose_substitution
from linkwright.launch.frontend.values import coerce_to_type
from linkwright.launch.places import error_at
from linkwright.launch.substitution import (
    Parsed,
    SomeSubstitutionsType,
    Substitution,
    SubstitutionFailure,
    describe,
    normalize_to_list_of_substitutions,
    perform_substitutions,
)


class _TwoSided(Parsed, Substitution):
    """What compares or joins two sides."""

    ARGUMENTS = ("left", "right")

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
        return f"{type(self).__name__}({describe(self._left)}, {describe(self._right)})"


@expose_substitution("equals")
class EqualsSubstitution(_TwoSided):
    """``true`` if two texts are equal, by number or truth value where both are such."""

    PARSED_AS = "equals"

    def __init__(self, left: Any, right: Any) -> None:
        super().__init__(_operand(left), _operand(right))

    def perform(self, context: LaunchContext) -> str:
        """``true`` or ``false``."""
        return _text(self._equal(context))

    def _equal(self, context: LaunchContext) -> bool:
        left = perform_substitutions(context, self._left)
        right = perform_substitutions(context, self._right)
        truths = [_WORDS.get(text.strip().lower()) for text in (left, right)]
        if None not in truths:
            return truths[0] == truths[1]
        try:
            return math.isclose(float(left), float(right))
        except ValueError:
            return left == right


@expose_substitution("not-equals")
class NotEqualsSubstitution(EqualsSubstitution):
    """``true`` if two texts differ."""

    PARSED_AS = "not-equals"

    def perform(self, context: LaunchContext) -> str:
        """``true`` or ``false``."""
        return _text(not self._equal(context))


@expose_substitution("not")
class NotSubstitution(Parsed, Substitution):
    """The opposite of a truth value."""

    PARSED_AS = "not"
    ARGUMENTS = ("value",)

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


@expose_substitution("and")
class AndSubstitution(_TwoSided):
    """Whether both values are true."""

    PARSED_AS = "and"

    def __init__(self, left: SomeSubstitutionsType, right: SomeSubstitutionsType) -> None:
        super().__init__(normalize_to_list_of_substitutions(left), normalize_to_list_of_substitutions(right))

    def perform(self, context: LaunchContext) -> str:
        """``true`` or ``false``."""
        return _text(all(self._truths(context)))

    def _truths(self, context: LaunchContext) -> list[bool]:
        return [_boolean(self, context, side) for side in (self._left, self._right)]


@expose_substitution("or")
class OrSubstitution(AndSubstitution):
    """Whether one of two values is true."""

    PARSED_AS = "or"

    def perform(self, context: LaunchContext) -> str:
        """``true`` or ``false``."""
        return _text(any(self._truths(context)))


class _Several(Substitution):
    """What combines any number of values."""

    def __init__(self, *args: SomeSubstitutionsType) -> None:
        self._values = [normalize_to_list_of_substitutions(value) for value in args]

    @property
    def args(self) -> list[list[Substitution]]:
        """The values, as substitutions."""
        return self._values

    def describe(self) -> str:
        """The values."""
        return f"{type(self).__name__}({', '.join(map(describe, self._values))})"

    def _truths(self, context: LaunchContext) -> list[bool]:
        return [_boolean(self, context, value) for value in self._values]


def _parsed_any(data: Sequence[Any]) -> tuple[Any, dict[str, Any]]:
    return lambda: AnySubstitution(*data), {}


def _parsed_all(data: Sequence[Any]) -> tuple[Any, dict[str, Any]]:
    return lambda: AllSubstitution(*data), {}


expose_substitution("any")(_parsed_any)
expose_substitution("all")(_parsed_all)


class AnySubstitution(_Several):
    """Whether any of several values is true."""

    def perform(self, context: LaunchContext) -> str:
        """``true`` or ``false``."""
        return _text(any(self._truths(context)))


class AllSubstitution(_Several):
    """Whether all of several values are true."""

    def perform(self, context: LaunchContext) -> str:
        """``true`` or ``false``."""
        return _text(all(self._truths(context)))


@expose_substitution("if")
class IfElseSubstitution(Parsed, Substitution):
    """One text or another, by a truth value.

    Args:
        condition: the truth value.
        if_value: the text where it is true.
        else_value: the text where it is false.
    """

    PARSED_AS = "if"
    ARGUMENTS = ("condition", "if_value")
    OPTIONAL_ARGUMENTS = ("else_value",)

    def __init__(
        self,
        condition: SomeSubstitutionsType,
        if_value: SomeSubstitutionsType = "",
        else_value: SomeSubstitutionsType = "",
    ) -> None:
        if not if_value and not else_value and (if_value, else_value) == ("", ""):
            text = "One of if_value and else_value must be specified"
            raise error_at(
                self.place,
                "LAUNCH127",
                "IfElseSubstitution needs an 'if_value' or an 'else_value'",
                promises=RuntimeError(text),
            )
        self._condition = normalize_to_list_of_substitutions(condition)
        self._if_value = normalize_to_list_of_substitutions(if_value)
        self._else_value = normalize_to_list_of_substitutions(else_value)

    @property
    def condition(self) -> list[Substitution]:
        """The truth value, as substitutions."""
        return self._condition

    @property
    def if_value(self) -> list[Substitution]:
        """The text where it is true, as substitutions."""
        return self._if_value

    @property
    def else_value(self) -> list[Substitution]:
        """The text where it is false, as substitutions."""
        return self._else_value

    def describe(self) -> str:
        """All three parts."""
        parts = (self._condition, self._if_value, self._else_value)
        return f"IfElseSubstitution({', '.join(map(describe, parts))})"

    def perform(self, context: LaunchContext) -> str:
        """The text chosen."""
        chosen = self._if_value if _boolean(self, context, self._condition) else self._else_value
        return perform_substitutions(context, chosen)


_WORDS = {"true": True, "1": True, "false": False, "0": False}


def _operand(value: Any) -> list[Substitution]:
    if value is None:
        value = ""
    if isinstance(value, (bool, int, float)):
        value = str(value).lower() if isinstance(value, bool) else str(value)
    return normalize_to_list_of_substitutions(value)


def _boolean(substitution: Substitution, context: LaunchContext, value: list[Substitution]) -> bool:
    text = perform_substitutions(context, value)
    word = _WORDS.get(text.strip().lower())
    if word is not None:
        return word
    try:
        return bool(coerce_to_type(text, bool))
    except ValueError as error:
        name = type(substitution).__name__
        message = f"{name} needs 'true' or 'false', not '{text}'"
        raise error_at(substitution.place, "LAUNCH127", message, promises=SubstitutionFailure(str(error))) from error


def _text(value: bool) -> str:
    return "true" if value else "false"
