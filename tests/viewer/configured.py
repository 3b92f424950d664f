"""A configuration with an unknown group and display, and a page that edits it; for tests."""

from __future__ import annotations

from contextlib import asynccontextmanager
from pathlib import Path

import yaml

from linkwright.messages import get_message
from linkwright.rviz import RvizConfig
from tests.viewer.scene import open_page, open_world

PointStamped = get_message("geometry_msgs/msg/PointStamped")

TEXT = """\
Panels: []
Visualization Manager:
  Displays:
    - Class: rviz_default_plugins/Grid
      Enabled: true
      Name: Grid
      Value: true
    - Class: rviz_common/Group
      Displays:
        - Alpha: 0.5
          Class: rviz_default_plugins/PointStamped
          Enabled: true
          Name: Clicks
          Topic: /clicked_point
          Value: true
      Enabled: true
      Name: Marks
    - Class: my_plugins/Radar
      Enabled: false
      Name: Radar
      Sweep: {a: 1}
  Global Options:
    Fixed Frame: base
"""


@asynccontextmanager
async def open_configured(text: str = TEXT, path: Path | None = None):
    """Return a world, and a page that has read its opening messages."""
    config = RvizConfig.parse(text)
    if path is not None:
        path.write_text(text, encoding="utf-8")  # noqa: ASYNC240 - a test may wait
        config = RvizConfig.load(path)
    async with open_world(config) as world, open_page(world.viewer) as client:
        client.first = await client.opened()
        yield world, client


def display_names(world) -> list[str]:
    return [display.config.name for display in world.viewer.displays]


def display_entries(world) -> list[dict]:
    return yaml.safe_load(world.viewer.config.text())["Visualization Manager"]["Displays"]


async def perform_edit(client, kind: str, **fields) -> dict:
    """Perform an edit, and return the state afterwards."""
    await client.drain(0.03)
    await client.send(kind, **fields)
    return await client.until("configuration")


async def undo_edit(client, kind: str = "undo") -> dict:
    return await perform_edit(client, kind)
