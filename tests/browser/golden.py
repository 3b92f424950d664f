"""Small meshes with known bounds and colors, and robots with them.

They give the expected drawing of a page and of an export.
"""

from __future__ import annotations

from pathlib import Path

from tests.browser.mesh_writers import BOX_SIZE_M, write_dae, write_glb, write_obj, write_stl_binary, write_stl_text

BLUE = "<color>0 0 1 1</color>"
TRANSPARENT = "<transparent><color>1 1 1 1</color></transparent><transparency><float>0.2</float></transparency>"
MATRIX = "<matrix>0 -1 0 1  1 0 0 2  0 0 1 3  0 0 0 1</matrix>"
NESTED = (
    "<node><translate>0 0 1</translate><rotate>0 0 1 90</rotate>"
    "<node><scale>2 1 1</scale><node><translate>1 0 0</translate>GEOMETRY</node></node></node>"
)

UPRIGHT = ((0.0, 0.0, 0.0), BOX_SIZE_M)
GREEN = '<material name="green"><color rgba="0 0.8 0.2 1"/></material>'
HALF_TRANSPARENT = '<material name="half"><color rgba="0 0.8 0.2 0.5"/></material>'

# name: file name, content, material and scale in the URDF -> bounds (minimum, maximum), color, opacity
GOLDEN: dict[str, tuple[str, bytes, str, str, tuple[tuple[float, ...], tuple[float, ...]], str, float]] = {
    "stl_text": ("text.stl", write_stl_text(), GREEN, "", UPRIGHT, "#00cc33", 1.0),
    "stl_binary": ("binary.stl", write_stl_binary(), HALF_TRANSPARENT, "", UPRIGHT, "#00cc33", 0.5),
    "stl_bare": ("bare.STL", write_stl_binary(), "", "", UPRIGHT, "#ff0000", 1.0),
    "stl_colored": ("colored.stl", write_stl_binary(color=True), GREEN, "", UPRIGHT, "#00cc33", 1.0),
    "stl_scaled": ("scaled.stl", write_stl_binary(), GREEN, "10 1 1", ((0, 0, 0), (1, 0.2, 0.3)), "#00cc33", 1.0),
    "stl_mirrored": (
        "mirrored.stl",
        write_stl_binary(),
        GREEN,
        "1 -1 1",
        ((0, -0.2, 0), (0.1, 0, 0.3)),
        "#00cc33",
        1.0,
    ),
    "obj_bare": ("bare.obj", write_obj(), "", "", UPRIGHT, "#999999", 1.0),
    "obj_urdf": ("urdf.obj", write_obj(), GREEN, "", UPRIGHT, "#00cc33", 1.0),
    "obj_own": ("own.obj", write_obj("own.mtl", "paint"), GREEN, "", UPRIGHT, "#ff8000", 1.0),
    "dae_z_up": ("z.dae", write_dae(), GREEN, "", UPRIGHT, "#00cc33", 1.0),
    "dae_y_up": ("y.dae", write_dae(up="Y_UP"), GREEN, "", UPRIGHT, "#00cc33", 1.0),
    "dae_x_up": ("x.dae", write_dae(up="X_UP"), GREEN, "", UPRIGHT, "#00cc33", 1.0),
    "dae_inches": ("inches.dae", write_dae(unit=0.0254), GREEN, "", UPRIGHT, "#00cc33", 1.0),
    "dae_millimeters": ("mm.dae", write_dae(unit=0.001), GREEN, "2 2 2", ((0, 0, 0), (0.2, 0.4, 0.6)), "#00cc33", 1.0),
    "dae_own": ("own.dae", write_dae(diffuse=BLUE), GREEN, "", UPRIGHT, "#0000ff", 1.0),
    "dae_own_half": ("own.dae", write_dae(diffuse=BLUE), HALF_TRANSPARENT, "", UPRIGHT, "#0000ff", 0.5),
    "dae_transparency": (
        "clear.dae",
        write_dae(diffuse=BLUE, extra=TRANSPARENT),
        "",
        "",
        UPRIGHT,
        "#0000ff",
        1.0,
    ),
    "dae_matrix": (
        "matrix.dae",
        write_dae(node=f"<node>{MATRIX}GEOMETRY</node>"),
        GREEN,
        "",
        ((0.8, 2, 3), (1, 2.1, 3.3)),
        "#00cc33",
        1.0,
    ),
    "dae_nested": ("nested.dae", write_dae(node=NESTED), GREEN, "", ((-0.2, 2, 1), (0, 2.2, 1.3)), "#00cc33", 1.0),
    "dae_nested_inches": (
        "nested_inches.dae",
        write_dae(node=NESTED.replace("0 0 1</translate>", "0 0 10</translate>"), unit=0.1, scale=1.0),
        GREEN,
        "",
        ((-0.02, 0.2, 1), (0, 0.22, 1.03)),
        "#00cc33",
        1.0,
    ),
    # y of glTF is z of the link: (x, y, z) -> (x, -z, y)
    "glb_bare": ("bare.glb", write_glb(), GREEN, "", ((0, -0.3, 0), (0.1, 0, 0.2)), "#ffffff", 1.0),
    "glb_own": ("own.glb", write_glb(color=(1, 0, 1, 1)), GREEN, "", ((0, -0.3, 0), (0.1, 0, 0.2)), "#ff00ff", 1.0),
    "glb_turned": (
        "turned.glb",
        write_glb(color=(1, 0, 1, 1), rotation=(0, 0, 2**-0.5, 2**-0.5)),
        GREEN,
        "",
        ((-0.2, -0.3, 0), (0, 0, 0.1)),
        "#ff00ff",
        1.0,
    ),
}  # fmt: skip


def robot_of(links: str) -> str:
    return f'<robot name="golden"><link name="base"/>{links}</robot>'


def link_element(name: str, visual: str) -> str:
    return (
        f'<link name="{name}">{visual}</link>'
        f'<joint name="{name}_joint" type="fixed"><parent link="base"/><child link="{name}"/></joint>'
    )


def mesh_visual(path: Path, material: str, scale: str = "") -> str:
    scale_attribute = f' scale="{scale}"' if scale else ""
    return f'<visual><geometry><mesh filename="{path.as_uri()}"{scale_attribute}/></geometry>{material}</visual>'


def golden_links(folder: Path) -> str:
    """Return a link for each mesh of the golden set, and write their files to a folder."""
    links = []
    for name, (file, content, material, scale, *_) in GOLDEN.items():
        path = folder / name / file
        path.parent.mkdir()
        path.write_bytes(content)
        (path.parent / "own.mtl").write_text("newmtl paint\nKd 1 0.5 0\nd 0.25\n")
        links.append(link_element(name, mesh_visual(path, material, scale)))
    return "".join(links)
