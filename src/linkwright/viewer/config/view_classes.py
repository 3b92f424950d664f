"""RViz's views: the properties of each class, declared once.

From these come the rows of the Views panel, the reading and writing of the ``Views`` of a .rviz file and the checks of
what pages send. How each class turns its values into a camera, and what the mouse does to them, is the page's:
`frontend/src/state/views`. Names and defaults are RViz's (rviz_common ``ViewController``, rviz_default_plugins).
"""

from __future__ import annotations

import math

from linkwright.viewer.config.property_store import Path, Schema
from linkwright.viewer.config.schema import FIXED_FRAME, PropertySpec, vector
from linkwright.viewer.protocol.parts import Property, PropertyValue
from linkwright.viewer.protocol.views import ViewClass

ORBIT = "rviz_default_plugins/Orbit"
FPS = "rviz_default_plugins/FPS"
CURRENT_NAME = "Current View"
PITCH_LIMIT = math.pi / 2 - 0.001

_EIGHTH_TURN = 0.785398  # as RViz writes it

_NEAR_CLIP = PropertySpec(
    "Near Clip Distance",
    "float",
    0.01,
    "What is closer to the camera than this is not drawn, in metres.",
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
"""For stereo screens: RViz too hides these rows on other screens. The file keeps them."""
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
    PropertySpec("Distance", "float", 10.0, "From the focal point to the camera, in metres.", minimum=0.001),
    PropertySpec(
        "Focal Shape Size", "float", 0.05, "Diameter of the disc at the focal point, in metres.", minimum=0.001
    ),
    PropertySpec(
        "Focal Shape Fixed Size", "bool", True, "The disc keeps its size; otherwise it grows with the distance."
    ),
    PropertySpec("Yaw", "float", _EIGHTH_TURN, _YAW_HELP),
    PropertySpec("Pitch", "float", _EIGHTH_TURN, _PITCH_HELP, minimum=-PITCH_LIMIT, maximum=PITCH_LIMIT),
    vector("Focal Point", "The point that the camera turns about, in the target frame, in metres."),
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
        description="Where the camera is in the target frame, in metres.",
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
    PropertySpec("Scale", "float", 10.0, "Pixels to a metre; a negative scale turns the picture upside down."),
    PropertySpec("Angle", "float", 0.0, "By how much the picture is turned about the z axis, in radians."),
    PropertySpec("X", "float", 0.0, "Where the middle of the picture is in the target frame, in metres."),
    PropertySpec("Y", "float", 0.0, "Where the middle of the picture is in the target frame, in metres."),
)

VIEW_SCHEMAS: dict[str, Schema] = {
    FPS: _FPS,
    ORBIT: _ORBIT,
    "rviz_default_plugins/ThirdPersonFollower": _ORBIT,
    "rviz_default_plugins/TopDownOrtho": _TOP_DOWN_ORTHO,
    "rviz_default_plugins/XYOrbit": _ORBIT,
}
"""The properties of each class, in the order in which RViz lists the classes."""

STAND_INS = {"rviz_default_plugins/FrameAligned": FPS}
"""Classes that are shown as another that looks alike: a FrameAligned is an FPS that can be aligned and locked."""


def value_paths(schema: Schema) -> dict[str, Path]:
    """The properties that have a value, by their names joined with ``/``, as `View.values` has them."""
    return {"/".join(path): path for path, spec in _walk(schema, ()) if spec.kind != "group"}


def view_classes() -> list[ViewClass]:
    """The classes as the page lists them."""
    return [
        ViewClass(cls, [_row(spec, ()) for spec in schema if not spec.hidden], _defaults(schema))
        for cls, schema in VIEW_SCHEMAS.items()
    ]


def _defaults(schema: Schema) -> dict[str, PropertyValue]:
    return {"/".join(path): spec.default for path, spec in _walk(schema, ()) if spec.kind != "group"}


def _walk(schema: Schema, above: Path) -> list[tuple[Path, PropertySpec]]:
    found = []
    for spec in schema:
        path = (*above, spec.name)
        found += [(path, spec), *_walk(spec.children, path)]
    return found


def _row(spec: PropertySpec, above: Path) -> Property:
    path = (*above, spec.name)
    return Property(
        id="/".join(path),
        name=spec.name,
        kind=spec.kind,
        value=spec.default,
        description=spec.description,
        minimum=spec.minimum,
        maximum=spec.maximum,
        expanded=spec.expanded,
        children=[_row(child, path) for child in spec.children],
    )
