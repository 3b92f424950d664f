"""Walking actors and roads, which are visible but have no contacts."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any, TypeVar

import numpy as np

from linkwright.diagnostics import LinkwrightError
from linkwright.geometry.single import IDENTITY, Transform, Vector3, compose
from linkwright.sdf.actors import Actor
from linkwright.sdf.figures import actor_model, road_model
from linkwright.sdf.frames import FrameError, Frames, PlacedLink, links_of
from linkwright.sdf.models import Model
from linkwright.sdf.walking import Walk
from linkwright.sdf.worlds import World
from linkwright.simulation.scene.bodies import BodyWriter
from linkwright.simulation.scene.meshes import MeshLibrary
from linkwright.simulation.scene.shapes import set_pose
from linkwright.simulation.scene.structure import Structure
from linkwright.xmltree import Element
from linkwright.xmltree.reader import parse_file

T = TypeVar("T", Actor, Model)
_OF_GZ = ("gz-sim", "ignition-gazebo")
"""Prefixes of the names of gz's libraries."""
_INVERSE = "INV_BIND_MATRIX"
_NUMBERS_OF_A_MATRIX = 16
_FLAT = 1e-12
"""A matrix whose determinant is not greater cannot be inverted."""


@dataclass(slots=True)
class Figure:
    """An actor or a road of a scene.

    Attributes:
        model: the model that determines the appearance.
        pose: the pose of the model at time 0.
        walk: the path of an actor; None for a static figure.
        origin: the pose in the world of the frame in which the points of `walk` are given.
        links: the links of the model, placed in the frame of the model.
    """

    model: Model
    pose: Transform
    walk: Walk | None
    origin: Transform
    links: tuple[PlacedLink, ...]

    def pose_at(self, seconds: float) -> Transform:
        """Return the pose in the world at a simulated time in s."""
        return self.pose if self.walk is None else compose(self.origin, self.walk.pose(seconds))


def figures_of(world: World, meshes: MeshLibrary) -> list[Figure]:
    """Return the actors and roads of a world.

    Actors that cannot be placed are left out; `check` reports them. In a world for gz, the points of walks are in the
    frame of the actor; in a world for Gazebo classic, they are in the frame of the world.

    Args:
        world: the world, with its includes resolved.
        meshes: the library of meshes, which finds skins.
    """
    relative = any(library in plugin.filename for plugin in world.plugins for library in _OF_GZ)
    frames, found = Frames(world), []
    taken = {model.name for model in world.models}
    for actor in world.actors:
        actor = _with_free_name(actor, taken)
        try:
            pose = frames.placed(actor.pose)
            model = actor_model(actor, _skin_origin(actor, meshes))
            links = tuple(links_of(model, Frames(model), IDENTITY, actor.name))
        except FrameError:
            continue
        walk = Walk(actor.script)
        origin = pose if relative else IDENTITY
        begin = compose(origin, walk.pose(0.0)) if walk.has_waypoints else pose
        found.append(Figure(model, begin, walk if walk.has_waypoints else None, origin, links))
    for road in world.roads:
        model = _with_free_name(road_model(road), taken)
        links = tuple(links_of(model, Frames(model), IDENTITY, model.name))
        found.append(Figure(model, IDENTITY, None, IDENTITY, links))
    return found


def _with_free_name(item: T, taken: set[str]) -> T:
    """Return an actor or road under a name that is not in `taken`, and add the name to `taken`."""
    while item.name in taken:
        item = replace(item, name=f"{item.name}~")
    taken.add(item.name)
    return item


def draw(figure: Figure, spec: Any, writer: BodyWriter) -> None:
    """Add the links of a figure to a MuJoCo specification, as bodies without contacts or dynamics."""
    for placed in figure.links:
        body = spec.worldbody.add_body(name=placed.name, mocap=figure.walk is not None)
        set_pose(body, compose(figure.pose, placed.pose))
        body.explicitinertial, body.ipos = True, [0.0, 0.0, 0.0]
        writer.add_visuals(body, placed.link, placed.frames, fixed=True)


def move_actors(figures: Iterable[Figure], model: Any, data: Any, seconds: float) -> None:
    """Set the poses of actors in MuJoCo's data for a simulated time in s."""
    for figure in figures:
        if figure.walk is None:
            continue
        pose = figure.pose_at(seconds)
        for placed in figure.links:
            _put(int(model.body(placed.name).mocapid[0]), compose(pose, placed.pose), data)


def set_kinematic_poses(structure: Structure, moved: Transform, model: Any, data: Any) -> bool:
    """Set the poses of a model's kinematic links in MuJoCo's data; return whether there are any.

    Args:
        structure: the links of the model.
        moved: the transform from the initial frame of the links to the new one.
        model: MuJoCo's model.
        data: MuJoCo's data.
    """
    links = [held.link for held in structure.links]
    driven = {int(model.body(link.name).mocapid[0]): link for link in links}
    driven.pop(-1, None)
    for place, link in driven.items():
        _put(place, compose(moved, link.pose), data)
    return bool(driven)


def _put(place: int, pose: Transform, data: Any) -> None:
    x, y, z, qx, qy, qz, qw = pose
    data.mocap_pos[place] = x, y, z
    data.mocap_quat[place] = qw, qx, qy, qz


def _skin_origin(actor: Actor, meshes: MeshLibrary) -> Vector3 | None:
    """Return the origin of a skin's skeleton in m; None if the mesh file is missing.

    The origin is zero if there is no skeleton.
    """
    if actor.skin is None:
        return (0.0, 0.0, 0.0)
    path = meshes.file(actor.skin.filename, actor.element)
    if path is None:
        return None
    return skeleton_origin(path) if path.suffix.lower() == ".dae" else (0.0, 0.0, 0.0)


def skeleton_origin(path: Path) -> Vector3:
    """Return the origin of the first joint of a COLLADA file's skeleton, in its bind pose, in m.

    The origin is zero if the file has no usable skeleton.
    """
    try:
        root = parse_file(path).root
    except LinkwrightError:
        return (0.0, 0.0, 0.0)
    skin = next((element for element in root.walk() if element.tag == "skin"), None)
    matrix = None if skin is None else _first_matrix(skin)
    if matrix is None:
        return (0.0, 0.0, 0.0)
    unit = next((element for element in root.walk() if element.tag == "unit"), None)
    scale = float(unit.attributes.get("meter", "1")) if unit is not None else 1.0
    x, y, z = (np.linalg.inv(matrix)[:3, 3] * scale).tolist()
    return x, y, z


def _first_matrix(skin: Element) -> Any:
    """Return the first invertible bind matrix of a skeleton; None if there is none."""
    named = (
        element.attributes.get("source", "")
        for element in skin.walk()
        if element.attributes.get("semantic") == _INVERSE
    )
    wanted = next(named, "").removeprefix("#")
    source = next((element for element in skin.elements("source") if element.attributes.get("id") == wanted), None)
    array = None if source is None else source.first("float_array")
    try:
        numbers = [float(item) for item in array.text().split()[:_NUMBERS_OF_A_MATRIX]] if array is not None else []
    except ValueError:
        return None
    if len(numbers) < _NUMBERS_OF_A_MATRIX or not np.isfinite(numbers).all():
        return None
    matrix = np.array(numbers).reshape(4, 4)
    return matrix if abs(np.linalg.det(matrix)) > _FLAT else None
