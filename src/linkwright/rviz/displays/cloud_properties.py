"""The properties of displays of points, as in RViz's PointCloudCommon and its transformers."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

from linkwright.rviz.clouds import AXES, TRANSFORMERS, ColorSettings
from linkwright.rviz.config.property_store import PropertyStore
from linkwright.rviz.config.schema import Path, PropertySpec, Schema, alpha

DECAY_TIME = "Decay Time"
COLOR_TRANSFORMER = "Color Transformer"
POSITION_TRANSFORMER = "Position Transformer"
CHANNEL = "Channel Name"
AUTO_INTENSITY = "Autocompute Intensity Bounds"
AUTO_VALUES = "Autocompute Value Bounds"
MIN_INTENSITY, MAX_INTENSITY = INTENSITY_BOUNDS = ("Min Intensity", "Max Intensity")
VALUE_BOUNDS = ("Min Value", "Max Value")

STYLE_SPECS: Schema = (
    PropertySpec("Selectable", "bool", True, "Whether the points can be selected."),
    PropertySpec(
        "Style",
        "enum",
        "Flat Squares",
        "The shape of a point, from the fastest to the slowest to draw.",
        options=("Points", "Squares", "Flat Squares", "Spheres", "Boxes", "Tiles"),
    ),
    PropertySpec(
        "Size (m)", "float", 0.01, "Size of a point, in meters; it does not apply to the style Points.", minimum=0.0001
    ),
    PropertySpec("Size (Pixels)", "float", 3.0, "Size of a point of the style Points, in pixels.", minimum=1.0),
    alpha("Opacity of the points: 0 is invisible."),
    PropertySpec(
        DECAY_TIME, "float", 0.0, "How many seconds points are shown; 0 shows only the newest message.", minimum=0.0
    ),
)

_IS_INTENSITY = ((COLOR_TRANSFORMER,), "Intensity")
_IS_AXIS = ((COLOR_TRANSFORMER,), "AxisColor")
_WITHOUT_RAINBOW = (("Use rainbow",), False)

TRANSFORMER_SPECS: Schema = (
    PropertySpec(POSITION_TRANSFORMER, "enum", "XYZ", "The source of the points' positions.", options=("XYZ",)),
    PropertySpec(
        COLOR_TRANSFORMER, "enum", "", "The source of the points' colors.", options=tuple(sorted(TRANSFORMERS))
    ),
    PropertySpec(
        CHANNEL,
        "string",
        "intensity",
        "The channel that contains the intensity.",
        options=("intensity",),
        when=_IS_INTENSITY,
    ),
    PropertySpec(
        "Use rainbow",
        "bool",
        True,
        "Use the colors of the rainbow, instead of a gradient between two colors.",
        when=_IS_INTENSITY,
    ),
    PropertySpec("Invert Rainbow", "bool", False, "Reverse the rainbow.", when=(("Use rainbow",), True)),
    PropertySpec("Min Color", "color", "#000000", "Color of the minimum intensity.", when=_WITHOUT_RAINBOW),
    PropertySpec("Max Color", "color", "#ffffff", "Color of the maximum intensity.", when=_WITHOUT_RAINBOW),
    PropertySpec(
        AUTO_INTENSITY, "bool", True, "Use the minimum and maximum intensity of each message.", when=_IS_INTENSITY
    ),
    PropertySpec(
        MIN_INTENSITY, "float", 0.0, "The intensity that is shown in the first color.", when=((AUTO_INTENSITY,), False)
    ),
    PropertySpec(
        MAX_INTENSITY,
        "float",
        4096.0,
        "The intensity that is shown in the last color.",
        when=((AUTO_INTENSITY,), False),
    ),
    PropertySpec("Axis", "enum", "Z", "The axis along which the color changes.", options=AXES, when=_IS_AXIS),
    PropertySpec(
        AUTO_VALUES,
        "bool",
        True,
        "Use the minimum and maximum coordinate of each message.",
        when=_IS_AXIS,
        expanded=True,
        children=(
            PropertySpec(
                VALUE_BOUNDS[0],
                "float",
                -10.0,
                "The coordinate that is shown in the first color, in meters.",
                when=((AUTO_VALUES,), False),
            ),
            PropertySpec(
                VALUE_BOUNDS[1],
                "float",
                10.0,
                "The coordinate that is shown in the last color, in meters.",
                when=((AUTO_VALUES,), False),
            ),
        ),
    ),
    PropertySpec(
        "Use Fixed Frame",
        "bool",
        True,
        "Use the coordinates in the Fixed Frame, not those in the frame of the message.",
        when=_IS_AXIS,
    ),
    PropertySpec("Color", "color", "#ffffff", "The color of every point.", when=((COLOR_TRANSFORMER,), "FlatColor")),
)

COLOR_PROPERTIES = frozenset(spec.name for spec in TRANSFORMER_SPECS) - {"Color", POSITION_TRANSFORMER}
"""The properties that affect the computed colors of points. The page itself applies ``Color``."""


def scalar_specs(channel: str, minimum: float, maximum: float, *, inverted: bool | None = None) -> Schema:
    """Return the properties of a display that colors points by one number.

    Properties with only one possible value are hidden, as in RViz.

    Args:
        channel: the channel that contains the number.
        minimum: the default of ``Min Intensity``.
        maximum: the default of ``Max Intensity``.
        inverted: the fixed value of ``Invert Rainbow``, whose row is then hidden; None to let the user choose.
    """
    changes: dict[str, dict[str, Any]] = {
        POSITION_TRANSFORMER: {"hidden": True},
        COLOR_TRANSFORMER: {"hidden": True, "default": "Intensity"},
        CHANNEL: {"hidden": True, "default": channel},
        AUTO_INTENSITY: {"hidden": True, "default": False},
        MIN_INTENSITY: {"default": minimum},
        MAX_INTENSITY: {"default": maximum},
    }
    if inverted is not None:
        changes["Invert Rainbow"] = {"hidden": True, "default": inverted}
    return tuple(replace(spec, **changes.get(spec.name, {})) for spec in (*STYLE_SPECS, *TRANSFORMER_SPECS))


def read_color_settings(properties: PropertyStore) -> ColorSettings:
    """Return the color settings from the values of the properties."""
    flag, number, text = properties.flag, properties.number, properties.text

    def read_bounds(auto_property: str, *paths: Path) -> tuple[float, float] | None:
        return None if flag(auto_property) else (number(*paths[0]), number(*paths[1]))

    return ColorSettings(
        transformer=text(COLOR_TRANSFORMER),
        channel=text(CHANNEL),
        rainbow=flag("Use rainbow"),
        inverted=flag("Invert Rainbow"),
        darkest=_parse_rgb(text("Min Color")),
        brightest=_parse_rgb(text("Max Color")),
        intensities=read_bounds(AUTO_INTENSITY, (MIN_INTENSITY,), (MAX_INTENSITY,)),
        axis=AXES.index(text("Axis")),
        values=read_bounds(AUTO_VALUES, (AUTO_VALUES, VALUE_BOUNDS[0]), (AUTO_VALUES, VALUE_BOUNDS[1])),
        in_fixed_frame=flag("Use Fixed Frame"),
    )


def _parse_rgb(color: str) -> tuple[int, int, int]:
    return int(color[1:3], 16), int(color[3:5], 16), int(color[5:7], 16)
