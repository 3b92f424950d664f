"""Properties that several displays of poses have: the shape of a pose, and how its covariance is drawn."""

from __future__ import annotations

from linkwright.viewer.config.schema import PropertySpec, Schema
from linkwright.viewer.displays.properties.look import alpha, length

_ARROW = (("Shape",), "Arrow")
_AXES = (("Shape",), "Axes")


def pose_shape(*, nested: bool = False) -> Schema:
    """Whether a pose is an arrow or axes, and how large; ``nested`` as Odometry has it: the sizes below ``Shape``."""
    description = "Whether a pose is drawn as an arrow along its x or as axes."
    sizes = (
        PropertySpec("Color", "color", "#ff1900", "Colour of the arrow.", when=_ARROW),
        alpha("Opacity of the arrow.", when=_ARROW),
        length("Shaft Length", 1.0, "Length of the arrow's shaft, in metres.", _ARROW),
        length("Shaft Radius", 0.05, "Thickness of the arrow's shaft, in metres.", _ARROW),
        length("Head Length", 0.3, "Length of the arrow's head, in metres.", _ARROW),
        length("Head Radius", 0.1, "Width of the arrow's head, in metres.", _ARROW),
        length("Axes Length", 1.0, "Length of each axis, in metres.", _AXES),
        length("Axes Radius", 0.1, "Thickness of each axis, in metres.", _AXES),
    )
    options = ("Arrow", "Axes")
    if nested:
        return (PropertySpec("Shape", "enum", "Arrow", description, options=options, children=sizes),)
    return (PropertySpec("Shape", "enum", "Arrow", description, options=options), *sizes)


def covariance() -> PropertySpec:
    """RViz's CovarianceProperty."""
    position = (
        PropertySpec("Color", "color", "#cc33cc", "Colour of the ellipsoid."),
        alpha("Opacity of the ellipsoid.", 0.3),
        PropertySpec("Scale", "float", 1.0, "How many standard deviations the ellipsoid is large.", minimum=0.0),
    )
    orientation = (
        PropertySpec(
            "Frame",
            "enum",
            "Local",
            "Whether the deviations are about the axes of the pose or of the frame it is given in.",
            options=("Local", "Fixed"),
        ),
        PropertySpec(
            "Color Style",
            "enum",
            "Unique",
            "One colour for all three, or red, green and blue for the rotations about x, y and z.",
            options=("Unique", "RGB"),
        ),
        PropertySpec(
            "Color",
            "color",
            "#ffff7f",
            "Colour of the three.",
            when=(("Covariance", "Orientation", "Color Style"), "Unique"),
        ),
        alpha("Opacity of the three.", 0.5),
        PropertySpec(
            "Offset",
            "float",
            1.0,
            "How far from the pose they are, in metres; in a plane: how long the triangle is.",
            minimum=0.0,
        ),
        PropertySpec("Scale", "float", 1.0, "How many standard deviations they are large.", minimum=0.0),
    )
    return PropertySpec(
        "Covariance",
        "bool",
        True,
        "Draw how uncertain each pose is.",
        children=(
            PropertySpec("Position", "bool", True, "Draw how uncertain the position is.", children=position),
            PropertySpec("Orientation", "bool", True, "Draw how uncertain the orientation is.", children=orientation),
        ),
    )
