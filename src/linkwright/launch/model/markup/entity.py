"""The interfaces of functions that read tags: the entity (an XML tag or YAML mapping), and the parser of its file."""

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
        """Where it stands; None for one that was made by a program."""
        return None

    def assert_entity_completely_parsed(self) -> None:
        """Check that all that is written in it has been read.

        Raises:
            ValueError: LAUNCH116, attributes or entities inside that nobody asked for.
        """
        raise NotImplementedError

    def get_attr(self, name: str, *, data_type: Any = str, optional: bool = False, can_be_str: bool = True) -> Any:
        """An attribute, or the entities inside of one name.

        Args:
            name: the attribute.
            data_type: the type of its value (see `linkwright.launch.model.markup.values`); None goes by YAML, and a
                list of `Entity` asks for the entities of that name.
            optional: whether None is given where it is not there.
            can_be_str: whether text is given where it cannot be of the type: a substitution may be in it.

        Raises:
            AttributeError: LAUNCH117, it is not there and not optional.
            TypeError: LAUNCH118, it has another type.
            ValueError: LAUNCH118, it has another type.
        """
        raise NotImplementedError


def is_list_of_entities(data_type: Any) -> bool:
    """Whether a type asks for entities: ``List[Entity]`` or ``list[Entity]``, also of a class derived from it."""
    arguments = typing.get_args(data_type)
    return (
        typing.get_origin(data_type) is list
        and len(arguments) == 1
        and isinstance(arguments[0], type)
        and issubclass(arguments[0], Entity)
    )


class PlacedText(str):
    """A text of a launch file that knows where it stands."""

    __slots__ = ("place",)

    place: Place | None

    def __new__(cls, text: str, place: Place | None) -> PlacedText:  # noqa: PYI034 - Self needs Python 3.11
        """The text, with its place."""
        made = super().__new__(cls, text)
        made.place = place
        return made


def place_of(text: object) -> Place | None:
    """Where a text stands, if it knows."""
    return text.place if isinstance(text, PlacedText) else None


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
