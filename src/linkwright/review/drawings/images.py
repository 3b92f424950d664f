"""Render images of both versions of a robot, with changed and moved parts highlighted."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace

from linkwright.descriptions.comparison import Comparison
from linkwright.descriptions.pairs import Model, Pair
from linkwright.images.png import png
from linkwright.picture import OUTLINE_COLOR, VIEWS, Scene, Style, SurfaceLibrary, camera_for, render, robot_scene
from linkwright.review.changes import ViewImages
from linkwright.review.drawings.changed_parts import Parts, find_changed_collisions, find_changed_parts
from linkwright.review.drawings.highlights import add_frames, find_notes, make_close_up, remove_colors
from linkwright.review.frames import SharedFrames
from linkwright.urdf import Robot, Visual

_SIZE = (480, 360)
_COLLISION_VIEWS = ("iso", "front")
_COLLISION_COLOR = (0.62, 0.67, 0.74)
"""The color of collision shapes: without a hue, so that the outlines of changed ones stand out."""


def render_views(
    models: Pair, old: Robot, new: Robot, comparison: Comparison, frames: SharedFrames
) -> list[ViewImages]:
    """Return images from four sides, and one of small changed parts; empty if both robots look the same.

    All joints are at position 0, or at the middle of limits that exclude 0. Both images of a view have the same camera.
    Links without visuals that were added, removed or attached elsewhere are shown as axes.
    """
    old_parts, new_parts = find_changed_parts(models, old, new, comparison, frames)
    if not (old_parts.links or new_parts.links or old_parts.frames or new_parts.frames):
        return []
    return _render_pair(models, (old, old_parts), (new, new_parts), frames, {name: name for name in VIEWS})


def render_collisions(
    models: Pair, old: Robot, new: Robot, comparison: Comparison, frames: SharedFrames
) -> list[ViewImages]:
    """Return images of the collision shapes from two sides; empty if the shapes are equal.

    Links with changed shapes are outlined, and so are added and removed ones. Links without collision shapes are not
    drawn.
    """
    shown = _show_collisions(old), _show_collisions(new)
    parts = find_changed_collisions(models, *shown, comparison, frames)
    if parts is None:
        return []
    old_side, new_side = zip(shown, parts, strict=True)
    labels = {name: f"{name}, collision" for name in _COLLISION_VIEWS}
    return _render_pair(models, old_side, new_side, frames, labels, is_of_collisions=True)


def _render_pair(
    models: Pair,
    old: tuple[Robot, Parts],
    new: tuple[Robot, Parts],
    frames: SharedFrames,
    labels: Mapping[str, str],
    *,
    is_of_collisions: bool = False,
) -> list[ViewImages]:
    """Return images of both robots; empty if neither has anything to draw.

    Args:
        models: the descriptions.
        old: the old robot, and its highlighted parts.
        new: the new robot, and its highlighted parts.
        frames: the frames that both robots have.
        labels: the labels of the images, by the name of the view.
        is_of_collisions: whether the robots show collision shapes, without colors and without an image of small parts.
    """
    library = SurfaceLibrary()
    scenes = [
        robot_scene(
            robot,
            model.finder,
            folder=model.path.parent,
            outlined=dict.fromkeys(parts.links, OUTLINE_COLOR),
            library=library,
            root=root,
        )
        for (robot, parts), model, root in ((old, models.old, None), (new, models.new, frames.new_root))
    ]
    if not any(len(scene.mesh.faces) for scene in scenes):
        return []
    if is_of_collisions:
        scenes = [remove_colors(scene, _COLLISION_COLOR) for scene in scenes]
    scenes = add_frames(scenes, (old[1].frames, new[1].frames))
    if not any(scene.axes or any(body.outline for body in scene.bodies) for scene in scenes):
        return []
    style = Style(labels="links")
    cameras = {label: camera_for(VIEWS[name], _SIZE, *scenes) for name, label in labels.items()}
    if not is_of_collisions:
        cameras |= make_close_up(scenes, _SIZE)
    images = []
    for label, camera in cameras.items():
        first, second = (png(render(scene, camera=camera, style=style)) for scene in scenes)
        images.append(ViewImages(label, first, second, find_notes(scenes)))
    return images


def _show_collisions(robot: Robot) -> Robot:
    """Return a robot that shows its collision shapes instead of its visuals."""
    links = {
        name: replace(
            link,
            visuals=tuple(Visual(shape.geometry, shape.origin, element=shape.element) for shape in link.collisions),
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
        first, second = (image, b"") if is_old else (b"", image)
        images.append(ViewImages(name, first, second, find_notes([scene])))
    return images
