"""The configuration of a page for a simulated world."""

from __future__ import annotations

import pytest

from linkwright.hosting.world_config import show_world
from linkwright.rviz import RvizConfig

CONFIG = """
Visualization Manager:
  Displays:
    - Class: rviz_default_plugins/Map
      Enabled: {enabled}
      Name: Map
  Global Options: {{Fixed Frame: map}}
"""


@pytest.mark.parametrize(("enabled", "checked"), [("true", False), ("false", True)])
def test_world_display_is_off_if_map_display_is_enabled(enabled: str, checked: bool) -> None:
    config = RvizConfig.parse(CONFIG.format(enabled=enabled), "test.rviz")
    show_world(config)
    (world,) = [display for display in config.walk() if display.cls == "linkwright/World"]
    assert world.checked is checked


def test_world_display_is_added_once_and_keeps_its_state() -> None:
    config = RvizConfig.parse(CONFIG.format(enabled="true"), "test.rviz")
    show_world(config)
    (world,) = [display for display in config.walk() if display.cls == "linkwright/World"]
    world.checked = True
    show_world(config)
    assert [display.checked for display in config.walk() if display.cls == "linkwright/World"] == [True]
