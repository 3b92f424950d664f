"""Two descriptions in one scene: their differences, and the links that show them."""

from __future__ import annotations

from typing import Literal

from linkwright.page.protocol.message import Record, ServerMessage

Mark = Literal["added", "removed", "changed"]
"""The difference of a link: in its own description or in that of the joint that moves it."""


class ComparedRobot(Record):
    """A robot of the comparison: its RobotModel display, empty if none shows it, its name, and the links to mark."""

    display: str
    label: str
    marks: dict[str, Mark]


class ComparedPlace(Record):
    """A place in a text, 1-based: for readers, and for the Source panel, or without a file."""

    text: str
    file: str
    line: int


class ComparedItem(Record):
    """A difference, as `linkwright diff` prints it.

    `property` is empty for a difference of the whole item; `old` and `new` are None for a value that a description does
    not set. `element` is the link or joint that shows it, empty if there is none, and `in_old` whether only the old
    description has that.
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
    old_place: ComparedPlace | None
    new_place: ComparedPlace | None


class ComparedDescriptions(ServerMessage):
    """The differences of two descriptions.

    By names in the old one: `joints` are the joints of the new one that they follow, `shapes` the links of the new one
    that have the same shapes.
    """

    old: ComparedRobot
    new: ComparedRobot
    joints: dict[str, str]
    shapes: dict[str, str]
    items: list[ComparedItem]
