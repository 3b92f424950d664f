"""Displays of classes that this program does not draw: shown, and kept in the file."""

from __future__ import annotations

from linkwright.viewer.displays.base.display import ViewerDisplay
from linkwright.viewer.protocol.parts import StatusRow


class UnsupportedDisplay(ViewerDisplay):
    """A display of any other class."""

    CLASS = ""
    SUPPORTED = False

    def start(self) -> None:
        """Say that it is not drawn."""
        self.enabled_changed()

    def enabled_changed(self) -> None:
        """Say that it is not drawn, where the user would have it drawn."""
        text = f"Displays of class '{self.config.cls}' are kept in the file but not drawn"
        self.set_status([StatusRow("Class", "warn", text)])
