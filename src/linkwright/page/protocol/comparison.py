"""The comparison of two descriptions in one scene: differences, and links to highlight."""

from __future__ import annotations

from typing import Literal

from linkwright.page.protocol.message import Record, ServerMessage

Mark = Literal["added", "removed", "changed"]
"""The kind of difference of a link, or of the joint that moves the link."""


class ComparedRobot(Record):
    """A robot of the comparison: its RobotModel display, its name, and the links to highlight.

    The display is empty if no display shows the robot.
    """

    display: str
    label: str
    marks: dict[str, Mark]


class ComparedLocation(Record):
    """A location in a source file: `text` is shown to users, `file` and the 1-based `line` are for the Source panel."""

    text: str
    file: str
    line: int


class ComparedItem(Record):
    """A difference, as `linkwright diff` prints it.

    `property` is empty for a difference of the whole item; `old` and `new` are None for a value that a description does
    not set. `element` is the link or joint where the difference is shown, or empty. `in_old` is true if only the old
    description has that element.
    """

    subject: Literal["robot", "link", "joint", "extension"]
    name: str
    kind: Literal["added", "removed", "renamed", "changed"]
    property: str
    old: str | None
    new: str | None
    unit: str
    element: str
    element_kind: Literal["link", "joint"]
    in_old: bool
    old_place: ComparedLocation | None
    new_place: ComparedLocation | None


class ComparedDescriptions(ServerMessage):
    """The differences between two descriptions.

    `joints` maps joints of the old description to joints of the new description, whose positions they take. `shapes`
    maps links of the old description to links of the new description with the same visuals and collisions.
    """

    old: ComparedRobot
    new: ComparedRobot
    joints: dict[str, str]
    shapes: dict[str, str]
    items: list[ComparedItem]
