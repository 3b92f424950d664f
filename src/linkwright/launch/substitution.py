"""Substitutions: text that is known only when the launch runs."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any, TypeVar

from linkwright.diagnostics import LinkwrightError
from linkwright.launch.places import Place, error_at, located

if TYPE_CHECKING:
    from linkwright.launch.context import LaunchContext

S = TypeVar("S", bound="Substitution")


class SubstitutionFailure(RuntimeError):  # noqa: N818 - its name in ROS
    """What a substitution written by a user raises when it cannot give a text."""


class Substitution:
    """Something that becomes text when it is performed in a launch context.

    Attributes:
        place: where in the user's program it was made.
    """

    place: Place | None = None

    def __new__(cls: type[S], *_: Any, **__: Any) -> S:  # noqa: PYI019 - Self needs Python 3.11
        """Remember the place; done here because substitutions of users need not call our constructor."""
        made = super().__new__(cls)
        made.place = Place.of_caller()
        return made

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

    def perform(self, context: LaunchContext) -> str:  # noqa: ARG002 - the interface of substitutions
        """The text."""
        return self.text


SomeSubstitutionsType = str | Substitution | Iterable[str | Substitution]
"""What may stand where a text is expected: a text, a substitution, or several of them to be joined."""

SomeSubstitutionsType_types_tuple = (str, Substitution, Iterable)


class Parsed:
    """What substitutions with a fixed number of arguments share: how ``$(name ...)`` makes them."""

    PARSED_AS = ""
    ARGUMENTS: tuple[str, ...] = ()
    OPTIONAL_ARGUMENTS: tuple[str, ...] = ()

    @classmethod
    def parse(cls, data: Sequence[Any]) -> tuple[type[Any], dict[str, Any]]:
        """The class and the keyword arguments.

        Args:
            data: the arguments, each a list of substitutions.

        Raises:
            TypeError: there are too many or too few.
        """
        least, most = len(cls.ARGUMENTS), len(cls.ARGUMENTS) + len(cls.OPTIONAL_ARGUMENTS)
        if not least <= len(data) <= most:
            expected = str(most) if least == most else f"{least} or {most}"
            plural = "" if most == 1 else "s"
            raise TypeError(f"{cls.PARSED_AS} substitution expects {expected} argument{plural}")
        return cls, dict(zip((*cls.ARGUMENTS, *cls.OPTIONAL_ARGUMENTS), data, strict=False))


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
    return "".join(perform(context, each) for each in substitutions)


def perform(context: LaunchContext, substitution: Substitution) -> str:
    """The text of one substitution; an error says where the substitution was written."""
    try:
        return substitution.perform(context)
    except LinkwrightError as error:
        raise located(error, substitution.place) from error
    except SubstitutionFailure as error:
        raise error_at(substitution.place, "LAUNCH120", str(error), promises=error) from error


def describe(substitutions: Iterable[Substitution]) -> str:
    """Several substitutions as listings show them."""
    return " + ".join(each.describe() for each in substitutions)


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
