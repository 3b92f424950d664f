"""The Displays tree, and the elements of displays and panels: rows of properties and of status."""

from __future__ import annotations

from typing import ClassVar, Literal

from msgspec import field

from linkwright.page.protocol.message import PageMessage, Record, ServerMessage

StatusLevel = Literal["ok", "warn", "error"]
PropertyKind = Literal["group", "bool", "int", "float", "string", "color", "enum", "frame", "topic"]
PropertyValue = bool | int | float | str | None
RowDetails = Literal["frame", "link", "joint", "effort"]


class TopicOffer(Record):
    """The topics offered for a row: those of one of the types, whose names contain one of the words, if any."""

    messages: list[str]
    words: list[str]


class Property(Record):
    """A row of a property tree, as RViz shows it.

    `id` is unique in the page and stable for the life of a display. Colours are ``#rrggbb``. A `group` has no value;
    any other kind may have children too (``Line Style`` > ``Line Width``).

    A row with `details` represents the frame, link or joint of its name. The page knows its current pose, so it adds
    read-only rows of its own: RViz's ``Position``, ``Orientation`` and the like.

    A `topic` without `topics` offers those that the display can be added for.
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
    """A row below a display's Status. Its text is usually a phrase, which each page gets in its language."""

    name: str
    level: StatusLevel
    text: str


class Place(Record):
    """A place in a source file, 1-based, with the way there (macro calls and includes, innermost first)."""

    file: str
    line: int
    column: int
    trail: list[str] = field(default_factory=list)


class Display(Record):
    """A display of the Displays panel. `cls` is RViz's class, such as ``rviz_default_plugins/Grid``.

    `group` is the id of the group it is in, ``rviz_common/Group``, which comes before it. `enabled` is its own box; it
    is drawn if those of the groups around it are on too.

    `drawing` is the class whose drawing the page uses: its own, or for a display of another package the one it is like.

    `supported` is false for a class this program does not draw; it is kept and shown as such. The rows:

    - RobotModel: a shape is drawn with the alpha of its colour, times ``Alpha``, times the link's ``Alpha`` below
      ``Links``. A link's row is a ``bool`` (draw its shapes) when it has any, else a ``group``.
    - TF: a frame is drawn when it has a row below ``Frames`` and that is on; frames that the filters leave out have
      none. ``Update Interval`` (seconds between updates, 0 for every frame) of both is applied by the page.
    """

    id: str
    cls: str
    drawing: str
    name: str
    group: str | None
    enabled: bool
    supported: bool
    level: StatusLevel
    status: list[StatusRow]
    properties: list[Property]


class Tree(ServerMessage):
    """The complete Displays tree: sent at the start and when displays are added, removed or moved."""

    global_options: list[Property]
    global_status: list[StatusRow]
    global_level: StatusLevel
    displays: list[Display]


class DisplayProperties(ServerMessage):
    """All property rows of one display again (the links of a new robot, the frames of TF)."""

    NEWEST_OF: ClassVar[tuple[str, ...]] = ("display",)

    display: str
    properties: list[Property]


class PropertyChanged(ServerMessage):
    """A new value, set by any page or by the server. Enable boxes are the property ``<display>/Enabled``."""

    NEWEST_OF: ClassVar[tuple[str, ...]] = ("id",)

    id: str
    value: PropertyValue
    options: list[str] | None = None


class DisplayStatus(ServerMessage):
    """The status rows of one display, or of ``global``."""

    NEWEST_OF: ClassVar[tuple[str, ...]] = ("display",)

    display: str
    level: StatusLevel
    status: list[StatusRow]


class SetProperty(PageMessage):
    """The user edited a property."""

    id: str
    value: PropertyValue
