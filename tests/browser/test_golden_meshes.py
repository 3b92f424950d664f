"""Small meshes of every kind, as large and as coloured as RViz draws them; read back from the page.

Every mesh is the same box, 0.1 x 0.2 x 0.3 m with a corner at the origin, written in another way: a wrong axis, unit or
transform shows in its bounds.
"""

from __future__ import annotations

from pathlib import Path

import pytest

from linkwright.graph import DESCRIPTION_QOS
from linkwright.messages import String
from tests.browser.conftest import state, until
from tests.browser.live import configuration
from tests.browser.mesh_writers import SIZE, dae, glb, obj, png, stl_binary, stl_text
from tests.browser.pixels import color_at

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


# --- the golden set ------------------------------------------------------------------------------------------------

BLUE = "<color>0 0 1 1</color>"
CLEAR = "<transparent><color>1 1 1 1</color></transparent><transparency><float>0.2</float></transparency>"
MATRIX = "<matrix>0 -1 0 1  1 0 0 2  0 0 1 3  0 0 0 1</matrix>"
NESTED = (
    "<node><translate>0 0 1</translate><rotate>0 0 1 90</rotate>"
    "<node><scale>2 1 1</scale><node><translate>1 0 0</translate>GEOMETRY</node></node></node>"
)

STANDING = ((0.0, 0.0, 0.0), SIZE)
GREEN = '<material name="green"><color rgba="0 0.8 0.2 1"/></material>'
HALF = '<material name="half"><color rgba="0 0.8 0.2 0.5"/></material>'

# name: file name, content, material and scale in the URDF -> bounds (least, most), colour, opacity
GOLDEN: dict[str, tuple[str, bytes, str, str, tuple[tuple[float, ...], tuple[float, ...]], str, float]] = {
    "stl_text": ("text.stl", stl_text(), GREEN, "", STANDING, "#00cc33", 1.0),
    "stl_binary": ("binary.stl", stl_binary(), HALF, "", STANDING, "#00cc33", 0.5),
    "stl_bare": ("bare.STL", stl_binary(), "", "", STANDING, "#ff0000", 1.0),
    "stl_coloured": ("coloured.stl", stl_binary(color=True), GREEN, "", STANDING, "#00cc33", 1.0),
    "stl_scaled": ("scaled.stl", stl_binary(), GREEN, "10 1 1", ((0, 0, 0), (1, 0.2, 0.3)), "#00cc33", 1.0),
    "stl_mirrored": ("mirrored.stl", stl_binary(), GREEN, "1 -1 1", ((0, -0.2, 0), (0.1, 0, 0.3)), "#00cc33", 1.0),
    "obj_bare": ("bare.obj", obj(), "", "", STANDING, "#999999", 1.0),
    "obj_urdf": ("urdf.obj", obj(), GREEN, "", STANDING, "#00cc33", 1.0),
    "obj_own": ("own.obj", obj("own.mtl", "paint"), GREEN, "", STANDING, "#ff8000", 1.0),
    "dae_z_up": ("z.dae", dae(), GREEN, "", STANDING, "#00cc33", 1.0),
    "dae_y_up": ("y.dae", dae(up="Y_UP"), GREEN, "", STANDING, "#00cc33", 1.0),
    "dae_x_up": ("x.dae", dae(up="X_UP"), GREEN, "", STANDING, "#00cc33", 1.0),
    "dae_inches": ("inches.dae", dae(unit=0.0254), GREEN, "", STANDING, "#00cc33", 1.0),
    "dae_millimetres": ("mm.dae", dae(unit=0.001), GREEN, "2 2 2", ((0, 0, 0), (0.2, 0.4, 0.6)), "#00cc33", 1.0),
    "dae_own": ("own.dae", dae(diffuse=BLUE), GREEN, "", STANDING, "#0000ff", 1.0),
    "dae_own_half": ("own.dae", dae(diffuse=BLUE), HALF, "", STANDING, "#0000ff", 0.5),
    "dae_transparency": (
        "clear.dae",
        dae(diffuse=BLUE, extra=CLEAR),
        "",
        "",
        STANDING,
        "#0000ff",
        1.0,
    ),
    "dae_matrix": (
        "matrix.dae",
        dae(node=f"<node>{MATRIX}GEOMETRY</node>"),
        GREEN,
        "",
        ((0.8, 2, 3), (1, 2.1, 3.3)),
        "#00cc33",
        1.0,
    ),
    "dae_nested": ("nested.dae", dae(node=NESTED), GREEN, "", ((-0.2, 2, 1), (0, 2.2, 1.3)), "#00cc33", 1.0),
    "dae_nested_inches": (
        "nested_inches.dae",
        dae(node=NESTED.replace("0 0 1</translate>", "0 0 10</translate>"), unit=0.1, scale=1.0),
        GREEN,
        "",
        ((-0.02, 0.2, 1), (0, 0.22, 1.03)),
        "#00cc33",
        1.0,
    ),
    # y of glTF is z of the link: (x, y, z) -> (x, -z, y)
    "glb_bare": ("bare.glb", glb(), GREEN, "", ((0, -0.3, 0), (0.1, 0, 0.2)), "#ffffff", 1.0),
    "glb_own": ("own.glb", glb(color=(1, 0, 1, 1)), GREEN, "", ((0, -0.3, 0), (0.1, 0, 0.2)), "#ff00ff", 1.0),
    "glb_turned": (
        "turned.glb",
        glb(color=(1, 0, 1, 1), rotation=(0, 0, 2**-0.5, 2**-0.5)),
        GREEN,
        "",
        ((-0.2, -0.3, 0), (0, 0, 0.1)),
        "#ff00ff",
        1.0,
    ),
}  # fmt: skip


def robot_of(links: str) -> str:
    return f'<robot name="golden"><link name="base"/>{links}</robot>'


def link(name: str, visual: str) -> str:
    return (
        f'<link name="{name}">{visual}</link>'
        f'<joint name="{name}_joint" type="fixed"><parent link="base"/><child link="{name}"/></joint>'
    )


def mesh(path: Path, material: str, scale: str = "") -> str:
    scaled = f' scale="{scale}"' if scale else ""
    return f'<visual><geometry><mesh filename="{path.as_uri()}"{scaled}/></geometry>{material}</visual>'


def drawn(page, name: str) -> dict:
    """The first visual of a link as it is drawn."""
    robot = next(each for each in state(page, "displays") if each["name"] == "Robot")["drawn"]
    return robot["links"][name]["visuals"][0]


def shown(live, open_page, links: str, names):
    viewer = live(ROBOT)
    for name in names:
        viewer.place(name, 0.0, 0.0, 0.0)
    viewer.publish("/robot_description", String(data=robot_of(links)), DESCRIPTION_QOS)
    return open_page(viewer)


def test_bounds_and_colours_are_those_of_rviz(live, open_page, tmp_path):
    (tmp_path / "own.mtl").write_text("newmtl paint\nKd 1 0.5 0\nd 0.25\n")
    links = []
    for name, (file, content, material, scale, *_) in GOLDEN.items():
        path = tmp_path / name / file
        path.parent.mkdir()
        path.write_bytes(content)
        (path.parent / "own.mtl").write_text("newmtl paint\nKd 1 0.5 0\nd 0.25\n")
        links.append(link(name, mesh(path, material, scale)))
    page = shown(live, open_page, "".join(links), GOLDEN)
    wrong = {}
    for name, (_, _, _, _, (least, most), color, opacity) in GOLDEN.items():
        told = drawn(page, name)
        (look,) = told["materials"]
        bounds = told["bounds"]
        right = (
            bounds["min"] == pytest.approx(least, abs=1e-5)
            and bounds["max"] == pytest.approx(most, abs=1e-5)
            and (look["color"], look["opacity"]) == (color, pytest.approx(opacity))
        )
        if not right:
            wrong[name] = told
    assert wrong == {}


def test_textures_are_drawn(live, open_page, tmp_path):
    (tmp_path / "skin.png").write_bytes(png(255, 255, 0))
    texture = f'<material name="skin"><texture filename="{(tmp_path / "skin.png").as_uri()}"/></material>'
    image = "<texture texture='c' texcoord='UV'/>"
    text = dae(diffuse=image).decode()
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
    (tmp_path / "plain.stl").write_bytes(stl_binary())
    links = link("dae", mesh(tmp_path / "skin.dae", "")) + link("stl", mesh(tmp_path / "plain.stl", texture))
    page = shown(live, open_page, links, ("dae", "stl"))
    assert [drawn(page, name)["materials"][0]["textured"] for name in ("dae", "stl")] == [True, True]
    assert {row["level"] for row in state(page, "displays")[0]["status"]} == {"ok"}


# --- transparency --------------------------------------------------------------------------------------------------


def box(x: float, color: str, size: float = 0.5) -> str:
    return (
        f'<visual><origin xyz="{x} 0 0"/><geometry><box size="0.1 {size} {size}"/></geometry>'
        f'<material name="m{x}{color}"><color rgba="{color}"/></material></visual>'
    )


def middle(page) -> tuple[int, int, int]:
    """The colour in the middle of the scene."""
    place = page.locator("canvas").first.bounding_box()
    return color_at(page, place["x"] + place["width"] / 2, place["y"] + place["height"] / 2)


# near, far -> what is seen; the eye is on +x, the background 48
LAYERS = (
    ("1 0 0 0.5", "0 0 1 1", (128, 0, 128)),
    ("0 0 1 1", "1 0 0 0.5", (0, 0, 255)),
    ("0 1 0 0.5", "1 0 0 0.5", (76, 140, 12)),
    ("1 0 0 0.5", "0 1 0 0.5", (140, 76, 12)),
)


def test_what_is_behind_shows_through(live, open_page):
    names = ("near", "far")
    viewer = live(ROBOT)
    for name in names:
        viewer.place(name, 0.0, 0.0, 0.0)
    page = None
    wrong = {}
    for near, far, expected in LAYERS:
        for first in (0, 1):
            pair = [link("near", box(0.3, near)), link("far", box(-0.3, far, 1.0))]
            described = robot_of("".join(pair if first == 0 else reversed(pair)))
            viewer.publish("/robot_description", String(data=described), DESCRIPTION_QOS)
            page = page or open_page(viewer)
            until(page, alphas(near, far))
            seen = settled(page, expected)
            if seen != pytest.approx(expected, abs=3):
                wrong[near, far, first] = seen
    assert wrong == {}


def settled(page, expected: tuple[int, int, int]) -> tuple[int, int, int]:
    """The colour in the middle, when it is what is expected or does not become that."""
    for _ in range(20):
        seen = middle(page)
        if seen == pytest.approx(expected, abs=3):
            break
        page.wait_for_timeout(100)
    return seen


def alphas(*colors: str) -> str:
    """Whether the boxes are drawn with these colours."""
    parts = []
    for name, color in zip(("near", "far"), colors, strict=True):
        r, g, b, a = (float(part) for part in color.split())
        look = f"lw.displays[0].drawn.links?.{name}?.visuals[0]?.materials[0]"
        code = "#" + "".join(f"{int(part * 255):02x}" for part in (r, g, b))
        parts.append(f"{look}?.color === '{code}' && {look}?.opacity === {a:g}")
    return " && ".join(parts)
