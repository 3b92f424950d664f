"""The display rviz_default_plugins/RobotModel."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import Literal

from linkwright.diagnostics import Diagnostic, LinkwrightError, Phrase, Severity, joined, phrase
from linkwright.page.files import MeshIndex
from linkwright.page.protocol.configuration import PropertyChanged, StatusRow
from linkwright.page.protocol.message import ServerMessage
from linkwright.page.protocol.robot import LinkProvenance, MeshStatus, RobotScene
from linkwright.rviz.config.rviz_config import DisplayConfig
from linkwright.rviz.config.schema import Path, PropertySpec, Schema, alpha
from linkwright.rviz.displays.base.display import DisplayHost, ViewerDisplay
from linkwright.rviz.robot import DESCRIPTION_SPECS, DescriptionSource, SceneBuilder
from linkwright.urdf import Joint, Link, Robot

LINKS = "Links"
JOINTS = "Joints"
STYLE = (LINKS, "Link Tree Style")
ALL = (LINKS, "All Links Enabled")

_TREES = ("Tree of links", "Tree of links and joints")
_OPTIONS = (
    PropertySpec(
        STYLE[1],
        "enum",
        "Links in Alphabetic Order",
        "The arrangement of the rows of links and joints.",
        options=("Links in Alphabetic Order", "Joints in Alphabetic Order", *_TREES),
    ),
    PropertySpec("Expand Tree", "bool", False, "Open or close the rows of all links and joints of the tree."),
    PropertySpec("Expand Link Details", "bool", False, "Open or close the details of each link."),
    PropertySpec("Expand Joint Details", "bool", False, "Open or close the details of each joint."),
    PropertySpec(ALL[1], "bool", True, "Enable or disable all links."),
)
_OPTION_NAMES = frozenset(spec.name for spec in _OPTIONS)

_LINK_ALPHA = alpha("Opacity of this link.")
_LINK_EXTRAS = (
    PropertySpec("Show Trail", "bool", False, "Draw the trail of the link."),
    PropertySpec("Show Axes", "bool", False, "Draw the axes of the link's frame."),
)
_JOINT_AXES = PropertySpec("Show Axes", "bool", False, "Draw the axes of the joint's frame.")
_JOINT_AXIS = PropertySpec("Show Joint Axis", "bool", False, "Draw the joint's axis of motion.")
_WITH_AXIS = ("continuous", "revolute", "prismatic", "planar")

NO_ROWS = (PropertySpec(LINKS, "group", children=_OPTIONS),)


class RobotRows:
    """The property rows of a robot's links and joints.

    The page arranges the rows by the Link Tree Style; their positions in the file do not depend on the style. A link
    has a check box if it has shapes. A joint has a check box if links with shapes are below it: in a tree, all
    descendants count; in a list, only the joint's child link.
    """

    def __init__(self, robot: Robot) -> None:
        self._robot = robot
        self._below: dict[str, list[str]] = {}
        for joint in robot.joints.values():
            self._below.setdefault(joint.parent, []).append(joint.name)
        self._shaped = {link.name for link in robot.links.values() if link.visuals or link.collisions}
        self._found: dict[tuple[str, bool], list[str]] = {}

    def specs(self, style: str) -> tuple[PropertySpec, ...]:
        """Return the groups of links and of joints, each in alphabetical order."""
        links = tuple(
            self._link(self._robot.links[name]) for name in sorted(self._robot.links) if name not in _OPTION_NAMES
        )
        joints = tuple(self._joint(self._robot.joints[name], style) for name in sorted(self._robot.joints))
        return (
            PropertySpec(LINKS, "group", description="The links of the robot.", children=(*_OPTIONS, *links)),
            PropertySpec(JOINTS, "group", description="The joints of the robot.", children=joints),
        )

    @property
    def boxes(self) -> list[Path]:
        """The paths of the links' check boxes."""
        return [(LINKS, name) for name in sorted(self._shaped - _OPTION_NAMES)]

    def boxes_of(self, joint: str, style: str) -> list[Path]:
        """Return the paths of the links' check boxes that a joint's check box controls."""
        return [(LINKS, name) for name in self._links_of(self._robot.joints[joint], style)]

    def derived(self, style: str, is_on: Callable[[Path], bool]) -> dict[Path, bool]:
        """Return the states of the joints' check boxes and of *All Links Enabled*, by property path.

        Such a check box is on if the check boxes of all its links are on.

        Args:
            style: the Link Tree Style.
            is_on: returns whether the check box of a link is on.
        """
        on = {name: is_on((LINKS, name)) for name in self._shaped - _OPTION_NAMES}
        found: dict[Path, bool] = {
            (JOINTS, joint.name): all(on.get(name, True) for name in links)
            for joint in self._robot.joints.values()
            if (links := self._links_of(joint, style))
        }
        return {**found, ALL: all(on.values())}

    def _link(self, link: Link) -> PropertySpec:
        if link.name not in self._shaped:
            about = "A link without shapes."
            return PropertySpec(link.name, "group", None, about, children=_LINK_EXTRAS, details="link")
        about, children = "Draw the shapes of this link.", (_LINK_ALPHA, *_LINK_EXTRAS)
        return PropertySpec(link.name, "bool", True, about, children=children, details="link")

    def _joint(self, joint: Joint, style: str) -> PropertySpec:
        children = (_JOINT_AXES, _JOINT_AXIS) if joint.type in _WITH_AXIS else (_JOINT_AXES,)
        about = f"Joint '{joint.name}' with parent link '{joint.parent}' and child link '{joint.child}'."
        if not self._links_of(joint, style):
            return PropertySpec(joint.name, "group", None, about, children=children, details="joint")
        return PropertySpec(joint.name, "bool", True, about, children=children, details="joint")

    def _links_of(self, joint: Joint, style: str) -> list[str]:
        key = (joint.name, style in _TREES)
        if key not in self._found:
            links = self._links_below(joint) if style in _TREES else [joint.child]
            self._found[key] = [name for name in links if name in self._shaped]
        return self._found[key]

    def _links_below(self, joint: Joint) -> list[str]:
        found, pending = [], [joint.child]
        while pending:
            link = pending.pop()
            found.append(link)
            pending.extend(self._robot.joints[name].child for name in self._below.get(link, ()))
        return found


_STATIC = (
    PropertySpec("Visual Enabled", "bool", True, "Draw the visual geometry."),
    PropertySpec("Collision Enabled", "bool", False, "Draw the collision geometry."),
    PropertySpec(
        "Mass Properties",
        "group",
        description="How masses are drawn.",
        children=(
            PropertySpec("Mass", "bool", False, "Draw each link's mass as a ball of lead at its centre of mass."),
            PropertySpec("Inertia", "bool", False, "Draw each link's inertia as a box of the same inertia."),
        ),
    ),
    PropertySpec("Update Interval", "float", 0.0, "Seconds between updates; 0 for every frame.", minimum=0.0),
    alpha("Opacity of all links: 0 is invisible."),
    *DESCRIPTION_SPECS,
    PropertySpec(
        "TF Prefix",
        "string",
        "",
        "The prefix of frame names: a link's frame is the prefix, a slash and the link's name.",
    ),
)
_SOURCE_NAMES = frozenset(spec.name for spec in DESCRIPTION_SPECS)
_MOST_FINDINGS = 5
_MANY_BOXES = 20
"""If more check boxes than these change, all rows are sent again."""


class RobotModelDisplay(ViewerDisplay):
    """A display of a robot, from a description on a topic or in a file.

    If a new description cannot be read, the last valid robot stays visible, whereas RViz would show none. When a new
    description lacks links, their frames are removed from tf; RViz would show the frames until it is closed.
    """

    CLASS = "rviz_default_plugins/RobotModel"
    MESSAGE = "std_msgs/msg/String"
    TOPIC = ("Description Topic",)
    SCHEMA = (*_STATIC, *NO_ROWS)

    def __init__(self, host: DisplayHost, identity: str, config: DisplayConfig) -> None:
        self._rows: RobotRows | None = None
        self._robot_specs: Schema = NO_ROWS
        super().__init__(host, identity, config)
        self.robot: Robot | None = None
        self.scene = RobotScene(display=identity, revision=0, name="", links=[])
        self._source = DescriptionSource(
            host.context,
            self.properties,
            self._described,
            self._refused,
        )
        self._text = ""
        self._held: str | None = None
        self._publisher: bytes | None = None
        self._is_contested = False
        self._description: list[StatusRow] = []
        self._file_problems: dict[str, list[Phrase]] = {}
        self._page_problems: dict[tuple[str, str], Phrase] = {}

    @property
    def text(self) -> str:
        """The text of the description from which the robot was read."""
        return self._text

    @property
    def file_problems(self) -> dict[str, list[Phrase]]:
        """The problems with the files that links refer to, by link."""
        return self._file_problems

    def schema(self) -> Schema:
        """Return the fixed properties, and the rows of all links and joints."""
        return (*_STATIC, *self._robot_specs)

    def start(self) -> None:
        """Subscribe to the description's topic, or read its file."""
        problem = self._source.follow()
        by_topic = self.properties.text("Description Source") == "Topic"
        name = "Topic" if by_topic else "Description File"
        if problem is not None:
            self._description = [StatusRow(name, "error", problem)]
        elif by_topic:
            self._description = [StatusRow(name, "warn", phrase("No messages received"))]
        else:
            self._description = []
        self._show_status()

    def stop(self) -> None:
        """Unsubscribe, and withdraw the pages' access to the robot's files."""
        self._source.close()
        self.context.meshes.replace(self.id, {})

    def changed(self, path: Path) -> None:
        """Apply a new source, a new frame prefix, or the check boxes of links and joints."""
        if path[0] in _SOURCE_NAMES:
            self.start()
        elif path == ("TF Prefix",) and self.robot is not None:
            self._show_robot(self.robot)
        elif self._rows is not None and path[0] in (LINKS, JOINTS):
            self._box_changed(self._rows, path)

    def frames_changed(self) -> None:
        """Show in the status which links have no known pose."""
        self._show_status()

    def time_changed(self) -> None:
        """Read the description that was received while time was paused."""
        if self._held is not None and not self.host.time.paused:
            self._described(self._held)

    def messages(self) -> list[ServerMessage]:
        """Return the robot's links and joints for a newly opened page."""
        return [self.scene]

    def receive(self, status: MeshStatus) -> None:
        """Show in the status whether a page could load a mesh of the current robot."""
        link = next((link for link in self.scene.links if link.name == status.link), None)
        if link is None or not any(shape.url == status.url for shape in (*link.visuals, *link.collisions)):
            return
        key = (status.link, status.url)
        known = self._page_problems.get(key)
        if status.error is None:
            self._page_problems.pop(key, None)
        else:
            name = status.url.partition("?")[0].rpartition("/")[2]
            self._page_problems[key] = phrase(
                "Could not load mesh '{name}': {reason}", name=name, reason=status.error[:500]
            )
            if self._page_problems[key] != known:
                self.context.node.get_logger().error(f"Link '{status.link}': {self._page_problems[key]}")
        self._show_status()

    def provenance(self, link: str) -> LinkProvenance | None:
        """Return where a link was defined in the source files, or None for an unknown link.

        The call takes as long as expanding the description.
        """
        from linkwright.xacro.tracing.provenance_text import provenance_lines

        element = self.robot.links[link].element if self.robot and link in self.robot.links else None
        if element is None:
            return None
        try:
            provenance = self.context.library.provenance(self._text, element)
        except LinkwrightError as error:
            return LinkProvenance(self.id, link, [diagnostic.message for diagnostic in error.diagnostics])
        return None if provenance is None else LinkProvenance(self.id, link, provenance_lines(provenance))

    # --- descriptions ------------------------------------------------------------------------------------------

    def _described(self, text: str) -> None:
        self._held = text if self.robot is not None and self.host.time.paused else None
        if self._held is not None:
            return
        if not text.strip():
            self._description = [StatusRow("URDF", "error", phrase("URDF is empty"))]
            self._show_status()
            return
        reading = self.context.library.read(text)
        if reading.robot is None:
            self._refused(reading.diagnostics)
            return
        is_other, self._text = text != self._text, text
        self._description = [StatusRow("URDF", "ok", phrase("URDF parsed OK"))]
        if self.properties.text("Description Source") == "Topic":
            self._description.insert(0, self._topic_row(is_other=is_other))
        self._show_robot(reading.robot)

    def _topic_row(self, *, is_other: bool) -> StatusRow:
        """Return the status row of the topic, which names the publisher if there are several.

        If a different description from another publisher replaces the current one, a warning is logged.
        """
        before = None if self._publisher is None else self._source.current(self._publisher)
        self._publisher = self._source.publisher
        publishers = self._source.publishers()
        owner = publishers.pop(self._publisher or b"", phrase("an unknown node"))
        if not publishers:
            self._is_contested = False
            return StatusRow("Topic", "ok", phrase("OK"))
        if is_other and before is not None and before in publishers:
            self._is_contested = True
            self.context.node.get_logger().warning(
                f"The description of {owner} replaces that of {publishers[before]}: both publish on "
                f"'{self.properties.text('Description Topic')}'"
            )
        others = ", ".join(sorted(set(publishers.values())))
        level: Literal["ok", "warn"] = "warn" if self._is_contested else "ok"
        return StatusRow(
            "Topic",
            level,
            phrase(
                "The description of {owner} is shown; {others} also publish on the topic", owner=owner, others=others
            ),
        )

    def _refused(self, diagnostics: Sequence[Diagnostic]) -> None:
        errors = [diagnostic for diagnostic in diagnostics if diagnostic.severity is Severity.ERROR]
        is_xml = not any(error.code.startswith("XML") for error in errors)
        text = phrase("URDF failed Model parse") if is_xml else phrase("URDF failed XML parse")
        self._description = [StatusRow("URDF", "error", text)]
        for error in errors[:_MOST_FINDINGS]:
            self._description.append(StatusRow(error.code, "error", error.placed_message))
        self._show_status()

    def _show_robot(self, robot: Robot) -> None:
        before = {link.frame for link in self.scene.links}
        finder = self.context.library.packages(self._text) or self.context.finder
        builder = SceneBuilder(MeshIndex(finder))
        links = builder.links(robot, self.properties.text("TF Prefix"))
        self.context.meshes.replace(self.id, builder.index.folders)
        self._log_new_problems(builder.problems)
        self._file_problems = builder.problems
        self._page_problems.clear()
        self.robot = robot
        joints = builder.joints(robot)
        if (self.scene.name, self.scene.links, self.scene.joints) != (robot.name, links, joints):
            self.scene = RobotScene(self.id, self.scene.revision + 1, robot.name, links, joints)
            self.pages.publish(self.scene)
        self._list_rows(robot)
        self.host.robot_changed(before - {link.frame for link in links})
        self._show_status()

    def recalled(self) -> None:
        """Update the rows for a restored Link Tree Style, and the joints' check boxes."""
        if self._rows is not None:
            self._robot_specs = self._rows.specs(self.properties.text(*STYLE))
            self._derive_boxes(self._rows)

    # --- rows of links and joints ------------------------------------------------------------------------------

    def _list_rows(self, robot: Robot) -> None:
        self._rows = RobotRows(robot)
        specs = self._rows.specs(self.properties.text(*STYLE))
        news = specs != self._robot_specs
        self._robot_specs = specs
        if self._derive_boxes(self._rows) or news:
            self.publish_properties()

    def _box_changed(self, rows: RobotRows, path: Path) -> None:
        """Set the check boxes that depend, directly or indirectly, on a changed one, as RViz does."""
        style = self.properties.text(*STYLE)
        followers: list[Path] = []
        if path == STYLE:
            self._robot_specs = rows.specs(style)
        elif path == ALL:
            followers = rows.boxes
        elif path[0] == JOINTS and len(path) == 2:
            followers = rows.boxes_of(path[1], style)
        elif path not in rows.boxes:
            return
        value = self.properties.get(*path)
        changed = [follower for follower in followers if self.properties.get(*follower) != value]
        for box_path in changed:
            self.properties.set(box_path, value)
        changed += self._derive_boxes(rows)
        if path == STYLE or len(changed) > _MANY_BOXES:
            self.publish_properties()
            return
        for box_path in changed:
            self.pages.publish(PropertyChanged(self.property_id(box_path), self.properties.get(*box_path)))

    def _derive_boxes(self, rows: RobotRows) -> list[Path]:
        derived = rows.derived(self.properties.text(*STYLE), lambda path: self.properties.flag(*path))
        return [path for path, value in derived.items() if self.properties.set_read_only(path, value)]

    def _log_new_problems(self, problems: dict[str, list[Phrase]]) -> None:
        for link, texts in problems.items():
            for text in texts:
                if text not in self._file_problems.get(link, ()):
                    self.context.node.get_logger().error(f"Link '{link}': {text}")

    # --- status ------------------------------------------------------------------------------------------------

    def _show_status(self) -> None:
        links = sorted(self.scene.links, key=lambda link: link.name)
        self.set_status(self._description + [self._link_status(link.name, link.frame) for link in links])

    def _link_status(self, name: str, frame: str) -> StatusRow:
        problems = [problem] if (problem := self.host.frames.problem(frame)) else []
        problems += self._file_problems.get(name, ())
        problems += [text for (link, _), text in self._page_problems.items() if link == name]
        if problems:
            return StatusRow(name, "error", joined(problems, "; "))
        return StatusRow(name, "ok", phrase("Transform OK"))
