"""Reads RViz's configuration files (``.rviz``), edits them in place, and writes them."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from math import isfinite
from pathlib import Path
from typing import Any

from linkwright.diagnostics import Diagnostic, LinkwrightError, Severity, phrase
from linkwright.page.protocol.views_and_tools import View
from linkwright.rviz.config import file as configuration_file
from linkwright.rviz.config import yaml_tree
from linkwright.rviz.config.file import FileForm, FileState
from linkwright.rviz.config.former_names import GROUP, to_modern_class
from linkwright.rviz.config.panels import PanelsConfig
from linkwright.rviz.config.property_store import PropertyStore
from linkwright.rviz.config.schema import Path as PropertyPath
from linkwright.rviz.config.schema import PropertySpec, is_on
from linkwright.rviz.config.tools import ToolsConfig
from linkwright.rviz.config.views import ModelSize, ViewsConfig
from linkwright.rviz.config.yaml_tree import NewSection, SavedEntry, SavedSequence, Section

__all__ = ["GLOBAL_OPTIONS", "Arrangement", "DisplayConfig", "RvizConfig"]

GLOBAL_OPTIONS = (
    PropertySpec(
        "Fixed Frame",
        "frame",
        "base_link",
        "The reference frame of the scene: everything is drawn at its pose in this frame.",
    ),
    PropertySpec(
        "Backdrop",
        "enum",
        "Color",
        "The background: one color, as in RViz, or a sky and a ground in the colors of the page's theme.",
        options=("Color", "Sky and Ground"),
    ),
    PropertySpec(
        "Background Color", "color", "#303030", "The background color of the scene.", when=(("Backdrop",), "Color")
    ),
    PropertySpec(
        "Frame Rate",
        "int",
        30,
        "The maximum rate of transform updates, in hertz.",
        minimum=1,
        maximum=120,
    ),
    PropertySpec(
        "Light",
        "enum",
        "Camera",
        "The lights of the scene: one at the camera, as in RViz, or a studio, with shadows on the ground. Automatic: "
        "the studio if a graphics card draws fast enough, else a soft light at the camera. The display of a simulated "
        "world has a setting of its own.",
        options=("Automatic", "Camera", "Studio"),
    ),
)

_MANAGER = "Visualization Manager"
_CONFIGURATION_KEYS = ("Panels", "Toolbars", "Window Geometry")
"""Keys of a configuration: a file with one of them is accepted even if it has no displays."""
_DEFAULT_PLUGINS = "rviz_default_plugins/"

_DEFAULT_TEXT = """\
Panels:
  - Class: rviz_common/Displays
    Name: Displays
  - Class: rviz_common/Selection
    Name: Selection
  - Class: rviz_common/Tool Properties
    Name: Tool Properties
  - Class: rviz_common/Views
    Name: Views
  - Class: rviz_common/Time
    Name: Time
Visualization Manager:
  Class: ""
  Displays:
    - Class: rviz_default_plugins/Grid
      Enabled: true
      Name: Grid
      Value: true
  Enabled: true
  Global Options:
    Background Color: 48; 48; 48
    Fixed Frame: map
    Frame Rate: 30
  Name: root
  Tools:
    - Class: rviz_default_plugins/Interact
    - Class: rviz_default_plugins/MoveCamera
    - Class: rviz_default_plugins/Select
    - Class: rviz_default_plugins/FocusCamera
    - Class: rviz_default_plugins/Measure
    - Class: rviz_default_plugins/SetInitialPose
    - Class: rviz_default_plugins/SetGoal
    - Class: rviz_default_plugins/PublishPoint
  Value: true
  Views:
    Current:
      Class: rviz_default_plugins/Orbit
      Name: Current View
      Value: Orbit (rviz)
    Saved: ~
"""

_DISPLAYS = "Displays"
_CHECK_BOX_KEYS = ("Enabled", "Value")


class DisplayConfig:
    """An entry of ``Displays``.

    Args:
        section: the entry's section of the file.
        group: the group that contains the display, or None at the top level.
        report: called with findings about entries of the group that cannot be used.

    Attributes:
        cls: the class name of the display in RViz 2, even if the file has the name in RViz 1.
        displays: the displays in the group; empty if the display is not a group.
        identity: the display's ID in pages; empty until it is assigned.
    """

    def __init__(
        self, section: Section, group: DisplayConfig | None, report: Callable[[Diagnostic], None] = lambda _: None
    ) -> None:
        self.section = section
        self.group = group
        self.cls = to_modern_class(self.written_class)
        self.identity = ""
        self.displays: list[DisplayConfig] = read_displays(section, self, report) if self.is_group else []

    @property
    def written_class(self) -> str:
        """The name of the display's class as written in the file, or empty if the file has none."""
        scalar = self.section.scalar("Class")
        return scalar.text if scalar else ""

    @property
    def is_group(self) -> bool:
        """Whether the display is a group.

        A group contains displays and draws nothing itself.
        """
        return self.cls == GROUP

    @property
    def name(self) -> str:
        """The name of the display in the Displays panel.

        The default is the class name without the package.
        """
        scalar = self.section.scalar("Name")
        return scalar.text if scalar else self.cls.rpartition("/")[2]

    @name.setter
    def name(self, name: str) -> None:
        self.section.put(("Name",), name, string=True)

    @property
    def checked(self) -> bool:
        """Whether the check box is on.

        ``Enabled`` or, if it is missing, ``Value`` determines the result. The default is off.
        """
        text = self.section.text("Enabled")
        if text is None:
            text = self.section.text("Value")
        return text is not None and is_on(text)

    @checked.setter
    def checked(self, value: bool) -> None:
        if value == self.checked:
            return
        existing_keys = [key for key in _CHECK_BOX_KEYS if self.section.scalar(key)]
        for key in existing_keys or _CHECK_BOX_KEYS[:1]:
            self.section.put((key,), "true" if value else "false")

    @property
    def check_box_entries(self) -> list[SavedEntry]:
        """The current entries of the check box in the file, to restore the check box later."""
        return [self.section.copy_entry(key) for key in _CHECK_BOX_KEYS]

    @check_box_entries.setter
    def check_box_entries(self, saved_entries: list[SavedEntry]) -> None:
        for saved_entry in saved_entries:
            self.section.restore(saved_entry)

    @property
    def enabled(self) -> bool:
        """Whether the check boxes of the display and of all enclosing groups are on."""
        return self.checked and (self.group is None or self.group.enabled)

    def walk(self) -> Iterator[DisplayConfig]:
        """Yield the display and all displays below it, each group before its contents."""
        yield self
        for display in self.displays:
            yield from display.walk()


def read_displays(
    parent: Section, group: DisplayConfig | None, report: Callable[[Diagnostic], None]
) -> list[DisplayConfig]:
    """Return the displays that are listed under ``Displays`` in a section.

    Entries without a class are reported (RVIZ202) and ignored.
    """
    displays = []
    for section in parent.sections(_DISPLAYS):
        if section.scalar("Class") is None:
            message = phrase("a display without a 'Class' is ignored")
            report(Diagnostic("RVIZ202", message, section.span(), Severity.WARNING, source=section.source))
        else:
            displays.append(DisplayConfig(section, group, report))
    return displays


def insert_display(display: DisplayConfig, parent: Section, siblings: list[DisplayConfig], index: int) -> None:
    """Insert a display before the sibling at `index`, both in the list and in the file."""
    next_section = siblings[index].section if index < len(siblings) else None
    yaml_tree.insert_section(parent, _DISPLAYS, display.section, next_section)
    siblings.insert(index, display)


def remove_display(display: DisplayConfig, parent: Section, siblings: list[DisplayConfig]) -> None:
    """Remove a display from its list of siblings and from the file."""
    yaml_tree.remove_section(parent, _DISPLAYS, display.section)
    siblings.remove(display)


_MODEL_DISPLAYS: tuple[tuple[str, dict[str, str]], ...] = (
    ("RobotModel", {"Description Topic": "/robot_description"}),
    ("TF", {}),
)
_MODEL_GRID = {"Alpha": "0.6", "Color": "136; 142; 150", "Plane Cell Count": "20"}
"""A grid that is visible on the ground of both themes, and extends beyond the visible area."""
_MODEL_DISTANCE = 3.0
"""The initial distance of the camera from a model, in m."""
_MODEL_PITCH = 0.5
"""The pitch of the view, in rad. The robot hides less of itself than at RViz's default pitch of 45 degrees."""


@dataclass(frozen=True, slots=True)
class Arrangement:
    """The order and grouping of the displays.

    Attributes:
        displays: the displays in each group, and at the top level under the key None.
        sequences: the ``Displays`` sequences of the file, by the same keys.
    """

    displays: dict[DisplayConfig | None, list[DisplayConfig]]
    sequences: dict[DisplayConfig | None, SavedSequence]


class RvizConfig:
    """An RViz configuration file.

    Keys, their order, Qt's window state and displays of unknown classes are preserved and written back. Missing keys
    have RViz's defaults and stay missing until they are set. A file without changes is written back exactly as it was
    read. A changed file loses its comments, as in RViz.

    Attributes:
        path: the file that the configuration was read from or saved to, or None.
        document: the root mapping of the file.
        displays: the top-level entries of ``Displays``; each group contains further displays.
        options: the values of the Global Options.
        views: the current view and the saved views.
        tools: the entries of ``Tools``.
        panels: the open panels.
        warnings: findings about entries of the file that cannot be used.
    """

    def __init__(self, document: Section, path: Path | None = None, form: FileForm | None = None) -> None:
        self.path = path
        self.warnings: list[Diagnostic] = []
        self.document = document
        self._form = form or FileForm()
        self._new_sections: list[NewSection] = []
        self._state: FileState | None = configuration_file.get_file_state(path) if path else None
        self.options = PropertyStore(
            "global",
            document,
            lambda: GLOBAL_OPTIONS,
            self.warnings.append,
            base=(_MANAGER, "Global Options"),
        )
        self.options.rows()  # reads all options, so that their findings are in `warnings` from the start
        self.displays: list[DisplayConfig] = read_displays(
            document.section(_MANAGER) or yaml_tree.new_section(document.source), None, self.warnings.append
        )
        self.views = ViewsConfig(document, self.warnings.append)
        self.tools = ToolsConfig(document, self.warnings.append)
        self.panels = PanelsConfig(document, self.warnings.append)
        self._proposed_view: View | None = None
        self._proposed_sizes: _ProposedSizes | None = None

    @classmethod
    def load(cls, path: str | Path) -> RvizConfig:
        """Return the configuration read from a file.

        Raises:
            LinkwrightError: RVIZ101, the file cannot be read; RVIZ102, it is not YAML; RVIZ103, it is not a
                configuration.
        """
        path = Path(path)
        text, form = configuration_file.read(path)
        return cls.parse(text, str(path), path, form)

    @classmethod
    def parse(
        cls, text: str, name: str = "<rviz>", path: Path | None = None, form: FileForm | None = None
    ) -> RvizConfig:
        """Parse a configuration from text.

        Findings refer to the text as `name`.

        Raises:
            LinkwrightError: RVIZ102, the text is not YAML; RVIZ103, it is not a configuration.
        """
        document = yaml_tree.parse(text, name)
        if document.section(_MANAGER) is None and not set(_CONFIGURATION_KEYS) & set(document.keys()):
            message = phrase(
                "'{name}' is not an RViz configuration: the key '{manager}' is missing", name=name, manager=_MANAGER
            )
            raise LinkwrightError(Diagnostic("RVIZ103", message, document.span(), source=document.source))
        return cls(document, path, form)

    @classmethod
    def default(cls, name: str = "<default>") -> RvizConfig:
        """Return RViz's default configuration: a Grid, Fixed Frame ``map``.

        Args:
            name: the name under which unsaved edits are stored.
        """
        return cls.parse(_DEFAULT_TEXT, name)

    @classmethod
    def for_model(
        cls, fixed_frame: str, *, size: ModelSize | None = None, frames: bool = True, name: str = "<model>"
    ) -> RvizConfig:
        """Return a configuration with Grid, RobotModel and TF for one robot.

        Args:
            fixed_frame: the Fixed Frame, usually the robot's root link.
            size: the size of the robot, which determines the sizes of grid and axes; None for RViz's default sizes.
            frames: whether TF is enabled, although its axes cover a robot that has visuals.
            name: the name of the model's file, under which unsaved edits are stored.
        """
        config = cls.parse(_DEFAULT_TEXT, name)
        for name, values in _MODEL_DISPLAYS:
            display = config.make_display(_DEFAULT_PLUGINS + name, name)
            for key, value in values.items():
                display.section.put((key,), value, string=True, nested=True)
            display.checked = frames or name != "TF"
            config.insert(display)
        config.options.set(("Fixed Frame",), fixed_frame)
        for key, value in _MODEL_GRID.items():
            config.displays[0].section.put((key,), value)
        config.options.set(("Backdrop",), "Sky and Ground")
        config.options.set(("Light",), "Automatic")
        view = config.views.current
        view.values |= {"Distance": _MODEL_DISTANCE, "Pitch": _MODEL_PITCH}
        if size is not None:
            for display_config, path, length in _compute_fitted_sizes(config.displays, size):
                display_config.section.put(path, f"{length:g}")
            view.values |= {"Distance": size.distance, "Focal Shape Size": size.focal_shape_size}
        config.propose_view(view.values)
        config._proposed_sizes = _ProposedSizes(config.displays, size)
        return config

    def propose_view(self, values: Mapping[str, Any]) -> None:
        """Set provisional view values.

        They apply until a page fits the camera to the scene.
        """
        view = self.views.current
        view.values |= values
        self.views.current = view
        self._proposed_view = self.views.current

    def follow_frame(self, frame: str, distance: float) -> None:
        """Make the view follow a mobile robot's frame, and keep the current sizes of grid and axes.

        Args:
            frame: the robot's frame.
            distance: the camera's distance from the frame, m.
        """
        view = self.views.current
        view.values |= {"Target Frame": frame, "Distance": distance}
        self.views.current = view
        self._proposed_sizes = None

    @property
    def shows_whole_robot(self) -> bool:
        """Whether the user has not chosen a view yet, so that pages fit the camera to the robot."""
        return self._proposed_view == self.views.current

    @property
    def awaits_size(self) -> bool:
        """Whether no page has measured the robot yet, so that `take_sizes` can return sizes."""
        return self._proposed_sizes is not None

    @property
    def spacing(self) -> float | None:
        """The typical distance between the frames of a link and its parent, in meters.

        The distance is None if it is unknown, and after `take_sizes` was called.
        """
        size = None if self._proposed_sizes is None else self._proposed_sizes.size
        return None if size is None else size.spacing

    def take_sizes(self, diagonal: float, ground: float = 0.0) -> list[tuple[DisplayConfig, PropertyPath, float]]:
        """Return the sizes of grid and axes that fit the robot, given the measurements of a page.

        Each item is a display, the path of a property and its new value. Properties that the user has changed are
        omitted. Only the first call returns sizes; later calls return an empty list.

        Args:
            diagonal: the diagonal of the robot's bounding box, m.
            ground: the height of the ground below the robot, in the Fixed Frame, m.
        """
        proposed_sizes, self._proposed_sizes = self._proposed_sizes, None
        if proposed_sizes is None or not isfinite(diagonal + ground) or diagonal <= 0:
            return []
        return proposed_sizes.compute_corrections(diagonal, ground)

    def copy(self) -> RvizConfig:
        """Return a copy of the configuration that has no file."""
        copied_config = RvizConfig.parse(self.text(), self.document.source.name)
        copied_config._proposed_view = self._proposed_view
        if self._proposed_sizes is not None:
            copied_config._proposed_sizes = self._proposed_sizes.for_copies(
                dict(zip(self.walk(), copied_config.walk(), strict=True))
            )
        return copied_config

    # --- displays ----------------------------------------------------------------------------------------------

    def walk(self) -> Iterator[DisplayConfig]:
        """Yield every display, each group before its contents."""
        for display in self.displays:
            yield from display.walk()

    def make_display(self, cls: str, name: str) -> DisplayConfig:
        """Return a new enabled display with the defaults of its class, to be added with `insert`."""
        section = yaml_tree.new_section(self.document.source)
        section.put(("Class",), cls, string=True)
        section.put(("Enabled",), "true")
        section.put(("Name",), name, string=True)
        if cls != GROUP:
            section.put(("Value",), "true")
        return DisplayConfig(section, None)

    def duplicate(self, display: DisplayConfig) -> DisplayConfig:
        """Return a copy of a display's entry, to be added with `insert`."""
        return DisplayConfig(yaml_tree.copy_section(display.section), None)

    def insert(self, display: DisplayConfig, group: DisplayConfig | None = None, index: int | None = None) -> None:
        """Insert a display into a group or at the top level.

        It is placed before the display at `index`, or at the end.

        Raises:
            ValueError: the target is not a group, or it is the display itself or a group inside the display.
        """
        if group is not None and (not group.is_group or group in display.walk()):
            raise ValueError(f"'{display.name}' cannot be put into '{group.name}'")
        siblings = self.siblings(group)
        insert_display(display, self._find_parent(group), siblings, len(siblings) if index is None else index)
        display.group = group

    def remove(self, display: DisplayConfig) -> None:
        """Remove a display from its group or the top level, and from the file."""
        remove_display(display, self._find_parent(display.group), self.siblings(display.group))

    def make_group(self, name: str) -> DisplayConfig:
        """Return an empty group, to be added with `insert`."""
        return self.make_display(GROUP, name)

    def arrangement(self) -> Arrangement:
        """Return the current order and grouping of the displays, for `arrange`."""
        groups = [None, *(display for display in self.walk() if display.is_group)]
        return Arrangement(
            {group: list(self.siblings(group)) for group in groups},
            {group: self._copy_sequence(group) for group in groups},
        )

    def arrange(self, arrangement: Arrangement) -> None:
        """Restore an order and grouping of the displays that `arrangement` returned."""
        for group, displays in arrangement.displays.items():
            self.siblings(group)[:] = displays
            for display in displays:
                display.group = group
            yaml_tree.restore_sequence(self._find_parent(group), "Displays", arrangement.sequences[group])
        self._new_sections = yaml_tree.remove_unchanged(self._new_sections)

    def siblings(self, group: DisplayConfig | None) -> list[DisplayConfig]:
        """Return the displays in a group, or the top-level displays if `group` is None."""
        return self.displays if group is None else group.displays

    def _copy_sequence(self, group: DisplayConfig | None) -> SavedSequence:
        section = group.section if group is not None else self.document.section(_MANAGER)
        return yaml_tree.copy_sequence(section, "Displays") if section is not None else SavedSequence(None, None)

    def _find_parent(self, group: DisplayConfig | None) -> Section:
        """Return the section that contains the ``Displays`` of a group or of the top level.

        The top-level section is created if it is missing.
        """
        if group is not None:
            return group.section
        manager, new_sections = yaml_tree.make_section(self.document, _MANAGER)
        self._new_sections += new_sections
        return manager

    # --- file --------------------------------------------------------------------------------------------------

    def text(self) -> str:
        """Return the text of the file with all edits.

        Without edits, this is exactly the text that was read.
        """
        source = self.document.source
        if yaml_tree.are_same(self.document, yaml_tree.parse(source.text, source.name)):
            return source.text
        return yaml_tree.write(self.document).replace("\n", self._form.newline)

    def save(self, path: str | Path | None = None) -> None:
        """Write the configuration to a file, by default to its current file.

        `path` becomes the configuration's file.

        Raises:
            ValueError: the configuration has no file and `path` is None.
            LinkwrightError: RVIZ104, the file cannot be written.
        """
        target = Path(path) if path is not None else self.path
        if target is None:
            raise ValueError("the configuration has no file: give the path to save to")
        configuration_file.write(target, self.text(), self._form)
        self.path = target
        self._state = configuration_file.get_file_state(target)

    @property
    def changed_on_disk(self) -> bool:
        """Whether another program has changed the file since it was read or saved."""
        return self.path is not None and configuration_file.get_file_state(self.path) not in (self._state, None)


class _ProposedSizes:
    """The proposed sizes of grid and axes, used until the meshes of the robot are measured.

    Args:
        displays: the displays of `RvizConfig.for_model`.
        size: the robot's estimated size, or None if it is unknown.
    """

    def __init__(self, displays: Sequence[DisplayConfig], size: ModelSize | None) -> None:
        self._displays = tuple(displays)
        self.size = size
        sizes = _compute_fitted_sizes(displays, size or _UNKNOWN_SIZE, ground=1.0)
        self._proposed_texts = {path: display.section.text(*path) for display, path, _ in sizes}

    def compute_corrections(self, diagonal: float, ground: float) -> list[tuple[DisplayConfig, PropertyPath, float]]:
        """Return the sizes for the measured robot, except those that the user has changed."""
        spacing = diagonal if self.size is None else self.size.spacing
        sizes = _compute_fitted_sizes(self._displays, ModelSize(diagonal, spacing), ground)
        return [change for change in sizes if change[0].section.text(*change[1]) == self._proposed_texts[change[1]]]

    def for_copies(self, copies: Mapping[DisplayConfig, DisplayConfig]) -> _ProposedSizes | None:
        """Return the same proposal for copies of the displays, or None if a display was removed."""
        copied_displays = [copies[display] for display in self._displays if display in copies]
        return _ProposedSizes(copied_displays, self.size) if len(copied_displays) == len(self._displays) else None


_UNKNOWN_SIZE = ModelSize(1.0, 1.0)


def _compute_fitted_sizes(
    displays: Sequence[DisplayConfig], size: ModelSize, ground: float = 0.0
) -> list[tuple[DisplayConfig, PropertyPath, float]]:
    """Return the sizes of grid and axes that fit a robot.

    `displays` are the displays of `RvizConfig.for_model`.

    Each item is a display, the path of a property and its value. The height of the ground is included unless it is 0.
    """
    grid, _, tf = displays
    offset = [(grid, ("Offset", "Z"), round(ground, 4))] if ground else []
    return [(grid, ("Cell Size",), size.cell_size), (tf, ("Marker Scale",), size.marker_scale), *offset]
