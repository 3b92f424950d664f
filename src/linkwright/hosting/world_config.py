"""The configuration of a viewer for a simulated world."""

from __future__ import annotations

from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from linkwright.rviz import RvizConfig

_WORLD_DISPLAY, _WORLD_FRAME = "linkwright/World", "world"
_MAP_DISPLAY = "rviz_default_plugins/Map"
_CAMERA_DISTANCE = 5.0
"""The distance in m from which the camera shows an empty world."""


def create_world_config(name: str, x: float = 0.0, y: float = 0.0) -> RvizConfig:
    """Return a configuration with the world and its robots, a grid, and a fixed view.

    The displays of robot models and transforms are disabled, because they would draw parts of the world twice.

    Args:
        name: the name of the page.
        x: the x coordinate of the focal point, in m.
        y: the y coordinate of the focal point, in m.
    """
    from linkwright.rviz import RvizConfig

    config = RvizConfig.for_model(_WORLD_FRAME, name=name)
    for display in config.displays:
        display.checked = display.cls.endswith("/Grid")
    show_world(config)
    config.propose_view({"Distance": _CAMERA_DISTANCE, "Focal Point/X": x, "Focal Point/Y": y})
    return config


def show_world(config: RvizConfig) -> None:
    """Add a World display to a configuration without one.

    If the configuration shows a map, the display is disabled, because both cover the same area.
    """
    if not shows_world(config):
        world = config.make_display(_WORLD_DISPLAY, "World")
        world.checked = not any(display.cls == _MAP_DISPLAY and display.checked for display in config.walk())
        config.insert(world)


def shows_world(config: RvizConfig) -> bool:
    """Return whether a configuration contains a World display."""
    return any(display.cls == _WORLD_DISPLAY for display in config.walk())
