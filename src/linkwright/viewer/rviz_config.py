"""RViz's configuration files (``.rviz``): read, kept whole, changed in place, written back."""

from __future__ import annotations

from dataclasses import dataclass, field
from pathlib import Path

from linkwright.diagnostics import Diagnostic, LinkwrightError, Severity
from linkwright.viewer import yaml_tree
from linkwright.viewer.orbit import read_view, write_view
from linkwright.viewer.property_store import PropertyStore
from linkwright.viewer.protocol import OrbitView
from linkwright.viewer.schema import PropertySpec
from linkwright.viewer.yaml_tree import Scalar, Section

GLOBAL_OPTIONS = (
    PropertySpec(
        "Fixed Frame",
        "frame",
        "base_link",
        "The frame that stands still: everything is drawn where it is in this frame.",
    ),
    PropertySpec("Background Color", "color", "#303030", "The colour behind the scene."),
    PropertySpec(
        "Frame Rate",
        "int",
        30,
        "The most transform updates a second, in hertz.",
        minimum=1,
        maximum=120,
    ),
)

_MANAGER = "Visualization Manager"
_GROUP = "Group"
_OWN_PREFIX = "rviz_default_plugins/"
_OLD_PREFIX = "rviz/"  # class names of ROS 1

_DEFAULT = """\
Panels:
  - Class: rviz_common/Displays
    Name: Displays
  - Class: rviz_common/Views
    Name: Views
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
    - Class: rviz_default_plugins/MoveCamera
  Value: true
  Views:
    Current:
      Class: rviz_default_plugins/Orbit
      Name: Current View
      Value: Orbit (rviz)
    Saved: ~
"""
_MODEL_DISPLAYS: tuple[tuple[str, dict[str, str]], ...] = (
    ("RobotModel", {"Description Topic": "/robot_description"}),
    ("TF", {}),
)


@dataclass(slots=True)
class DisplayConfig:
    """One entry of ``Displays``.

    Attributes:
        cls: RViz 2's name of its class, also where the file says it as RViz 1 did.
        name: as shown; one inside of groups carries their names, as in ``Sensors / Laser``.
        section: its part of the file.
        groups: the groups around it, outermost first; it is drawn only if they are enabled too.
    """

    cls: str
    name: str
    section: Section
    groups: tuple[Section, ...] = field(default=())

    @property
    def enabled(self) -> bool:
        """Whether it is drawn: its box and those of the groups around it are on."""
        return all(_enabled(section) for section in (*self.groups, self.section))

    @enabled.setter
    def enabled(self, value: bool) -> None:
        for section in (*self.groups, self.section) if value else (self.section,):
            if _enabled(section) != value:
                for key in ("Enabled", "Value"):
                    section.put((key,), "true" if value else "false")


class RvizConfig:
    """A configuration file.

    What this program does not know is kept and written back: keys, their order, Qt's window state, displays of other
    classes. Missing keys have RViz's defaults and stay missing until they are set.

    Attributes:
        path: the file it was read from, or None.
        displays: the entries of ``Displays``; those inside of groups follow in their place.
        options: the Global Options.
        warnings: what the file says that cannot be used.
    """

    def __init__(self, document: Section, path: Path | None = None) -> None:
        self.path = path
        self.warnings: list[Diagnostic] = []
        self._document = document
        self.options = PropertyStore(
            "global",
            document,
            lambda: GLOBAL_OPTIONS,
            self.warnings.append,
            base=(_MANAGER, "Global Options"),
        )
        self.options.rows()  # so that all warnings are there from the start
        self.displays: list[DisplayConfig] = []
        manager = document.section(_MANAGER)
        if manager is not None:
            self._collect(manager, (), "")
        self._view = read_view(document, self.warnings.append)

    @classmethod
    def load(cls, path: str | Path) -> RvizConfig:
        """Read a file.

        Raises:
            LinkwrightError: RVIZ101, it cannot be read; RVIZ102, it is not YAML; RVIZ103, it is no such configuration.
        """
        path = Path(path)
        try:
            text = path.read_text(encoding="utf-8-sig")
        except OSError as error:
            hint = "name a .rviz file after '-d'" if isinstance(error, FileNotFoundError) else None
            message = f"cannot read the RViz configuration '{path}': {error.strerror or error}"
            raise LinkwrightError(Diagnostic("RVIZ101", message, hint=hint)) from None
        except UnicodeDecodeError:
            message = f"the RViz configuration '{path}' is not a text in UTF-8"
            raise LinkwrightError(Diagnostic("RVIZ101", message)) from None
        return cls.parse(text, str(path), path)

    @classmethod
    def parse(cls, text: str, name: str = "<rviz>", path: Path | None = None) -> RvizConfig:
        """Read a text; `name` is what messages call it.

        Raises:
            LinkwrightError: RVIZ102, it is not YAML; RVIZ103, it is no such configuration.
        """
        document = yaml_tree.parse(text, name)
        if document.section(_MANAGER) is None:
            message = f"'{name}' is no RViz configuration: it has no '{_MANAGER}'"
            raise LinkwrightError(Diagnostic("RVIZ103", message, document.span(), source=document.source))
        return cls(document, path)

    @classmethod
    def default(cls) -> RvizConfig:
        """What RViz shows without a file: a Grid, Fixed Frame ``map``."""
        return cls.parse(_DEFAULT, "<default>")

    @classmethod
    def for_model(cls, fixed_frame: str, *, distance: float = 3.0) -> RvizConfig:
        """Grid, RobotModel and TF about one robot.

        Args:
            fixed_frame: the Fixed Frame, usually the robot's root link.
            distance: of the eye from the origin, metres.
        """
        config = cls.parse(_DEFAULT, "<model>")
        manager = config._document.section(_MANAGER)
        assert manager is not None
        for name, values in _MODEL_DISPLAYS:
            section = yaml_tree.append_section(manager, "Displays")
            section.put(("Class",), _OWN_PREFIX + name, string=True)
            for key, value in values.items():
                section.put((key,), value, string=True, nested=True)
            section.put(("Enabled",), "true")
            section.put(("Name",), name, string=True)
            section.put(("Value",), "true")
            config.displays.append(DisplayConfig(_OWN_PREFIX + name, name, section))
        config.options.set(("Fixed Frame",), fixed_frame)
        config.view.distance = distance
        write_view(config._document, config.view)
        return config

    @property
    def view(self) -> OrbitView:
        """The current view, as an Orbit."""
        return self._view

    @view.setter
    def view(self, view: OrbitView) -> None:
        write_view(self._document, view)
        self._view = view

    def text(self) -> str:
        """The file's text with the values set so far."""
        return yaml_tree.write(self._document)

    def save(self, path: str | Path | None = None) -> None:
        """Write to a file, by default the one it came from.

        Raises:
            ValueError: when it came from none and none is given.
            LinkwrightError: RVIZ104, the file cannot be written.
        """
        target = Path(path) if path is not None else self.path
        if target is None:
            raise ValueError("no file to save to")
        try:
            target.write_text(self.text(), encoding="utf-8")
        except OSError as error:
            message = f"cannot write the RViz configuration '{target}': {error.strerror or error}"
            raise LinkwrightError(Diagnostic("RVIZ104", message)) from None

    def _collect(self, parent: Section, groups: tuple[Section, ...], prefix: str) -> None:
        for section in parent.sections("Displays"):
            scalar = section.scalar("Class")
            if scalar is None:
                message = "a display without a 'Class' is left out"
                self.warnings.append(
                    Diagnostic("RVIZ202", message, section.span(), Severity.WARNING, source=section.source)
                )
                continue
            name = _name(section, scalar)
            if scalar.text.rpartition("/")[2] == _GROUP:
                self._collect(section, (*groups, section), f"{prefix}{name} / ")
            else:
                self.displays.append(DisplayConfig(_modern(scalar.text), prefix + name, section, groups))


def _modern(cls: str) -> str:
    return _OWN_PREFIX + cls.removeprefix(_OLD_PREFIX) if cls.startswith(_OLD_PREFIX) else cls


def _name(section: Section, cls: Scalar) -> str:
    scalar = section.scalar("Name")
    return scalar.text if scalar else cls.text.rpartition("/")[2]


def _enabled(section: Section) -> bool:
    """``Enabled``, else ``Value``; RViz's default for both is off."""
    scalar = section.scalar("Enabled") or section.scalar("Value")
    return scalar is not None and scalar.text.strip().lower() in ("true", "1", "yes", "on")
