"""The description: information about its parts, and the arguments that it needs.

A page requests the parts that it shows. `DescriptionChanged` notifies every page of a new description.
"""

from __future__ import annotations

from typing import ClassVar, Literal

from linkwright.page.protocol.message import PageMessage, Record, ServerMessage


class ArgumentChoice(Record):
    """Argument values that some caller uses together; `label` contains those that differ from the other choices."""

    label: str
    values: dict[str, str]


class ArgumentForm(ServerMessage):
    """The arguments that a file needs, in order, and their initial values.

    Without a file there is no form.
    """

    file: str
    names: list[str]
    values: dict[str, str]
    choices: list[ArgumentChoice]


NOTHING_ASKED = ArgumentForm(file="", names=[], values={}, choices=[])


class GiveArguments(PageMessage):
    """The user sets values for arguments of the form."""

    values: dict[str, str]


class CallSite(Record):
    """A call of a macro or, if the macro is empty, an include of a file; 1-based."""

    macro: str | None
    file: str
    line: int
    column: int


class SourceRange(Record):
    """A range of characters in a text, 1-based, with an exclusive end.

    `file` is empty for the expanded description.
    """

    file: str
    line: int
    column: int
    end_line: int
    end_column: int


class Written(Record):
    """Where an element is written: in the expanded text, and in its file, with the calls in between.

    `origin` is None if only the place in the expanded text is known. `calls` lists macro calls and includes, innermost
    first; if there are very many, the outermost ones are omitted.
    """

    expanded: SourceRange | None
    origin: SourceRange | None
    calls: list[CallSite]


class LinkInertia(Record):
    """A link's mass in kg and centre of mass in the link's frame, m.

    `box` has the edge lengths, m, of the uniform box with the same inertia, and `quaternion` is the box's orientation
    in the link. `box` is empty if no body can have this inertia.
    """

    mass: float
    center: list[float]
    box: list[float]
    quaternion: list[float]


class LinkDetails(Record):
    """A link as described; `frame` is the name of its frame in tf."""

    name: str
    frame: str
    parent_joint: str | None
    inertia: LinkInertia | None
    written: Written


class JointMimic(Record):
    """The mimic relation of a joint: position = multiplier * position of `joint` + offset."""

    joint: str
    multiplier: float
    offset: float


class JointDetails(Record):
    """A joint as described; SI units.

    The origin is in the parent's frame, and the unit axis in the joint's frame.

    A value that is not set or not finite is None.
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
    """The description of the robot of a RobotModel display; response to `AskDescription`.

    Links are in file order. `files` are the files that the description was generated from, the main file first.
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
    """A notice that a display shows a new description; lists the links and joints that differ."""

    NEWEST_OF: ClassVar[tuple[str, ...]] = ("display",)

    display: str
    revision: int
    links: list[str]
    joints: list[str]


class DescriptionText(ServerMessage):
    """The text of a file of a description, or the expanded text if `file` is empty.

    The text is None for a file that is not part of the description.
    """

    NEWEST_OF: ClassVar[tuple[str, ...]] = ("display", "file")

    display: str
    revision: int
    file: str
    text: str | None


class InertiaFinding(Record):
    """A finding about an implausible mass or inertia of a link."""

    link: str
    code: str
    message: str
    hint: str


class InertiaFindings(ServerMessage):
    """All implausible masses and inertias of a robot; response to `AskInertia`."""

    NEWEST_OF: ClassVar[tuple[str, ...]] = ("display",)

    display: str
    revision: int
    findings: list[InertiaFinding]


class AskDescription(PageMessage):
    """The page shows links, joints or masses of a RobotModel display."""

    display: str


class AskDescriptionText(PageMessage):
    """The page shows a text of a description; an empty `file` means the expanded text.

    If `display` is empty, `file` is a file that a diagnostic refers to.
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
    """A diagnostic for the page; `excerpt` is the source line if available."""

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
    """The current findings about the description; an empty list clears them."""

    items: list[DiagnosticItem]
