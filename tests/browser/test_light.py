"""Light in the page.

The studio compresses bright colors as film does; the camera's light keeps the given colors.

In `view`, robots of any color stand out from the background, also with software rendering.
"""

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


def measure_ball_brightness(start, open_page, tmp_path: Path, light: str) -> list[int]:
    """Return the brightness of the ball along a line through its center, from top to bottom."""
    (tmp_path / "ball.urdf").write_text(BALL)
    (tmp_path / f"{light}.rviz").write_text(VIEW.format(light=light))
    page = open_page(start("view", str(tmp_path / "ball.urdf"), "-d", str(tmp_path / f"{light}.rviz")))
    until(page, "lw.settled")
    box = page.locator(".canvas-box canvas").first.bounding_box()
    x, y = box["x"] + box["width"] / 2, box["y"] + box["height"] / 2
    colors = colors_at(page, *[(x, y + 0.2 * box["height"] * step / 20) for step in range(-20, 21)])
    assert all(r == g == b for r, g, b in colors), "white has no tint"
    return [r for r, _, _ in colors]


def test_studio_light_does_not_saturate_lit_surfaces(start, open_page, tmp_path):
    camera, studio = (measure_ball_brightness(start, open_page, tmp_path, light) for light in ("Camera", "Studio"))
    assert max(camera) >= 254, "a face toward the camera has the given color"
    assert 225 < max(studio) < 252
    assert studio.count(max(studio)) < len(studio) / 5, "the shading shows the shape: no part is clipped to white"


BLACK = BALL.replace("1 1 1 1", "0 0 0 1")


def measure_column_brightness(page, across: float = 0.5) -> list[int]:
    """Return the brightness of the scene from top to bottom, at a fraction of its width."""
    box = page.locator(".canvas-box canvas").first.bounding_box()
    x = box["x"] + across * box["width"]
    pixels = [(x, box["y"] + box["height"] * (0.02 + 0.96 * step / 60)) for step in range(61)]
    return [sum(color) // 3 for color in colors_at(page, *pixels)]


@pytest.mark.parametrize("theme", ["light", "dark"])
@pytest.mark.parametrize("robot", [BLACK, BALL], ids=["black", "white"])
def test_default_view_shows_shape_of_black_and_white_robots(start, open_page, tmp_path, theme, robot):
    (tmp_path / "ball.urdf").write_text(robot)
    page = open_page(start("view", str(tmp_path / "ball.urdf")), theme=theme)
    until(page, "lw.settled")
    grays = measure_column_brightness(page)
    ball, ground = grays[16:45], measure_column_brightness(page, 0.02)
    assert min(ground) > 60
    assert max(ground) < 245
    assert max(ball) - min(ball) > 25, "the shading shows that the ball is round"
    assert max(abs(ground[30] - gray) for gray in ball) > 40


def test_rviz_file_colors_are_kept(start, open_page, tmp_path):
    (tmp_path / "ball.urdf").write_text(BALL)
    (tmp_path / "plain.rviz").write_text(VIEW.format(light="Camera"))
    page = open_page(start("view", str(tmp_path / "ball.urdf"), "-d", str(tmp_path / "plain.rviz")))
    until(page, "lw.settled")
    assert set(measure_column_brightness(page, 0.02)) == {0x30}


def test_background_color_can_be_chosen(start, open_page, tmp_path):
    (tmp_path / "ball.urdf").write_text(BALL)
    page = open_page(start("view", str(tmp_path / "ball.urdf")))
    until(page, "lw.settled")
    background = page.get_by_role("treeitem").filter(has_text="Background Color")
    assert background.count() == 0
    page.get_by_role("treeitem").filter(has_text="Backdrop").locator("select").select_option("Color")
    background.wait_for()
    until(page, "lw.settled")
    assert measure_column_brightness(page, 0.02)[:2] == [0x30] * 2, "the top of the scene has the background color"
