"""Find the parts of two robots that images highlight: links that look different or moved, and changed frames."""

from __future__ import annotations

from collections.abc import Collection, Hashable, Iterable, Iterator, Mapping
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from linkwright.descriptions.comparison import Comparison, Difference
from linkwright.descriptions.pairs import Model, Pair
from linkwright.diagnostics import LinkwrightError
from linkwright.geometry.mesh_content import surface_key
from linkwright.geometry.shapes import Placement
from linkwright.picture.link_frames import placement_from_pose
from linkwright.review.frames import SharedFrames
from linkwright.urdf import Box, Mesh, Pose, Robot, Sphere, Visual

Array = NDArray[np.float64]

_POSE_PROPERTIES = ("origin xyz", "origin rpy")
"""The name endings of pose properties. Poses are compared as seen in the image."""
_ATTACHMENT_PROPERTIES = (*_POSE_PROPERTIES, "parent")
"""The properties of a joint that move its link."""
_MOTION_TOLERANCE = 1e-5
"""The maximum difference, in m and between entries of rotation matrices, of a part that has not moved."""
_MAX_FRAMES = 8
"""The maximum number of frames that are shown in an image. More would hide each other."""


@dataclass(frozen=True)
class Parts:
    """The highlighted parts of one robot.

    Attributes:
        links: the links with visuals that look different or moved.
        frames: the links without visuals that were added, removed or attached elsewhere.
    """

    links: Collection[str] = ()
    frames: Collection[str] = ()


def find_changed_parts(
    models: Pair, old: Robot, new: Robot, comparison: Comparison, frames: SharedFrames
) -> tuple[Parts, Parts]:
    """Return the highlighted parts of the old and of the new robot."""
    changed = {*_find_changed_surfaces(models, old, new, comparison), *_find_moved_links(old, new, comparison, frames)}
    old_links = _select_links_with_visuals(
        old, {*set(old.links) - set(comparison.links), *(name for name, _ in changed)}
    )
    new_links = _select_links_with_visuals(
        new, {*set(new.links) - set(comparison.links.values()), *(name for _, name in changed)}
    )
    old_side = _Side(models.old, old, frames.old, old_links)
    new_side = _Side(models.new, new, frames.new, new_links)
    old_shown, new_shown = _drop_equal_links(old_side, new_side, comparison)
    old_frames, new_frames = _find_changed_frames(old, new, comparison, frames)
    return Parts(old_shown, old_frames), Parts(new_shown, new_frames)


def find_changed_collisions(
    models: Pair, old: Robot, new: Robot, comparison: Comparison, frames: SharedFrames
) -> tuple[Parts, Parts] | None:
    """Return the links with other collision shapes of the old and of the new robot, or None.

    The result is None if no link of both robots has other shapes.

    Args:
        models: the descriptions.
        old: the old robot, with its collision shapes as visuals.
        new: the new robot, with its collision shapes as visuals.
        comparison: the comparison of the robots.
        frames: the frames that both robots have.
    """
    old_names = {new_name: old_name for old_name, new_name in comparison.links.items()}
    changed = {
        difference.name
        for difference in comparison.differences
        if difference.subject == "link" and difference.property.startswith("collision") and difference.name in old_names
        if not difference.property.endswith(_POSE_PROPERTIES)
        or not _have_equal_poses(old, old_names[difference.name], new, difference.name)
    }
    if not changed:
        return None
    old_links = {*set(old.links) - set(comparison.links), *(old_names[name] for name in changed)}
    new_links = {*set(new.links) - set(comparison.links.values()), *changed}
    old_shown, new_shown = _drop_equal_links(
        _Side(models.old, old, frames.old, _select_links_with_visuals(old, old_links)),
        _Side(models.new, new, frames.new, _select_links_with_visuals(new, new_links)),
        comparison,
    )
    return (Parts(old_shown), Parts(new_shown)) if old_shown or new_shown else None


# --- frames ----------------------------------------------------------------------------------------------------------


def _find_changed_frames(
    old: Robot, new: Robot, comparison: Comparison, frames: SharedFrames
) -> tuple[list[str], list[str]]:
    """Return the links without visuals of each robot that its joint places elsewhere; none if there are many."""
    old_names = {new_name: old_name for old_name, new_name in comparison.links.items()}
    old_found: dict[str, None] = {}
    new_found: dict[str, None] = {}
    for difference in comparison.differences:
        if difference.subject != "joint" or not _places_link(difference):
            continue
        if difference.kind == "removed":
            child = old.joints[difference.name].child
            if child not in comparison.links:
                old_found[child] = None
            continue
        child = new.joints[difference.name].child
        old_child = old_names.get(child)
        if old_child is None:
            new_found[child] = None
        elif frames.motion(old_child) is not None:
            old_found[old_child] = None
            new_found[child] = None
    found = (
        [name for name in names if name in placed and name in robot.links and not robot.links[name].visuals]
        for robot, names, placed in ((old, old_found, frames.old), (new, new_found, frames.new))
    )
    old_frames, new_frames = found
    return ([], []) if max(len(old_frames), len(new_frames)) > _MAX_FRAMES else (old_frames, new_frames)


def _places_link(difference: Difference) -> bool:
    return difference.kind in ("added", "removed") or difference.property in _ATTACHMENT_PROPERTIES


# --- links -----------------------------------------------------------------------------------------------------------


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
    return [_make_shape_key(model, visual) for visual in robot.links[link].visuals]


def _make_shape_key(model: Model, visual: Visual) -> Hashable:
    shape = visual.geometry
    if not isinstance(shape, Mesh):
        return repr(shape)
    try:
        key = surface_key(model.resolve(shape.filename))
    except LinkwrightError:
        key = None
    return (key or shape.filename), shape.scale


def _find_moved_links(
    old: Robot, new: Robot, comparison: Comparison, frames: SharedFrames
) -> Iterator[tuple[str, str]]:
    """Yield the old and new names of links whose visuals moved relative to the shared link."""
    for old_name, new_name in comparison.links.items():
        if old_name in frames.old and new_name in frames.new:
            old_poses = _compute_visual_poses(old, old_name, frames.old[old_name])
            new_poses = _compute_visual_poses(new, new_name, frames.new[new_name])
            if old_poses.shape != new_poses.shape or not _are_equal_poses(old_poses, new_poses):
                yield old_name, new_name


def _compute_visual_poses(robot: Robot, link: str, frame: Placement) -> Array:
    """Return the orientations and positions of a link's visuals in the frame of the images.

    Two orientations in which a shape looks the same, such as those of a cylinder after half a turn, are equal.
    The shape of the result is (visuals, 4, 3).
    """
    visuals = robot.links[link].visuals
    poses = [placement_from_pose(visual.origin).inside(frame) for visual in visuals]
    return np.array(
        [
            [*_remove_symmetry(visual, np.array(pose.rotation)), pose.position]
            for visual, pose in zip(visuals, poses, strict=True)
        ]
    )


def _remove_symmetry(visual: Visual, rotation: Array) -> Array:
    """Return a matrix that is equal for all rotations in which a shape looks the same, shape (3, 3)."""
    shape = visual.geometry
    if isinstance(shape, Mesh) or (visual.material is not None and visual.material.texture):
        return rotation
    scales: Array = np.zeros(3)
    if isinstance(shape, Box):
        scales = np.array(shape.size) / max(*map(abs, shape.size), 1e-9)
    elif not isinstance(shape, Sphere):
        scales = np.array([0.0, 0.0, 1.0])
    turned: Array = rotation @ np.diag(scales**2) @ rotation.T
    return turned


def _have_equal_poses(old: Robot, old_name: str, new: Robot, new_name: str) -> bool:
    """Return whether the visuals of a link look the same in the frames of the link."""
    origin = placement_from_pose(Pose())
    poses = _compute_visual_poses(old, old_name, origin), _compute_visual_poses(new, new_name, origin)
    return poses[0].shape == poses[1].shape and _are_equal_poses(*poses)


def _are_equal_poses(old: Array, new: Array) -> bool:
    return np.allclose(old, new, rtol=0.0, atol=_MOTION_TOLERANCE)


@dataclass(frozen=True)
class _Side:
    """One robot, the frames of its links, and its links that may look different."""

    model: Model
    robot: Robot
    frames: Mapping[str, Placement]
    links: Collection[str]

    def make_appearances(self, link: str) -> list[tuple[Hashable, Array]]:
        """Return the shape with its material, and the pose, of each visual of a link."""
        poses = _compute_visual_poses(self.robot, link, self.frames[link])
        return [
            ((_make_shape_key(self.model, visual), _make_material_key(visual)), pose)
            for visual, pose in zip(self.robot.links[link].visuals, poses, strict=True)
        ]


def _make_material_key(visual: Visual) -> Hashable:
    material = visual.material
    return None if material is None else (material.rgba, material.texture)


def _drop_equal_links(old: _Side, new: _Side, comparison: Comparison) -> tuple[set[str], set[str]]:
    """Return the links of both robots, without those whose visuals only belong to another link of the other robot."""
    old_names = {new_name: old_name for old_name, new_name in comparison.links.items()}
    return _drop_equal_links_of(old, new, comparison.links), _drop_equal_links_of(new, old, old_names)


def _drop_equal_links_of(side: _Side, other: _Side, matches: Mapping[str, str]) -> set[str]:
    """Return the links of a robot, without those whose visuals only belong to another link of the other robot."""
    appearances = [
        appearance for name in other.links if name in other.frames for appearance in other.make_appearances(name)
    ]

    def is_elsewhere(link: str) -> bool:
        match = matches.get(link)
        has_own_visuals = match is not None and bool(other.robot.links[match].visuals)
        return (
            not has_own_visuals
            and link in side.frames
            and all(
                any(key == other_key and _are_equal_poses(pose, other_pose) for other_key, other_pose in appearances)
                for key, pose in side.make_appearances(link)
            )
        )

    return {link for link in side.links if not is_elsewhere(link)}
