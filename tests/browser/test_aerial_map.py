"""Aerial images, drawn in a real browser."""

from __future__ import annotations

import io

import numpy as np
import pytest
from PIL import Image

from tests.browser.conftest import until
from tests.browser.live import configuration
from tests.rviz.displays.test_aerial_map import make_fix, write_tiles

pytestmark = pytest.mark.browser


def test_tiles_of_a_folder_are_drawn(start_viewer, open_page, tmp_path):
    uri = write_tiles(tmp_path, (33185, 22545))
    write_tiles(tmp_path, (33186, 22545), color=(120, 90, 30))
    north = Image.new("RGB", (16, 16), (30, 120, 40))
    north.paste((200, 60, 60), (0, 0, 16, 4))  # the northern quarter
    north.save(tmp_path / "16" / "33185" / "22545.png")
    display = f"""
- Class: rviz_satellite/AerialMap
  Alpha: 1
  Blocks: 1
  Enabled: true
  Name: map
  Object URI: "{uri}"
  Topic: {{Value: /fix}}
"""
    viewer = start_viewer(configuration(display, distance=900, pitch=1.5, yaw=-1.5708))
    page = open_page(viewer, wait=False)
    viewer.place("antenna", 0.0, 0.0, 0.0)
    viewer.publish("/fix", make_fix())
    until(page, "Object.keys(lw.displays[0]?.drawn?.markers ?? {}).length === 2 && lw.settled")
    viewer.settle(page)
    page.screenshot(path=tmp_path / "aerial.png")
    scene = page.locator(".canvas-box").bounding_box()
    shown = np.array(Image.open(io.BytesIO(page.screenshot())).convert("RGB"))
    middle = shown[int(scene["y"] + scene["height"] / 2), int(scene["x"] + scene["width"] / 2)]
    assert middle.tolist() == [30, 120, 40]
    # The view is from the south, so that north is above.
    red_rows = np.flatnonzero((shown == [200, 60, 60]).all(axis=2).any(axis=1))
    green_rows = np.flatnonzero((shown == [30, 120, 40]).all(axis=2).any(axis=1))
    assert red_rows.max() <= green_rows.min() + 5
