"""The base class of XML and YAML entities.

The class records the parts that were read, and reports the remaining ones as unknown.
"""

from __future__ import annotations

from collections.abc import Collection, Iterable
from typing import Any, NoReturn

from linkwright.diagnostics import Phrase, did_you_mean, nearest, phrase, quoted_names, term
from linkwright.launch.errors.locations import SourceLocation, error_at
from linkwright.launch.model.markup.entity import Entity


class MarkupEntity(Entity):
    """An entity with named parts that records which parts were read.

    Args:
        type_name: the tag of the entity.
        location: the location of the entity.
        parent: the enclosing entity.
    """

    def __init__(self, type_name: str, location: SourceLocation | None, parent: Entity | None) -> None:
        self._type_name = type_name
        self._location = location
        self._parent = parent
        self._read_names: dict[str, None] = {}

    @property
    def type_name(self) -> str:
        """The tag of the entity."""
        return self._type_name

    @property
    def parent(self) -> Entity | None:
        """The enclosing entity, or None for the root."""
        return self._parent

    @property
    def source_location(self) -> SourceLocation | None:
        """The location of the entity, or None if it is unknown."""
        return self._location

    def _check_all_read(self, present: Iterable[str], part_kind: str, ros_text: str) -> None:
        """Raise an error if some parts of the entity were not read.

        Args:
            present: the names of all parts.
            part_kind: the term for such a part in the message, such as ``attribute``.
            ros_text: the text of the error in ROS, to which the names are appended.

        Raises:
            ValueError: LAUNCH116, a part was not read.
        """
        unread_names = [name for name in present if name not in self._read_names]
        if not unread_names:
            return
        name = unread_names[0]
        names_text = ", ".join(repr(str(unread_name)) for unread_name in unread_names)
        known_names = [name for name in self._read_names if name not in unread_names]
        hint = did_you_mean(name, known_names)
        if hint is None and known_names:
            hint = phrase(
                "'{type_name}' accepts {names}", type_name=self._type_name, names=quoted_names(sorted(known_names))
            )
        raise error_at(
            self._locate_part(name),
            "LAUNCH116",
            phrase(
                "'{type_name}' has no {part_kind} '{name}'",
                type_name=self._type_name,
                part_kind=term(part_kind),
                name=name,
            ),
            hint,
            ros_error=ValueError(f"{ros_text} `{self._type_name}`: {{{names_text}}}"),
        )

    def _locate_part(self, name: str) -> SourceLocation | None:
        return self._location

    def _fail_missing(self, name: str, present: Collection[str], ros_error: str) -> NoReturn:
        unread_names = [candidate for candidate in present if candidate not in self._read_names]
        similar_names = nearest(name, unread_names)
        hint = (
            phrase("did you mean '{name}' instead of {names}?", name=name, names=quoted_names(similar_names, " or "))
            if similar_names
            else None
        )
        message = phrase("'{type_name}' needs an attribute '{name}'", type_name=self._type_name, name=name)
        raise error_at(self._location, "LAUNCH117", message, hint, ros_error=AttributeError(ros_error))

    def _fail_wrong_type(self, name: str, value: Any, data_type: Any, ros_error: str) -> NoReturn:
        message = phrase(
            "attribute '{name}' of '{type_name}' is {value}, which is not {type}",
            name=name,
            type_name=self._type_name,
            value=repr(value),
            type=describe_type(data_type),
        )
        raise error_at(self._locate_part(name), "LAUNCH118", message, ros_error=TypeError(ros_error))


def describe_type(data_type: Any) -> Phrase:
    """Return the phrase for a type in messages, such as "an integer"."""
    type_words = {
        int: phrase("an integer"),
        float: phrase("a number"),
        bool: phrase("a boolean ('true' or 'false')"),
        str: phrase("a string"),
    }
    return type_words.get(data_type, phrase("a list of the expected type"))
