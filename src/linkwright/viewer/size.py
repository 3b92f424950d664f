"""How large a robot is, as far as its description tells without its meshes."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from linkwright.geometry.arrays import Array, matrix_from_pose, row_from_pose
from linkwright.geometry.bounds import Bounds, around, union
from linkwright.geometry.shapes import Box, Capsule, Cylinder, Sphere
from linkwright.kinematics import KinematicTree
from linkwright.urdf import Collision, Robot, Visual
from linkwright.viewer.config.model_size import ModelSize

_APART = 1e-6
"""Frames closer than this are at one place, m."""


def size_of(robot: Robot) -> ModelSize | None:
    """The size of a robot whose joints are at zero; None for one that is a single point.

    It is measured by the frames of its links and by its visuals and collisions that are simple shapes: a page that has
    read the meshes knows better, but first there are axes to be drawn.
    """
    tree = KinematicTree(robot)
    frames = dict(zip(tree.link_names, tree.forward({}), strict=True))
    boxes = [Bounds(frame[:3, 3], frame[:3, 3]) for frame in frames.values()]
    boxes += [box.moved(frames[name]) for name in frames for box in _simple_shapes(robot, name)]
    whole = union(boxes)
    if whole is None or not np.isfinite(whole.diagonal) or whole.diagonal < _APART:
        return None
    steps = [
        float(np.linalg.norm(frames[joint.child][:3, 3] - frames[joint.parent][:3, 3]))
        for joint in robot.joints.values()
        if joint.child in frames and joint.parent in frames
    ]
    apart = [step for step in steps if step > _APART]
    return ModelSize(whole.diagonal, float(np.median(apart)) if apart else whole.diagonal)


def _simple_shapes(robot: Robot, link: str) -> Iterator[Bounds]:
    """The boxes around the simple shapes of a link, in the link's frame."""
    parts: tuple[Visual | Collision, ...] = (*robot.links[link].visuals, *robot.links[link].collisions)
    for part in parts:
        half = _half_edges(part.geometry)
        if half is not None:
            yield around(np.array([-half, half])).moved(matrix_from_pose(row_from_pose(part.origin)))


def _half_edges(shape: object) -> Array | None:
    if isinstance(shape, Box):
        return np.abs(np.array(shape.size, dtype=np.float64)) / 2
    if isinstance(shape, Cylinder):
        return np.array([shape.radius, shape.radius, shape.length / 2])
    if isinstance(shape, Capsule):
        return np.array([shape.radius, shape.radius, shape.length / 2 + shape.radius])
    if isinstance(shape, Sphere):
        return np.array([shape.radius] * 3)
    return None
