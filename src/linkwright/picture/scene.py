"""Scenes of bodies, and the cameras that show them."""

from __future__ import annotations

from collections.abc import Sequence
from functools import cached_property

import numpy as np

from linkwright.diagnostics import Diagnostic
from linkwright.geometry.arrays import Array
from linkwright.picture.axes import make_points
from linkwright.picture.bodies import Axes, Body, Labels
from linkwright.picture.camera import Camera, View, fit_camera
from linkwright.picture.scene_mesh import Mesh


class Scene:
    """Bodies to render together.

    Args:
        bodies: the bodies to render, with their frames in the scene.
        problems: the findings about surfaces that are missing.
        labels: the points that can have labels.
        axes: the axes of frames to draw over the bodies.

    Attributes:
        bodies: the bodies to render, with their frames in the scene.
        problems: the findings about surfaces that are missing.
        labels: the points that can have labels.
        axes: the axes of frames to draw over the bodies.
    """

    def __init__(
        self,
        bodies: Sequence[Body],
        problems: Sequence[Diagnostic] = (),
        labels: Labels | None = None,
        axes: Sequence[Axes] = (),
    ) -> None:
        self.bodies = tuple(bodies)
        self.problems = tuple(problems)
        self.labels = labels or Labels()
        self.axes = tuple(axes)

    def __add__(self, other: Scene) -> Scene:
        """Return a scene with the bodies and axes of both scenes, and the labels of the first."""
        bodies, axes = (*self.bodies, *other.bodies), (*self.axes, *other.axes)
        return Scene(bodies, (*self.problems, *other.problems), self.labels, axes)

    @cached_property
    def mesh(self) -> Mesh:
        """The triangles of all bodies."""
        return Mesh.of(self.bodies)

    @property
    def points(self) -> Array:
        """The points that an image must show: all vertices and axes, else the origins of the bodies."""
        points = [self.mesh.points, *map(make_points, self.axes)]
        if any(map(len, points)):
            return np.concatenate(points)
        return np.array([body.frame.position for body in self.bodies] or [(0.0, 0.0, 0.0)])


def camera_for(view: View, size: tuple[int, int], *scenes: Scene) -> Camera:
    """Return the camera that shows all scenes at the largest possible common size.

    Images with this camera are comparable.

    Args:
        view: the direction of the camera.
        size: the width and height of the image in pixels.
        scenes: one scene or several.
    """
    return fit_camera(view, size, [scene.points for scene in scenes])
