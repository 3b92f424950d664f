"""The displays, and the configuration that contains them: its file, edits, undo and redo."""

from __future__ import annotations

from typing import ClassVar, Literal

from msgspec import field

from linkwright.page.protocol.message import PageMessage, Record, ServerMessage

StatusLevel = Literal["ok", "warn", "error"]
PropertyKind = Literal["group", "bool", "int", "float", "string", "color", "enum", "frame", "topic"]
PropertyValue = bool | int | float | str | None
RowDetails = Literal["frame", "link", "joint", "effort"]


class TopicOffer(Record):
    """The topics offered for a row.

    They have one of the types and, if words are given, contain one of them in their names.
    """

    messages: list[str]
    words: list[str]


class Property(Record):
    """A row of a property tree, as RViz shows it.

    `id` is unique in the page and stable for the lifetime of a display. Colours are ``#rrggbb``. A `group` has no
    value; any other kind may have children too (``Line Style`` > ``Line Width``).

    A row with `details` represents the frame, link or joint of its name. The page knows its current pose, so it adds
    its own read-only rows: RViz's ``Position``, ``Orientation`` and the like.

    A `topic` without `topics` offers the topics that the display can be added for.
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
    """A row below a display's Status.

    Its text is usually a phrase, which each page receives in its own language.
    """

    name: str
    level: StatusLevel
    text: str


class Place(Record):
    """A 1-based place in a source file, with the macro calls and includes that lead to it.

    The calls and includes are ordered innermost first.
    """

    file: str
    line: int
    column: int
    trail: list[str] = field(default_factory=list)


class Display(Record):
    """A display of the Displays panel. `cls` is RViz's class, such as ``rviz_default_plugins/Grid``.

    `group` is the ID of the display's group, a ``rviz_common/Group`` that precedes it. `enabled` is the display's own
    check box; the display is drawn if the check boxes of all enclosing groups are also on.

    `drawing` is the class that determines how the page draws the display: the display's own class, or for a display of
    another package, the class that it resembles.

    `supported` is false for a class this program does not draw; such a display is kept and listed as unsupported. Rows
    of particular classes:

    - RobotModel: a shape is drawn with the alpha of its colour, times ``Alpha``, times the link's ``Alpha`` below
      ``Links``. A link's row is a ``bool`` (draw its shapes) if it has any, or else a ``group``.
    - TF: a frame is drawn if it has a row below ``Frames`` and the row is on; frames excluded by the filters have no
      row. ``Update Interval`` (seconds between updates, 0 for every frame) of both is applied by the page.
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
    """The complete tree of displays, sent at the start and when displays are added, removed or moved."""

    global_options: list[Property]
    global_status: list[StatusRow]
    global_level: StatusLevel
    displays: list[Display]


class DisplayProperties(ServerMessage):
    """All property rows of one display, sent again when they change.

    Examples are the links of a new robot and the frames of TF.
    """

    NEWEST_OF: ClassVar[tuple[str, ...]] = ("display",)

    display: str
    properties: list[Property]


class PropertyChanged(ServerMessage):
    """A new value, set by any page or by the server.

    Enable boxes are the property ``<display>/Enabled``.
    """

    NEWEST_OF: ClassVar[tuple[str, ...]] = ("id",)

    id: str
    value: PropertyValue
    options: list[str] | None = None


class DisplayStatus(ServerMessage):
    """The status rows of one display or of ``global``."""

    NEWEST_OF: ClassVar[tuple[str, ...]] = ("display",)

    display: str
    level: StatusLevel
    status: list[StatusRow]


class SetProperty(PageMessage):
    """The user edited a property."""

    id: str
    value: PropertyValue


EditKind = Literal["set", "enable", "disable", "add", "duplicate", "rename", "remove", "move", "group"]
Question = Literal["unsaved", "exists", "changed_on_disk"]


# --- server to page ------------------------------------------------------------------------------------------------
class EditName(Record):
    """An edit to undo or redo: its kind, and the name of the property or display."""

    kind: EditKind
    name: str


class Configuration(ServerMessage):
    """The configuration that the page shows.

    Attributes:
        path: the path of its file on the server; None if it does not have one yet.
        opened: the number of configurations opened so far; when it increases, earlier messages are about another file.
        unsaved: whether there are unsaved edits.
        undo: the edit that undo would revert, or None.
        redo: the edit that redo would repeat, or None.
        own: whether the page has its own displays.
        recent: files opened or saved before, newest first.
    """

    path: str | None
    opened: int
    unsaved: bool
    undo: EditName | None
    redo: EditName | None
    own: bool
    recent: list[str]


class DisplayClass(Record):
    """A class of displays that can be added, and the types of the topics that it shows."""

    cls: str
    messages: list[str]


class TopicChoice(Record):
    """A topic of the graph, its type, and the classes of displays that can show it, possibly none."""

    topic: str
    message: str
    classes: list[str]


class DisplayChoices(ServerMessage):
    """The display classes that can be added, and the topics; response to `AskDisplayChoices`."""

    classes: list[DisplayClass]
    topics: list[TopicChoice]


class Folder(ServerMessage):
    """The folders and configuration files in a server folder, by name; response to `AskFolder`."""

    path: str
    parent: str | None
    folders: list[str]
    files: list[str]


class ConfigurationText(ServerMessage):
    """The file's text as it would be saved, and a name; response to `AskConfigurationText`."""

    name: str
    text: str


class ConfigurationSaved(ServerMessage):
    """A notice that the configuration was saved."""

    path: str


class ConfigurationRefused(ServerMessage):
    """The rejection of a page's request.

    With a question, the page may confirm it and repeat the request.
    """

    message: str
    question: Question | None
    path: str | None


# --- page to server ------------------------------------------------------------------------------------------------
class AddDisplay(PageMessage):
    """Add an enabled display of a class, optionally to a group, and optionally showing a topic."""

    cls: str
    name: str
    group: str | None
    topic: str | None


class DuplicateDisplays(PageMessage):
    """Add a copy after each of these displays."""

    displays: list[str]


class RenameDisplay(PageMessage):
    """Rename a display."""

    display: str
    name: str


class RemoveDisplays(PageMessage):
    """Remove displays with their contents."""

    displays: list[str]


class MoveDisplays(PageMessage):
    """Move displays into a group, before one of its displays.

    A group of None means the top level, and a display of None means the end.
    """

    displays: list[str]
    group: str | None
    before: str | None


class GroupDisplays(PageMessage):
    """Put displays into a new group at the position of the first of them."""

    displays: list[str]
    name: str


class Undo(PageMessage):
    """Undo the last edit of any page."""


class Redo(PageMessage):
    """Redo the edit that was last undone."""


class AskDisplayChoices(PageMessage):
    """Ask for the classes of displays that can be added, the topics, and the displays that show them."""


class AskFolder(PageMessage):
    """Ask for the contents of a folder of the server; None for the folder of the open file."""

    path: str | None


class NewConfiguration(PageMessage):
    """Open RViz's default configuration; `discard` allows losing unsaved edits."""

    discard: bool


class OpenConfiguration(PageMessage):
    """Open a file on the server; `discard` allows losing unsaved edits."""

    path: str
    discard: bool


class LoadConfiguration(PageMessage):
    """Open a file from the browser's machine, given its name and text."""

    name: str
    text: str
    discard: bool


class RevertConfiguration(PageMessage):
    """Open the file again and discard the edits."""


class SaveConfiguration(PageMessage):
    """Save to the current or another file on the server, which becomes the configuration's file.

    Attributes:
        path: a path that ends in ``.rviz``; None for the current file.
        replace: whether an existing file, or a file that another program changed, may be replaced.
    """

    path: str | None
    replace: bool


class AskConfigurationText(PageMessage):
    """Ask for the text of the file as it would be saved now, to store it on the browser's machine."""


PanelName = Literal["displays", "selection", "tool-properties", "views", "time", "transformation", "navigation"]
"""RViz's and nav2's panels that the page has too; the names are the page's."""


class Panels(ServerMessage):
    """The panels in the configuration.

    Attributes:
        opened: the number of configurations opened for this page's displays; when it changes, the page shows these
            panels.
        origin: the name under which a page remembers a configuration that has no file.
        shown: the panels that are open, in the order of the file; None if the file does not list panels.
    """

    opened: int
    origin: str
    shown: list[PanelName] | None


class ShowPanels(PageMessage):
    """The user opened or closed a panel; the file stores the list of open panels."""

    shown: list[PanelName]
