"""The configuration of a viewer for a simulated world."""

from __future__ import annotations

from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from linkwright.viewer import RvizConfig

_DISPLAY, _FRAME = "linkwright/World", "world"
_MAP = "rviz_default_plugins/Map"
_DISTANCE = 5.0
"""Metres from which an empty world is seen."""


def world_config(name: str, x: float = 0.0, y: float = 0.0) -> RvizConfig:
    """A configuration with the world in it, robots included, on a grid; it stands still.

    Models of robots and transforms are there too, but off: they would draw what is in the world a second time.

    Args:
        name: of the page.
        x: of the place that is looked at, in m.
        y: likewise.
    """
    from linkwright.viewer import RvizConfig

    config = RvizConfig.for_model(_FRAME, name=name)
    for display in config.displays:
        display.checked = display.cls.endswith("/Grid")
    show_world(config)
    config.propose_view({"Distance": _DISTANCE, "Focal Point/X": x, "Focal Point/Y": y})
    return config


def show_world(config: RvizConfig) -> None:
    """Add the display of the world to a configuration that has none; switched off where a map would lie under it."""
    if not shows_world(config):
        world = config.make(_DISPLAY, "World")
        world.checked = not any(display.cls == _MAP and display.checked for display in config.walk())
        config.insert(world)


def shows_world(config: RvizConfig) -> bool:
    """Whether a configuration has a display of the world."""
    return any(display.cls == _DISPLAY for display in config.walk())
