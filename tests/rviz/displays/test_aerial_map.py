"""The display of aerial images around a position."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from PIL import Image

from linkwright.messages import get_message
from linkwright.rviz import RvizConfig
from linkwright.rviz.displays.aerial_map import compute_tile_position
from tests.viewer.contents import shown_markers
from tests.viewer.scene import open_world

NavSatFix = get_message("sensor_msgs/msg/NavSatFix")
FILE = """\
Visualization Manager:
  Displays:
    - {{Class: rviz_satellite/AerialMap, Enabled: true, Name: Map, Topic: /fix, Blocks: {blocks}, Object URI: "{uri}"}}
  Global Options:
    Fixed Frame: base
"""
PLACE = (48.858, 2.2945)
"""A latitude and a longitude in a tile of the known number 33185, 22545 at the level 16."""


def make_fix(latitude: float = PLACE[0], longitude: float = PLACE[1]) -> NavSatFix:
    """Return a position in the frame ``base``."""
    message = NavSatFix(latitude=latitude, longitude=longitude)
    message.header.frame_id = "base"
    return message


def write_tiles(folder: Path, *tiles: tuple[int, int], color: tuple[int, int, int] = (30, 120, 40)) -> str:
    """Write tiles of the level 16 of one color, and return the address of all tiles."""
    for x, y in tiles:
        path = folder / "16" / str(x) / f"{y}.png"
        path.parent.mkdir(parents=True, exist_ok=True)
        Image.new("RGB", (16, 16), color).save(path)
    return f"file://{folder.as_posix()}/{{z}}/{{x}}/{{y}}.png"


async def show(world, message: NavSatFix):
    """Publish a position, and return the display."""
    world.move_arm()
    publisher = world.graph.create_node("gnss").create_publisher(NavSatFix, "/fix", 10)
    await world.settle()
    publisher.publish(message)
    await world.settle()
    (display,) = world.viewer.displays
    return display


def test_tiles_are_numbered_from_the_north_west():
    assert compute_tile_position(0.0, 0.0, 1) == pytest.approx((1.0, 1.0))
    x, y = compute_tile_position(*PLACE, 16)
    assert (int(x), int(y)) == (33185, 22545)


async def test_tile_is_placed_around_the_position_with_north_along_y(tmp_path):
    uri = write_tiles(tmp_path, (33185, 22545), (33186, 22545))
    async with open_world(RvizConfig.parse(FILE.format(blocks=1, uri=uri))) as world:
        display = await show(world, make_fix())
        markers = shown_markers(display)
        assert set(markers) == {"tiles/4", "tiles/5"}, "of nine tiles, two exist"
        corners = np.asarray(markers["tiles/4"]["points"]).reshape(-1, 3)
        size = 2 * np.pi * 6378137.0 * np.cos(np.radians(PLACE[0])) / 2**16
        x, y = compute_tile_position(*PLACE, 16)
        np.testing.assert_allclose(corners[0, :2], ((33185 - x) * size, (y - 22545) * size), atol=1e-2)
        np.testing.assert_allclose(corners[2] - corners[0], (size, -size, 0), atol=1e-2)
        assert markers["tiles/4"]["texture"].startswith("/mesh/")
        (text,) = [str(row.text) for row in display.status if row.name == "Map"]
        assert text.startswith("7 of 9 tiles are missing, such as file://")
        assert text.endswith("/16/33184/22544.png")


@pytest.mark.parametrize("uri", ["", "https://tiles.example.org/{z}/{x}/{y}.png", "file:///tmp/tile.png"])
async def test_no_server_is_asked_for_tiles(uri):
    async with open_world(RvizConfig.parse(FILE.format(blocks=0, uri=uri))) as world:
        display = await show(world, make_fix())
        assert len(display._store) == 0
        (text,) = [str(row.text) for row in display.status if row.name == "Map"]
        assert "Only tiles of a local folder are drawn" in text
        assert "{z}/{x}/{y}" in text


async def test_position_without_a_fix_or_near_a_pole_shows_no_tiles(tmp_path):
    uri = write_tiles(tmp_path, (33185, 22545))
    async with open_world(RvizConfig.parse(FILE.format(blocks=0, uri=uri))) as world:
        display = await show(world, make_fix(latitude=89.0))
        assert [row.level for row in display.status if row.name == "Map"] == ["error"]
        message = make_fix()
        message.status.status = -1
        world.graph.create_node("other").create_publisher(NavSatFix, "/fix", 10).publish(message)
        await world.settle()
        assert len(display._store) == 0
