"""rviz_default_plugins/Axes."""

from __future__ import annotations

from linkwright.viewer.config.schema import FIXED_FRAME, Path, PropertySpec
from linkwright.viewer.displays.base.display import ViewerDisplay
from linkwright.viewer.frames.stream import transform_status

_FRAME = "Reference Frame"


class AxesDisplay(ViewerDisplay):
    """The axes of a frame: x red, y green, z blue."""

    CLASS = "rviz_default_plugins/Axes"
    SCHEMA = (
        PropertySpec(_FRAME, "frame", FIXED_FRAME, "The frame whose axes are drawn."),
        PropertySpec("Length", "float", 1.0, "Length of each axis, in metres.", minimum=0.0001),
        PropertySpec("Radius", "float", 0.1, "Radius of each axis, in metres.", minimum=0.0001),
    )

    def start(self) -> None:
        """Say whether the frame can be placed."""
        self.frames_changed()

    def changed(self, path: Path) -> None:
        """Another frame has another status."""
        if path == (_FRAME,):
            self.frames_changed()

    def frames_changed(self) -> None:
        """Say whether the frame can be placed."""
        self.set_status([transform_status(self.host.frames, self.properties.text(_FRAME))])
