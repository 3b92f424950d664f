"""The viewer configuration for a simulated world."""

from __future__ import annotations

from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from linkwright.rviz import RvizConfig

_DISPLAY, _FRAME = "linkwright/World", "world"
_MAP = "rviz_default_plugins/Map"
_DISTANCE = 5.0
"""Distance from which an empty world is seen, in m."""


def world_config(name: str, x: float = 0.0, y: float = 0.0) -> RvizConfig:
    """Return a configuration with the world and its robots, on a grid, in a fixed view.

    The displays of robot models and transforms are disabled, because they would draw content of the world twice.

    Args:
        name: the name of the page.
        x: the x coordinate of the focal point, in m.
        y: the y coordinate of the focal point, in m.
    """
    from linkwright.rviz import RvizConfig

    config = RvizConfig.for_model(_FRAME, name=name)
    for display in config.displays:
        display.checked = display.cls.endswith("/Grid")
    show_world(config)
    config.propose_view({"Distance": _DISTANCE, "Focal Point/X": x, "Focal Point/Y": y})
    return config


def show_world(config: RvizConfig) -> None:
    """Add a World display to a configuration that has none.

    The display is disabled if the configuration shows a map, which covers the same area.
    """
    if not shows_world(config):
        world = config.make(_DISPLAY, "World")
        world.checked = not any(display.cls == _MAP and display.checked for display in config.walk())
        config.insert(world)


def shows_world(config: RvizConfig) -> bool:
    """Return whether a configuration has a display of the world."""
    return any(display.cls == _DISPLAY for display in config.walk())
