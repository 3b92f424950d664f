"""RViz's views: properties by class, views in .rviz files, and sizes for a robot.

The declarations determine the rows of the Views panel, the keys of ``Views`` in the file, and the values accepted from
pages. The page implements cameras and mouse actions, see `frontend/src/state/views`. Names and defaults are the same as
in rviz_common (``ViewController``) and rviz_default_plugins.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass

from linkwright.diagnostics import Diagnostic, Severity, phrase
from linkwright.page.protocol.configuration import Property, PropertyValue
from linkwright.page.protocol.views_and_tools import View, ViewClass
from linkwright.rviz.config.former_names import to_modern_class
from linkwright.rviz.config.property_store import PropertyStore
from linkwright.rviz.config.schema import FIXED_FRAME, MAX_TEXT_LENGTH, Path, PropertySpec, Schema, vector_spec
from linkwright.rviz.config.yaml_tree import (
    SavedEntry,
    Section,
    ensure_section,
    insert_section,
    new_section,
    remove_section,
)

_AXIS_LENGTH = 0.2
"""The length of an axis of the TF display at Marker Scale 1, in m."""
_MAX_FOCAL_SHAPE = 0.05


@dataclass(frozen=True, slots=True)
class ModelSize:
    """The size of a robot and the typical spacing of its links, in meters.

    Attributes:
        diagonal: the diagonal of the robot's bounding box.
        spacing: the typical distance from a link's frame to its parent's frame.
    """

    diagonal: float
    spacing: float

    @property
    def distance(self) -> float:
        """The camera distance in m at which the whole robot is visible.

        It is used until a page has measured the robot's meshes.
        """
        return _round_length(2.0 * self.diagonal)

    @property
    def marker_scale(self) -> float:
        """The marker scale of the TF display at which axes are visible but do not cover links."""
        axis = min(max(self.spacing / 2, self.diagonal / 40), self.diagonal / 10)
        return _round_length(axis / _AXIS_LENGTH)

    @property
    def focal_shape_size(self) -> float:
        """The diameter of the disc at the focal point in m, at most the default of RViz."""
        return min(_MAX_FOCAL_SHAPE, _round_length(self.diagonal / 15))

    @property
    def cell_size(self) -> float:
        """The cell size of the grid in m.

        It is the largest power of ten that is at most 1.5 times the diagonal.
        """
        return float(10.0 ** math.floor(math.log10(self.diagonal * 1.5)))


def _round_length(length: float) -> float:
    """Return a length rounded to two significant digits, as a user would type it."""
    return float(f"{length:.2g}")


ORBIT = "rviz_default_plugins/Orbit"
FPS = "rviz_default_plugins/FPS"
CURRENT_NAME = "Current View"
PITCH_LIMIT = math.pi / 2 - 0.001

_EIGHTH_TURN = 0.785398  # spelled as RViz writes it

_NEAR_CLIP = PropertySpec(
    "Near Clip Distance",
    "float",
    0.01,
    "The near clipping distance of the camera, in meters.",
    minimum=0.001,
    maximum=10000.0,
)
_STEREO = PropertySpec(
    "Enable Stereo Rendering",
    "bool",
    False,
    hidden=True,
    children=(
        PropertySpec("Stereo Eye Separation", "float", 0.06),
        PropertySpec("Stereo Focal Distance", "float", 1.0),
        PropertySpec("Swap Stereo Eyes", "bool", False),
    ),
)
"""Properties for stereo screens. RViz hides these rows on other screens, and their values stay in the file."""
_INVERT_Z = PropertySpec(
    "Invert Z Axis", "bool", False, "Turns the camera upside down, for frames whose z axis points down."
)
_TARGET = PropertySpec("Target Frame", "frame", FIXED_FRAME, "The frame whose motion the camera follows.")
_YAW_HELP = "Rotation of the camera about the z axis, in radians."
_PITCH_HELP = "How far the camera looks down, in radians."

_ORBIT: Schema = (
    _NEAR_CLIP,
    _STEREO,
    _INVERT_Z,
    _TARGET,
    PropertySpec("Distance", "float", 10.0, "From the focal point to the camera, in meters.", minimum=0.001),
    PropertySpec(
        "Focal Shape Size", "float", 0.05, "Diameter of the disc at the focal point, in meters.", minimum=0.001
    ),
    PropertySpec(
        "Focal Shape Fixed Size", "bool", True, "The disc keeps its size; otherwise it grows with the distance."
    ),
    PropertySpec("Yaw", "float", _EIGHTH_TURN, _YAW_HELP),
    PropertySpec("Pitch", "float", _EIGHTH_TURN, _PITCH_HELP, minimum=-PITCH_LIMIT, maximum=PITCH_LIMIT),
    vector_spec("Focal Point", "The point that the camera orbits, in the target frame, in meters."),
)
_FPS: Schema = (
    _NEAR_CLIP,
    _STEREO,
    _TARGET,
    PropertySpec("Yaw", "float", 0.0, _YAW_HELP),
    PropertySpec("Pitch", "float", 0.0, _PITCH_HELP, minimum=-PITCH_LIMIT, maximum=PITCH_LIMIT),
    PropertySpec(
        "Position",
        "group",
        description="The position of the camera in the target frame, in meters.",
        children=(
            PropertySpec("X", "float", 5.0),
            PropertySpec("Y", "float", 5.0),
            PropertySpec("Z", "float", 10.0),
        ),
    ),
)
_TOP_DOWN_ORTHO: Schema = (
    _NEAR_CLIP,
    _STEREO,
    _TARGET,
    PropertySpec("Scale", "float", 10.0, "Pixels per meter; a negative scale turns the image upside down."),
    PropertySpec("Angle", "float", 0.0, "The rotation of the image about the z axis, in radians."),
    PropertySpec("X", "float", 0.0, "The center of the image along x in the target frame, in meters."),
    PropertySpec("Y", "float", 0.0, "The center of the image along y in the target frame, in meters."),
)

VIEW_SCHEMAS: dict[str, Schema] = {
    FPS: _FPS,
    ORBIT: _ORBIT,
    "rviz_default_plugins/ThirdPersonFollower": _ORBIT,
    "rviz_default_plugins/TopDownOrtho": _TOP_DOWN_ORTHO,
    "rviz_default_plugins/XYOrbit": _ORBIT,
}
"""The properties of each class, in the order in which RViz lists the classes."""

SIMILAR_CLASSES = {"rviz_default_plugins/FrameAligned": FPS}
"""The supported class for each similar, unsupported class: FrameAligned is an FPS that can be aligned and locked."""


def find_value_paths(schema: Schema) -> dict[str, Path]:
    """Return the paths of the properties that have a value, by key of `View.values`.

    A key consists of the names of the path, joined with ``/``.
    """
    return {"/".join(path): path for path, spec in _walk(schema, ()) if spec.kind != "group"}


def make_view_classes() -> list[ViewClass]:
    """Return the view classes and their property rows, for the page."""
    return [
        ViewClass(cls, [_make_row(spec, ()) for spec in schema if not spec.hidden], _get_defaults(schema))
        for cls, schema in VIEW_SCHEMAS.items()
    ]


def _get_defaults(schema: Schema) -> dict[str, PropertyValue]:
    return {"/".join(path): spec.default for path, spec in _walk(schema, ()) if spec.kind != "group"}


def _walk(schema: Schema, parent_path: Path) -> list[tuple[Path, PropertySpec]]:
    specs = []
    for spec in schema:
        path = (*parent_path, spec.name)
        specs += [(path, spec), *_walk(spec.children, path)]
    return specs


def _make_row(spec: PropertySpec, parent_path: Path) -> Property:
    path = (*parent_path, spec.name)
    return Property(
        id="/".join(path),
        name=spec.name,
        kind=spec.kind,
        value=spec.default,
        description=spec.description,
        minimum=spec.minimum,
        maximum=spec.maximum,
        expanded=spec.expanded,
        children=[_make_row(child, path) for child in spec.children],
    )


_MANAGER = "Visualization Manager"
_VIEWS = "Views"
_SAVED = "Saved"

MAX_SAVED_VIEWS = 1000
"""The maximum number of saved views."""

Report = Callable[[Diagnostic], None]


class ViewEntry:
    """An entry of ``Views``.

    Unknown keys of the entry stay in the file. If `VIEW_SCHEMAS` does not have the class of the view, the view is shown
    as a similar class or as an Orbit. It stays unchanged in the file until a value is set.

    Args:
        section: the file, or the view's section of it.
        base: the keys from the section to the view.
        report: called with findings about an unknown class (RVIZ203) and unusable values (RVIZ201).
    """

    def __init__(self, section: Section, base: Path, report: Report) -> None:
        self._section = section
        self._base = base
        self._report = report
        self._cls = self._find_supported_class()
        self._store = self._make_store(self._cls)
        self._view = self._read()

    @property
    def view(self) -> View:
        """A copy of the current view."""
        return View(self._view.cls, self._view.name, dict(self._view.values))

    def set(self, view: View) -> None:
        """Write a view to the file.

        Values that have not changed keep their spelling.

        Raises:
            ValueError: the name is too long, the class is unknown or has no such value, or a value is not accepted.
        """
        if view == self._view:
            return
        if len(view.name) > MAX_TEXT_LENGTH:
            raise ValueError(f"the name of a view has at most {MAX_TEXT_LENGTH} characters")
        if view.cls not in VIEW_SCHEMAS:
            raise ValueError(f"there is no view class {view.cls!r}")
        paths = find_value_paths(VIEW_SCHEMAS[view.cls])
        store = self._store if view.cls == self._cls else self._make_store(view.cls)
        for name, value in view.values.items():
            if name not in paths:
                raise ValueError(f"a view of the class {view.cls!r} has no value {name!r}")
            store.check(paths[name], value)
        self._write_class(view.cls)
        if self._get_name() != view.name:
            self._section.put((*self._base, "Name"), view.name, string=True)
        for name, value in view.values.items():
            store.set(paths[name], value)
        self._store, self._cls = store, view.cls
        self._view = self._read()

    def _write_class(self, cls: str) -> None:
        """Change the class of the view, and remove the keys that the new class does not have."""
        scalar = self._section.scalar(*self._base, "Class")
        written_class = to_modern_class(scalar.text) if scalar else ""
        if cls in (written_class, SIMILAR_CLASSES.get(written_class)):
            return
        section = ensure_section(self._section, *self._base)
        new_keys = {spec.name for spec in VIEW_SCHEMAS[cls]}
        for spec in VIEW_SCHEMAS[self._cls]:
            if spec.name not in new_keys:
                section.restore(SavedEntry(spec.name, None))
        section.put(("Class",), cls, string=True)
        section.put(("Name",), self._get_name(), string=True)
        package, _, name = cls.partition("/")
        section.put(("Value",), f"{name} ({package})", string=True)

    def _read(self) -> View:
        paths = find_value_paths(VIEW_SCHEMAS[self._cls])
        return View(self._cls, self._get_name(), {name: self._store.get(*path) for name, path in paths.items()})

    def _get_name(self) -> str:
        scalar = self._section.scalar(*self._base, "Name")
        return scalar.text if scalar else CURRENT_NAME

    def _make_store(self, cls: str) -> PropertyStore:
        schema: Schema = VIEW_SCHEMAS[cls]
        return PropertyStore("view", self._section, lambda: schema, self._report, base=self._base)

    def _find_supported_class(self) -> str:
        scalar = self._section.scalar(*self._base, "Class")
        if scalar is None:
            return ORBIT
        cls = to_modern_class(scalar.text)
        if cls in VIEW_SCHEMAS:
            return cls
        shown_class = SIMILAR_CLASSES.get(cls, ORBIT)
        message = phrase(
            "the view class '{class_name}' is not supported; it is shown as {shown_class}",
            class_name=scalar.text,
            shown_class=shown_class.rpartition("/")[2],
        )
        self._report(Diagnostic("RVIZ203", message, scalar.span, Severity.WARNING, source=self._section.source))
        return shown_class


class ViewsConfig:
    """The ``Views`` of a file.

    Args:
        document: the file.
        report: called with findings about views that cannot be used as written.
    """

    def __init__(self, document: Section, report: Report) -> None:
        self._document = document
        self._current = ViewEntry(document, (_MANAGER, _VIEWS, "Current"), report)
        self._saved: dict[str, tuple[Section, ViewEntry]] = {}
        self._count = 0
        for section in document.sections(_MANAGER, _VIEWS, _SAVED):
            if section.scalar("Class") is not None:  # RViz skips views without a class
                self._add_saved(section, ViewEntry(section, (), report))

    @property
    def current(self) -> View:
        """The current view."""
        return self._current.view

    @current.setter
    def current(self, view: View) -> None:
        """Set the current view, and write it to the file.

        Raises:
            ValueError: the view is not valid.
        """
        self._current.set(view)

    @property
    def saved(self) -> dict[str, View]:
        """The saved views in file order, by IDs that are stable while the file is open."""
        return {identity: entry.view for identity, (_, entry) in self._saved.items()}

    def save(self, view: View) -> str:
        """Add a view to the saved views and return its ID.

        Raises:
            ValueError: the view is not valid, or there are too many saved views.
        """
        if len(self._saved) >= MAX_SAVED_VIEWS:
            raise ValueError(f"there are already {MAX_SAVED_VIEWS} saved views, the maximum")
        section = new_section(self._document.source)
        entry = ViewEntry(section, (), _ignore_finding)
        entry.set(view)
        insert_section(ensure_section(self._document, _MANAGER, _VIEWS), _SAVED, section)
        return self._add_saved(section, entry)

    def change(self, identity: str, view: View) -> None:
        """Change the name or the values of a saved view.

        Raises:
            KeyError: there is no such saved view.
            ValueError: the view is not valid.
        """
        self._saved[identity][1].set(view)

    def remove(self, identity: str) -> None:
        """Remove a saved view.

        Raises:
            KeyError: there is no such saved view.
        """
        section, _ = self._saved.pop(identity)
        remove_section(ensure_section(self._document, _MANAGER, _VIEWS), _SAVED, section)

    def _add_saved(self, section: Section, entry: ViewEntry) -> str:
        self._count += 1
        identity = f"view-{self._count}"
        self._saved[identity] = (section, entry)
        return identity


def _ignore_finding(diagnostic: Diagnostic) -> None:
    """Ignore a finding, because the values that were just written are valid."""
