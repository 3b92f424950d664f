"""A configuration with an unknown group and display, and a page that edits it; for tests."""

from __future__ import annotations

from contextlib import asynccontextmanager
from pathlib import Path

import yaml

from linkwright.messages import get_message
from linkwright.rviz import RvizConfig
from tests.viewer.scene import page, world

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
async def opened(text: str = TEXT, path: Path | None = None):
    """Return a world, and a page that has read its opening messages."""
    config = RvizConfig.parse(text)
    if path is not None:
        path.write_text(text, encoding="utf-8")  # noqa: ASYNC240 - a test may wait
        config = RvizConfig.load(path)
    async with world(config) as made, page(made.viewer) as client:
        client.first = await client.opened()
        yield made, client


def names(made) -> list[str]:
    return [display.config.name for display in made.viewer.displays]


def entries(made) -> list[dict]:
    return yaml.safe_load(made.viewer.config.text())["Visualization Manager"]["Displays"]


async def edit(client, kind: str, **fields) -> dict:
    """Perform an edit, and return the state afterwards."""
    await client.drain(0.03)
    await client.send(kind, **fields)
    return await client.until("configuration")


async def undo(client, kind: str = "undo") -> dict:
    return await edit(client, kind)
