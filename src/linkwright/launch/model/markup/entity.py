"""The interfaces that functions for reading tags use.

They are `Entity`, which is an XML tag or YAML mapping, and `Parser`, which parses the file.
"""

from __future__ import annotations

import typing
from typing import Any, Protocol

from linkwright.launch.errors.locations import SourceLocation
from linkwright.launch.model.entity import LaunchDescriptionEntity
from linkwright.launch.model.substitution import Substitution


class Entity:
    """The interface of an XML tag or YAML mapping in a launch file."""

    @property
    def type_name(self) -> str:
        """The tag of the entity."""
        raise NotImplementedError

    @property
    def parent(self) -> Entity | None:
        """The enclosing entity, or None for the root."""
        raise NotImplementedError

    @property
    def children(self) -> list[Entity]:
        """The child entities."""
        raise NotImplementedError

    @property
    def source_location(self) -> SourceLocation | None:
        """The location of the entity in its file, or None if a program created the entity."""
        return None

    def assert_entity_completely_parsed(self) -> None:
        """Raise an error if some attributes or child entities have not been read.

        Raises:
            ValueError: LAUNCH116, an attribute or child entity was not read.
        """
        raise NotImplementedError

    def get_attr(self, name: str, *, data_type: Any = str, optional: bool = False, can_be_str: bool = True) -> Any:
        """Return the value of an attribute, or the child entities with a name.

        Args:
            name: the name of the attribute.
            data_type: the type of the value (see `linkwright.launch.model.markup.values`); None applies YAML's rules,
                and a list of `Entity` requests the child entities with that name.
            optional: whether to return None if the attribute is missing.
            can_be_str: whether to return a string unchanged if it is not of the type, because it may contain a
                substitution.

        Raises:
            AttributeError: LAUNCH117, the attribute is missing and not optional.
            TypeError, ValueError: LAUNCH118, the attribute has another type.
        """
        raise NotImplementedError


def is_list_of_entities(data_type: Any) -> bool:
    """Return whether a type is ``List[Entity]`` or ``list[Entity]``.

    The items may also be of a subclass of `Entity`.
    """
    arguments = typing.get_args(data_type)
    return (
        typing.get_origin(data_type) is list
        and len(arguments) == 1
        and isinstance(arguments[0], type)
        and issubclass(arguments[0], Entity)
    )


class LocatedText(str):
    """A string from a launch file that has a location."""

    __slots__ = ("source_location",)

    source_location: SourceLocation | None

    def __new__(cls, text: str, location: SourceLocation | None) -> LocatedText:  # noqa: PYI034 - Self needs Python 3.11
        """Return a string with a location."""
        located_text = super().__new__(cls, text)
        located_text.source_location = location
        return located_text


def location_of(text: object) -> SourceLocation | None:
    """Return the location of a string, or None if it has none."""
    return text.source_location if isinstance(text, LocatedText) else None


class Parser(Protocol):
    """The interface of objects that create actions and substitutions from entities.

    `linkwright.launch.frontend.parser.Parser` implements it.
    """

    def parse_action(self, entity: Entity) -> LaunchDescriptionEntity:
        """Return the action that an entity describes."""

    def parse_substitution(self, value: str) -> list[Substitution]:
        """Parse a text that may contain ``$(...)`` into substitutions."""

    def parse_if_substitutions(self, value: Any) -> Any:
        """Return a value with the substitutions in its strings parsed.

        Strings without substitutions are unchanged.
        """

    def escape_characters(self, value: str) -> str:
        """Return the text with its backslash escapes resolved."""


def parse_attributes(entity: Entity, parser: Parser, **attributes: str) -> dict[str, list[Substitution]]:
    """Return keyword arguments for the given attributes that the tag has.

    Args:
        entity: the tag.
        parser: parses the substitutions.
        attributes: maps the names of arguments to the names of attributes.
    """
    texts = {argument: entity.get_attr(attribute, optional=True) for argument, attribute in attributes.items()}
    return {argument: parser.parse_substitution(text) for argument, text in texts.items() if text is not None}
