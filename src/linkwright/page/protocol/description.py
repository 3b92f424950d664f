"""The description: information about its parts, and the arguments that it needs.

A page requests the parts that it shows. `DescriptionChanged` notifies every page of a new description.
"""

from __future__ import annotations

from typing import ClassVar, Literal

from linkwright.page.protocol.message import PageMessage, Record, ServerMessage


class ArgumentChoice(Record):
    """An argument set with which another file calls the file.

    `label` contains the values that differ from the other choices.
    """

    label: str
    values: dict[str, str]


class ArgumentForm(ServerMessage):
    """The arguments that a file needs, in order, and their initial values.

    If `file` is empty, there is no form.
    """

    file: str
    names: list[str]
    values: dict[str, str]
    choices: list[ArgumentChoice]


NO_ARGUMENT_FORM = ArgumentForm(file="", names=[], values={}, choices=[])


class SetArguments(PageMessage):
    """The values that the user has entered for arguments of the form."""

    values: dict[str, str]


class CallSite(Record):
    """A macro call or, if `macro` is empty, an include of a file. The position is 1-based."""

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
    """The positions of an element in the expanded text and in its file, with its calls.

    `origin` is None if only the position in the expanded text is known. `calls` lists macro calls and includes,
    beginning with the innermost. If there are very many, the outermost are omitted.
    """

    expanded: SourceRange | None
    origin: SourceRange | None
    calls: list[CallSite]


class LinkInertia(Record):
    """The mass of a link in kg, its center of mass in its frame in m, and its equivalent box.

    `box` has the edge lengths in m of the uniform box with the same inertia, and `quaternion` is the orientation of
    the box in the link. `box` is empty if no body can have this inertia.
    """

    mass: float
    center: list[float]
    box: list[float]
    quaternion: list[float]


class LinkDetails(Record):
    """A link of the description. `frame` is the name of the link's tf frame."""

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
    """A joint of the description, in SI units.

    The origin is in the frame of the parent, and the unit axis is in the frame of the joint. A value that is not set
    or not finite is None.
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
    """The description of the robot of a RobotModel display. Response to `RequestDescription`.

    Links are in file order. `files` are the source files of the description, beginning with the main file.
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
    """The notice of a new description in a display, with the links and joints that changed."""

    NEWEST_OF: ClassVar[tuple[str, ...]] = ("display",)

    display: str
    revision: int
    links: list[str]
    joints: list[str]


class DescriptionText(ServerMessage):
    """The text of a file of a description, or the expanded text if `file` is empty.

    The text is None for a file that does not belong to the description or cannot be read.
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
    """All findings about a robot's masses and inertias. Response to `RequestInertia`."""

    NEWEST_OF: ClassVar[tuple[str, ...]] = ("display",)

    display: str
    revision: int
    findings: list[InertiaFinding]


class RequestDescription(PageMessage):
    """A request for the details of a RobotModel display's links and joints."""

    display: str


class RequestDescriptionText(PageMessage):
    """A request for a text of a description. An empty `file` means the expanded text.

    If `display` is empty, `file` is a file that a diagnostic refers to.
    """

    display: str
    file: str


class RequestInertia(PageMessage):
    """A request for the findings about masses and inertias.

    The computation of the findings takes a while.
    """

    display: str


class DiagnosticNote(Record):
    """An additional note of a diagnostic, with its position."""

    message: str
    file: str | None
    line: int | None
    column: int | None


class DiagnosticItem(Record):
    """A diagnostic for the page. `excerpt` is the source line if available."""

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
    """The current findings about the description. The list is empty if there are none."""

    items: list[DiagnosticItem]
