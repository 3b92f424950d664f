"""The values of configuration files in Lua."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import Union

from linkwright.diagnostics import SourceText, Span


@dataclass(frozen=True, slots=True)
class Place:
    """The place of a value: the file and the range in the file."""

    source: SourceText
    start: int
    end: int

    @property
    def span(self) -> Span:
        """The range with line and column."""
        return self.source.span(self.start, self.end)


@dataclass(slots=True, eq=False)
class Table:
    """A table of Lua, which is shared by all variables that refer to it.

    Attributes:
        values: the values by key; items without a key have the keys 1, 2, ....
        places: the places of the last assignments, by key.
    """

    values: dict[Key, Value] = field(default_factory=dict)
    places: dict[Key, Place] = field(default_factory=dict)

    def assign(self, key: Key, value: Value, place: Place) -> None:
        """Set the value of a key; nil removes the key."""
        if value is None:
            self.values.pop(key, None)
            self.places.pop(key, None)
            return
        self.values[key] = value
        self.places[key] = place


Key = Union[str, float]  # noqa: UP007 - evaluated at run time by Python 3.10
Value = Union[bool, float, str, Table, None]  # noqa: UP007
