"""Substitutions: objects that evaluate to text when the launch runs."""

from __future__ import annotations

from collections.abc import Iterable
from pathlib import Path
from typing import TYPE_CHECKING, Any

from linkwright.launch.errors.locations import Located

if TYPE_CHECKING:
    from linkwright.launch.model.context import LaunchContext


class Substitution(Located):
    """An object that evaluates to text in a launch context."""

    def __repr__(self) -> str:
        return f"<{_find_public_name(type(self))} {self.describe()}>"

    def describe(self) -> str:
        """Return the text of the substitution in listings such as ``ros2 launch --show-args``."""
        return f"{type(self).__name__}()"

    def perform(self, context: LaunchContext) -> str:
        """Evaluate the substitution in a launch context, and return the resulting text."""
        raise NotImplementedError(f"{type(self).__name__} does not define perform()")


class TextSubstitution(Substitution):
    """A constant text."""

    def __init__(self, *, text: str) -> None:
        if not isinstance(text, str):
            raise TypeError(f"TextSubstitution expects a str as 'text', got {type(text).__name__}")
        self.text = text

    def describe(self) -> str:
        """Return the text in quotes."""
        return f"'{self.text}'"

    def perform(self, context: LaunchContext) -> str:
        """Return the text."""
        return self.text


SomeSubstitutionsType = str | Substitution | Iterable[str | Substitution]
"""A text, a substitution, or an iterable of these whose texts are joined."""

SomeSubstitutionsType_types_tuple = (str, Substitution, Iterable)


def normalize_to_list_of_substitutions(value: Any) -> list[Substitution]:
    """Return a value of `SomeSubstitutionsType` as a list of substitutions.

    A path is converted to its text.

    Raises:
        TypeError: the value has another type.
    """
    if isinstance(value, Substitution):
        return [value]
    if isinstance(value, (str, Path)):
        return [TextSubstitution(text=str(value))]
    if isinstance(value, Iterable) and not isinstance(value, bytes):
        return [_as_substitution(item) for item in value]
    raise TypeError(f"expected a text, a substitution or a list of them, got {value!r} of type {type(value).__name__}")


def perform_substitutions(context: LaunchContext, substitutions: Iterable[Substitution]) -> str:
    """Evaluate substitutions, and return their concatenated texts."""
    return "".join(context.perform_substitution(substitution) for substitution in substitutions)


def describe(substitutions: Iterable[Substitution]) -> str:
    """Return the text of substitutions in listings."""
    return " + ".join(substitution.describe() for substitution in substitutions)


def _as_substitution(value: Any) -> Substitution:
    if isinstance(value, Substitution):
        return value
    if isinstance(value, (str, Path)):
        return TextSubstitution(text=str(value))
    raise TypeError(f"expected a text or a substitution in the list, got {value!r} of type {type(value).__name__}")


def _find_public_name(kind: type) -> str:
    """Return the full name with which users import a class.

    Linkwright's own classes have the names of ``launch.substitutions``.
    """
    if not kind.__module__.startswith("linkwright."):
        return f"{kind.__module__}.{kind.__qualname__}"
    module_name = "".join("_" + letter.lower() if letter.isupper() else letter for letter in kind.__name__).lstrip("_")
    return f"launch.substitutions.{module_name}.{kind.__name__}"
