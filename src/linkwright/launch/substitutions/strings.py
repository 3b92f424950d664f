"""Substitutions that work on texts."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from typing import Any

from linkwright.launch.context import LaunchContext
from linkwright.launch.frontend.expose import expose_substitution
from linkwright.launch.substitution import (
    Parsed,
    SomeSubstitutionsType,
    Substitution,
    describe,
    normalize_to_list_of_substitutions,
    perform_substitutions,
)


@expose_substitution("string-join")
class StringJoinSubstitution(Substitution):
    """Texts with a delimiter between them.

    Args:
        substitutions: the texts; each may be made of several.
        delimiter: what stands between.
    """

    def __init__(self, substitutions: Iterable[SomeSubstitutionsType], delimiter: SomeSubstitutionsType = "") -> None:
        self._parts = [normalize_to_list_of_substitutions(part) for part in substitutions]
        self._delimiter = normalize_to_list_of_substitutions(delimiter)

    @classmethod
    def parse(cls, data: Sequence[Any]) -> tuple[type[Substitution], dict[str, Any]]:
        """The class and its arguments, for a delimiter and texts.

        Raises:
            ValueError: there are not enough.
        """
        if len(data) < 2:
            raise ValueError("string-join substitution expects a delimiter and at least 1 more argument")
        return cls, {"delimiter": data[0], "substitutions": data[1:]}

    @property
    def substitutions(self) -> list[list[Substitution]]:
        """The texts, as substitutions."""
        return self._parts

    @property
    def delimiter(self) -> list[Substitution]:
        """What stands between, as substitutions."""
        return self._delimiter

    def describe(self) -> str:
        """The texts and the delimiter."""
        texts = ", ".join(map(describe, self._parts))
        return f"StringJoin({describe(self._delimiter)}, {texts})"

    def perform(self, context: LaunchContext) -> str:
        """The joined text."""
        delimiter = perform_substitutions(context, self._delimiter)
        return delimiter.join(perform_substitutions(context, part) for part in self._parts)


class _OfOneText(Parsed, Substitution):
    """What works on one text."""

    ARGUMENTS = ("value",)

    def __init__(self, value: SomeSubstitutionsType) -> None:
        self._value = normalize_to_list_of_substitutions(value)

    @property
    def value(self) -> list[Substitution]:
        """The text, as substitutions."""
        return self._value

    def describe(self) -> str:
        """The text."""
        return f"{type(self).__name__}({describe(self._value)})"


@expose_substitution("string-strip")
class StringStripSubstitution(_OfOneText):
    """A text without blanks at its ends."""

    PARSED_AS = "string-strip"

    def perform(self, context: LaunchContext) -> str:
        """The text."""
        return perform_substitutions(context, self._value).strip()


@expose_substitution("is-empty")
class IsEmptySubstitution(_OfOneText):
    """Whether a text has no characters."""

    PARSED_AS = "is-empty"

    def perform(self, context: LaunchContext) -> str:
        """``true`` or ``false``."""
        return "false" if perform_substitutions(context, self._value) else "true"


@expose_substitution("not-empty")
class NotEmptySubstitution(_OfOneText):
    """Whether a text has characters."""

    PARSED_AS = "not-empty"

    def perform(self, context: LaunchContext) -> str:
        """``true`` or ``false``."""
        return "true" if perform_substitutions(context, self._value) else "false"
