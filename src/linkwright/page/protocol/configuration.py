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
    """The topics that a row offers: topics of these types, with one of these words in the name.

    If there are no words, topics with any name are offered.
    """

    messages: list[str]
    words: list[str]


class Property(Record):
    """A row of a property tree, as RViz shows it.

    `id` is unique in the page and stable for the lifetime of a display. Colors are ``#rrggbb``. A `group` has no
    value. A row of any other kind may also have children (``Line Style`` > ``Line Width``).

    A row with `details` has the name of a frame, link or joint. The page adds read-only rows below it, such as
    ``Position`` and ``Orientation`` as in RViz, because the page has the current pose.

    A `topic` without `topics` offers the topics that the display can show.
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

    `text` is usually a phrase, which is translated for each page.
    """

    name: str
    level: StatusLevel
    text: str


class Place(Record):
    """A 1-based position in a source file, with the macro calls and includes that lead to it.

    `trail` begins with the innermost call or include.
    """

    file: str
    line: int
    column: int
    trail: list[str] = field(default_factory=list)


class Display(Record):
    """A display of the Displays panel.

    `cls` is RViz's class, such as ``rviz_default_plugins/Grid``. `drawing` is the class that the page draws: the class
    of the display or, for a display of another package, a class that looks the same.

    `group` is the ID of the group that contains the display, a ``rviz_common/Group`` that precedes it. `enabled` is
    the check box of the display. The display is drawn if the check boxes of all enclosing groups are also on.

    `supported` is false for a class that this program does not draw. Such a display stays in the file and is listed as
    unsupported. Rows of particular classes:

    - RobotModel: a shape is drawn with the alpha of its color, times ``Alpha``, times the link's ``Alpha`` below
      ``Links``. The row of a link with shapes is a ``bool`` (draw the shapes); the row of any other link is a
      ``group``.
    - TF: a frame is drawn if it has a row below ``Frames`` and the row is on. Frames excluded by the filters have no
      row.

    The page applies the ``Update Interval`` (seconds between updates, 0 for every frame) of both classes.
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
    """The complete tree of displays.

    It is sent at the start, and when displays are added, removed or moved.
    """

    global_options: list[Property]
    global_status: list[StatusRow]
    global_level: StatusLevel
    displays: list[Display]


class DisplayProperties(ServerMessage):
    """All property rows of one display, sent when rows appear or disappear.

    Examples are the links of a new robot and the frames of TF.
    """

    NEWEST_OF: ClassVar[tuple[str, ...]] = ("display",)

    display: str
    properties: list[Property]


class PropertyChanged(ServerMessage):
    """A new value of a property, set by any page or by the server.

    The check box of a display is the property ``<display>/Enabled``.
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
    """A property value that the user has entered."""

    id: str
    value: PropertyValue


EditKind = Literal["set", "enable", "disable", "add", "duplicate", "rename", "remove", "move", "group"]
Question = Literal["unsaved", "exists", "changed_on_disk"]


# --- server to page ------------------------------------------------------------------------------------------------
class EditName(Record):
    """An edit to undo or redo: the kind of the edit, and the name of the property or display."""

    kind: EditKind
    name: str


class Configuration(ServerMessage):
    """The configuration that the page shows.

    Attributes:
        path: the path of the configuration's file on the server; None if it has no file yet.
        opened: the number of configurations opened so far; when it increases, earlier messages are about another file.
        unsaved: whether there are unsaved edits.
        undo: the edit that undo would revert, or None.
        redo: the edit that redo would repeat, or None.
        is_own: whether the page has its own configuration.
        recent: the recently opened or saved files, newest first.
    """

    path: str | None
    opened: int
    unsaved: bool
    undo: EditName | None
    redo: EditName | None
    is_own: bool
    recent: list[str]


class DisplayClass(Record):
    """An available display class, and the message types that it shows."""

    cls: str
    messages: list[str]


class TopicChoice(Record):
    """A topic of the graph, its message type, and the display classes that can show it."""

    topic: str
    message: str
    classes: list[str]


class DisplayChoices(ServerMessage):
    """The display classes that can be added, and the topics. Response to `RequestDisplayChoices`."""

    classes: list[DisplayClass]
    topics: list[TopicChoice]


class Folder(ServerMessage):
    """The folders and configuration files in a server folder, by name. Response to `RequestFolder`."""

    path: str
    parent: str | None
    folders: list[str]
    files: list[str]


class ConfigurationText(ServerMessage):
    """The text of the configuration, as for saving, and a file name.

    Response to `RequestConfigurationText`.
    """

    name: str
    text: str


class ConfigurationSaved(ServerMessage):
    """The notice that the configuration was saved to a path."""

    path: str


class ConfigurationRefused(ServerMessage):
    """The notice that a request of the page was refused, with the reason.

    If there is a question, the page may repeat the request after the user has confirmed it.
    """

    message: str
    question: Question | None
    path: str | None


# --- page to server ------------------------------------------------------------------------------------------------
class AddDisplay(PageMessage):
    """A request to add an enabled display of a class, optionally to a group and for a topic."""

    cls: str
    name: str
    group: str | None
    topic: str | None


class DuplicateDisplays(PageMessage):
    """A request to insert a copy of each of these displays after the original."""

    displays: list[str]


class RenameDisplay(PageMessage):
    """A request to rename a display."""

    display: str
    name: str


class RemoveDisplays(PageMessage):
    """A request to remove displays with their contents."""

    displays: list[str]


class MoveDisplays(PageMessage):
    """A request to move displays into a group, before one of the displays in it.

    If `group` is None, the displays are moved to the top level; if `before` is None, they are moved to the end.
    """

    displays: list[str]
    group: str | None
    before: str | None


class GroupDisplays(PageMessage):
    """A request to move displays into a new group at the position of the first display."""

    displays: list[str]
    name: str


class Undo(PageMessage):
    """A request to undo the last edit that any page made to the configuration."""


class Redo(PageMessage):
    """A request to redo the last undone edit."""


class RequestDisplayChoices(PageMessage):
    """A request for the available display classes and the topics that they can show."""


class RequestFolder(PageMessage):
    """A request for the contents of a folder of the server.

    None means the folder of the open file.
    """

    path: str | None


class NewConfiguration(PageMessage):
    """A request to open RViz's default configuration.

    `discard` permits discarding unsaved edits.
    """

    discard: bool


class OpenConfiguration(PageMessage):
    """A request to open a file on the server.

    `discard` permits discarding unsaved edits.
    """

    path: str
    discard: bool


class LoadConfiguration(PageMessage):
    """A request to open a file from the browser's machine, with its name and text."""

    name: str
    text: str
    discard: bool


class RevertConfiguration(PageMessage):
    """A request to open the current file again and discard the edits."""


class SaveConfiguration(PageMessage):
    """A request to save the configuration to a file on the server.

    The file becomes the configuration's file.

    Attributes:
        path: a path that ends in ``.rviz``; None for the current file.
        replace: whether an existing file, or a file that another program changed, may be replaced.
    """

    path: str | None
    replace: bool


class RequestConfigurationText(PageMessage):
    """A request for the text of the configuration, to store it on the browser's machine."""


PanelName = Literal[
    "displays", "selection", "tool-properties", "views", "time", "transformation", "help", "navigation", "visual-tools"
]
"""The panels of RViz and nav2 that the page also has, under their names in the page."""


class Panels(ServerMessage):
    """The open panels of a configuration.

    Attributes:
        opened: the number of configurations opened so far; if it changes, the page shows these panels.
        origin: the name under which the browser stores the panels of a configuration that has no file.
        shown: the panels that are open, in the order of the file; None if the file does not list panels.
    """

    opened: int
    origin: str
    shown: list[PanelName] | None


class ShowPanels(PageMessage):
    """The open panels, sent after the user has opened or closed a panel. The file stores them."""

    shown: list[PanelName]
