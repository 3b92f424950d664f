"""Substitutions that compare and combine booleans."""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import Any

from linkwright.diagnostics import phrase
from linkwright.launch.errors.exceptions import SubstitutionFailure
from linkwright.launch.errors.locations import error_at
from linkwright.launch.model.context import LaunchContext
from linkwright.launch.model.declared_substitution import (
    AnyTexts,
    DeclaredSubstitution,
    Texts,
)
from linkwright.launch.model.markup.expose import expose_substitution
from linkwright.launch.model.markup.values import coerce_to_type
from linkwright.launch.model.substitution import (
    SomeSubstitutionsType,
    Substitution,
    describe,
    normalize_to_list_of_substitutions,
    perform_substitutions,
)

_BOOLEANS = {"true": True, "1": True, "false": False, "0": False}


def _normalize_operand(value: Any) -> list[Substitution]:
    """Return an operand of a comparison as substitutions.

    The operand may also be a number, a boolean or None.
    """
    if value is None:
        value = ""
    if isinstance(value, (bool, int, float)):
        value = str(value).lower() if isinstance(value, bool) else str(value)
    return normalize_to_list_of_substitutions(value)


class EqualsSubstitution(DeclaredSubstitution, tag="equals"):
    """A substitution that evaluates to ``true`` if two texts are equal, otherwise to ``false``.

    Numbers and booleans are compared by value.
    """

    left: AnyTexts = AnyTexts(read=_normalize_operand)
    right: AnyTexts = AnyTexts(read=_normalize_operand)

    def perform(self, context: LaunchContext) -> str:
        """Return ``true`` if the texts are equal, otherwise ``false``."""
        return _format_boolean(self._is_equal(context))

    def _is_equal(self, context: LaunchContext) -> bool:
        left = perform_substitutions(context, self.left)
        right = perform_substitutions(context, self.right)
        booleans = [_BOOLEANS.get(text.strip().lower()) for text in (left, right)]
        if None not in booleans:
            return booleans[0] == booleans[1]
        try:
            return math.isclose(float(left), float(right))
        except ValueError:
            return left == right


class NotEqualsSubstitution(EqualsSubstitution, tag="not-equals"):
    """A substitution that evaluates to ``true`` if two texts differ, otherwise to ``false``."""

    def perform(self, context: LaunchContext) -> str:
        """Return ``true`` if the texts differ, otherwise ``false``."""
        return _format_boolean(not self._is_equal(context))


class NotSubstitution(DeclaredSubstitution, tag="not", shown="NotSubstitution({value})"):
    """A substitution that evaluates to ``true`` if a boolean is false, otherwise to ``false``."""

    value: Texts = Texts()

    def perform(self, context: LaunchContext) -> str:
        """Return ``true`` if the value is false, otherwise ``false``."""
        return _format_boolean(not _evaluate_boolean(self, context, self.value))


class AndSubstitution(DeclaredSubstitution, tag="and"):
    """A substitution that evaluates to ``true`` if two booleans are both true.

    Otherwise, it evaluates to ``false``.
    """

    left: Texts = Texts()
    right: Texts = Texts()

    def perform(self, context: LaunchContext) -> str:
        """Return ``true`` if both values are true, otherwise ``false``."""
        return _format_boolean(all(self._evaluate_operands(context)))

    def _evaluate_operands(self, context: LaunchContext) -> list[bool]:
        return [_evaluate_boolean(self, context, operand) for operand in (self.left, self.right)]


class OrSubstitution(AndSubstitution, tag="or"):
    """A substitution that evaluates to ``true`` if at least one of two booleans is true.

    Otherwise, it evaluates to ``false``.
    """

    def perform(self, context: LaunchContext) -> str:
        """Return ``true`` if at least one value is true, otherwise ``false``."""
        return _format_boolean(any(self._evaluate_operands(context)))


class _MultiValueSubstitution(Substitution):
    """The base class of substitutions that combine any number of values."""

    def __init__(self, *args: SomeSubstitutionsType) -> None:
        self._values = [normalize_to_list_of_substitutions(value) for value in args]

    @property
    def args(self) -> list[list[Substitution]]:
        """The values, as substitutions."""
        return self._values

    def describe(self) -> str:
        """Return a text with the values."""
        return f"{type(self).__name__}({', '.join(map(describe, self._values))})"

    def _evaluate_operands(self, context: LaunchContext) -> list[bool]:
        return [_evaluate_boolean(self, context, value) for value in self._values]


def _parse_any(data: Sequence[Any]) -> tuple[Any, dict[str, Any]]:
    return lambda: AnySubstitution(*data), {}


def _parse_all(data: Sequence[Any]) -> tuple[Any, dict[str, Any]]:
    return lambda: AllSubstitution(*data), {}


expose_substitution("any")(_parse_any)
expose_substitution("all")(_parse_all)


class AnySubstitution(_MultiValueSubstitution):
    """A substitution that evaluates to ``true`` if at least one of several booleans is true.

    Otherwise, it evaluates to ``false``.
    """

    def perform(self, context: LaunchContext) -> str:
        """Return ``true`` if at least one value is true, otherwise ``false``."""
        return _format_boolean(any(self._evaluate_operands(context)))


class AllSubstitution(_MultiValueSubstitution):
    """A substitution that evaluates to ``true`` if several booleans are all true.

    Otherwise, it evaluates to ``false``.
    """

    def perform(self, context: LaunchContext) -> str:
        """Return ``true`` if all values are true, otherwise ``false``."""
        return _format_boolean(all(self._evaluate_operands(context)))


class IfElseSubstitution(
    DeclaredSubstitution, tag="if", shown="IfElseSubstitution({condition}, {if_value}, {else_value})"
):
    """A substitution that evaluates to one of two texts, selected by a boolean.

    Args:
        condition: the boolean.
        if_value: the text if the boolean is true.
        else_value: the text if the boolean is false.
    """

    condition: Texts = Texts()
    if_value: Texts = Texts()
    else_value: Texts = Texts(default="")

    def __init__(
        self,
        condition: SomeSubstitutionsType,
        if_value: SomeSubstitutionsType = "",
        else_value: SomeSubstitutionsType = "",
    ) -> None:
        if not if_value and not else_value and (if_value, else_value) == ("", ""):
            text = "One of if_value and else_value must be specified"
            raise error_at(
                self.source_location,
                "LAUNCH127",
                phrase("IfElseSubstitution needs an 'if_value' or an 'else_value'"),
                ros_error=RuntimeError(text),
            )
        self.condition, self.if_value, self.else_value = condition, if_value, else_value

    def perform(self, context: LaunchContext) -> str:
        """Return the selected text."""
        selected_value = self.if_value if _evaluate_boolean(self, context, self.condition) else self.else_value
        return perform_substitutions(context, selected_value)


def _evaluate_boolean(substitution: Substitution, context: LaunchContext, value: list[Substitution]) -> bool:
    text = perform_substitutions(context, value)
    boolean = _BOOLEANS.get(text.strip().lower())
    if boolean is not None:
        return boolean
    try:
        return bool(coerce_to_type(text, bool))
    except ValueError as error:
        name = type(substitution).__name__
        message = phrase("{name} needs 'true' or 'false', not '{text}'", name=name, text=text)
        raise error_at(
            substitution.source_location, "LAUNCH127", message, ros_error=SubstitutionFailure(str(error))
        ) from error


def _format_boolean(value: bool) -> str:
    return "true" if value else "false"
