"""Worlds as scenes."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from linkwright.descriptions import examine_world
from linkwright.packages import PackageFinder
from linkwright.picture.camera import VIEWS
from linkwright.picture.rendering import Style, render
from linkwright.picture.scene import Scene, camera_for
from linkwright.picture.visibility import count_outlined_pixels
from linkwright.picture.worlds import world_scene
from linkwright.sdf.resources import ResourceFinder
from tests.places import REPOSITORY

WORLDS = REPOSITORY / "robots" / "my_robot_gazebo" / "worlds"


def load_scene(path: Path) -> Scene:
    finder = PackageFinder(start=[path.parent])
    sdf = examine_world(path, packages=finder).sdf
    assert sdf is not None
    return world_scene(sdf, ResourceFinder(finder))


def world_with_visual(folder: Path, visual: str, pose: str = "1 2 3 0 0 1.5707963267948966") -> Scene:
    path = folder / "a.world"
    path.write_text(
        f'<sdf version="1.9"><world name="w"><model name="m"><pose>{pose}</pose>'
        f'<link name="l"><visual name="v">{visual}</visual></link></model></world></sdf>'
    )
    return load_scene(path)


@pytest.mark.parametrize("name", ["house.world", "playground.world"])
def test_course_worlds_are_drawn_completely(name: str) -> None:
    scene = load_scene(WORLDS / name)
    assert scene.problems == ()
    assert len(scene.mesh.faces) > 100


@pytest.mark.parametrize(
    ("shape", "extent"),
    [
        ("<box><size>2 4 6</size></box>", (2, 1, 3)),
        ("<cylinder><radius>1</radius><length>4</length></cylinder>", (1, 1, 2)),
        ("<cone><radius>1</radius><length>4</length></cone>", (1, 1, 2)),
        ("<ellipsoid><radii>1 2 3</radii></ellipsoid>", (2, 1, 3)),
        ("<capsule><radius>1</radius><length>4</length></capsule>", (1, 1, 3)),
        ("<sphere><radius>2</radius></sphere>", (2, 2, 2)),
    ],
)
def test_shapes_are_placed_as_in_file(shape: str, extent: tuple[float, ...], tmp_path: Path) -> None:
    points = world_with_visual(tmp_path, f"<geometry>{shape}</geometry>").points - (1, 2, 3)
    np.testing.assert_allclose(points.max(axis=0), extent, atol=1e-8)
    np.testing.assert_allclose(points.min(axis=0), np.negative(extent), atol=1e-8)


def test_color_and_transparency_match_visual(tmp_path: Path) -> None:
    material = "<material><diffuse>0.2 0.4 0.6 0.5</diffuse></material><transparency>0.5</transparency>"
    scene = world_with_visual(tmp_path, f"<geometry><sphere><radius>1</radius></sphere></geometry>{material}")
    (surface,) = scene.mesh.surfaces
    assert surface.color == (0.2, 0.4, 0.6)
    assert surface.alpha == 0.25


def test_planes_are_omitted_and_unsupported_shapes_reported(tmp_path: Path) -> None:
    plane = world_with_visual(tmp_path, "<geometry><plane><normal>0 0 1</normal></plane></geometry>")
    assert len(plane.mesh.faces) == 0
    assert plane.problems == ()
    polyline = "<polyline><point>0 0</point><point>1 0</point><point>0 1</point><height>1</height></polyline>"
    (problem,) = world_with_visual(tmp_path, f"<geometry>{polyline}</geometry>").problems
    assert problem.code == "PIC101"
    (problem,) = world_with_visual(tmp_path, "<geometry><mesh><uri>no.dae</uri></mesh></geometry>").problems
    assert problem.code == "PIC101"


ROOM = """<sdf version="1.9"><world name="w">
<model name="floor"><link name="l"><visual name="v"><geometry><box><size>{width} {width} {height}</size></box>
</geometry></visual></link></model>
<model name="table"><pose>2 1 0.5 0 0 0</pose><link name="l"><visual name="v"><geometry><box><size>1 2 1</size></box>
</geometry></visual></link></model></world></sdf>"""


@pytest.mark.parametrize(("width", "height", "is_ground"), [(100, 0.1, True), (5, 0.1, False), (100, 20, False)])
def test_images_need_not_show_a_large_floor_as_a_whole(
    tmp_path: Path, width: float, height: float, is_ground: bool
) -> None:
    path = tmp_path / "room.world"
    path.write_text(ROOM.format(width=width, height=height))
    scene = load_scene(path)
    assert [body.is_ground for body in scene.bodies] == [is_ground, False]
    shown = np.ptp(scene.points, axis=0).max()
    assert shown == pytest.approx(2.0 if is_ground else width)
    drawn = np.ptp(scene.mesh.points, axis=0).max()
    assert drawn == pytest.approx(2.0 + 2.0 * np.linalg.norm((1, 2, 1)) if is_ground else width)


def test_parts_behind_the_camera_are_not_drawn(tmp_path: Path) -> None:
    path = tmp_path / "room.world"
    path.write_text(ROOM.format(width=100, height=20).replace("2 1 0.5", "2 1 12"))
    scene = load_scene(path)
    alone = Scene(scene.bodies[1:])
    camera = camera_for(VIEWS["iso"], (120, 90), alone)
    shown, expected = (render(each, camera=camera, style=Style(transparent=True)) for each in (scene, alone))
    table = expected[:, :, 3] == 255
    assert (shown[:, :, 3] == 255)[table].all()
    assert count_outlined_pixels(Scene([replace(body, outline=(1.0, 0.0, 0.0)) for body in alone.bodies]), camera) > 500
