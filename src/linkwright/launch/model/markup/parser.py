"""What the functions that read tags ask of the parser of their file."""

from __future__ import annotations

from typing import Any, Protocol

from linkwright.launch.model.entity import LaunchDescriptionEntity
from linkwright.launch.model.markup.entity import Entity
from linkwright.launch.model.substitution import Substitution


class Parser(Protocol):
    """Makes actions and substitutions out of entities; `linkwright.launch.frontend.parser.Parser` is one."""

    def parse_action(self, entity: Entity) -> LaunchDescriptionEntity:
        """The action of an entity."""

    def parse_substitution(self, value: str) -> list[Substitution]:
        """A text with ``$(...)`` in it, as substitutions."""

    def parse_if_substitutions(self, value: Any) -> Any:
        """A value with the substitutions in its texts."""

    def escape_characters(self, value: str) -> str:
        """The text with its escapes resolved."""


def parse_texts(entity: Entity, parser: Parser, **attributes: str) -> dict[str, list[Substitution]]:
    """The keyword arguments that are texts with substitutions in them, those whose attribute the tag has.

    Args:
        entity: the tag.
        parser: for the substitutions.
        attributes: the attribute of each argument.
    """
    given = {argument: entity.get_attr(attribute, optional=True) for argument, attribute in attributes.items()}
    return {argument: parser.parse_substitution(text) for argument, text in given.items() if text is not None}
