"""The interfaces for functions that read tags: the entity (an XML tag or YAML mapping) and its file's parser."""

from __future__ import annotations

import typing
from typing import Any, Protocol

from linkwright.launch.errors.places import Place
from linkwright.launch.model.entity import LaunchDescriptionEntity
from linkwright.launch.model.substitution import Substitution


class Entity:
    """An XML tag or YAML mapping, as functions that read tags see it."""

    @property
    def type_name(self) -> str:
        """The tag."""
        raise NotImplementedError

    @property
    def parent(self) -> Entity | None:
        """The entity around it."""
        raise NotImplementedError

    @property
    def children(self) -> list[Entity]:
        """The entities inside."""
        raise NotImplementedError

    @property
    def place(self) -> Place | None:
        """The location; None for an entity that a program created."""
        return None

    def assert_entity_completely_parsed(self) -> None:
        """Check that all of its parts have been read.

        Raises:
            ValueError: LAUNCH116, unread attributes or child entities.
        """
        raise NotImplementedError

    def get_attr(self, name: str, *, data_type: Any = str, optional: bool = False, can_be_str: bool = True) -> Any:
        """Return an attribute, or the child entities with a name.

        Args:
            name: the attribute.
            data_type: the type of its value (see `linkwright.launch.model.markup.values`); None uses YAML's rules, and
                a list of `Entity` requests the child entities with that name.
            optional: whether to return None if it is missing.
            can_be_str: whether to return a string that is not of the type, which may contain a substitution.

        Raises:
            AttributeError: LAUNCH117, it is missing and not optional.
            TypeError: LAUNCH118, it has another type.
            ValueError: LAUNCH118, it has another type.
        """
        raise NotImplementedError


def is_list_of_entities(data_type: Any) -> bool:
    """Return whether a type requests entities: ``List[Entity]`` or ``list[Entity]``, also of a subclass."""
    arguments = typing.get_args(data_type)
    return (
        typing.get_origin(data_type) is list
        and len(arguments) == 1
        and isinstance(arguments[0], type)
        and issubclass(arguments[0], Entity)
    )


class PlacedText(str):
    """A string of a launch file that records its location."""

    __slots__ = ("place",)

    place: Place | None

    def __new__(cls, text: str, place: Place | None) -> PlacedText:  # noqa: PYI034 - Self needs Python 3.11
        """Create the string with its place."""
        made = super().__new__(cls, text)
        made.place = place
        return made


def place_of(text: object) -> Place | None:
    """Return the location of a string, if it has one."""
    return text.place if isinstance(text, PlacedText) else None


class Parser(Protocol):
    """Creates actions and substitutions from entities; `linkwright.launch.frontend.parser.Parser` is one."""

    def parse_action(self, entity: Entity) -> LaunchDescriptionEntity:
        """The action of an entity."""

    def parse_substitution(self, value: str) -> list[Substitution]:
        """A text with ``$(...)`` in it, as substitutions."""

    def parse_if_substitutions(self, value: Any) -> Any:
        """A value with the substitutions in its texts."""

    def escape_characters(self, value: str) -> str:
        """The text with its escapes resolved."""


def parse_texts(entity: Entity, parser: Parser, **attributes: str) -> dict[str, list[Substitution]]:
    """Return the keyword arguments with substitutions for the attributes that the tag has.

    Args:
        entity: the tag.
        parser: for the substitutions.
        attributes: the attribute of each argument.
    """
    given = {argument: entity.get_attr(attribute, optional=True) for argument, attribute in attributes.items()}
    return {argument: parser.parse_substitution(text) for argument, text in given.items() if text is not None}
