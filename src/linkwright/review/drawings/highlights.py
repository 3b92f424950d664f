"""Highlight the changed parts of two robots: axes for frames, names, and an image of small parts."""

from __future__ import annotations

from collections.abc import Collection, Sequence
from dataclasses import dataclass, replace

import numpy as np

from linkwright.diagnostics import Phrase
from linkwright.diagnostics.phrase import as_phrase
from linkwright.geometry.arrays import Array
from linkwright.picture import Camera, Scene, View
from linkwright.picture.bodies import Anchor, Axes, Body, Color, Labels
from linkwright.picture.camera import fit_camera
from linkwright.picture.visibility import count_outlined_pixels

_AXIS_LENGTH = 0.1
"""The length of the axes of a frame, as a fraction of the size of the robots."""
_MAX_DISTANCE = 1.0
"""The distance from the robots, as a fraction of their size, up to which frames are shown."""
_MAX_NAMES = 4
"""The maximum number of highlighted parts that all have their names in the images."""
_MIN_SIZE_RATIO = 2.5
"""The minimum ratio of the sizes of the robots and of the changed parts for an image of these parts."""
_MARGIN = 0.3
"""The width of the surroundings of the changed parts, as a fraction of their size."""
_CLOSE_UP_VIEWS = tuple(
    View(azimuth, elevation) for elevation in (28.0, -20.0) for azimuth in (40.0, -40.0, 140.0, 220.0)
)
_TRIAL_SIZE = (120, 90)
_SUFFICIENT_SHARE = 0.75
"""The share of the best view's pixels with which an earlier view is chosen."""


@dataclass(frozen=True)
class _Extent:
    """The box around points.

    Attributes:
        low: the lowest corner in m, shape (3,).
        high: the highest corner in m, shape (3,).
    """

    low: Array
    high: Array

    @classmethod
    def of(cls, points: Array) -> _Extent:
        return cls(points.min(axis=0), points.max(axis=0))

    @property
    def size(self) -> float:
        """The length of the diagonal in m."""
        return float(np.linalg.norm(self.high - self.low))

    def distance_to(self, point: Sequence[float]) -> float:
        """Return the distance of a point from the box in m; 0 inside."""
        outside = np.maximum(np.maximum(self.low - point, point - self.high), 0.0)
        return float(np.linalg.norm(outside))

    def make_corners(self, margin: float) -> Array:
        """Return the corners of the box, extended by a margin in m, shape (8, 3)."""
        unit = np.array([[x, y, z] for x in (0, 1) for y in (0, 1) for z in (0, 1)], dtype=float)
        corners: Array = self.low - margin + unit * (self.high - self.low + 2.0 * margin)
        return corners


def add_frames(scenes: Sequence[Scene], frames: Sequence[Collection[str]]) -> list[Scene]:
    """Return scenes with the axes of frames, and with the names of the highlighted parts as labels.

    Args:
        scenes: the scenes of both robots.
        frames: the names of the frames to add to each scene.
    """
    extent = _Extent.of(np.concatenate([scene.points for scene in scenes]))
    length = _AXIS_LENGTH * extent.size
    shown = [
        [
            body
            for body in scene.bodies
            if body.name in names and extent.distance_to(body.frame.position) <= _MAX_DISTANCE * extent.size
        ]
        for scene, names in zip(scenes, frames, strict=True)
    ]
    outlined = [[body for body in scene.bodies if body.outline is not None and body.surfaces] for scene in scenes]
    has_all_names = max(len(links) + len(added) for links, added in zip(outlined, shown, strict=True)) <= _MAX_NAMES
    result = []
    for scene, links, added in zip(scenes, outlined, shown, strict=True):
        anchors = [Anchor(body.name, body.frame.position) for body in added]
        if has_all_names:
            anchors += map(_make_anchor, links)
        axes = [Axes(body.frame, length) for body in added]
        result.append(Scene(scene.bodies, scene.problems, Labels(tuple(anchors)), axes))
    return result


def _make_anchor(body: Body) -> Anchor:
    """Return the label of a body at its vertex that is nearest to its middle."""
    points = Scene([body]).points
    extent = _Extent.of(points)
    distances = np.linalg.norm(points - (extent.low + extent.high) / 2.0, axis=1)
    x, y, z = points[int(np.argmin(distances))].tolist()
    return Anchor(body.name, (x, y, z))


def make_close_up(scenes: Sequence[Scene], size: tuple[int, int]) -> dict[str, Camera]:
    """Return the camera that shows the highlighted parts and their surroundings, by its label.

    The result is empty if the parts are large, or if no link is among them: axes alone show no place. Of several sides,
    the first one is chosen from which nearly as much of the parts is visible as from the best side.
    """
    highlighted = [
        Scene([body for body in scene.bodies if body.outline is not None and body.surfaces], axes=scene.axes)
        for scene in scenes
    ]
    points = [scene.points for scene in highlighted if scene.bodies or scene.axes]
    if not any(scene.bodies for scene in highlighted):
        return {}
    extent = _Extent.of(np.concatenate(points))
    whole = _Extent.of(np.concatenate([scene.points for scene in scenes]))
    if extent.size * _MIN_SIZE_RATIO > whole.size:
        return {}
    corners = extent.make_corners(_MARGIN * extent.size)
    shown = scenes[-1] if highlighted[-1].bodies else scenes[0]
    counts = [count_outlined_pixels(shown, fit_camera(view, _TRIAL_SIZE, [corners])) for view in _CLOSE_UP_VIEWS]
    first = next(index for index, count in enumerate(counts) if count >= _SUFFICIENT_SHARE * max(counts))
    return {"changed parts": fit_camera(_CLOSE_UP_VIEWS[first], size, [corners])}


def find_notes(scenes: Sequence[Scene]) -> tuple[Phrase, ...]:
    """Return what is drawn incompletely in scenes, such as links with a mesh that is not found."""
    messages = (as_phrase(problem.message) for scene in scenes for problem in scene.problems)
    return tuple({str(message): message for message in messages}.values())


def remove_colors(scene: Scene, color: Color) -> Scene:
    """Return a scene with all surfaces in one color, without textures."""
    bodies = (
        replace(
            body,
            surfaces=tuple(
                replace(surface, color=color, alpha=1.0, texture=None, vertex_colors=None) for surface in body.surfaces
            ),
        )
        for body in scene.bodies
    )
    return Scene(tuple(bodies), scene.problems, scene.labels, scene.axes)
