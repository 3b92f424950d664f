"""The description: what is known about its parts, and the arguments that it needs.

A page asks for the parts that it shows. `DescriptionChanged` notifies every page of a new description.
"""

from __future__ import annotations

from typing import ClassVar, Literal

from linkwright.page.protocol.message import PageMessage, Record, ServerMessage


class ArgumentChoice(Record):
    """Argument values that some caller uses together; `label` contains those that differ from the other choices."""

    label: str
    values: dict[str, str]


class ArgumentForm(ServerMessage):
    """The arguments that a file needs, in order, and their initial values; without a file there is no form."""

    file: str
    names: list[str]
    values: dict[str, str]
    choices: list[ArgumentChoice]


NOTHING_ASKED = ArgumentForm(file="", names=[], values={}, choices=[])


class GiveArguments(PageMessage):
    """The user gives values to arguments of the form."""

    values: dict[str, str]


class CallSite(Record):
    """A call of a macro, or, without a macro, an include of a file; 1-based."""

    macro: str | None
    file: str
    line: int
    column: int


class SourceRange(Record):
    """Characters of a text, from 1, the end exclusive; `file` is empty for the expanded description."""

    file: str
    line: int
    column: int
    end_line: int
    end_column: int


class Written(Record):
    """The place of an element: in the expanded text, and in its file, with the calls between them.

    `origin` is None where only the expanded text is known. `calls` has macro calls and includes, innermost first;
    the outermost of very many are left out.
    """

    expanded: SourceRange | None
    origin: SourceRange | None
    calls: list[CallSite]


class LinkInertia(Record):
    """Mass in kg and centre of mass in the link's frame, m.

    `box` has the edges, m, of the uniform box of the same inertia, with the orientation `quaternion` in the link; it is
    empty if no body can have this inertia.
    """

    mass: float
    center: list[float]
    box: list[float]
    quaternion: list[float]


class LinkDetails(Record):
    """A link as described; `frame` is its name in tf."""

    name: str
    frame: str
    parent_joint: str | None
    inertia: LinkInertia | None
    written: Written


class JointMimic(Record):
    """Position = multiplier * position of `joint` + offset."""

    joint: str
    multiplier: float
    offset: float


class JointDetails(Record):
    """A joint as described: the origin in the parent's frame, the unit axis in the joint's frame; SI units.

    A value that is not set, or is not a finite number, is None.
    """

    name: str
    kind: Literal["revolute", "continuous", "prismatic", "fixed", "floating", "planar"]
    parent: str
    child: str
    xyz: list[float]
    rpy: list[float]
    quaternion: list[float]
    axis: list[float]
    lower: float | None
    upper: float | None
    velocity: float | None
    effort: float | None
    damping: float | None
    friction: float | None
    soft_lower: float | None
    soft_upper: float | None
    k_position: float | None
    k_velocity: float | None
    mimic: JointMimic | None
    written: Written


class Description(ServerMessage):
    """The description of the robot of a RobotModel display; answers `AskDescription`.

    Links are in the order of the file. `files` are the files that the description was made from, the main one first.
    """

    NEWEST_OF: ClassVar[tuple[str, ...]] = ("display",)

    display: str
    revision: int
    name: str
    root: str
    links: list[LinkDetails]
    joints: list[JointDetails]
    files: list[str]


class DescriptionChanged(ServerMessage):
    """A display shows another description now; lists the links and joints that differ."""

    NEWEST_OF: ClassVar[tuple[str, ...]] = ("display",)

    display: str
    revision: int
    links: list[str]
    joints: list[str]


class DescriptionText(ServerMessage):
    """A text of a description, or the expanded one if `file` is empty; None for a file that is not part of it."""

    NEWEST_OF: ClassVar[tuple[str, ...]] = ("display", "file")

    display: str
    revision: int
    file: str
    text: str | None


class InertiaFinding(Record):
    """An implausible mass or inertia of a link."""

    link: str
    code: str
    message: str
    hint: str


class InertiaFindings(ServerMessage):
    """All implausible masses of a robot; answers `AskInertia`."""

    NEWEST_OF: ClassVar[tuple[str, ...]] = ("display",)

    display: str
    revision: int
    findings: list[InertiaFinding]


class AskDescription(PageMessage):
    """The page shows links, joints or masses of a RobotModel display."""

    display: str


class AskDescriptionText(PageMessage):
    """The page shows a text of a description; an empty `file` is the expanded one.

    `display` may be empty: then `file` is one that a diagnostic is about.
    """

    display: str
    file: str


class AskInertia(PageMessage):
    """Ask for implausible masses, which the page marks; the server needs a while for the answer."""

    display: str


class DiagnosticNote(Record):
    """A note of a diagnostic."""

    message: str
    file: str | None
    line: int | None
    column: int | None


class DiagnosticItem(Record):
    """A diagnostic for the page; `excerpt` is the source line, if there is one."""

    code: str
    severity: Literal["error", "warning", "info"]
    message: str
    file: str | None
    line: int | None
    column: int | None
    end_line: int | None
    end_column: int | None
    excerpt: str
    notes: list[DiagnosticNote]
    hints: list[str]


class Diagnostics(ServerMessage):
    """The current findings on the description; an empty list clears them."""

    items: list[DiagnosticItem]
