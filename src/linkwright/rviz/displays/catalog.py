"""The registry of display classes, by the names that .rviz files use for them.

Displays are registered as entry points of the group ``linkwright.displays``. The name of an entry point is the name of
the class in .rviz files. A display class is imported when its first display is created, because most configurations use
only a few classes and the program must start quickly.
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
    """A display whose class is not available.

    The entry stays in the file, but nothing is drawn.
    """

    CLASS = ""
    SUPPORTED = False

    def start(self) -> None:
        """Show in the status that displays of this class are not drawn."""
        self.on_enabled_changed()

    def on_enabled_changed(self) -> None:
        """Show in the status that displays of this class are not drawn, if the display is enabled."""
        text = phrase(
            "Displays of class '{name}' are not supported: they stay in the file but are not drawn",
            name=self.config.cls,
        )
        self.set_status([StatusRow("Class", "warn", text)])


ENTRY_POINT_GROUP = "linkwright.displays"
"""The group of the entry points."""


def has_display(cls: str) -> bool:
    """Return whether a display class is available, that is, has an entry point."""
    return cls in extensions(ENTRY_POINT_GROUP)


def display_classes() -> list[type[ViewerDisplay]]:
    """Return the display classes that can be imported, including the group class."""
    return [
        display_class
        for cls in extensions(ENTRY_POINT_GROUP)
        if isinstance(display_class := _load_display_class(cls), type)
    ]


def make_display(host: DisplayHost, identity: str, config: DisplayConfig) -> ViewerDisplay:
    """Return a new display for an entry of the file.

    If the class is not available, the display is an `UnsupportedDisplay`.
    """
    if not has_display(config.cls):
        return UnsupportedDisplay(host, identity, config)
    display_class = _load_display_class(config.cls)
    if isinstance(display_class, str):
        host.context.node.get_logger().error(f"Displays of class '{config.cls}' cannot be imported: {display_class}")
        return UnsupportedDisplay(host, identity, config)
    return display_class(host, identity, config)


@cache
def _load_display_class(cls: str) -> type[ViewerDisplay] | str:
    """Return the class that an entry point names, or the reason why the class cannot be loaded."""
    try:
        display_class = extensions(ENTRY_POINT_GROUP)[cls].load()
    except Exception as error:  # noqa: BLE001  # a third-party package may raise any exception
        return f"{type(error).__name__}: {error}"
    if not (isinstance(display_class, type) and issubclass(display_class, ViewerDisplay)):
        return f"{display_class!r} is not a class derived from ViewerDisplay"
    return display_class
