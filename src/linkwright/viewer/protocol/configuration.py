"""The configuration file and what is edited in it: displays that come, go and move, undo and redo, open and save."""

from __future__ import annotations

from typing import Literal

from linkwright.viewer.protocol.record import record

EditKind = Literal["set", "enable", "disable", "add", "duplicate", "rename", "remove", "move", "group"]
Question = Literal["unsaved", "exists", "changed_on_disk"]


# --- server to page ------------------------------------------------------------------------------------------------


@record
class EditName:
    """What undo or redo would do: the kind of edit, and the name of the property or display."""

    kind: EditKind
    name: str


@record
class Configuration:
    """The configuration that the page sees.

    Attributes:
        path: of its file on the server; None when it has none yet.
        opened: counts the configurations opened so far; when it grows, all that was known is of another file.
        unsaved: whether the file lacks something that was edited.
        undo: what undo would take back; None for nothing.
        redo: what redo would do again; None for nothing.
        own: whether the page has displays of its own.
        recent: files opened or saved before, newest first.
    """

    path: str | None
    opened: int
    unsaved: bool
    undo: EditName | None
    redo: EditName | None
    own: bool
    recent: list[str]
    type: Literal["configuration"] = "configuration"


@record
class DisplayClass:
    """A class of displays that can be added, and the types of the topics that it shows."""

    cls: str
    messages: list[str]


@record
class DisplayClasses:
    """All classes of displays that can be added."""

    classes: list[DisplayClass]
    type: Literal["display_classes"] = "display_classes"


@record
class TopicChoice:
    """A topic of the graph, its type, and the classes of displays that show it; none when no display does."""

    topic: str
    message: str
    classes: list[str]


@record
class TopicChoices:
    """Answers `AskTopics`."""

    topics: list[TopicChoice]
    type: Literal["topic_choices"] = "topic_choices"


@record
class Folder:
    """Answers `AskFolder`: the folders and configuration files in a folder of the server, by name."""

    path: str
    parent: str | None
    folders: list[str]
    files: list[str]
    type: Literal["folder"] = "folder"


@record
class ConfigurationText:
    """Answers `AskConfigurationText`: the file as it would be saved now, and a name for it."""

    name: str
    text: str
    type: Literal["configuration_text"] = "configuration_text"


@record
class ConfigurationSaved:
    """The configuration was saved."""

    path: str
    type: Literal["configuration_saved"] = "configuration_saved"


@record
class ConfigurationRefused:
    """What a page asked for was not done. With a question, it is done when the page asks again and says so."""

    message: str
    question: Question | None
    path: str | None
    type: Literal["configuration_refused"] = "configuration_refused"


# --- page to server ------------------------------------------------------------------------------------------------


@record
class AddDisplay:
    """Add a display of a class, enabled; into a group, if one is named, and showing a topic, if one is named."""

    cls: str
    name: str
    group: str | None
    topic: str | None
    type: Literal["add_display"] = "add_display"


@record
class DuplicateDisplays:
    """Add a display alike after each of these."""

    displays: list[str]
    type: Literal["duplicate_displays"] = "duplicate_displays"


@record
class RenameDisplay:
    """Give a display another name."""

    display: str
    name: str
    type: Literal["rename_display"] = "rename_display"


@record
class RemoveDisplays:
    """Remove displays, and what is in them."""

    displays: list[str]
    type: Literal["remove_displays"] = "remove_displays"


@record
class MoveDisplays:
    """Put displays into a group (None for none), in front of one of it (None for the end)."""

    displays: list[str]
    group: str | None
    before: str | None
    type: Literal["move_displays"] = "move_displays"


@record
class GroupDisplays:
    """Put displays into a new group, where the first of them is."""

    displays: list[str]
    name: str
    type: Literal["group_displays"] = "group_displays"


@record
class Undo:
    """Take back the last edit of any page."""

    type: Literal["undo"] = "undo"


@record
class Redo:
    """Do again what was taken back."""

    type: Literal["redo"] = "redo"


@record
class AskTopics:
    """Which topics there are, and which displays show them."""

    type: Literal["ask_topics"] = "ask_topics"


@record
class AskFolder:
    """What is in a folder of the server; None for that of the open file."""

    path: str | None
    type: Literal["ask_folder"] = "ask_folder"


@record
class NewConfiguration:
    """Begin anew with RViz's default; `discard` says that what is unsaved may be lost."""

    discard: bool
    type: Literal["new_configuration"] = "new_configuration"


@record
class OpenConfiguration:
    """Open a file of the server; `discard` says that what is unsaved may be lost."""

    path: str
    discard: bool
    type: Literal["open_configuration"] = "open_configuration"


@record
class LoadConfiguration:
    """Open a file of the browser's machine: its name and text."""

    name: str
    text: str
    discard: bool
    type: Literal["load_configuration"] = "load_configuration"


@record
class RevertConfiguration:
    """Open the file anew, without what was edited."""

    type: Literal["revert_configuration"] = "revert_configuration"


@record
class SaveConfiguration:
    """Save to the file, or to another one of the server, which is the configuration's file from then on.

    Attributes:
        path: ends in ``.rviz``; None for the file it has.
        replace: whether a file that is there, or was changed by another program, may be replaced.
    """

    path: str | None
    replace: bool
    type: Literal["save_configuration"] = "save_configuration"


@record
class AskConfigurationText:
    """The file as it would be saved now, to be kept on the browser's machine."""

    type: Literal["ask_configuration_text"] = "ask_configuration_text"
