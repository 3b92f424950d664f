"""The element ``<population>``: copies of a model, distributed over a box or a cylinder.

Sources: for the elements the SDFormat specification 1.12, ``population.sdf``; for the positions and names Gazebo
classic's ``Population.cc``. In Gazebo classic, the positions of ``random`` and ``uniform`` differ with each start; here
they are always the same.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, field, replace
from math import cos, pi, sin, sqrt
from random import Random

from linkwright.geometry.shapes import Box, Cylinder
from linkwright.geometry.single import Pose, Vector3, pose_quaternion, rotate
from linkwright.schema import ElementRule
from linkwright.sdf.models import MODEL, Model
from linkwright.sdf.poses import AT_ORIGIN, POSE, RawPose
from linkwright.sdf.values import INTEGER, NUMBER, VECTOR3, choice, name_of, object_rule, value
from linkwright.xmltree import Element

_AXES = ("linear-x", "linear-y", "linear-z")
KINDS = ("random", "uniform", "grid", *_AXES)
"""The values of ``<type>`` in a ``<distribution>``."""
_MAX_MODELS = 100_000
"""The maximum number of models in one population."""
_GOLDEN_ANGLE = pi * (3 - sqrt(5))
"""The angle in radians between consecutive points of a spiral that fills a disc evenly."""


@dataclass(frozen=True, slots=True)
class Distribution:
    """The distribution of models.

    `rows`, `columns` and `step` (in meters) apply only to a grid.
    """

    type: str = "random"
    rows: int = 1
    columns: int = 1
    step: Vector3 = (0.5, 0.5, 0.0)


@dataclass(frozen=True, slots=True)
class Population:
    """A model and the distribution of its copies.

    Attributes:
        pose: the pose of the center of the box or grid, or of the center of the cylinder's base.
        models: the repeated model; only the first is used.
        count: the number of copies, unless the copies form a grid.
        box: the box that contains the copies; None if there is no box.
        cylinder: the cylinder that contains the copies; None if there is no cylinder.
    """

    name: str
    pose: RawPose = AT_ORIGIN
    models: tuple[Model, ...] = ()
    count: int = 1
    distribution: Distribution = Distribution()
    box: Box | None = None
    cylinder: Cylinder | None = None
    element: Element | None = field(default=None, compare=False, repr=False)


def generate_models(population: Population) -> Iterator[Model]:
    """Yield the models of a population, named ``NAME_clone_0``, ``NAME_clone_1`` and so on.

    As in Gazebo, a population without a box or cylinder has no models unless it is a grid.
    """
    if not population.models:
        return
    model = population.models[0]
    origin = population.pose.pose
    corner = [
        coordinate - offset for coordinate, offset in zip(origin.xyz, _offset_from_corner(population), strict=True)
    ]
    rotation = pose_quaternion(origin)
    for index, position in enumerate(_generate_positions(population)):
        x, y, z = (
            corner_coordinate + position_coordinate
            for corner_coordinate, position_coordinate in zip(corner, rotate(rotation, position), strict=True)
        )
        yield replace(model, name=f"{model.name}_clone_{index}", pose=RawPose(Pose((x, y, z))))


def _offset_from_corner(population: Population) -> Vector3:
    """Return the offset in meters from the first corner of a volume to its pose.

    Gazebo does not rotate this offset.
    """
    distribution = population.distribution
    if distribution.type == "grid":
        x, y, _ = distribution.step
        return x * (distribution.columns - 1) / 2, y * (distribution.rows - 1) / 2, 0.0
    if population.box is None:
        return 0.0, 0.0, 0.0
    x, y, z = population.box.size
    return x / 2, y / 2, z / 2


def _generate_positions(population: Population) -> Iterator[Vector3]:
    distribution, count = population.distribution, min(population.count, _MAX_MODELS)
    generator = Random(population.name)  # noqa: S311 - the same numbers at each start, on purpose
    if distribution.type == "grid":
        x, y, _ = distribution.step
        for index in range(min(distribution.rows * distribution.columns, _MAX_MODELS)):
            row, column = divmod(index, distribution.columns)
            yield column * x, row * y, 0.0
    elif population.box is not None:
        yield from _generate_positions_in_box(distribution.type, count, population.box, generator)
    elif population.cylinder is not None and distribution.type not in _AXES:
        yield from _generate_positions_in_cylinder(distribution.type, count, population.cylinder, generator)


def _generate_positions_in_box(kind: str, count: int, box: Box, generator: Random) -> Iterator[Vector3]:
    x, y, z = box.size
    columns = max(1, round(sqrt(count * x / y))) if x > 0 and y > 0 else 1
    rows = -(-count // columns)
    for index in range(count):
        if kind == "random":
            yield generator.uniform(0, x), generator.uniform(0, y), generator.uniform(0, z)
        elif kind == "uniform":
            row, column = divmod(index, columns)
            yield (column + 0.5) * x / columns, (row + 0.5) * y / rows, generator.uniform(0, z)
        else:
            position = [x / 2, y / 2, z / 2]
            axis_index = _AXES.index(kind)
            position[axis_index] = box.size[axis_index] * index / count
            yield position[0], position[1], position[2]


def _generate_positions_in_cylinder(kind: str, count: int, cylinder: Cylinder, generator: Random) -> Iterator[Vector3]:
    for index in range(count):
        if kind == "random":
            angle, radius = generator.uniform(0, 2 * pi), generator.uniform(0, cylinder.radius)
        else:
            angle, radius = index * _GOLDEN_ANGLE, cylinder.radius * sqrt((index + 0.5) / count)
        yield radius * cos(angle), radius * sin(angle), generator.uniform(0, cylinder.length)


POPULATION = ElementRule(
    "population",
    "copies of a model, distributed over a volume",
    (name_of(),),
    (
        POSE,
        MODEL,
        value("model_count", INTEGER, "the number of copies, unless they form a grid", default="1", field="count"),
        object_rule(
            Distribution,
            "distribution",
            "the distribution of the copies",
            value("type", choice(*KINDS), "the kind of distribution", default="random"),
            value("rows", INTEGER, "the rows of a grid", default="1"),
            value("cols", INTEGER, "the columns of a grid", default="1", field="columns"),
            value("step", VECTOR3, "the spacing of a grid", "m", default="0.5 0.5 0"),
            default=Distribution(),
        ),
        object_rule(
            Box,
            "box",
            "the box that contains the copies",
            value("size", VECTOR3, "the edge lengths along x, y, z", "m", default="1 1 1"),
        ),
        object_rule(
            Cylinder,
            "cylinder",
            "the cylinder that contains the copies, from its base upwards",
            value("radius", NUMBER, "the radius", "m", default="1"),
            value("length", NUMBER, "the length along z", "m", default="1"),
        ),
    ),
    is_repeated=True,
    make=Population,
    keeps_element=True,
    passes_element=True,
    field="populations",
)
