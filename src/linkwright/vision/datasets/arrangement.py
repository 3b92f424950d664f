"""The random arrangement of the camera and the objects for an image."""

from __future__ import annotations

from dataclasses import dataclass
from math import atan2, cos, exp, log, pi, radians, sin, tan

import numpy as np

from linkwright.geometry.arrays import Array
from linkwright.geometry.single import Transform, quaternion_from_rpy
from linkwright.sdf.optics import Optics
from linkwright.vision.datasets.options import Options
from linkwright.vision.datasets.randomized_world import MovableObject, RandomizedWorld

_MAX_TRIES = 20
_LINE_OF_SIGHT_STEPS = 40
_MIN_DISTANCE_M, _MAX_DISTANCE_M = 0.3, 12.0
"""The minimum and maximum distance of objects from the camera, in m."""
_MIN_LENGTH_FRACTION, _MAX_LENGTH_FRACTION = 0.045, 0.5
"""The minimum and maximum length of an object, as fractions of the image width: 30 to 320 of 640 pixels."""
_FAR_CLIP_M = 30.0
"""The far clip distance, in m."""
_OCCLUDED_FRACTION = 0.15
"""The fraction of objects that may be placed behind structures."""
_CAMERA_CLEARANCE_M = 0.12
"""The minimum distance of the camera from any object or structure, in m."""


@dataclass(frozen=True)
class Arrangement:
    """A camera pose with the objects and structures of an image.

    Attributes:
        optics: the camera's projection.
        pose: the camera's pose; the camera looks along x, with z up.
        placed_objects: the objects that were placed; some may be out of view.
        structures: the geoms of the surroundings that are not hidden.
    """

    optics: Optics
    pose: Transform
    placed_objects: tuple[MovableObject, ...]
    structures: tuple[int, ...]


class _Ground:
    """The occupied areas of the ground, as rectangles and circles seen from above."""

    def __init__(self, world: RandomizedWorld, geoms: list[int]) -> None:
        data = world.simulation.data
        horizontal_z = np.abs(data.geom_xmat[geoms].reshape(-1, 3, 3)[:, 2, :2]).max(initial=0.0, axis=1)
        is_upright = horizontal_z < 1e-3
        half = world.simulation.model.geom_aabb[geoms, 3:5]
        centers = world.simulation.model.geom_aabb[geoms, :2]
        axes = data.geom_xmat[geoms].reshape(-1, 3, 3)[:, :2, :2]
        bounds = world.boxes[geoms]
        self._half_sizes = np.where(is_upright[:, None], half, (bounds[:, 1, :2] - bounds[:, 0, :2]) / 2)
        self._axes = np.where(is_upright[:, None, None], axes, np.eye(2))
        rotated_centers = data.geom_xpos[geoms, :2] + np.einsum("gij,gj->gi", axes, centers)
        self._centers = np.where(is_upright[:, None], rotated_centers, (bounds[:, 0, :2] + bounds[:, 1, :2]) / 2)
        self._occupied_circles: list[tuple[float, float, float]] = []

    def is_free(self, x: float, y: float, radius: float) -> bool:
        """Return whether a circle overlaps no structure and no occupied circle."""
        if any((x - a) ** 2 + (y - b) ** 2 < (radius + other) ** 2 for a, b, other in self._occupied_circles):
            return False
        if not len(self._half_sizes):
            return True
        local = np.einsum("gji,gj->gi", self._axes, np.array([x, y]) - self._centers)
        offset = np.maximum(np.abs(local) - self._half_sizes, 0.0)
        return bool((np.hypot(offset[:, 0], offset[:, 1]) > radius).all())

    def has_line_of_sight(self, start: tuple[float, float], end: tuple[float, float]) -> bool:
        """Return whether no structure blocks the line between two points."""
        steps = np.linspace(start, end, _LINE_OF_SIGHT_STEPS)[:, None] - self._centers
        distances_outside = np.abs(np.einsum("gji,sgj->sgi", self._axes, steps)) - self._half_sizes
        return not (distances_outside < 0.0).all(axis=2).any()

    def occupy(self, x: float, y: float, radius: float) -> None:
        """Mark a circle as occupied."""
        self._occupied_circles.append((x, y, radius))


def arrange(world: RandomizedWorld, options: Options, generator: np.random.Generator) -> Arrangement:
    """Place a camera, objects and distractors at random, and return the resulting arrangement.

    Args:
        world: the world, after `RandomizedWorld.reset`.
        options: the options of the dataset.
        generator: the random generator.
    """
    structures = _choose_structures(world, generator)
    ground = _Ground(world, structures)
    field = radians(generator.uniform(45.0, 100.0))
    focal = options.width / (2 * tan(field / 2))
    optics = Optics(
        options.width, options.height, focal, focal, options.width / 2, options.height / 2, 0.03, _FAR_CLIP_M
    )
    x, y, heading = _choose_camera_pose(world, ground, generator)
    height = world.floor + (exp(generator.uniform(log(0.08), log(0.8))) if generator.random() < 0.7 else
                            generator.uniform(0.6, 2.5))  # fmt: skip
    ground.occupy(x, y, _CAMERA_CLEARANCE_M)
    placed_objects, target = [], None
    for movable in _choose_objects(world, options, generator):
        position = _find_free_position(
            world,
            ground,
            movable.radius,
            (x, y, heading),
            field,
            generator,
            _find_distance_range(movable, focal, options),
        )
        if position is not None:
            _place_object(world, movable, position, generator)
            placed_objects.append(movable)
            target = target or (position, float(movable.corners[:, 2].max()))
    for geom in world.distractors:
        if generator.random() < 0.35:
            radius = world.shape_distractor(geom, generator)
            position = _find_free_position(
                world, ground, radius, (x, y, heading), field, generator, (_MIN_DISTANCE_M, _MAX_DISTANCE_M)
            )
            if position is not None:
                height_above_floor = generator.uniform(0.0, 1.5) if generator.random() < 0.2 else 0.0
                rotation = (
                    _draw_rotation(generator)
                    if generator.random() < 0.5
                    else _make_yaw_rotation(generator.uniform(-pi, pi))
                )
                world.put_distractor(geom, np.array([*position, world.floor + height_above_floor]), rotation)
    if target is None:
        pitch = generator.uniform(-0.1, 0.5)
    else:
        (target_x, target_y), target_height = target
        distance = max(float(np.hypot(target_x - x, target_y - y)), 0.1)
        vertical_field = 2 * atan2(options.height / 2, focal)
        pitch = (
            atan2(height - world.floor - target_height / 2, distance) + generator.uniform(-0.3, 0.3) * vertical_field
        )
    roll = generator.normal(0.0, radians(12.0 if generator.random() < 0.1 else 1.5))
    pose = x, y, height, *quaternion_from_rpy((float(roll), float(np.clip(pitch, -1.0, 1.5)), heading))
    return Arrangement(optics, pose, tuple(placed_objects), tuple(structures))


def _choose_structures(world: RandomizedWorld, generator: np.random.Generator) -> list[int]:
    """Hide some of the structures at random, and return the geoms of the others."""
    visible_geoms = []
    for geoms in world.structures.values():
        if generator.random() < 0.25:
            world.hide(geoms)
        else:
            visible_geoms += geoms
    return visible_geoms


def _choose_camera_pose(
    world: RandomizedWorld, ground: _Ground, generator: np.random.Generator
) -> tuple[float, float, float]:
    """Return the camera's x and y in m and heading in rad, with free space ahead if possible."""
    minimum, maximum = world.area
    x = y = heading = 0.0
    for _ in range(_MAX_TRIES):
        x, y = (float(coordinate) for coordinate in generator.uniform(minimum, maximum))
        heading = float(generator.uniform(-pi, pi))
        clearance = generator.uniform(0.8, 2.5)
        distances = (share * clearance for share in (0.0, 0.25, 0.5, 0.75, 1.0))
        is_free = (
            ground.is_free(x + distance * cos(heading), y + distance * sin(heading), _CAMERA_CLEARANCE_M)
            for distance in distances
        )
        if all(is_free):
            break
    return x, y, heading


def _choose_objects(world: RandomizedWorld, options: Options, generator: np.random.Generator) -> list[MovableObject]:
    """Return randomly chosen objects.

    Each class is equally likely, regardless of its number of objects. In 4 % of the images, there are no objects.
    """
    if generator.random() < 0.04:
        return []
    by_class: dict[int, list[MovableObject]] = {}
    for movable in world.movable_objects:
        by_class.setdefault(movable.label, []).append(movable)
    selected_objects: list[MovableObject] = []
    for _ in range(int(generator.integers(1, options.max_objects + 1))):
        classes = [label for label, movable_objects in by_class.items() if movable_objects]
        if not classes:
            break
        movable_objects = by_class[classes[int(generator.integers(len(classes)))]]
        selected_objects.append(movable_objects.pop(int(generator.integers(len(movable_objects)))))
    return selected_objects


def _find_distance_range(movable: MovableObject, focal: float, options: Options) -> tuple[float, float]:
    """Return the range of distances in m at which an object has a suitable size in an image."""
    spans = np.sort(movable.corners.max(axis=0) - movable.corners.min(axis=0))
    nearest = max(focal * spans[2] / (_MAX_LENGTH_FRACTION * options.width), _MIN_DISTANCE_M)
    farthest = (
        min(spans[2] / (_MIN_LENGTH_FRACTION * options.width), spans[1] / (1.2 * max(options.min_size, 1))) * focal
    )
    return float(min(nearest, _MAX_DISTANCE_M / 2)), float(np.clip(farthest, 1.5 * nearest, _MAX_DISTANCE_M))


def _find_free_position(
    world: RandomizedWorld,
    ground: _Ground,
    radius: float,
    camera: tuple[float, float, float],
    field: float,
    generator: np.random.Generator,
    distances: tuple[float, float],
) -> tuple[float, float] | None:
    """Return a free position, usually in view of the camera, or None if none was found.

    The position is marked as occupied.
    """
    x, y, heading = camera
    minimum, maximum = world.area
    nearest, may_be_hidden = distances[0] + radius, generator.random() < _OCCLUDED_FRACTION
    for _ in range(_MAX_TRIES):
        if generator.random() < 0.9:
            bearing = heading + generator.uniform(-0.45, 0.45) * field
            distance = exp(generator.uniform(log(nearest), log(max(distances[1], nearest * 1.5))))
            position = x + distance * cos(bearing), y + distance * sin(bearing)
        else:
            first, second = generator.uniform(minimum, maximum)
            position = float(first), float(second)
        is_inside = bool((minimum < position).all() and (position < maximum).all())
        is_visible = may_be_hidden or ground.has_line_of_sight((x, y), position)
        if is_inside and is_visible and ground.is_free(*position, radius):
            ground.occupy(*position, radius)
            return position
    return None


def _place_object(
    world: RandomizedWorld, movable: MovableObject, position: tuple[float, float], generator: np.random.Generator
) -> None:
    """Place an object at a position: usually upright, sometimes lying or above the ground."""
    rotation = _make_yaw_rotation(generator.uniform(-pi, pi))
    if movable.is_round or generator.random() < 0.08:
        rotation = _draw_rotation(generator)
    elif generator.random() < 0.06:
        rotation = rotation @ np.array([[1.0, 0.0, 0.0], [0.0, 0.0, -1.0], [0.0, 1.0, 0.0]])
    corners = movable.corners @ rotation.T
    minimum, maximum = corners.min(axis=0), corners.max(axis=0)
    height_above_floor = generator.uniform(0.1, 0.9) if generator.random() < 0.06 else 0.0
    bounds_center = (minimum + maximum) / 2
    is_tilted = rotation[2, 2] < 1.0 - 1e-9
    offset = -bounds_center[:2] if is_tilted else np.zeros(2)
    height = -float(minimum[2])
    if movable.is_round:  # the bounding box of a rotated ball is larger than the ball
        center = (movable.corners.min(axis=0) + movable.corners.max(axis=0)) / 2
        height = float(center[2] - (rotation @ center)[2])
    world.place_object(
        movable,
        np.array([position[0] + offset[0], position[1] + offset[1], world.floor + height + height_above_floor]),
        rotation,
    )


def _make_yaw_rotation(angle: float) -> Array:
    rotation: Array = np.array([[cos(angle), -sin(angle), 0.0], [sin(angle), cos(angle), 0.0], [0.0, 0.0, 1.0]])
    return rotation


def _draw_rotation(generator: np.random.Generator) -> Array:
    orthogonal, triangle = np.linalg.qr(generator.normal(size=(3, 3)))
    orthogonal = orthogonal * np.sign(np.diag(triangle))
    rotation: Array = orthogonal * np.linalg.det(orthogonal)
    return rotation
