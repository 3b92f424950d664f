"""The studio shows what lamps light as film would; the light at the camera shows colours as they are written."""

from __future__ import annotations

from pathlib import Path

import pytest

from tests.browser.conftest import until
from tests.browser.pixels import colors_at

pytestmark = pytest.mark.browser

BALL = """\
<robot name="ball"><link name="ball"><visual><geometry><sphere radius="1"/></geometry>
<material name="white"><color rgba="1 1 1 1"/></material></visual></link></robot>
"""
VIEW = """\
Visualization Manager:
  Displays:
    - {{Class: rviz_default_plugins/RobotModel, Enabled: true, Description Topic: {{Value: /robot_description}}}}
  Global Options: {{Fixed Frame: ball, Frame Rate: 30, Light: {light}}}
  Views:
    Current: {{Class: rviz_default_plugins/Orbit, Distance: 4, Pitch: 0.3, Yaw: 0.8}}
"""


def greys(start, open_page, tmp_path: Path, light: str) -> list[int]:
    """How bright the ball is along a line through its middle, from its top to its foot."""
    (tmp_path / "ball.urdf").write_text(BALL)
    (tmp_path / f"{light}.rviz").write_text(VIEW.format(light=light))
    page = open_page(start("view", str(tmp_path / "ball.urdf"), "-d", str(tmp_path / f"{light}.rviz")))
    until(page, "lw.settled")
    box = page.locator(".canvas-box canvas").first.bounding_box()
    x, y = box["x"] + box["width"] / 2, box["y"] + box["height"] / 2
    colors = colors_at(page, *[(x, y + 0.2 * box["height"] * step / 20) for step in range(-20, 21)])
    assert all(r == g == b for r, g, b in colors), "white stays without a tint"
    return [r for r, _, _ in colors]


def test_the_studio_keeps_the_shape_of_what_is_lit_strongly(start, open_page, tmp_path):
    camera, studio = (greys(start, open_page, tmp_path, light) for light in ("Camera", "Studio"))
    assert max(camera) >= 254, "what faces the camera has its own colour"
    assert 225 < max(studio) < 252
    assert studio.count(max(studio)) < len(studio) / 5, "brightness tells the shape: nothing is cut off at white"
