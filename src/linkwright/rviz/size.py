"""The size of a robot, as far as its description gives it without its meshes."""

from __future__ import annotations

from collections.abc import Iterator
from math import dist, isfinite

import numpy as np

from linkwright.geometry.arrays import Array
from linkwright.geometry.bounds import Bounds, Placement, bounds_of, placement, union
from linkwright.kinematics import KinematicTree
from linkwright.rviz.config.model_size import ModelSize
from linkwright.urdf import Collision, Mesh, Robot, Visual

_APART = 1e-6
"""Frames closer than this are at one place, m."""


def size_of(robot: Robot) -> ModelSize | None:
    """Return the size of a robot whose joints are at zero, or None for one that is a single point.

    It is measured by the frames of its links and by its visuals and collisions that are simple shapes: a page that has
    read the meshes has the exact size, but axes are drawn before that.
    """
    tree = KinematicTree(robot)
    frames = dict(zip(tree.link_names, map(_placement, tree.forward({})), strict=True))
    boxes = [Bounds(frame.position, frame.position) for frame in frames.values()]
    boxes += [box.moved(frames[name]) for name in frames for box in _simple_shapes(robot, name)]
    bounds = union(boxes)
    if bounds is None or not isfinite(bounds.diagonal) or bounds.diagonal < _APART:
        return None
    steps = [
        dist(frames[joint.child].position, frames[joint.parent].position)
        for joint in robot.joints.values()
        if joint.child in frames and joint.parent in frames
    ]
    apart = [step for step in steps if step > _APART]
    return ModelSize(bounds.diagonal, float(np.median(apart)) if apart else bounds.diagonal)


def _simple_shapes(robot: Robot, link: str) -> Iterator[Bounds]:
    """Return the boxes around the simple shapes of a link, in the link's frame."""
    parts: tuple[Visual | Collision, ...] = (*robot.links[link].visuals, *robot.links[link].collisions)
    for part in parts:
        if not isinstance(part.geometry, Mesh):
            yield bounds_of(part.geometry).moved(placement(part.origin))


def _placement(matrix: Array) -> Placement:
    (a, b, c, x), (d, e, f, y), (g, h, i, z), _ = matrix.tolist()
    return Placement(((a, b, c), (d, e, f), (g, h, i)), (x, y, z))
