"""Properties of how things look, which displays of many kinds have."""

from __future__ import annotations

from linkwright.viewer.config.schema import Path, PropertySpec

BILLBOARDS = (("Line Style",), "Billboards")
"""The condition of properties of lines that have a width."""


def alpha(
    description: str = "Opacity: 0 is invisible.", default: float = 1.0, when: tuple[Path, str] | None = None
) -> PropertySpec:
    """The opacity of what a display draws."""
    return PropertySpec("Alpha", "float", default, description, minimum=0.0, maximum=1.0, when=when)


def length(name: str, default: float, description: str, when: tuple[Path, str] | None = None) -> PropertySpec:
    """A length in metres."""
    return PropertySpec(name, "float", default, description, when=when)


def line_style(*children: PropertySpec) -> PropertySpec:
    """Whether lines are thin or have a width."""
    return PropertySpec(
        "Line Style",
        "enum",
        "Lines",
        "Lines are one pixel wide; billboards have a width in metres.",
        options=("Lines", "Billboards"),
        children=children,
    )


def line_width() -> PropertySpec:
    """The width of lines that have one."""
    return PropertySpec("Line Width", "float", 0.03, "Width of the lines, in metres.", minimum=0.001, when=BILLBOARDS)
