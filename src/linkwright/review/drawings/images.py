"""Render images of both versions of a robot, with changed and moved links outlined."""

from __future__ import annotations

from collections.abc import Collection, Hashable, Iterable, Iterator, Mapping
from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from linkwright.descriptions.comparison import Comparison
from linkwright.descriptions.pairs import Model, Pair
from linkwright.diagnostics import LinkwrightError
from linkwright.geometry.mesh_content import surface_key
from linkwright.geometry.shapes import Placement
from linkwright.images.png import png
from linkwright.picture import OUTLINE_COLOR, VIEWS, Scene, SurfaceLibrary, camera_for, render, robot_scene
from linkwright.picture.link_frames import placement_from_pose
from linkwright.review.changes import ViewImages
from linkwright.review.frames import SharedFrames
from linkwright.urdf import Material, Mesh, Robot, Visual

Array = NDArray[np.float64]

_SIZE = (480, 360)
_COLLISION_VIEWS = ("iso", "front")
_COLLISION_MATERIAL = Material("", (0.62, 0.67, 0.74, 1.0))
"""The material of collision shapes: without a hue, so that the outlines of changed ones stand out."""
_POSE_PROPERTIES = ("origin xyz", "origin rpy")
"""The name endings of pose properties. Poses are compared as seen in the image."""
_MOTION_TOLERANCE = 1e-5
"""The maximum difference, in m and between entries of rotation matrices, of a link that has not moved."""


def render_views(
    models: Pair, old: Robot, new: Robot, comparison: Comparison, frames: SharedFrames
) -> list[ViewImages]:
    """Return images from four sides; empty if both robots look the same.

    All joints are at position 0, or at the middle of limits that exclude 0. Both images of a view have the same camera.
    """
    changed = {*_find_changed_surfaces(models, old, new, comparison), *_find_moved_links(old, new, comparison, frames)}
    old_links = _select_links_with_visuals(
        old, {*set(old.links) - set(comparison.links), *(name for name, _ in changed)}
    )
    new_links = _select_links_with_visuals(
        new, {*set(new.links) - set(comparison.links.values()), *(name for _, name in changed)}
    )
    if not old_links and not new_links:
        return []
    return _render_pair(models, (old, old_links), (new, new_links), frames, {name: name for name in VIEWS})


def render_collisions(
    models: Pair, old: Robot, new: Robot, comparison: Comparison, frames: SharedFrames
) -> list[ViewImages]:
    """Return images of the collision shapes from two sides; empty if the shapes are equal.

    Links with changed shapes are outlined. Links without collision shapes are not drawn.
    """
    old_names = {new_name: old_name for old_name, new_name in comparison.links.items()}
    changed = {
        difference.name
        for difference in comparison.differences
        if difference.subject == "link" and difference.property.startswith("collision") and difference.name in old_names
    }
    if not changed:
        return []
    old_links = (_show_collisions(old), {old_names[name] for name in changed})
    labels = {name: f"{name}, collision" for name in _COLLISION_VIEWS}
    return _render_pair(models, old_links, (_show_collisions(new), changed), frames, labels)


def _render_pair(
    models: Pair,
    old: tuple[Robot, Collection[str]],
    new: tuple[Robot, Collection[str]],
    frames: SharedFrames,
    labels: Mapping[str, str],
) -> list[ViewImages]:
    """Return images of both robots; empty if neither has anything to draw.

    Args:
        models: the descriptions.
        old: the old robot, and its links to outline.
        new: the new robot, and its links to outline.
        frames: the frames that both robots have.
        labels: the labels of the images, by the name of the view.
    """
    library = SurfaceLibrary()
    scenes = [
        robot_scene(
            robot,
            model.finder,
            folder=model.path.parent,
            outlined=dict.fromkeys(links, OUTLINE_COLOR),
            library=library,
            root=root,
        )
        for (robot, links), model, root in ((old, models.old, None), (new, models.new, frames.new_root))
    ]
    if not any(len(scene.mesh.faces) for scene in scenes):
        return []
    images = []
    for name, label in labels.items():
        camera = camera_for(VIEWS[name], _SIZE, *scenes)
        images.append(ViewImages(label, *(png(render(scene, camera=camera)) for scene in scenes)))
    return images


def _show_collisions(robot: Robot) -> Robot:
    """Return a robot that shows its collision shapes instead of its visuals."""
    links = {
        name: replace(
            link,
            visuals=tuple(
                Visual(shape.geometry, shape.origin, material=_COLLISION_MATERIAL, element=shape.element)
                for shape in link.collisions
            ),
        )
        for name, link in robot.links.items()
    }
    return replace(robot, links=links)


def render_unpaired_robot(model: Model, robot: Robot, *, is_old: bool) -> list[ViewImages]:
    """Return images of a robot that only one version has, from four sides.

    The result is empty if the robot has no visuals.
    """
    return render_unpaired_scene(robot_scene(robot, model.finder, folder=model.path.parent), is_old=is_old)


def render_unpaired_scene(scene: Scene, *, is_old: bool) -> list[ViewImages]:
    """Return images of a scene that only one version has, from four sides.

    The result is empty for an empty scene.
    """
    if not len(scene.mesh.faces):
        return []
    images = []
    for name, view in VIEWS.items():
        image = png(render(scene, camera=camera_for(view, _SIZE, scene)))
        images.append(ViewImages(name, image, b"") if is_old else ViewImages(name, b"", image))
    return images


def _select_links_with_visuals(robot: Robot, links: Iterable[str]) -> set[str]:
    """Return the links of a robot that have visuals."""
    return {name for name in links if name in robot.links and robot.links[name].visuals}


def _find_changed_surfaces(models: Pair, old: Robot, new: Robot, comparison: Comparison) -> Iterator[tuple[str, str]]:
    """Yield the old and new names of links whose shapes, colors or textures differ."""
    old_names = {new_name: old_name for old_name, new_name in comparison.links.items()}
    for difference in comparison.differences:
        is_visual = difference.subject == "link" and difference.property.startswith("visual")
        if not is_visual or difference.property.endswith(_POSE_PROPERTIES) or difference.name not in old_names:
            continue
        names = old_names[difference.name], difference.name
        if not difference.property.endswith("geometry") or _make_shape_keys(
            models.old, old, names[0]
        ) != _make_shape_keys(models.new, new, names[1]):
            yield names


def _make_shape_keys(model: Model, robot: Robot, link: str) -> list[Hashable]:
    """Return comparable keys of the visuals of a link.

    Equal meshes under different paths have equal keys.
    """
    geometries = (visual.geometry for visual in robot.links[link].visuals)
    return [_make_mesh_key(model, shape) if isinstance(shape, Mesh) else repr(shape) for shape in geometries]


def _make_mesh_key(model: Model, mesh: Mesh) -> Hashable:
    try:
        key = surface_key(model.resolve(mesh.filename))
    except LinkwrightError:
        key = None
    return (key or mesh.filename), mesh.scale


def _find_moved_links(
    old: Robot, new: Robot, comparison: Comparison, frames: SharedFrames
) -> Iterator[tuple[str, str]]:
    """Yield the old and new names of links whose visuals moved relative to the shared link."""
    for old_name, new_name in comparison.links.items():
        if old_name in frames.old and new_name in frames.new:
            old_poses = _compute_visual_poses(old, old_name, frames.old[old_name])
            new_poses = _compute_visual_poses(new, new_name, frames.new[new_name])
            if old_poses.shape != new_poses.shape or not np.allclose(
                old_poses, new_poses, rtol=0.0, atol=_MOTION_TOLERANCE
            ):
                yield old_name, new_name


def _compute_visual_poses(robot: Robot, link: str, frame: Placement) -> Array:
    """Return the rotations and positions of a link's visuals in the frame of the images.

    The shape of the result is (visuals, 4, 3).
    """
    poses = [placement_from_pose(visual.origin).inside(frame) for visual in robot.links[link].visuals]
    return np.array([[*pose.rotation, pose.position] for pose in poses])
