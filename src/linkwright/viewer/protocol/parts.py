"""What displays and panels are made of: rows of properties and of status."""

from __future__ import annotations

from typing import Literal

from msgspec import field

from linkwright.viewer.protocol.message import Record

StatusLevel = Literal["ok", "warn", "error"]
PropertyKind = Literal["group", "bool", "int", "float", "string", "color", "enum", "frame", "topic"]
PropertyValue = bool | int | float | str | None
RowDetails = Literal["frame", "link", "joint", "effort"]


class TopicOffer(Record):
    """Which topics are offered for a row: those of one of the types with one of the words, if any, in their names."""

    messages: list[str]
    words: list[str]


class Property(Record):
    """One row of a property tree, as RViz shows it.

    `id` is unique in the page and stable for the life of a display. Colours are ``#rrggbb``. A `group` has no value;
    any other kind may have children too (``Line Style`` > ``Line Width``).

    A row with `details` stands for a frame, link or joint of its name. Where that is now the page knows without being
    told again, so it adds read-only rows of its own: RViz's ``Position``, ``Orientation`` and the like.

    For a `topic` without `topics` those are offered that the display can be added for.
    """

    id: str
    name: str
    kind: PropertyKind
    value: PropertyValue = None
    description: str = ""
    options: list[str] = field(default_factory=list)
    minimum: float | None = None
    maximum: float | None = None
    read_only: bool = False
    expanded: bool = False
    children: list[Property] = field(default_factory=list)
    details: RowDetails | None = None
    topics: TopicOffer | None = None


class StatusRow(Record):
    """One row below a display's Status."""

    name: str
    level: StatusLevel
    text: str


class Place(Record):
    """A place in a source file, 1-based, with the way there (macro calls and includes, innermost first)."""

    file: str
    line: int
    column: int
    trail: list[str] = field(default_factory=list)
