"""The view of a .rviz file, as an Orbit.

RViz's other view controllers are shown by an Orbit that looks at the same scene from the same side, as far as there
is one.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator

from linkwright.diagnostics import Diagnostic, Severity
from linkwright.viewer.property_store import Path, PropertyStore
from linkwright.viewer.protocol import OrbitView, PropertyValue
from linkwright.viewer.schema import FIXED_FRAME, PropertySpec, vector
from linkwright.viewer.yaml_tree import Section

ORBIT = "rviz_default_plugins/Orbit"

PITCH_LIMIT = math.pi / 2 - 0.001
FIELD_OF_VIEW = math.pi / 4
"""Vertical, radians: Ogre's default, which RViz leaves as it is."""

_CURRENT = ("Visualization Manager", "Views", "Current")
_NOMINAL_HEIGHT = 700.0
"""Height in pixels of a 3-D view in RViz's default window, to turn an orthographic scale into a distance."""

_COMMON = (
    PropertySpec("Name", "string", "Current View"),
    PropertySpec("Near Clip Distance", "float", 0.01, minimum=0.001),
    PropertySpec("Invert Z Axis", "bool", False),
    PropertySpec("Target Frame", "frame", FIXED_FRAME),
)
_ORBIT = (
    *_COMMON,
    PropertySpec("Distance", "float", 10.0, minimum=0.001),
    PropertySpec("Yaw", "float", 0.785398),
    PropertySpec("Pitch", "float", 0.785398, minimum=-PITCH_LIMIT, maximum=PITCH_LIMIT),
    vector("Focal Point", ""),
    PropertySpec("Focal Shape Size", "float", 0.05, minimum=0.001),
    PropertySpec("Focal Shape Fixed Size", "bool", True),
)
_FPS = (
    *_COMMON,
    PropertySpec(
        "Position",
        "group",
        children=(
            PropertySpec("X", "float", 5.0),
            PropertySpec("Y", "float", 5.0),
            PropertySpec("Z", "float", 10.0),
        ),
    ),
    PropertySpec("Yaw", "float", 0.0),
    PropertySpec("Pitch", "float", 0.0, minimum=-PITCH_LIMIT, maximum=PITCH_LIMIT),
)
_ORTHO = (
    *_COMMON,
    PropertySpec("Scale", "float", 10.0, minimum=0.001),
    PropertySpec("Angle", "float", 0.0),
    PropertySpec("X", "float", 0.0),
    PropertySpec("Y", "float", 0.0),
)


def read_view(document: Section, report: Callable[[Diagnostic], None]) -> OrbitView:
    """The current view of a file. Another class than Orbit is reported (RVIZ203)."""
    current = document.section(*_CURRENT)
    scalar = document.scalar(*_CURRENT, "Class")
    kind = scalar.text.rpartition("/")[2] if scalar else "Orbit"
    if scalar is not None and kind != "Orbit":
        message = f"the view '{scalar.text}' is shown as an Orbit view"
        source = current.source if current else None
        report(Diagnostic("RVIZ203", message, scalar.span, Severity.WARNING, source=source))
    schema = {"FPS": _FPS, "TopDownOrtho": _ORTHO}.get(kind, _ORBIT)
    store = PropertyStore("view", document, lambda: schema, report, base=_CURRENT)
    view = OrbitView(
        name=store.text("Name"),
        near_clip_distance=store.number("Near Clip Distance"),
        invert_z_axis=store.flag("Invert Z Axis"),
        target_frame=store.text("Target Frame"),
    )
    if schema is _FPS:
        _look_from(store, view)
    elif schema is _ORTHO:
        _look_down(store, view)
    else:
        view.distance = store.number("Distance")
        view.yaw = store.number("Yaw") % math.tau
        view.pitch = store.number("Pitch")
        view.focal_point = [store.number("Focal Point", axis) for axis in "XYZ"]
        view.focal_shape_size = store.number("Focal Shape Size")
        view.focal_shape_fixed_size = store.flag("Focal Shape Fixed Size")
    return view


def write_view(document: Section, view: OrbitView) -> None:
    """Make a view the file's current one, as an Orbit; values that are equal stay as they are spelt.

    Raises:
        ValueError: when a value is none that a view can have.
    """
    if view == read_view(document, lambda _: None):
        return
    store = PropertyStore("view", document, lambda: _ORBIT, lambda _: None, base=_CURRENT)
    values = dict(_values(view))
    for path, value in values.items():
        store.check(path, value)
    scalar = document.scalar(*_CURRENT, "Class")
    if scalar is None or scalar.text.rpartition("/")[2] != "Orbit":
        document.put((*_CURRENT, "Class"), ORBIT, string=True)
    for path, value in values.items():
        store.set(path, value)


def _values(view: OrbitView) -> Iterator[tuple[Path, PropertyValue]]:
    yield ("Name",), view.name
    yield ("Near Clip Distance",), view.near_clip_distance
    yield ("Invert Z Axis",), view.invert_z_axis
    yield ("Target Frame",), view.target_frame
    yield ("Distance",), view.distance
    yield ("Yaw",), view.yaw
    yield ("Pitch",), view.pitch
    for axis, value in zip("XYZ", view.focal_point, strict=True):
        yield ("Focal Point", axis), value
    yield ("Focal Shape Size",), view.focal_shape_size
    yield ("Focal Shape Fixed Size",), view.focal_shape_fixed_size


def _look_from(store: PropertyStore, view: OrbitView) -> None:
    """An Orbit with the eye and direction of an FPS view; it turns about where the ground is seen, if it is."""
    x, y, z = (store.number("Position", axis) for axis in "XYZ")
    yaw, pitch = store.number("Yaw"), store.number("Pitch")
    forward = (math.cos(yaw) * math.cos(pitch), math.sin(yaw) * math.cos(pitch), -math.sin(pitch))
    reach = -z / forward[2] if forward[2] else math.inf
    view.distance = reach if 0.1 < reach < 100.0 else 10.0
    view.yaw = (yaw + math.pi) % math.tau
    view.pitch = pitch
    view.focal_point = [at + view.distance * step for at, step in zip((x, y, z), forward, strict=True)]


def _look_down(store: PropertyStore, view: OrbitView) -> None:
    """An Orbit from above that shows as much as a TopDownOrtho view does, with the same side up."""
    view.distance = _NOMINAL_HEIGHT / store.number("Scale") / 2 / math.tan(FIELD_OF_VIEW / 2)
    view.yaw = (store.number("Angle") - math.pi / 2) % math.tau
    view.pitch = PITCH_LIMIT
    view.focal_point = [store.number("X"), store.number("Y"), 0.0]
