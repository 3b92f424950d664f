"""rviz_default_plugins/Grid."""

from __future__ import annotations

from linkwright.viewer.config.schema import FIXED_FRAME, Path, PropertySpec, vector
from linkwright.viewer.displays.base.display import ViewerDisplay
from linkwright.viewer.displays.properties.look import alpha, line_style, line_width
from linkwright.viewer.frames.stream import transform_status


class GridDisplay(ViewerDisplay):
    """A grid in a plane of a frame."""

    CLASS = "rviz_default_plugins/Grid"
    SCHEMA = (
        PropertySpec("Reference Frame", "frame", FIXED_FRAME, "The frame whose origin is the middle of the grid."),
        PropertySpec("Plane Cell Count", "int", 10, "Cells along each side of the grid.", minimum=1, maximum=1000),
        PropertySpec(
            "Normal Cell Count",
            "int",
            0,
            "Layers of cells along the normal of the plane; more than 0 makes a lattice.",
            minimum=0,
            maximum=100,
        ),
        PropertySpec("Cell Size", "float", 1.0, "Side of a cell, in metres.", minimum=0.0001),
        line_style(line_width()),
        PropertySpec("Color", "color", "#a0a0a4", "Colour of the lines."),
        alpha("Opacity of the lines: 0 is invisible.", 0.5),
        PropertySpec("Plane", "enum", "XY", "The plane the grid lies in.", options=("XY", "XZ", "YZ")),
        vector("Offset", "Where the grid's middle is in the reference frame, in metres."),
    )

    def start(self) -> None:
        """Say whether the reference frame can be placed."""
        self.frames_changed()

    def changed(self, path: Path) -> None:
        """Another reference frame has another status."""
        if path == ("Reference Frame",):
            self.frames_changed()

    def frames_changed(self) -> None:
        """Say whether the reference frame can be placed."""
        self.set_status([transform_status(self.host.frames, self.properties.text("Reference Frame"))])
