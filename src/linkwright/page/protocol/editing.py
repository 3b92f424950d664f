"""The messages for editing a robot: editable parts, previews of text changes, writing, undo and redo.

Positions are in meters and angles in radians, in the parent link's frame for a joint, and in the link's frame for a
visual, a collision or an inertial. An axis is in its joint's frame.
"""

from __future__ import annotations

from typing import Literal

from linkwright.page.protocol.description import DiagnosticItem
from linkwright.page.protocol.message import PageMessage, Record, ServerMessage

EditedPart = Literal["joint", "axis", "visual", "collision", "inertial"]


class EditablePart(Record):
    """A part of a robot that can be edited.

    A part is the origin of a joint, visual, collision or inertial, or the axis of a joint.

    `index` counts the visuals or collisions of the link `name`. `title` is the label for users. `rpy` is empty for an
    axis. `written` is the text in the file, or empty. `file` and `line` are the position of the text, or the position
    where the text would be inserted.
    """

    part: EditedPart
    name: str
    index: int
    title: str
    xyz: list[float]
    rpy: list[float]
    written: str
    file: str
    line: int


class EditableParts(ServerMessage):
    """The editable parts of a display's link, beginning with the parent joint.

    `refusal_reason` is the reason why the parts cannot be edited, or empty.
    """

    display: str
    link: str
    refusal_reason: str
    parts: list[EditablePart]


class EditedFile(Record):
    """A file that an edit changes: its name, and removed, added and surrounding lines."""

    file: str
    diff: list[str]


class EditPreview(ServerMessage):
    """The text changes of an edit, or the reason why the edit is rejected.

    `number` is the number of the request. `files` is empty if nothing changes or the edit is rejected. `also` lists
    further parts that the edit changes.
    """

    number: int
    files: list[EditedFile]
    also: list[str]
    refusal: DiagnosticItem | None


class EditWritten(ServerMessage):
    """The files that were written for an edit or an undo.

    `refusal` is the reason why writing failed, or None. `is_saved` is False if the edit was sent to an editor of source
    files instead, because it concerns unsaved texts.
    """

    files: list[str]
    refusal: DiagnosticItem | None
    is_saved: bool


class EditHistory(ServerMessage):
    """Whether an edit can be undone or redone."""

    can_undo: bool
    can_redo: bool


class RequestEditableParts(PageMessage):
    """A request for the editable parts of a link that the user has selected."""

    display: str
    link: str


class PreviewEdit(PageMessage):
    """A request to preview an edit that moves or rotates a part.

    A value that does not change is None. If `together` is true, all elements that the same text generates may change.
    """

    number: int
    display: str
    part: EditedPart
    name: str
    index: int
    xyz: list[float] | None
    rpy: list[float] | None
    together: bool


class ApplyEdit(PageMessage):
    """A request to write the previewed edit with this number to the files."""

    number: int


class UndoEdit(PageMessage):
    """A request to undo the last edit that was written to the files."""


class RedoEdit(PageMessage):
    """A request to redo the last undone edit."""
