"""GridMap, drawn in a real browser."""

from __future__ import annotations

import numpy as np
import pytest

from tests.browser.conftest import until
from tests.browser.live import configuration
from tests.rviz.displays.test_grid_map import make_grid_map

pytestmark = pytest.mark.browser

DISPLAY = "- {Class: grid_map_rviz_plugin/GridMap, Enabled: true, Name: Map, Topic: /grid_map}"


def test_grid_map_with_missing_cell_is_drawn(start_viewer, open_page, tmp_path):
    viewer = start_viewer(configuration(DISPLAY, distance=9))
    page = open_page(viewer, wait=False)
    x, y = np.meshgrid(np.linspace(-2, 2, 21), np.linspace(-2, 2, 21))
    heights = 1.5 * np.exp(-(x**2) - y**2)
    heights[3, 3] = np.nan
    viewer.publish("/grid_map", make_grid_map(0.2, elevation=heights.tolist()))
    drawn_expression = "lw.displays[0]?.drawn"
    # Each of the four squares around the hole keeps only the triangle opposite the hole.
    until(page, f"{drawn_expression}?.triangles === 20 * 20 * 2 - 4 && {drawn_expression}?.lines === 2 * 20 * 21 - 4")
    until(page, f"Math.abs({drawn_expression}?.bounds?.max[2] - 1.5) < 1e-5")
    viewer.settle(page)
    page.screenshot(path=tmp_path / "grid-map.png")
    viewer.run(lambda: viewer.viewer.displays[0].set_property(("Color Transformer",), "None"))
    viewer.run(lambda: viewer.viewer.displays[0].set_property(("Show Grid Lines",), False))
    until(page, f"{drawn_expression}?.triangles === 0 && {drawn_expression}?.lines === 0")
