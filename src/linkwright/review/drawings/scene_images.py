"""Render images of both versions of a world, model or mesh, with the changed links outlined."""

from __future__ import annotations

from collections.abc import Hashable, Sequence
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from linkwright.descriptions import examine_world
from linkwright.diagnostics import LinkwrightError
from linkwright.geometry.arrays import Array
from linkwright.geometry.shapes import IDENTITY, Placement
from linkwright.images.png import png
from linkwright.picture import OUTLINE_COLOR, VIEWS, Scene, SurfaceLibrary, render
from linkwright.picture.bodies import Body, Surface
from linkwright.picture.camera import fit_camera
from linkwright.picture.scene import crop_ground
from linkwright.picture.worlds import world_scene
from linkwright.review.changes import ViewImages
from linkwright.review.drawings.highlights import find_notes
from linkwright.review.drawings.images import render_unpaired_scene
from linkwright.review.file_pair import FilePair
from linkwright.review.versions import Version
from linkwright.sdf.frames import FrameError
from linkwright.sdf.resources import ResourceFinder
from linkwright.sdf.worlds import Sdf

_SIZE = (480, 360)
_MAX_FACES = 2_000_000
"""The maximum number of triangles of both versions for which images are rendered. More take a minute."""
_MAX_SIZE_RATIO = 8.0
"""The ratio of the sizes of a scene and its changed links from which only their surroundings are shown."""


def read_worlds(pair: FilePair) -> tuple[Sdf, Sdf] | None:
    """Return both versions of a world or model with their includes resolved.

    The result is None if one of them cannot be read.
    """
    old = _try_read_world(pair.versions.old, pair.old_file)
    new = None if old is None else _try_read_world(pair.versions.new, pair.new_file)
    return None if old is None or new is None else (old, new)


def build_world_scenes(pair: FilePair, worlds: tuple[Sdf, Sdf]) -> tuple[Scene, Scene] | None:
    """Return the scenes of both versions of a world or model, or None if one cannot be drawn."""
    library = SurfaceLibrary()
    sides = ((pair.versions.old, pair.old_file), (pair.versions.new, pair.new_file))
    old, new = (
        _try_build_scene(version, file, world, library) for (version, file), world in zip(sides, worlds, strict=True)
    )
    return None if old is None or new is None else (old, new)


def render_worlds(old: Scene, new: Scene) -> list[ViewImages]:
    """Return images of a world or model from four sides; empty if both versions look the same."""
    return _render_pair(old, new)


def render_meshes(pair: FilePair) -> list[ViewImages]:
    """Return images of a mesh from four sides.

    The result is empty if both versions look the same or cannot be drawn.
    """
    try:
        old, new = (_build_mesh_scene(file) for file in (pair.old_file, pair.new_file))
    except LinkwrightError:
        return []
    return _render_pair(old, new, has_outlines=False)


def render_unpaired_world(version: Version, path: str) -> list[ViewImages]:
    """Return images of a world or model that only one version has, from four sides.

    The result is empty if it cannot be drawn.
    """
    file = version.file(path)
    world = _try_read_world(version, file)
    scene = None if world is None else _try_build_scene(version, file, world, SurfaceLibrary())
    if scene is None or len(scene.mesh.faces) > _MAX_FACES:
        return []
    return render_unpaired_scene(scene, is_old=version.is_old)


def _try_read_world(version: Version, file: Path) -> Sdf | None:
    try:
        return examine_world(file, packages=version.finder(file.parent)).sdf
    except LinkwrightError:
        return None


def _try_build_scene(version: Version, file: Path, world: Sdf, library: SurfaceLibrary) -> Scene | None:
    try:
        return world_scene(world, ResourceFinder(version.finder(file.parent)), library=library)
    except (LinkwrightError, FrameError):
        return None


def _build_mesh_scene(file: Path) -> Scene:
    surfaces = tuple(part.surface for part in SurfaceLibrary().read(file) if part.surface.is_in_range)
    return Scene([Body("", Placement(IDENTITY, (0.0, 0.0, 0.0)), surfaces)])


def _render_pair(old: Scene, new: Scene, *, has_outlines: bool = True) -> list[ViewImages]:
    changed = _find_changed_bodies(old, new), _find_changed_bodies(new, old)
    drawn = [body for bodies in changed for body in bodies if body.surfaces]
    if not drawn or len(old.mesh.faces) + len(new.mesh.faces) > _MAX_FACES:
        return []
    points = _select_shown_points([old.points, new.points], Scene(drawn).points)
    scenes = [
        _outline_bodies(scene, bodies) if has_outlines else scene
        for scene, bodies in zip((old, new), changed, strict=True)
    ]
    shown = np.concatenate(points)
    scenes = [
        Scene([crop_ground(body, shown) if body.is_ground else body for body in scene.bodies], scene.problems)
        for scene in scenes
    ]
    images = []
    for name, view in VIEWS.items():
        camera = fit_camera(view, _SIZE, points)
        first, second = (png(render(scene, camera=camera)) for scene in scenes)
        images.append(ViewImages(name, first, second, find_notes((old, new))))
    return images


def _find_changed_bodies(scene: Scene, other: Scene) -> list[Body]:
    """Return the links of a scene that are missing, moved or look different in the other scene.

    A link that only has another name is not changed.
    """
    other_bodies = {body.name: body for body in other.bodies}
    names = {body.name for body in scene.bodies}
    others_by_place: dict[Hashable, list[Body]] = {}
    for body in other.bodies:
        if body.name not in names:
            others_by_place.setdefault(_make_place_key(body), []).append(body)

    def is_changed(body: Body) -> bool:
        if body.name in other_bodies:
            return not _are_equal_bodies(body, other_bodies[body.name])
        return not any(_are_equal_bodies(body, same) for same in others_by_place.get(_make_place_key(body), ()))

    return [body for body in scene.bodies if is_changed(body)]


def _make_place_key(body: Body) -> Hashable:
    return body.frame.position, len(body.surfaces)


def _are_equal_bodies(body: Body, other: Body) -> bool:
    if body.frame != other.frame or len(body.surfaces) != len(other.surfaces):
        return False
    return all(map(_are_equal_surfaces, body.surfaces, other.surfaces))


def _are_equal_surfaces(surface: Surface, other: Surface) -> bool:
    arrays = zip(_get_arrays(surface), _get_arrays(other), strict=True)
    is_same_color = (surface.color, surface.alpha) == (other.color, other.alpha)
    return is_same_color and all(_are_equal_arrays(first, second) for first, second in arrays)


def _get_arrays(surface: Surface) -> list[NDArray[Any] | None]:
    return [surface.points, surface.faces, surface.vertex_colors, surface.texture]


def _are_equal_arrays(first: NDArray[Any] | None, second: NDArray[Any] | None) -> bool:
    return first is second or (first is not None and second is not None and np.array_equal(first, second))


def _outline_bodies(scene: Scene, bodies: Sequence[Body]) -> Scene:
    changed = {id(body) for body in bodies}
    return Scene([replace(body, outline=OUTLINE_COLOR) if id(body) in changed else body for body in scene.bodies])


def _select_shown_points(scenes: Sequence[Array], changed: Array) -> list[Array]:
    """Return the points that the images show: all, or the surroundings of a small change."""
    low, high = changed.min(axis=0), changed.max(axis=0)
    size = float(np.linalg.norm(high - low)) or 1.0
    points = np.concatenate(scenes)
    if float(np.linalg.norm(points.max(axis=0) - points.min(axis=0))) <= _MAX_SIZE_RATIO * size:
        return list(scenes)
    corners = np.array([[x, y, z] for x in (0, 1) for y in (0, 1) for z in (0, 1)], dtype=float)
    return [low - size + corners * (high - low + 2.0 * size)]
