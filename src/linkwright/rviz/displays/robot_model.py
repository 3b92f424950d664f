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
ALL_LINKS = (LINKS, "All Links Enabled")

_TREE_STYLES = ("Tree of links", "Tree of links and joints")
_OPTIONS = (
    PropertySpec(
        STYLE[1],
        "enum",
        "Links in Alphabetic Order",
        "The arrangement of the rows of links and joints.",
        options=("Links in Alphabetic Order", "Joints in Alphabetic Order", *_TREE_STYLES),
    ),
    PropertySpec("Expand Tree", "bool", False, "Open or close the rows of all links and joints of the tree."),
    PropertySpec("Expand Link Details", "bool", False, "Open or close the details of each link."),
    PropertySpec("Expand Joint Details", "bool", False, "Open or close the details of each joint."),
    PropertySpec(ALL_LINKS[1], "bool", True, "Enable or disable all links."),
)
_OPTION_NAMES = frozenset(spec.name for spec in _OPTIONS)

_LINK_ALPHA = alpha("Opacity of this link.")
_LINK_EXTRAS = (
    PropertySpec("Show Trail", "bool", False, "Draw the trail of the link."),
    PropertySpec("Show Axes", "bool", False, "Draw the axes of the link's frame."),
)
_JOINT_AXES = PropertySpec("Show Axes", "bool", False, "Draw the axes of the joint's frame.")
_JOINT_AXIS = PropertySpec("Show Joint Axis", "bool", False, "Draw the joint's axis of motion.")
_TYPES_WITH_AXIS = ("continuous", "revolute", "prismatic", "planar")

NO_ROWS = (PropertySpec(LINKS, "group", children=_OPTIONS),)


class RobotRows:
    """The property rows of a robot's links and joints.

    The page arranges the rows by the Link Tree Style. The style does not affect the file. A link has a check box if it
    has shapes. A joint has a check box if its child link or, in a tree, any descendant link has shapes.
    """

    def __init__(self, robot: Robot) -> None:
        self._robot = robot
        self._joints_by_parent: dict[str, list[str]] = {}
        for joint in robot.joints.values():
            self._joints_by_parent.setdefault(joint.parent, []).append(joint.name)
        self._links_with_shapes = {link.name for link in robot.links.values() if link.visuals or link.collisions}
        self._visible_links: dict[tuple[str, bool], list[str]] = {}

    def specs(self, style: str) -> tuple[PropertySpec, ...]:
        """Return the groups of links and of joints, each in alphabetical order."""
        links = tuple(
            self._make_link_spec(self._robot.links[name])
            for name in sorted(self._robot.links)
            if name not in _OPTION_NAMES
        )
        joints = tuple(self._make_joint_spec(self._robot.joints[name], style) for name in sorted(self._robot.joints))
        return (
            PropertySpec(LINKS, "group", description="The links of the robot.", children=(*_OPTIONS, *links)),
            PropertySpec(JOINTS, "group", description="The joints of the robot.", children=joints),
        )

    @property
    def link_check_boxes(self) -> list[Path]:
        """The paths of the links' check boxes."""
        return [(LINKS, name) for name in sorted(self._links_with_shapes - _OPTION_NAMES)]

    def find_controlled_boxes(self, joint: str, style: str) -> list[Path]:
        """Return the paths of the links' check boxes that a joint's check box controls."""
        return [(LINKS, name) for name in self._find_links(self._robot.joints[joint], style)]

    def derive_states(self, style: str, is_on: Callable[[Path], bool]) -> dict[Path, bool]:
        """Return the states of the dependent check boxes, by property path.

        These are the check boxes of the joints, and *All Links Enabled*. Each of them is on if the check boxes of all
        its links are on.

        Args:
            style: the Link Tree Style.
            is_on: returns whether the check box of a link is on.
        """
        link_states = {name: is_on((LINKS, name)) for name in self._links_with_shapes - _OPTION_NAMES}
        joint_states: dict[Path, bool] = {
            (JOINTS, joint.name): all(link_states.get(name, True) for name in links)
            for joint in self._robot.joints.values()
            if (links := self._find_links(joint, style))
        }
        return {**joint_states, ALL_LINKS: all(link_states.values())}

    def _make_link_spec(self, link: Link) -> PropertySpec:
        if link.name not in self._links_with_shapes:
            description = "A link without shapes."
            return PropertySpec(link.name, "group", None, description, children=_LINK_EXTRAS, details="link")
        description, children = "Draw the shapes of this link.", (_LINK_ALPHA, *_LINK_EXTRAS)
        return PropertySpec(link.name, "bool", True, description, children=children, details="link")

    def _make_joint_spec(self, joint: Joint, style: str) -> PropertySpec:
        children = (_JOINT_AXES, _JOINT_AXIS) if joint.type in _TYPES_WITH_AXIS else (_JOINT_AXES,)
        description = f"Joint '{joint.name}' with parent link '{joint.parent}' and child link '{joint.child}'."
        if not self._find_links(joint, style):
            return PropertySpec(joint.name, "group", None, description, children=children, details="joint")
        return PropertySpec(joint.name, "bool", True, description, children=children, details="joint")

    def _find_links(self, joint: Joint, style: str) -> list[str]:
        key = (joint.name, style in _TREE_STYLES)
        if key not in self._visible_links:
            links = self._find_links_below(joint) if style in _TREE_STYLES else [joint.child]
            self._visible_links[key] = [name for name in links if name in self._links_with_shapes]
        return self._visible_links[key]

    def _find_links_below(self, joint: Joint) -> list[str]:
        link_names, pending = [], [joint.child]
        while pending:
            link = pending.pop()
            link_names.append(link)
            pending.extend(self._robot.joints[name].child for name in self._joints_by_parent.get(link, ()))
        return link_names


_FIXED_PROPERTIES = (
    PropertySpec("Visual Enabled", "bool", True, "Draw the visual geometry."),
    PropertySpec("Collision Enabled", "bool", False, "Draw the collision geometry."),
    PropertySpec(
        "Mass Properties",
        "group",
        description="How masses are drawn.",
        children=(
            PropertySpec("Mass", "bool", False, "Draw each link's mass as a sphere of lead at its center of mass."),
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
_MAX_FINDINGS = 5
_MAX_SINGLE_UPDATES = 20
"""If more check boxes change than this number, all rows are sent again."""


class RobotModelDisplay(ViewerDisplay):
    """A display of a robot, from a description on a topic or in a file.

    If a new description cannot be read, the last valid robot stays visible, whereas RViz shows no robot. If a new
    description lacks links of the previous one, their frames are removed, whereas RViz shows them until it is closed.
    """

    CLASS = "rviz_default_plugins/RobotModel"
    MESSAGE = "std_msgs/msg/String"
    TOPIC = ("Description Topic",)
    SCHEMA = (*_FIXED_PROPERTIES, *NO_ROWS)

    def __init__(self, host: DisplayHost, identity: str, config: DisplayConfig) -> None:
        self._rows: RobotRows | None = None
        self._robot_specs: Schema = NO_ROWS
        super().__init__(host, identity, config)
        self.robot: Robot | None = None
        self.scene = RobotScene(display=identity, revision=0, name="", links=[])
        self._description_source = DescriptionSource(
            host.context,
            self.properties,
            self._on_description,
            self._on_refusal,
        )
        self._text = ""
        self._queued_text: str | None = None
        self._publisher: bytes | None = None
        self._has_replaced_other = False
        self._description: list[StatusRow] = []
        self._file_problems: dict[str, list[Phrase]] = {}
        self._page_problems: dict[tuple[str, str], Phrase] = {}

    @property
    def text(self) -> str:
        """The text of the description from which the robot was read."""
        return self._text

    @property
    def file_problems(self) -> dict[str, list[Phrase]]:
        """The problems with the files that links refer to, by link name."""
        return self._file_problems

    def schema(self) -> Schema:
        """Return the fixed properties, and the rows of all links and joints."""
        return (*_FIXED_PROPERTIES, *self._robot_specs)

    def start(self) -> None:
        """Subscribe to the description's topic, or read its file."""
        problem = self._description_source.follow()
        is_from_topic = self.properties.text("Description Source") == "Topic"
        name = "Topic" if is_from_topic else "Description File"
        if problem is not None:
            self._description = [StatusRow(name, "error", problem)]
        elif is_from_topic:
            self._description = [StatusRow(name, "warn", phrase("No messages received"))]
        else:
            self._description = []
        self._show_status()

    def stop(self) -> None:
        """Unsubscribe, and end the pages' access to the files of the robot."""
        self._description_source.close()
        self.context.meshes.replace(self.id, {})

    def on_property_changed(self, path: Path) -> None:
        """Apply a new source, a new frame prefix, or the check boxes of links and joints."""
        if path[0] in _SOURCE_NAMES:
            self.start()
        elif path == ("TF Prefix",) and self.robot is not None:
            self._show_robot(self.robot)
        elif self._rows is not None and path[0] in (LINKS, JOINTS):
            self._on_box_changed(self._rows, path)

    def on_frames_changed(self) -> None:
        """Show in the status which links have a known pose."""
        self._show_status()

    def on_time_changed(self) -> None:
        """Read the description that was received while time was paused."""
        if self._queued_text is not None and not self.host.time.paused:
            self._on_description(self._queued_text)

    def messages(self) -> list[ServerMessage]:
        """Return the robot's links and joints for a newly opened page."""
        return [self.scene]

    def receive(self, status: MeshStatus) -> None:
        """Show in the status whether a page could load a mesh of the current robot."""
        link = next((link for link in self.scene.links if link.name == status.link), None)
        if link is None or not any(shape.url == status.url for shape in (*link.visuals, *link.collisions)):
            return
        key = (status.link, status.url)
        previous_problem = self._page_problems.get(key)
        if status.error is None:
            self._page_problems.pop(key, None)
        else:
            name = status.url.partition("?")[0].rpartition("/")[2]
            self._page_problems[key] = phrase(
                "Could not load mesh '{name}': {reason}", name=name, reason=status.error[:500]
            )
            if self._page_problems[key] != previous_problem:
                self.context.node.get_logger().error(f"Link '{status.link}': {self._page_problems[key]}")
        self._show_status()

    def find_provenance(self, link: str) -> LinkProvenance | None:
        """Return the source locations of the definition of a link, or None if they are not known.

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

    def _on_description(self, text: str) -> None:
        self._queued_text = text if self.robot is not None and self.host.time.paused else None
        if self._queued_text is not None:
            return
        if not text.strip():
            self._description = [StatusRow("URDF", "error", phrase("URDF is empty"))]
            self._show_status()
            return
        reading = self.context.library.read(text)
        if reading.robot is None:
            self._on_refusal(reading.diagnostics)
            return
        is_changed, self._text = text != self._text, text
        self._description = [StatusRow("URDF", "ok", phrase("URDF parsed OK"))]
        if self.properties.text("Description Source") == "Topic":
            self._description.insert(0, self._make_topic_row(is_changed=is_changed))
        self._show_robot(reading.robot)

    def _make_topic_row(self, *, is_changed: bool) -> StatusRow:
        """Return the status row of the topic.

        The row names the publisher if there are several.

        If a different description from another publisher replaces the current one, a warning is logged.
        """
        previous_gid = None if self._publisher is None else self._description_source.find_current_gid(self._publisher)
        self._publisher = self._description_source.publisher
        publishers = self._description_source.publishers()
        owner = publishers.pop(self._publisher or b"", phrase("an unknown node"))
        if not publishers:
            self._has_replaced_other = False
            return StatusRow("Topic", "ok", phrase("OK"))
        if is_changed and previous_gid is not None and previous_gid in publishers:
            self._has_replaced_other = True
            self.context.node.get_logger().warning(
                f"The description of {owner} replaces that of {publishers[previous_gid]}: both publish on "
                f"'{self.properties.text('Description Topic')}'"
            )
        other_publishers = ", ".join(sorted(set(publishers.values())))
        level: Literal["ok", "warn"] = "warn" if self._has_replaced_other else "ok"
        return StatusRow(
            "Topic",
            level,
            phrase(
                "The description of {owner} is shown; {others} also publish on the topic",
                owner=owner,
                others=other_publishers,
            ),
        )

    def _on_refusal(self, diagnostics: Sequence[Diagnostic]) -> None:
        errors = [diagnostic for diagnostic in diagnostics if diagnostic.severity is Severity.ERROR]
        is_xml = not any(error.code.startswith("XML") for error in errors)
        text = phrase("URDF failed Model parse") if is_xml else phrase("URDF failed XML parse")
        self._description = [StatusRow("URDF", "error", text)]
        for error in errors[:_MAX_FINDINGS]:
            self._description.append(StatusRow(error.code, "error", error.located_message))
        self._show_status()

    def _show_robot(self, robot: Robot) -> None:
        previous_frames = {link.frame for link in self.scene.links}
        finder = self.context.library.packages(self._text) or self.context.finder
        builder = SceneBuilder(MeshIndex(finder))
        links = builder.links(robot, self.properties.text("TF Prefix"))
        self.context.meshes.replace(self.id, builder.index.folders)
        self._log_new_file_problems(builder.problems)
        self._file_problems = builder.problems
        self._page_problems.clear()
        self.robot = robot
        joints = builder.joints(robot)
        if (self.scene.name, self.scene.links, self.scene.joints) != (robot.name, links, joints):
            self.scene = RobotScene(self.id, self.scene.revision + 1, robot.name, links, joints)
            self.pages.publish(self.scene)
        self._update_rows(robot)
        self.host.on_robot_changed(previous_frames - {link.frame for link in links})
        self._show_status()

    def on_properties_restored(self) -> None:
        """Update the rows for a restored Link Tree Style, and the check boxes of the joints."""
        if self._rows is not None:
            self._robot_specs = self._rows.specs(self.properties.text(*STYLE))
            self._derive_boxes(self._rows)

    # --- rows of links and joints ------------------------------------------------------------------------------

    def _update_rows(self, robot: Robot) -> None:
        self._rows = RobotRows(robot)
        specs = self._rows.specs(self.properties.text(*STYLE))
        has_changed = specs != self._robot_specs
        self._robot_specs = specs
        if self._derive_boxes(self._rows) or has_changed:
            self.publish_properties()

    def _on_box_changed(self, rows: RobotRows, path: Path) -> None:
        """Set the check boxes that depend on a changed check box, as in RViz."""
        style = self.properties.text(*STYLE)
        dependent_paths: list[Path] = []
        if path == STYLE:
            self._robot_specs = rows.specs(style)
        elif path == ALL_LINKS:
            dependent_paths = rows.link_check_boxes
        elif path[0] == JOINTS and len(path) == 2:
            dependent_paths = rows.find_controlled_boxes(path[1], style)
        elif path not in rows.link_check_boxes:
            return
        value = self.properties.get(*path)
        changed = [
            dependent_path for dependent_path in dependent_paths if self.properties.get(*dependent_path) != value
        ]
        for box_path in changed:
            self.properties.set(box_path, value)
        changed += self._derive_boxes(rows)
        if path == STYLE or len(changed) > _MAX_SINGLE_UPDATES:
            self.publish_properties()
            return
        for box_path in changed:
            self.pages.publish(PropertyChanged(self.property_id(box_path), self.properties.get(*box_path)))

    def _derive_boxes(self, rows: RobotRows) -> list[Path]:
        derived_states = rows.derive_states(self.properties.text(*STYLE), lambda path: self.properties.flag(*path))
        return [path for path, value in derived_states.items() if self.properties.set_read_only(path, value)]

    def _log_new_file_problems(self, problems: dict[str, list[Phrase]]) -> None:
        for link, texts in problems.items():
            for text in texts:
                if text not in self._file_problems.get(link, ()):
                    self.context.node.get_logger().error(f"Link '{link}': {text}")

    # --- status ------------------------------------------------------------------------------------------------

    def _show_status(self) -> None:
        links = sorted(self.scene.links, key=lambda link: link.name)
        self.set_status(self._description + [self._make_link_status(link.name, link.frame) for link in links])

    def _make_link_status(self, name: str, frame: str) -> StatusRow:
        problems = [problem] if (problem := self.host.frames.find_problem(frame)) else []
        problems += self._file_problems.get(name, ())
        problems += [text for (link, _), text in self._page_problems.items() if link == name]
        if problems:
            return StatusRow(name, "error", joined(problems, "; "))
        return StatusRow(name, "ok", phrase("Transform OK"))
