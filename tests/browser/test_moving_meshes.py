"""Meshes of a moving robot on a slow page: fewer triangles, and the same image."""

from __future__ import annotations

import io
import threading
from collections.abc import Iterator
from contextlib import contextmanager
from typing import Any

import numpy as np
import pytest
import trimesh
from PIL import Image

from linkwright.graph import DESCRIPTION_QOS
from linkwright.messages import String
from tests.browser.conftest import state, until
from tests.browser.live import LiveViewer, configuration

pytestmark = pytest.mark.browser

DISPLAYS = """
- Class: rviz_default_plugins/RobotModel
  Description Topic: {Value: /robot_description}
  Enabled: true
  Name: RobotModel
"""
LINKS = ("round", "edged", "stretched")
FACE_COUNTS = {"ball.stl": 20 * 4**5, "box.glb": 12 * 4**4}

SLOW_PAGE = """() => {
  const hold = () => {
    for (const begin = performance.now(); performance.now() - begin < 80; );
    if (window.slow) requestAnimationFrame(hold);
  };
  window.slow = true;
  requestAnimationFrame(hold);
}"""
"""Keep the page's processor busy in each frame, as a too complex scene does."""


@contextmanager
def keep_moving(viewer: LiveViewer) -> Iterator[None]:
    """Move a robot all the time by invisible amounts."""
    ends = threading.Event()

    def move() -> None:
        count = 0
        while not ends.wait(0.05):
            count += 1
            viewer.place("round", 0.0, 0.0, 1e-6 * (count % 2))

    thread = threading.Thread(target=move)
    thread.start()
    try:
        yield
    finally:
        ends.set()
        thread.join()
        viewer.place("round", 0.0, 0.0, 0.0)


def scene_pixels(page: Any) -> np.ndarray:
    """Return the scene as on the screen: height x width x 3."""
    box = page.locator(".canvas-box canvas").bounding_box()
    # The notice about the slow page covers the upper right corner, and the axes cover the lower one.
    clip = {"x": box["x"], "y": box["y"], "width": 0.6 * box["width"], "height": box["height"]}
    with Image.open(io.BytesIO(page.screenshot(clip=clip))) as image:
        return np.asarray(image.convert("RGB")).astype(int)


def test_moving_meshes_are_simplified_and_look_the_same(start_viewer, open_page, tmp_path):
    trimesh.creation.icosphere(subdivisions=5, radius=0.5).export(tmp_path / "ball.stl")
    box = trimesh.creation.box((0.6, 0.6, 0.6)).subdivide_loop(0)
    for _ in range(4):
        box = box.subdivide()
    box.unmerge_vertices()
    box.export(tmp_path / "box.glb")
    (tmp_path / "package.xml").write_text("<package><name>shapes</name></package>")
    viewer = start_viewer(configuration(DISPLAYS, distance=6.0), packages={"shapes": tmp_path})
    for name, x in zip(LINKS, (0.0, 1.2, -1.2), strict=True):
        viewer.place(name, 0.0, 0.5 * x, x)
    meshes = ('ball.stl"', 'box.glb"', 'ball.stl" scale="-0.5 0.3 1"')
    links = "".join(
        f'<link name="{name}"><visual><geometry><mesh filename="package://shapes/{mesh}/></geometry>'
        f'<material name="m"><color rgba="0.2 0.7 0.3 1"/></material></visual></link>'
        f'<joint name="{name}_joint" type="floating"><parent link="base"/><child link="{name}"/></joint>'
        for name, mesh in zip(LINKS, meshes, strict=True)
    )
    text = f'<robot name="r"><link name="base"/>{links}</robot>'
    viewer.publish("robot_description", String(data=text), DESCRIPTION_QOS)
    page = open_page(viewer)
    until(page, "lw.settled && lw.robot.visuals === 3")
    still = scene_pixels(page)
    assert state(page, "displays[0].drawn.moving") == {"pieces": 0, "triangles": 0}

    all_of_them = 2 * FACE_COUNTS["ball.stl"] + FACE_COUNTS["box.glb"]
    page.evaluate(SLOW_PAGE)
    with keep_moving(viewer):
        until(page, "lw.displays[0].drawn.moving.pieces === 3")
        triangles = state(page, "displays[0].drawn.moving.triangles")
        image_in_motion = scene_pixels(page)
    assert 0 < triangles < all_of_them / 4

    page.evaluate("() => { window.slow = false; }")
    viewer.settle(page)
    np.testing.assert_array_equal(scene_pixels(page), still)

    # Coarse frames have larger pixels: they differ along edges, but hardly within surfaces.
    difference = np.abs(image_in_motion - still).max(axis=2)
    assert (still.max(axis=2) > 100).mean() > 0.02  # the image is not empty
    assert np.median(difference[still.max(axis=2) > 100]) < 12
    assert (difference > 60).mean() < 0.02
