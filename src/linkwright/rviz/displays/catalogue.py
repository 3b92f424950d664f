"""The registry of display classes, by the names that .rviz files use for them.

Displays are found through the entry points ``linkwright.displays``, which are named as .rviz files name the class. A
display class is imported when its first display is created: most configurations use only a few classes, and the program
must start quickly.
"""

from __future__ import annotations

from functools import cache

from linkwright.diagnostics import phrase
from linkwright.loading.extensions import extensions
from linkwright.page.protocol.configuration import StatusRow
from linkwright.rviz.config.former_names import GROUP as GROUP_CLASS
from linkwright.rviz.config.rviz_config import DisplayConfig
from linkwright.rviz.displays.base.display import DisplayHost, ViewerDisplay


class GroupDisplay(ViewerDisplay):
    """A display that contains other displays, and enables or disables all of them together."""

    CLASS = GROUP_CLASS


class UnsupportedDisplay(ViewerDisplay):
    """A display whose class is not available; its entry stays in the file, but nothing is drawn."""

    CLASS = ""
    SUPPORTED = False

    def start(self) -> None:
        """Show in the status that displays of this class are not drawn."""
        self.enabled_changed()

    def enabled_changed(self) -> None:
        """Show in the status that displays of this class are not drawn, if the display is enabled."""
        text = phrase("Displays of class '{name}' are kept in the file but not drawn", name=self.config.cls)
        self.set_status([StatusRow("Class", "warn", text)])


GROUP = "linkwright.displays"
"""The group of the entry points."""


def has_display(cls: str) -> bool:
    """Return whether a display class has an entry point; groups have one too."""
    return cls in extensions(GROUP)


def display_classes() -> list[type[ViewerDisplay]]:
    """Return the display classes that can be imported, including the group class."""
    return [found for cls in extensions(GROUP) if isinstance(found := _display_class(cls), type)]


def make_display(host: DisplayHost, identity: str, config: DisplayConfig) -> ViewerDisplay:
    """Create the display for an entry of the file; an `UnsupportedDisplay` if its class is not available."""
    if not has_display(config.cls):
        return UnsupportedDisplay(host, identity, config)
    found = _display_class(config.cls)
    if isinstance(found, str):
        host.context.node.get_logger().error(f"Displays of class '{config.cls}' cannot be imported: {found}")
        return UnsupportedDisplay(host, identity, config)
    return found(host, identity, config)


@cache
def _display_class(cls: str) -> type[ViewerDisplay] | str:
    """Return the class that an entry point names, or the reason why the class cannot be loaded."""
    try:
        found = extensions(GROUP)[cls].load()
    except Exception as error:  # noqa: BLE001  # of a package that is not ours anything may be wrong
        return f"{type(error).__name__}: {error}"
    if not (isinstance(found, type) and issubclass(found, ViewerDisplay)):
        return f"{found!r} is not a class derived from ViewerDisplay"
    return found
