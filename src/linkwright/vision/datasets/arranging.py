"""Arrange the camera and the objects for an image randomly."""

from __future__ import annotations

from dataclasses import dataclass
from math import atan2, cos, exp, log, pi, radians, sin, tan

import numpy as np

from linkwright.geometry.arrays import Array
from linkwright.geometry.single import Transform, quaternion_from_rpy
from linkwright.sdf.optics import Optics
from linkwright.vision.datasets.options import Options
from linkwright.vision.datasets.stage import Prop, Stage

_TRIES = 20
_STEPS = 40
_NEAREST, _FARTHEST = 0.3, 12.0
"""The least and the greatest distance of objects from the camera, in m."""
_SMALLEST, _LARGEST = 0.045, 0.5
"""The least and the greatest length of an object, in widths of the image: 30 to 320 pixels of 640."""
_SEEN_FROM = 30.0
"""The far clip distance, in m."""
_BEHIND = 0.15
"""The share of objects that may be put behind structures."""
_ROOM = 0.12
"""The least distance of the camera from any object or structure, in m."""


@dataclass(frozen=True)
class Shot:
    """A camera pose with the visible scene.

    Attributes:
        optics: the projection.
        pose: the camera's pose; the camera looks along x, with z up.
        shown: the placed objects.
        structures: the geoms of the surroundings.
    """

    optics: Optics
    pose: Transform
    shown: tuple[Prop, ...]
    structures: tuple[int, ...]


class _Ground:
    """The occupied places on the ground, as circles seen from above."""

    def __init__(self, stage: Stage, geoms: list[int]) -> None:
        data = stage.simulation.data
        reach = np.abs(data.geom_xmat[geoms].reshape(-1, 3, 3)[:, 2, :2]).max(initial=0.0, axis=1)
        upright = reach < 1e-3
        half = stage.simulation.model.geom_aabb[geoms, 3:5]
        middle = stage.simulation.model.geom_aabb[geoms, :2]
        axes = data.geom_xmat[geoms].reshape(-1, 3, 3)[:, :2, :2]
        boxes = stage.boxes[geoms]
        self._half = np.where(upright[:, None], half, (boxes[:, 1, :2] - boxes[:, 0, :2]) / 2)
        self._axes = np.where(upright[:, None, None], axes, np.eye(2))
        placed = data.geom_xpos[geoms, :2] + np.einsum("gij,gj->gi", axes, middle)
        self._middle = np.where(upright[:, None], placed, (boxes[:, 0, :2] + boxes[:, 1, :2]) / 2)
        self._discs: list[tuple[float, float, float]] = []

    def is_free(self, x: float, y: float, radius: float) -> bool:
        """Return whether a circle is free."""
        if any((x - a) ** 2 + (y - b) ** 2 < (radius + other) ** 2 for a, b, other in self._discs):
            return False
        if not len(self._half):
            return True
        local = np.einsum("gji,gj->gi", self._axes, np.array([x, y]) - self._middle)
        beyond = np.maximum(np.abs(local) - self._half, 0.0)
        return bool((np.hypot(beyond[:, 0], beyond[:, 1]) > radius).all())

    def is_open(self, start: tuple[float, float], end: tuple[float, float]) -> bool:
        """Return whether no structure is between two points."""
        steps = np.linspace(start, end, _STEPS)[:, None] - self._middle
        beyond = np.abs(np.einsum("gji,sgj->sgi", self._axes, steps)) - self._half
        return not (beyond < 0.0).all(axis=2).any()

    def occupy(self, x: float, y: float, radius: float) -> None:
        """Mark a circle as occupied."""
        self._discs.append((x, y, radius))


def arrange(stage: Stage, options: Options, generator: np.random.Generator) -> Shot:
    """Arrange a camera and objects in a world.

    Args:
        stage: the world, after `Stage.begin`.
        options: the options.
        generator: the random generator.
    """
    structures = _choose_structures(stage, generator)
    ground = _Ground(stage, structures)
    field = radians(generator.uniform(45.0, 100.0))
    focal = options.width / (2 * tan(field / 2))
    optics = Optics(
        options.width, options.height, focal, focal, options.width / 2, options.height / 2, 0.03, _SEEN_FROM
    )
    x, y, heading = _camera_place(stage, ground, generator)
    height = stage.floor + (exp(generator.uniform(log(0.08), log(0.8))) if generator.random() < 0.7 else
                            generator.uniform(0.6, 2.5))  # fmt: skip
    ground.occupy(x, y, _ROOM)
    shown, target = [], None
    for prop in _chosen(stage, options, generator):
        place = _free_place(stage, ground, prop.radius, (x, y, heading), field, generator, _reach(prop, focal, options))
        if place is not None:
            _stand(stage, prop, place, generator)
            shown.append(prop)
            target = target or (place, float(prop.corners[:, 2].max()))
    for geom in stage.distractors:
        if generator.random() < 0.35:
            radius = stage.shape_distractor(geom, generator)
            place = _free_place(stage, ground, radius, (x, y, heading), field, generator, (_NEAREST, _FARTHEST))
            if place is not None:
                lift = generator.uniform(0.0, 1.5) if generator.random() < 0.2 else 0.0
                turn = _any_turn(generator) if generator.random() < 0.5 else _yawed(generator.uniform(-pi, pi))
                stage.put_distractor(geom, np.array([*place, stage.floor + lift]), turn)
    if target is None:
        pitch = generator.uniform(-0.1, 0.5)
    else:
        (there_x, there_y), tall = target
        distance = max(float(np.hypot(there_x - x, there_y - y)), 0.1)
        across = 2 * atan2(options.height / 2, focal)
        pitch = atan2(height - stage.floor - tall / 2, distance) + generator.uniform(-0.3, 0.3) * across
    roll = generator.normal(0.0, radians(12.0 if generator.random() < 0.1 else 1.5))
    pose = x, y, height, *quaternion_from_rpy((float(roll), float(np.clip(pitch, -1.0, 1.5)), heading))
    return Shot(optics, pose, tuple(shown), tuple(structures))


def _choose_structures(stage: Stage, generator: np.random.Generator) -> list[int]:
    """Hide some of the structures, and return the others."""
    left = []
    for geoms in stage.structures.values():
        if generator.random() < 0.25:
            stage.hide(geoms)
        else:
            left += geoms
    return left


def _camera_place(stage: Stage, ground: _Ground, generator: np.random.Generator) -> tuple[float, float, float]:
    """Return the camera's position and the point that it looks at, with free space ahead if possible."""
    least, greatest = stage.area
    x = y = heading = 0.0
    for _ in range(_TRIES):
        x, y = (float(coordinate) for coordinate in generator.uniform(least, greatest))
        heading = float(generator.uniform(-pi, pi))
        ahead = generator.uniform(0.8, 2.5)
        free = (ground.is_free(x + share * ahead * cos(heading), y + share * ahead * sin(heading), _ROOM)
                for share in (0.0, 0.25, 0.5, 0.75, 1.0))  # fmt: skip
        if all(free):
            break
    return x, y, heading


def _chosen(stage: Stage, options: Options, generator: np.random.Generator) -> list[Prop]:
    """Return a random choice of objects.

    Each class is equally likely, regardless of its number of objects.
    """
    if generator.random() < 0.04:
        return []
    by_class: dict[int, list[Prop]] = {}
    for prop in stage.props:
        by_class.setdefault(prop.label, []).append(prop)
    chosen: list[Prop] = []
    for _ in range(int(generator.integers(1, options.most + 1))):
        classes = [label for label, props in by_class.items() if props]
        if not classes:
            break
        props = by_class[classes[int(generator.integers(len(classes)))]]
        chosen.append(props.pop(int(generator.integers(len(props)))))
    return chosen


def _reach(prop: Prop, focal: float, options: Options) -> tuple[float, float]:
    """Return the distances in m at which an object is neither too large nor too small in an image."""
    spans = np.sort(prop.corners.max(axis=0) - prop.corners.min(axis=0))
    nearest = max(focal * spans[2] / (_LARGEST * options.width), _NEAREST)
    farthest = min(spans[2] / (_SMALLEST * options.width), spans[1] / (1.2 * max(options.least_size, 1))) * focal
    return float(min(nearest, _FARTHEST / 2)), float(np.clip(farthest, 1.5 * nearest, _FARTHEST))


def _free_place(
    stage: Stage,
    ground: _Ground,
    radius: float,
    camera: tuple[float, float, float],
    field: float,
    generator: np.random.Generator,
    reach: tuple[float, float],
) -> tuple[float, float] | None:
    """Return a free place, usually in view of the camera; None if there is none."""
    x, y, heading = camera
    least, greatest = stage.area
    nearest, hidden = reach[0] + radius, generator.random() < _BEHIND
    for _ in range(_TRIES):
        if generator.random() < 0.9:
            bearing = heading + generator.uniform(-0.45, 0.45) * field
            distance = exp(generator.uniform(log(nearest), log(max(reach[1], nearest * 1.5))))
            place = x + distance * cos(bearing), y + distance * sin(bearing)
        else:
            first, second = generator.uniform(least, greatest)
            place = float(first), float(second)
        inside = bool((least < place).all() and (place < greatest).all())
        in_view = hidden or ground.is_open((x, y), place)
        if inside and in_view and ground.is_free(*place, radius):
            ground.occupy(*place, radius)
            return place
    return None


def _stand(stage: Stage, prop: Prop, place: tuple[float, float], generator: np.random.Generator) -> None:
    """Place an object: upright in most cases, sometimes lying or above the ground."""
    turn = _yawed(generator.uniform(-pi, pi))
    if prop.is_round or generator.random() < 0.08:
        turn = _any_turn(generator)
    elif generator.random() < 0.06:
        turn = turn @ np.array([[1.0, 0.0, 0.0], [0.0, 0.0, -1.0], [0.0, 1.0, 0.0]])
    turned = prop.corners @ turn.T
    least, greatest = turned.min(axis=0), turned.max(axis=0)
    lift = generator.uniform(0.1, 0.9) if generator.random() < 0.06 else 0.0
    middle = (least + greatest) / 2
    tilted = turn[2, 2] < 1.0 - 1e-9
    across = -middle[:2] if tilted else np.zeros(2)
    height = -float(least[2])
    if prop.is_round:  # the bounding box of a rotated ball is larger than the ball
        center = (prop.corners.min(axis=0) + prop.corners.max(axis=0)) / 2
        height = float(center[2] - (turn @ center)[2])
    stage.put(prop, np.array([place[0] + across[0], place[1] + across[1], stage.floor + height + lift]), turn)


def _yawed(angle: float) -> Array:
    turned: Array = np.array([[cos(angle), -sin(angle), 0.0], [sin(angle), cos(angle), 0.0], [0.0, 0.0, 1.0]])
    return turned


def _any_turn(generator: np.random.Generator) -> Array:
    turn, triangle = np.linalg.qr(generator.normal(size=(3, 3)))
    turn = turn * np.sign(np.diag(triangle))
    turned: Array = turn * np.linalg.det(turn)
    return turned
