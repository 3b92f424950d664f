"""A robot among objects, in MuJoCo, which finds what collides.

The model is compiled when the objects change. Links that never move do not collide with objects, because neither can
be moved out of the way.

As in MoveIt, a link may have a margin to objects of the world, and not to other links. Such a link has each of its
shapes twice: one for other links, and one for the world.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping, Sequence
from contextlib import contextmanager
from dataclasses import dataclass, field
from math import inf
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from linkwright.geometry.arrays import Array
from linkwright.planning.robot_model import PlacedShape, RobotModel, Shapes, add_shape, body_name, set_pose
from linkwright.planning.shapes import scale_shape
from linkwright.simulation.library import load_mujoco
from linkwright.urdf import Robot


@dataclass(frozen=True, slots=True)
class SceneObject:
    """An object in the world, or attached to a link.

    Attributes:
        shapes: the shapes of the object, in the frame of the object.
        pose: the pose of the object in the frame of the root link, or of the link to which it is attached, shape (7,).
        link: the link to which the object is attached; empty for an object in the world.
        touch_links: the links that may touch an attached object.
    """

    name: str
    shapes: tuple[PlacedShape, ...]
    pose: Array
    link: str = ""
    touch_links: frozenset[str] = frozenset()


@dataclass(slots=True)
class AllowedCollisions:
    """Which pairs of links and objects may collide.

    Attributes:
        pairs: whether a pair may collide, for each pair that is listed.
        defaults: whether a link or object may collide with those without a listed pair.
    """

    pairs: dict[frozenset[str], bool] = field(default_factory=dict)
    defaults: dict[str, bool] = field(default_factory=dict)

    def copy(self) -> AllowedCollisions:
        """Return a copy that can be changed."""
        return AllowedCollisions(dict(self.pairs), dict(self.defaults))

    def allows(self, first: str, second: str) -> bool:
        """Return whether two links or objects may collide."""
        listed = self.pairs.get(frozenset((first, second)))
        if listed is not None:
            return listed
        return self.defaults.get(first, False) or self.defaults.get(second, False)


@dataclass(frozen=True, slots=True)
class LinkMargin:
    """How much a link is larger than its shapes, with what is attached to it, toward objects of the world.

    Attributes:
        padding: the distance in m within which an object collides with the link.
        scale: the factor of the sizes of the shapes.
    """

    padding: float = 0.0
    scale: float = 1.0

    def find_error(self) -> str:
        """Return why the margin cannot be used, or an empty string."""
        if not 0.0 <= self.padding < inf:
            return "Padding must be finite and cannot be negative"
        return "" if 0.0 < self.scale < inf else "Scale must be positive and finite"


_NO_MARGIN = LinkMargin()
_RANGE_M = 1e-5
"""The distance in m up to which MuJoCo finds shapes, so that those that touch are among them."""
ROUNDING_M = 1e-7
"""The depth in m up to which shapes only touch. Neighboring links often do, with a depth that is a rounding error."""
_WORLD = 2
"""The bit of MuJoCo's contype and conaffinity for contacts with objects of the world; 1 is for those of the robot."""


class Contact(NamedTuple):
    """Two links or objects that collide, at a position in the frame of the root link.

    Attributes:
        depth: the penetration in m, of the padded shapes.
        normal: the direction from the first to the second.
    """

    first: str
    second: str
    position: Array
    normal: Array
    depth: float


class Nearness(NamedTuple):
    """Which shapes are near to each other in a configuration.

    Attributes:
        distances: in m, by the numbers of two shapes, the larger one first; negative for collisions.
        centers: the centers of all shapes in m, shape (shapes, 3).
        rotations: their rotation matrices, shape (shapes, 3, 3).
        radii: the radii in m of the spheres around the centers that contain them, shape (shapes,).
    """

    distances: Mapping[tuple[int, int], float]
    centers: Array
    rotations: Array
    radii: Array


class CollisionScene:
    """A robot among objects.

    Args:
        robot: the robot.
        shapes: the collision shapes of its links.
        objects: the objects in the world and those that are attached to links.
        allowed: the pairs that may collide.
        margins: the margins of links, by link name.
        range_m: the distance in m up to which distances are measured.
    """

    def __init__(
        self,
        robot: Robot,
        shapes: Shapes,
        objects: Iterable[SceneObject],
        allowed: AllowedCollisions,
        margins: Mapping[str, LinkMargin] | None = None,
        range_m: float = _RANGE_M,
    ) -> None:
        objects = tuple(objects)
        parts = [
            *((body_name(name), name) for name in robot.links if shapes.get(name)),
            *((_object_body(item), item.name) for item in objects),
        ]

        def complete(spec: Any) -> None:
            spec.option.disableflags |= int(load_mujoco().mjtDisableBit.mjDSBL_FILTERPARENT)
            for name, placed_shapes in shapes.items():
                _add_margin(spec, spec.body(body_name(name)), placed_shapes, (margins or {}).get(name, _NO_MARGIN))
            for scene_object in objects:
                _add_object(spec, scene_object, (margins or {}).get(scene_object.link, _NO_MARGIN))
            for first, second in _allowed_pairs(parts, objects, allowed):
                spec.add_exclude(bodyname1=first, bodyname2=second)
            for geom in spec.geoms:  # MuJoCo adds the margins of two geoms.
                geom.margin += range_m / 2.0

        self._range = range_m
        self._world = {item.name for item in objects if not item.link}
        self._model = RobotModel(robot, shapes, complete)
        mujoco_model = self._model.mujoco_model
        names_by_body = {mujoco_model.body(body).id: name for body, name in parts}
        self._names_by_geom = [names_by_body[int(body)] for body in mujoco_model.geom_bodyid]

    def is_free(self, positions: Array) -> bool:
        """Return whether nothing collides at the positions of all joints."""
        self._move(positions)
        return not self._model.data.ncon or float(self._distances().min()) >= -ROUNDING_M

    def colliding_pairs(self, positions: Array) -> set[frozenset[str]]:
        """Return the pairs of links or objects that collide or touch at the positions of all joints."""
        self._move(positions)
        names = self._names_by_geom
        touching = self._model.data.contact.geom[self._distances() <= 0.0]
        return {frozenset((names[first], names[second])) for first, second in touching.tolist()}

    def find_colliding_pair(self, positions: Array, shapes: NDArray[np.bool_]) -> tuple[str, str] | None:
        """Return two links or objects that collide, by name, or None.

        Args:
            positions: the positions of all joints.
            shapes: the shapes that count, in the order of `shape_frames`.
        """
        self._move(positions)
        geoms = self._model.data.contact.geom[self._distances() < -ROUNDING_M]
        geoms = geoms[shapes[geoms].all(axis=1)]
        if not len(geoms):
            return None
        first, second = sorted(self._names_by_geom[geom] for geom in geoms[0])
        return first, second

    def shape_frames(self, positions: Array) -> Array:
        """Return the positions and rotation matrices of all shapes, shape (shapes, 12)."""
        self._move(positions)
        return np.hstack((self._model.data.geom_xpos, self._model.data.geom_xmat))

    def clearances(self, positions: Array) -> tuple[float, float]:
        """Return the distances in m of the robot to itself and to objects of the world, at most the range.

        A distance is 0 if there is a collision.
        """
        self._move(positions)
        return self._measure()

    @contextmanager
    def measuring_up_to(self, range_m: float) -> Iterator[None]:
        """Change the range within a block."""
        before = self._range
        self._set_range(range_m)
        try:
            yield
        finally:
            self._set_range(before)

    def _set_range(self, range_m: float) -> None:
        growth = (range_m - self._range) / 2.0  # MuJoCo adds the margins of two geoms.
        self._model.mujoco_model.geom_margin += growth
        self._model.mujoco_model.body_margin += growth
        self._range = range_m

    def measure_nearness(self, positions: Array) -> Nearness:
        """Return which shapes are nearer to each other than the range."""
        self._move(positions)
        data, radii = self._model.data, self._model.mujoco_model.geom_rbound
        distances: dict[tuple[int, int], float] = {}
        if data.ncon:
            values = self._distances().tolist()
            for (first, second), distance in zip(data.contact.geom.tolist(), values, strict=True):
                pair = (first, second) if radii[first] >= radii[second] else (second, first)
                distances[pair] = min(distance, distances.get(pair, distance))
        return Nearness(distances, data.geom_xpos.copy(), data.geom_xmat.reshape(-1, 3, 3).copy(), radii)

    def _measure(self) -> tuple[float, float]:
        to_self = to_world = self._range
        for contact in self._model.data.contact:
            distance = max(0.0, float(contact.dist - contact.includemargin) + self._range)
            if self._world.isdisjoint(self._names_by_geom[geom] for geom in contact.geom):
                to_self = min(to_self, distance)
            else:
                to_world = min(to_world, distance)
        return to_self, to_world

    def contacts(self, positions: Array) -> list[Contact]:
        """Return what collides at the positions of all joints."""
        self._move(positions)
        contacts = []
        for contact in self._model.data.contact:
            first, second = (self._names_by_geom[geom] for geom in contact.geom)
            depth = float(contact.includemargin - contact.dist) - self._range
            if depth <= ROUNDING_M:
                continue
            contacts.append(Contact(first, second, contact.pos.copy(), contact.frame[:3].copy(), depth))
        return contacts

    def _distances(self) -> Array:
        """Return the distances in m of the shapes that are near to each other; negative for collisions."""
        contact = self._model.data.contact
        distances: Array = contact.dist - contact.includemargin + self._range
        return distances

    def _move(self, positions: Array) -> None:
        self._model.move(positions)
        load_mujoco().mj_collision(self._model.mujoco_model, self._model.data)


def _object_body(scene_object: SceneObject) -> str:
    return f"object {scene_object.name}"


def _add_object(spec: Any, scene_object: SceneObject, margin: LinkMargin) -> None:
    parent = spec.body(body_name(scene_object.link)) if scene_object.link else spec.worldbody
    body = parent.add_body(name=_object_body(scene_object))
    set_pose(body, scene_object.pose)
    for placed_shape in scene_object.shapes:
        add_shape(spec, body, placed_shape)
    if scene_object.link:
        _add_margin(spec, body, scene_object.shapes, margin)
    else:
        for geom in body.geoms:
            geom.contype, geom.conaffinity = _WORLD, 0


def _add_margin(spec: Any, body: Any, placed_shapes: Sequence[PlacedShape], margin: LinkMargin) -> None:
    """Make the shapes of a body collide with the world, or larger copies of them."""
    geoms = list(body.geoms)
    if margin != _NO_MARGIN:
        geoms = [add_shape(spec, body, scale_shape(placed_shape, margin.scale)) for placed_shape in placed_shapes]
        for geom in geoms:
            geom.margin, geom.contype, geom.conaffinity = margin.padding, 0, 0
    for geom in geoms:
        geom.conaffinity |= _WORLD


def _allowed_pairs(
    parts: Sequence[tuple[str, str]], objects: Sequence[SceneObject], allowed: AllowedCollisions
) -> Iterable[tuple[str, str]]:
    """Yield the pairs of bodies that may collide.

    Args:
        parts: the body and the name of each link and object.
        objects: the objects.
        allowed: the names of links and objects that may collide.
    """
    attached = {item.name: item.touch_links for item in objects if item.link}
    for index, (first_body, first) in enumerate(parts):
        for second_body, second in parts[:index]:
            touches = second in attached.get(first, ()) or first in attached.get(second, ())
            if touches or allowed.allows(first, second):
                yield first_body, second_body
