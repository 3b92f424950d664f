"""Meshes with their colors."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from linkwright.diagnostics import LinkwrightError
from linkwright.geometry.collada_colors import read_colored_meshes
from linkwright.picture.materials import DEFAULT_COLOR, SurfaceLibrary, choose_surface_color
from tests.browser.golden import GOLDEN, golden_links, robot_of
from tests.picture.robots import joint, link, make_scene, render_image, strongest_channel, urdf
from tests.places import REPOSITORY

KINECT = REPOSITORY / "robots" / "my_robot_description" / "meshes" / "kinect.dae"
TRIANGLE = b"facet normal 0 0 1\nouter loop\nvertex 0 -1 -1\nvertex 0 1 -1\nvertex 0 0 1\nendloop\nendfacet\n"


def write_stl(folder: Path, count: int = 1) -> Path:
    path = folder / "a.stl"
    path.write_bytes(b"solid a\n" + count * TRIANGLE + b"endsolid a\n")
    return path


def test_collada_colors_are_read_without_trimesh() -> None:
    meshes = read_colored_meshes(KINECT.read_bytes())
    assert meshes is not None
    assert {mesh.color for mesh in meshes} >= {(0.055, 0.055, 0.062), (0.11, 0.11, 0.12), (0.2, 0.012, 0.02)}


@pytest.mark.extra("mesh")
def test_collada_colors_match_trimesh() -> None:
    from linkwright.geometry.mesh_parts import MeshPart, read_parts, read_simple_parts

    def facts(parts: list[MeshPart]) -> list[tuple[int, tuple[int, ...], list[float]]]:
        return sorted(
            (
                len(part.triangles.indices),
                tuple(round(value * 255) for value in part.file_material.color) if part.file_material else (),
                np.round(part.triangles.positions[part.triangles.indices].sum(axis=0), 4).tolist(),
            )
            for part in parts
        )

    simple = read_simple_parts(KINECT)
    assert simple is not None
    assert facts(simple) == facts(read_parts(KINECT, resolver=None))


@pytest.mark.parametrize(
    "change",
    [
        (b"<color>0.055 0.055 0.062 1</color>", b'<texture texture="a" texcoord="b"/>'),
        (b"#shell-effect", b"#missing"),
        (b"0.055 0.055 0.062 1", b"red"),
        (b"</COLLADA>", b""),
    ],
    ids=["a texture", "a missing effect", "no numbers", "cut off"],
)
def test_unusual_files_are_left_to_trimesh(change: tuple[bytes, bytes]) -> None:
    data = KINECT.read_bytes()
    assert change[0] in data
    assert read_colored_meshes(data.replace(*change)) is None


def test_file_color_precedes_description_color() -> None:
    from linkwright.geometry.mesh_parts import FileMaterial

    blue = FileMaterial((0.0, 0.0, 1.0))
    assert choose_surface_color(blue, (1.0, 0.0, 0.0), is_textured=False, format_has_colors=True) == (0.0, 0.0, 1.0)
    assert choose_surface_color(None, (0.0, 1.0, 0.0), is_textured=False, format_has_colors=True) == (0.0, 1.0, 0.0)
    assert choose_surface_color(None, None, is_textured=False, format_has_colors=False) == DEFAULT_COLOR
    assert choose_surface_color(None, None, is_textured=False, format_has_colors=True) == (0.6, 0.6, 0.6)


def test_mesh_uses_color_and_scale_of_description(tmp_path: Path) -> None:
    mesh = f'<mesh filename="{write_stl(tmp_path).as_uri()}" scale="1 2 0.5"/>'
    text = urdf(link("base", mesh, "0.1 0.8 0.1 1"))
    assert strongest_channel(render_image(text)[50, 60]) == "green"
    np.testing.assert_allclose(np.ptp(make_scene(text).points, axis=0), (0, 4, 1), atol=1e-8)


def test_mirrored_mesh_is_lit_from_same_side(tmp_path: Path) -> None:
    path = write_stl(tmp_path).as_uri()
    plain, mirrored = (
        render_image(urdf(link("base", f'<mesh filename="{path}" scale="{scale}"/>', "0.8 0.8 0.8 1")))
        for scale in ("1 1 1", "1 -1 1")
    )
    assert np.abs(plain[60, 60].astype(int) - mirrored[60, 60]).max() <= 2


def test_mesh_file_is_read_again_only_after_change(tmp_path: Path) -> None:
    library = SurfaceLibrary()
    path = write_stl(tmp_path)
    first = library.read(path)
    assert library.read(path) is first
    write_stl(tmp_path, 2)
    assert library.read(path) is not first


@pytest.mark.parametrize("name", ["missing.stl", "missing.dae", "broken.dae", "broken.stl", "a.txt", "folder.dae"])
def test_unreadable_mesh_is_reported_once(name: str, tmp_path: Path) -> None:
    path = tmp_path / name
    if name.startswith("broken"):
        path.write_bytes(b"<COLLADA>")
    elif name == "folder.dae":
        path.mkdir()
    elif name == "a.txt":
        path.write_text("")
    with pytest.raises(LinkwrightError) as raised:
        SurfaceLibrary().read(path)
    assert raised.value.diagnostics[0].code in ("INR101", "INR102", "INR103", "INR104")


@pytest.mark.extra("mesh")
def test_mesh_sizes_and_colors_match_page(tmp_path: Path) -> None:
    shown = make_scene(robot_of(golden_links(tmp_path)))
    assert shown.problems == ()
    drawn = {body.name: surface for body, surface in zip(shown.mesh.bodies, shown.mesh.surfaces, strict=True)}
    mismatches = {}
    for name, (_, _, _, _, (lower_corner, upper_corner), color, opacity) in GOLDEN.items():
        surface = drawn[name]
        hex_color = "#" + "".join(f"{round(value * 255):02x}" for value in surface.color)
        low, high = surface.points.min(axis=0).tolist(), surface.points.max(axis=0).tolist()
        is_in_place = low == pytest.approx(lower_corner, abs=1e-5) and high == pytest.approx(upper_corner, abs=1e-5)
        if not is_in_place or hex_color != color or surface.alpha != pytest.approx(opacity):
            mismatches[name] = (low, high, hex_color, surface.alpha)
    assert mismatches == {}


def test_robots_share_read_meshes(tmp_path: Path) -> None:
    text = urdf(
        link("base", f'<mesh filename="{write_stl(tmp_path).as_uri()}"/>', "1 0 0 1"),
        link("other", '<sphere radius="1"/>', "1 0 0 1"),
        joint("j", "base", "other"),
    )
    library = SurfaceLibrary()
    first, second = make_scene(text, library=library), make_scene(text, library=library)
    assert first.mesh.surfaces[0].points is second.mesh.surfaces[0].points
