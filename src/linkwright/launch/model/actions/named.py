"""The base classes of actions on launch configurations and environment variables.

Such an action has a name and an optional value.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from linkwright.launch.model.action import Action
from linkwright.launch.model.context import LaunchContext
from linkwright.launch.model.markup.entity import Entity
from linkwright.launch.model.substitution import (
    SomeSubstitutionsType,
    Substitution,
    describe,
    normalize_to_list_of_substitutions,
    perform_substitutions,
)

if TYPE_CHECKING:
    from collections.abc import Iterable

    from linkwright.launch.model.markup.entity import Parser

Pairs = list[tuple[list[Substitution], list[Substitution]]]
"""Names and values, as substitutions."""


class NamedAction(Action):
    """An action on the launch configuration or environment variable with a given name."""

    def __init__(self, name: SomeSubstitutionsType, **kwargs: Any) -> None:
        super().__init__(**kwargs)
        self._name = normalize_to_list_of_substitutions(name)

    @classmethod
    def parse(cls, entity: Entity, parser: Parser) -> tuple[type[Action], dict[str, Any]]:
        """Return the class and keyword arguments for the tag, with its attribute ``name``."""
        _, kwargs = super().parse(entity, parser)
        kwargs["name"] = parser.parse_substitution(entity.get_attr("name"))
        return cls, kwargs

    @property
    def name(self) -> list[Substitution]:
        """The name, as substitutions."""
        return self._name

    def describe(self) -> str:
        """Return a text with the name."""
        return f"{type(self).__name__}({describe(self._name)})"

    def evaluate_name(self, context: LaunchContext) -> str:
        """Return the evaluated name."""
        return perform_substitutions(context, self._name)


class AssigningAction(NamedAction):
    """An action that assigns a value to a launch configuration or environment variable."""

    def __init__(self, name: SomeSubstitutionsType, value: SomeSubstitutionsType, **kwargs: Any) -> None:
        super().__init__(name, **kwargs)
        self._value = normalize_to_list_of_substitutions(value)

    @classmethod
    def parse(cls, entity: Entity, parser: Parser) -> tuple[type[Action], dict[str, Any]]:
        """Return the class and keyword arguments for the tag, including its name and value."""
        _, kwargs = super().parse(entity, parser)
        kwargs["value"] = parser.parse_substitution(entity.get_attr("value"))
        return cls, kwargs

    @property
    def value(self) -> list[Substitution]:
        """The value, as substitutions."""
        return self._value

    def describe(self) -> str:
        """Return a text with the name and the value."""
        return f"{type(self).__name__}({describe(self._name)}, {describe(self._value)})"

    def evaluate_value(self, context: LaunchContext) -> str:
        """Return the evaluated value."""
        return perform_substitutions(context, self._value)


def parse_pairs(entity: Entity, parser: Parser, tag: str) -> dict[Any, Any] | None:
    """Return the names and values in child tags such as ``<env name= value=/>``.

    The result is None if there are no such tags.
    """
    children = entity.get_attr(tag, data_type=list[Entity], optional=True)
    if children is None:
        return None
    pairs = {
        tuple(parser.parse_substitution(child.get_attr("name"))): parser.parse_substitution(child.get_attr("value"))
        for child in children
    }
    for child in children:
        child.assert_entity_completely_parsed()
    return pairs


def normalize_pairs(pairs_or_mapping: Any) -> Pairs:
    """Return (name, value) pairs, or a mapping, as pairs of lists of substitutions."""
    pairs: Iterable[Any] = pairs_or_mapping.items() if hasattr(pairs_or_mapping, "items") else pairs_or_mapping
    return [
        (normalize_to_list_of_substitutions(name), normalize_to_list_of_substitutions(value)) for name, value in pairs
    ]


def perform_pairs(context: LaunchContext, pairs: Pairs) -> dict[str, str]:
    """Return the evaluated names and values as a dictionary."""
    return {perform_substitutions(context, name): perform_substitutions(context, value) for name, value in pairs}
