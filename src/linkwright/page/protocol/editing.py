"""Editing a robot: its editable parts, the text changes of an edit, writing and undoing them.

Positions are in metres, angles in radians, in the frame of the parent link for a joint, of the link for a visual, a
collision or an inertial. An axis is in its joint's frame.
"""

from __future__ import annotations

from typing import Literal

from linkwright.page.protocol.description import DiagnosticItem
from linkwright.page.protocol.message import PageMessage, Record, ServerMessage

EditedPart = Literal["joint", "axis", "visual", "collision", "inertial"]


class EditablePart(Record):
    """A part of a robot with a pose: the origin of a joint, visual, collision or inertial, or the axis of a joint.

    `index` counts the visuals or collisions of the link `name`; `title` is the label for users. `rpy` is empty for an
    axis. `written` is the text of the file, empty if nothing is written; `file` and `line` are where that is, or would
    be.
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
    """The editable parts of a link of a display, the joint above it first; `why_not` is the reason for none."""

    display: str
    link: str
    why_not: str
    parts: list[EditablePart]


class EditedFile(Record):
    """A file that an edit changes: its full name, and the lines that it removes, adds and keeps around them."""

    file: str
    diff: list[str]


class EditPreview(ServerMessage):
    """The outcome of an edit, or why it is refused; `also` lists further changes.

    `number` is that of the request. `files` is empty if nothing changes, or the edit is refused.
    """

    number: int
    files: list[EditedFile]
    also: list[str]
    refusal: DiagnosticItem | None


class EditWritten(ServerMessage):
    """The outcome of writing files: `refusal` is the reason if it failed; `files` were written, also by an undo."""

    files: list[str]
    refusal: DiagnosticItem | None


class EditHistory(ServerMessage):
    """Whether an edit can be undone, or redone."""

    can_undo: bool
    can_redo: bool


class AskEditableParts(PageMessage):
    """The user selects a link of a display for editing."""

    display: str
    link: str


class PreviewEdit(PageMessage):
    """The user moves or rotates a part; None for a value that does not change.

    With `together` all elements that the same text produces may change.
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
    """The user applies the edit of the preview with this number."""

    number: int


class UndoEdit(PageMessage):
    """Undo the last edit written to the files."""


class RedoEdit(PageMessage):
    """Redo the edit that was undone last."""
