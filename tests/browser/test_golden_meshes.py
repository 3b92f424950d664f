"""Small meshes of all formats: they have the same sizes and colors in the page as in RViz.

Every mesh is the same box, 0.1 x 0.2 x 0.3 m with a corner at the origin, written in another way: a wrong axis, unit or
transform shows in its bounds.
"""

from __future__ import annotations

import pytest

from linkwright.graph import DESCRIPTION_QOS
from linkwright.messages import String
from tests.browser.conftest import state, until, wait_until_equal
from tests.browser.golden import GOLDEN, golden_links, link_element, mesh_visual, robot_of
from tests.browser.live import configuration
from tests.browser.mesh_writers import make_png, write_dae, write_stl_binary
from tests.browser.pixels import Color, colors_at

pytestmark = pytest.mark.browser

ROBOT = configuration(
    """
- Class: rviz_default_plugins/RobotModel
  Description Topic:
    Value: /robot_description
  Enabled: true
  Name: Robot
""",
    distance=2.0,
    pitch=0.0,
    yaw=0.0,
)


def drawn_visual(page, name: str) -> dict:
    """Return the first visual of a link as it is drawn."""
    robot = next(display for display in state(page, "displays") if display["name"] == "Robot")["drawn"]
    return robot["links"][name]["visuals"][0]


def open_robot(start_viewer, open_page, links: str, names):
    viewer = start_viewer(ROBOT)
    for name in names:
        viewer.place(name, 0.0, 0.0, 0.0)
    viewer.publish("/robot_description", String(data=robot_of(links)), DESCRIPTION_QOS)
    return open_page(viewer)


def test_bounds_and_colors_match_rviz(start_viewer, open_page, tmp_path):
    page = open_robot(start_viewer, open_page, golden_links(tmp_path), GOLDEN)
    mismatches = {}
    for name, (_, _, _, _, (low, high), color, opacity) in GOLDEN.items():
        drawing = drawn_visual(page, name)
        (material,) = drawing["materials"]
        bounds = drawing["bounds"]
        right = (
            bounds["min"] == pytest.approx(low, abs=1e-5)
            and bounds["max"] == pytest.approx(high, abs=1e-5)
            and (material["color"], material["opacity"]) == (color, pytest.approx(opacity))
        )
        if not right:
            mismatches[name] = drawing
    assert mismatches == {}


def test_textures_are_drawn(start_viewer, open_page, tmp_path):
    (tmp_path / "skin.png").write_bytes(make_png(255, 255, 0))
    texture = f'<material name="skin"><texture filename="{(tmp_path / "skin.png").as_uri()}"/></material>'
    image = "<texture texture='c' texcoord='UV'/>"
    text = write_dae(diffuse=image).decode()
    sampler = (
        "<newparam sid='f'><surface type='2D'><init_from>i</init_from></surface></newparam>"
        "<newparam sid='c'><sampler2D><source>f</source></sampler2D></newparam><technique sid='t'>"
    )
    text = text.replace("<technique sid='t'>", sampler)
    text = text.replace(
        "<library_effects>",
        "<library_images><image id='i'><init_from>skin.png</init_from></image></library_images><library_effects>",
    )
    (tmp_path / "skin.dae").write_text(text)
    (tmp_path / "plain.stl").write_bytes(write_stl_binary())
    links = link_element("dae", mesh_visual(tmp_path / "skin.dae", "")) + link_element(
        "stl", mesh_visual(tmp_path / "plain.stl", texture)
    )
    page = open_robot(start_viewer, open_page, links, ("dae", "stl"))
    assert [drawn_visual(page, name)["materials"][0]["textured"] for name in ("dae", "stl")] == [True, True]
    assert {row["level"] for row in state(page, "displays")[0]["status"]} == {"ok"}


# --- transparency --------------------------------------------------------------------------------------------------


def box_visual(x: float, color: str, size: float = 0.5) -> str:
    return (
        f'<visual><origin xyz="{x} 0 0"/><geometry><box size="0.1 {size} {size}"/></geometry>'
        f'<material name="m{x}{color}"><color rgba="{color}"/></material></visual>'
    )


def center_color(page) -> Color:
    """Return the color in the center of the scene."""
    box = page.locator("canvas").first.bounding_box()
    (color,) = colors_at(page, (box["x"] + box["width"] / 2, box["y"] + box["height"] / 2))
    return color


# color of the near box, color of the far box, visible color; the camera is on +x, and the background is 48
LAYERS = (
    ("1 0 0 0.5", "0 0 1 1", (128, 0, 128)),
    ("0 0 1 1", "1 0 0 0.5", (0, 0, 255)),
    ("0 1 0 0.5", "1 0 0 0.5", (76, 140, 12)),
    ("1 0 0 0.5", "0 1 0 0.5", (140, 76, 12)),
)


def test_transparent_layers_are_blended_by_depth(start_viewer, open_page):
    names = ("near", "far")
    viewer = start_viewer(ROBOT)
    for name in names:
        viewer.place(name, 0.0, 0.0, 0.0)
    page = None
    for near_color, far_color, expected in LAYERS:
        for first in (0, 1):
            pair = [
                link_element("near", box_visual(0.3, near_color)),
                link_element("far", box_visual(-0.3, far_color, 1.0)),
            ]
            description = robot_of("".join(pair if first == 0 else reversed(pair)))
            viewer.publish("/robot_description", String(data=description), DESCRIPTION_QOS)
            page = page or open_page(viewer)
            until(page, drawn_alphas(near_color, far_color))
            viewer.settle(page)
            wait_until_equal(lambda page=page: center_color(page), pytest.approx(expected, abs=3))


def drawn_alphas(*colors: str) -> str:
    """Return the materials of boxes with these colors."""
    boxes = []
    for name, color in zip(("near", "far"), colors, strict=True):
        r, g, b, a = (float(component) for component in color.split())
        material = f"lw.displays[0].drawn.links?.{name}?.visuals[0]?.materials[0]"
        code = "#" + "".join(f"{int(component * 255):02x}" for component in (r, g, b))
        boxes.append(f"{material}?.color === '{code}' && {material}?.opacity === {a:g}")
    return " && ".join(boxes)
