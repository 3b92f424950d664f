"""Editing a robot: what of it can be edited, the changes of text that an edit comes to, writing them, taking them back.

Positions are in metres, angles in radians, in the frame of the parent link for a joint, of the link for a visual, a
collision or an inertial. An axis is in its joint's frame.
"""

from __future__ import annotations

from typing import Literal

from linkwright.viewer.protocol.description import DiagnosticItem
from linkwright.viewer.protocol.message import PageMessage, Record, ServerMessage

EditedPart = Literal["joint", "axis", "visual", "collision", "inertial"]


class EditablePart(Record):
    """Something with a place: the origin of a joint, visual, collision or inertial, or the axis of a joint.

    `index` counts the visuals or collisions of the link `name`; `title` says which it is. `rpy` is empty for an axis.
    `written` is the text of the file, empty where nothing is written; `file` and `line` are where
    that is, or would be.
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
    """The editable parts of a link of a display, the joint above it first; `why_not` is empty where there are some."""

    display: str
    link: str
    why_not: str
    parts: list[EditablePart]


class EditedFile(Record):
    """A file that an edit changes: its whole name, and the lines that it takes away, adds and has around."""

    file: str
    diff: list[str]


class EditPreview(ServerMessage):
    """The outcome of an edit, or why it is refused; `also` is what would change with it.

    `number` is that of the question. `files` is empty where nothing changes, or nothing can be changed.
    """

    number: int
    files: list[EditedFile]
    also: list[str]
    refusal: DiagnosticItem | None


class EditWritten(ServerMessage):
    """The outcome of writing files: `refusal` says why they were not; `files` were written, after an undo too."""

    files: list[str]
    refusal: DiagnosticItem | None


class EditHistory(ServerMessage):
    """Whether an edit can be taken back, or made again."""

    can_undo: bool
    can_redo: bool


class AskEditableParts(PageMessage):
    """The user wants to edit a link of a display."""

    display: str
    link: str


class PreviewEdit(PageMessage):
    """The user moves or turns something; None for what stays.

    With `together` all that the same text makes may change.
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
    """The user wants the edit of the preview with this number to be written."""

    number: int


class UndoEdit(PageMessage):
    """The user takes the last edit that was written back."""


class RedoEdit(PageMessage):
    """The user makes the edit again that was taken back last."""
