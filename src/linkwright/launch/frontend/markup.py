"""What the entities of XML and of YAML share: which of their parts have been read, and messages about the others."""

from __future__ import annotations

from collections.abc import Collection, Iterable
from typing import Any, NoReturn

from linkwright.diagnostics import did_you_mean
from linkwright.launch.frontend.entity import Entity
from linkwright.launch.places import Place, error_at


class MarkupEntity(Entity):
    """An entity with named parts, which notes down what is asked for.

    Args:
        type_name: its tag.
        place: where it stands.
        parent: the entity around it.
    """

    def __init__(self, type_name: str, place: Place | None, parent: Entity | None) -> None:
        self._type_name = type_name
        self._place = place
        self._parent = parent
        self._asked: dict[str, None] = {}

    @property
    def type_name(self) -> str:
        """The tag."""
        return self._type_name

    @property
    def parent(self) -> Entity | None:
        """The entity around it."""
        return self._parent

    @property
    def place(self) -> Place | None:
        """Where it stands."""
        return self._place

    def _check_all_asked(self, present: Iterable[str], what: str, promise: str) -> None:
        """Complain of what is there and has not been asked for.

        Args:
            present: names of what is there.
            what: what it is called.
            promise: ROS's own text about it, with the names to be put behind.
        """
        unknown = [name for name in present if name not in self._asked]
        if not unknown:
            return
        name = unknown[0]
        listed = ", ".join(repr(str(each)) for each in unknown)
        known = [each for each in self._asked if each not in unknown]
        hint = did_you_mean(name, known)
        if hint is None and known:
            hint = f"'{self._type_name}' takes " + ", ".join(f"'{each}'" for each in sorted(known))
        raise error_at(
            self._place_of_part(name),
            "LAUNCH116",
            f"'{self._type_name}' has no {what} '{name}'",
            hint,
            promises=ValueError(f"{promise} `{self._type_name}`: {{{listed}}}"),
        )

    def _place_of_part(self, name: str) -> Place | None:  # noqa: ARG002 - the interface
        return self._place

    def _missing(self, name: str, present: Collection[str], promised: str) -> NoReturn:
        others = [each for each in present if each not in self._asked]
        hint = did_you_mean(name, others)
        if hint is not None:
            hint = f"it has {hint[len('did you mean ') : -1]}: is that the one?"
        message = f"'{self._type_name}' needs an attribute '{name}'"
        raise error_at(self._place, "LAUNCH117", message, hint, promises=AttributeError(promised))

    def _wrong_type(self, name: str, value: Any, data_type: Any, promised: str) -> NoReturn:
        message = f"attribute '{name}' of '{self._type_name}' is {value!r}, which is no {type_words(data_type)}"
        raise error_at(self._place_of_part(name), "LAUNCH118", message, promises=TypeError(promised))


def type_words(data_type: Any) -> str:
    """A type in a user's words."""
    words = {int: "whole number", float: "number", bool: "truth value ('true' or 'false')", str: "text"}
    return words.get(data_type, "list of such values")
