"""Substitutions: text that is known only when the launch runs."""

from __future__ import annotations

from collections.abc import Iterable
from pathlib import Path
from typing import TYPE_CHECKING, Any

from linkwright.launch.errors.places import Placed

if TYPE_CHECKING:
    from linkwright.launch.model.context import LaunchContext


class Substitution(Placed):
    """Something that becomes text when it is performed in a launch context."""

    def __repr__(self) -> str:
        return f"<{_public_name(type(self))} {self.describe()}>"

    def describe(self) -> str:
        """A short form for listings, as ``ros2 launch --show-args`` prints it."""
        return f"{type(self).__name__}()"

    def perform(self, context: LaunchContext) -> str:
        """The text."""
        raise NotImplementedError(f"{type(self).__name__} does not define perform()")


class TextSubstitution(Substitution):
    """Text that is already known."""

    def __init__(self, *, text: str) -> None:
        if not isinstance(text, str):
            raise TypeError(f"TextSubstitution expects a str as 'text', got {type(text).__name__}")
        self.text = text

    def describe(self) -> str:
        """The text in quotes."""
        return f"'{self.text}'"

    def perform(self, context: LaunchContext) -> str:
        """The text."""
        return self.text


SomeSubstitutionsType = str | Substitution | Iterable[str | Substitution]
"""A text, a substitution, or several of them to be joined."""

SomeSubstitutionsType_types_tuple = (str, Substitution, Iterable)


def normalize_to_list_of_substitutions(value: Any) -> list[Substitution]:
    """A value of `SomeSubstitutionsType` as a list of substitutions; paths count as text.

    Raises:
        TypeError: for anything else.
    """
    if isinstance(value, Substitution):
        return [value]
    if isinstance(value, (str, Path)):
        return [TextSubstitution(text=str(value))]
    if isinstance(value, Iterable) and not isinstance(value, bytes):
        return [_single(each) for each in value]
    raise TypeError(f"expected a text, a substitution or a list of them, got {value!r} of type {type(value).__name__}")


def perform_substitutions(context: LaunchContext, substitutions: Iterable[Substitution]) -> str:
    """The texts of several substitutions, joined."""
    return "".join(context.perform_substitution(substitution) for substitution in substitutions)


def describe(substitutions: Iterable[Substitution]) -> str:
    """Several substitutions as listings show them."""
    return " + ".join(substitution.describe() for substitution in substitutions)


def _single(value: Any) -> Substitution:
    if isinstance(value, Substitution):
        return value
    if isinstance(value, (str, Path)):
        return TextSubstitution(text=str(value))
    raise TypeError(f"expected a text or a substitution in the list, got {value!r} of type {type(value).__name__}")


def _public_name(kind: type) -> str:
    """The name by which users import a class: ours have those of ``launch``."""
    if not kind.__module__.startswith("linkwright."):
        return f"{kind.__module__}.{kind.__qualname__}"
    module = "".join("_" + each.lower() if each.isupper() else each for each in kind.__name__).lstrip("_")
    return f"launch.substitutions.{module}.{kind.__name__}"
