"""Scenes of bodies, and the cameras that show them."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from functools import cached_property

import numpy as np

from linkwright.diagnostics import Diagnostic
from linkwright.geometry.arrays import Array
from linkwright.geometry.shapes import IDENTITY, Placement
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
        """The triangles of all bodies. Those of the ground are near the others."""
        shown = self._shown_bodies
        if len(shown) == len(self.bodies):
            return Mesh.of(self.bodies)
        points = Mesh.of(shown).points
        return Mesh.of([crop_ground(body, points) if body.is_ground and len(points) else body for body in self.bodies])

    @property
    def _shown_bodies(self) -> list[Body]:
        return [body for body in self.bodies if not body.is_ground]

    @property
    def points(self) -> Array:
        """The points that an image must show: all vertices and axes, else the origins of the bodies.

        Those of the ground are left out if there are others.
        """
        shown = self._shown_bodies
        mesh = self.mesh if len(shown) == len(self.bodies) else Mesh.of(shown)
        points = [mesh.points if len(mesh.points) else self.mesh.points, *map(make_points, self.axes)]
        if any(map(len, points)):
            return np.concatenate(points)
        return np.array([body.frame.position for body in self.bodies] or [(0.0, 0.0, 0.0)])


def crop_ground(body: Body, points: Array) -> Body:
    """Return the ground without what is far from points, shape (n, 3), and would be behind the camera.

    Its vertices are moved to the border of a rectangle.
    """
    low, high = points.min(axis=0), points.max(axis=0)
    margin = float(np.linalg.norm(high - low))
    surfaces = []
    for surface in body.surfaces:
        placed = surface.placed(body.frame)
        cropped = placed.points.copy()
        cropped[:, :2] = np.clip(cropped[:, :2], low[:2] - margin, high[:2] + margin)
        surfaces.append(replace(placed, points=cropped))
    return replace(body, frame=Placement(IDENTITY, (0.0, 0.0, 0.0)), surfaces=tuple(surfaces))


def camera_for(view: View, size: tuple[int, int], *scenes: Scene) -> Camera:
    """Return the camera that shows all scenes at the largest possible common size.

    Images with this camera are comparable.

    Args:
        view: the direction of the camera.
        size: the width and height of the image in pixels.
        scenes: one scene or several.
    """
    return fit_camera(view, size, [scene.points for scene in scenes])
