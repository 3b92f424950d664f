"""Actors and roads: visible models without contacts, except for actors with ``libActorCollisionsPlugin.so``."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any, TypeVar

import numpy as np

from linkwright.diagnostics import LinkwrightError
from linkwright.geometry.single import IDENTITY, Transform, Vector3, compose
from linkwright.sdf.actors import Actor
from linkwright.sdf.figures import ACTOR_WALK_LIBRARY, make_actor_model, make_road_model
from linkwright.sdf.frames import FrameError, Frames, PlacedLink, place_links
from linkwright.sdf.models import Model
from linkwright.sdf.plugins import library_name
from linkwright.sdf.walking import Walk
from linkwright.sdf.worlds import World
from linkwright.simulation.scene.bodies import BodyWriter
from linkwright.simulation.scene.meshes import MeshLibrary
from linkwright.simulation.scene.shapes import set_pose
from linkwright.simulation.scene.structure import KinematicTrees
from linkwright.xmltree import Element
from linkwright.xmltree.reader import parse_file

T = TypeVar("T", Actor, Model)
ACTOR_PERIOD_NS = 10_000_000
"""The time in nanoseconds between two poses of an actor that collides."""
_GZ_LIBRARIES = ("gz-sim", "ignition-gazebo")
"""Strings that the file names of gz's plugins contain."""
_BIND_MATRIX_SEMANTIC = "INV_BIND_MATRIX"
_MATRIX_SIZE = 16
_MIN_DETERMINANT = 1e-12
"""The determinant up to which a matrix counts as not invertible."""


@dataclass(slots=True)
class Figure:
    """An actor or a road of a scene.

    Attributes:
        model: the model with the visuals of the figure.
        pose: the pose of the model in the world at time 0.
        walk: the walk of an actor; None for a static figure.
        origin: the pose in the world of the frame to which the points of `walk` refer.
        links: the links of the model, with poses in the frame of the model.
        is_steered: whether a plugin moves the figure.
        steered_pose: the pose in the world that the plugin has set; None before that.
    """

    model: Model
    pose: Transform
    walk: Walk | None
    origin: Transform
    links: tuple[PlacedLink, ...]
    is_steered: bool = False
    steered_pose: Transform | None = None

    @property
    def moves(self) -> bool:
        """Whether the figure walks, or a plugin moves it."""
        return self.walk is not None or self.is_steered

    @property
    def walks_into_bodies(self) -> bool:
        """Whether the figure moves, and collides."""
        return self.moves and any(link.collisions for link in self.model.links)

    def pose_at(self, seconds: float) -> Transform:
        """Return the pose in the world at a simulated time in s."""
        if self.steered_pose is not None:
            return self.steered_pose
        return self.pose if self.walk is None else compose(self.origin, self.walk.pose(seconds))


def create_figures(world: World, meshes: MeshLibrary) -> list[Figure]:
    """Return the actors and roads of a world.

    Actors whose pose is not defined are left out; `check` reports them. The waypoints of an actor are in the frame of
    the actor in a world for gz, and in the frame of the world in a world for Gazebo classic.

    Args:
        world: the world, with its includes resolved.
        meshes: the library of meshes, which finds the files of skins.
    """
    is_gz_world = any(library in plugin.filename for plugin in world.plugins for library in _GZ_LIBRARIES)
    frames, figures = Frames(world), []
    used_names = {model.name for model in world.models}
    for actor in world.actors:
        actor = _choose_free_name(actor, used_names)
        try:
            pose = frames.placed(actor.pose)
            model = make_actor_model(actor, _find_skin_origin(actor, meshes))
            links = tuple(place_links(model, Frames(model), IDENTITY, actor.name))
        except FrameError:
            continue
        walk = Walk(actor.script)
        origin = pose if is_gz_world else IDENTITY
        initial_pose = compose(origin, walk.pose(0.0)) if walk.has_waypoints else pose
        is_steered = any(library_name(plugin.filename) == ACTOR_WALK_LIBRARY for plugin in actor.plugins)
        figures.append(Figure(model, initial_pose, walk if walk.has_waypoints else None, origin, links, is_steered))
    for road in world.roads:
        model = _choose_free_name(make_road_model(road), used_names)
        links = tuple(place_links(model, Frames(model), IDENTITY, model.name))
        figures.append(Figure(model, IDENTITY, None, IDENTITY, links))
    return figures


def _choose_free_name(item: T, used_names: set[str]) -> T:
    """Return an actor or road with an unused name, and add this name to the used names."""
    while item.name in used_names:
        item = replace(item, name=f"{item.name}~")
    used_names.add(item.name)
    return item


def add_figure(figure: Figure, spec: Any, writer: BodyWriter) -> None:
    """Add the links of a figure to a MuJoCo specification.

    The links become bodies without dynamics. Only actors that collide have contacts.
    """
    for placed_link in figure.links:
        body = spec.worldbody.add_body(name=placed_link.name, mocap=figure.moves)
        set_pose(body, compose(figure.pose, placed_link.pose))
        body.explicitinertial, body.ipos = True, [0.0, 0.0, 0.0]
        writer.add_visuals(body, placed_link.link, placed_link.frames, fixed=True)
        writer.add_collisions(body, placed_link.link, placed_link.frames, fixed=True)


def move_actors(figures: Iterable[Figure], model: Any, data: Any, seconds: float) -> None:
    """Set the poses of actors in MuJoCo's data for a simulated time in s."""
    for figure in figures:
        if not figure.moves:
            continue
        pose = figure.pose_at(seconds)
        for placed_link in figure.links:
            _set_mocap_pose(int(model.body(placed_link.name).mocapid[0]), compose(pose, placed_link.pose), data)


def set_kinematic_poses(structure: KinematicTrees, displacement: Transform, model: Any, data: Any) -> bool:
    """Set the poses of a model's kinematic links in MuJoCo's data.

    Returns whether the model has such links.

    Args:
        structure: the links of the model.
        displacement: the transform in the world that moves the model from its initial pose to its new pose.
        model: MuJoCo's model.
        data: MuJoCo's data.
    """
    links = [tree_link.link for tree_link in structure.links]
    kinematic_links = {int(model.body(link.name).mocapid[0]): link for link in links}
    kinematic_links.pop(-1, None)
    for mocap_index, link in kinematic_links.items():
        _set_mocap_pose(mocap_index, compose(displacement, link.pose), data)
    return bool(kinematic_links)


def _set_mocap_pose(mocap_index: int, pose: Transform, data: Any) -> None:
    x, y, z, qx, qy, qz, qw = pose
    data.mocap_pos[mocap_index] = x, y, z
    data.mocap_quat[mocap_index] = qw, qx, qy, qz


def _find_skin_origin(actor: Actor, meshes: MeshLibrary) -> Vector3 | None:
    """Return the origin, in m, of the skeleton of an actor's skin.

    Returns None if the mesh file is missing.

    The origin is zero if the actor has no skin, or the skin has no skeleton.
    """
    if actor.skin is None:
        return (0.0, 0.0, 0.0)
    path = meshes.file(actor.skin.filename, actor.element)
    if path is None:
        return None
    return read_skeleton_origin(path) if path.suffix.lower() == ".dae" else (0.0, 0.0, 0.0)


def read_skeleton_origin(path: Path) -> Vector3:
    """Return the origin in m of the first joint of a COLLADA skeleton, in its bind pose.

    The origin is zero if the file has no usable skeleton.
    """
    try:
        root = parse_file(path).root
    except LinkwrightError:
        return (0.0, 0.0, 0.0)
    skin = next((element for element in root.walk() if element.tag == "skin"), None)
    matrix = None if skin is None else _read_first_matrix(skin)
    if matrix is None:
        return (0.0, 0.0, 0.0)
    unit = next((element for element in root.walk() if element.tag == "unit"), None)
    scale = float(unit.attributes.get("meter", "1")) if unit is not None else 1.0
    x, y, z = (np.linalg.inv(matrix)[:3, 3] * scale).tolist()
    return x, y, z


def _read_first_matrix(skin: Element) -> Any:
    """Return the first inverse bind matrix of a skin, or None if there is no usable one."""
    source_references = (
        element.attributes.get("source", "")
        for element in skin.walk()
        if element.attributes.get("semantic") == _BIND_MATRIX_SEMANTIC
    )
    source_id = next(source_references, "").removeprefix("#")
    source = next((element for element in skin.elements("source") if element.attributes.get("id") == source_id), None)
    array = None if source is None else source.first("float_array")
    try:
        numbers = [float(token) for token in array.text().split()[:_MATRIX_SIZE]] if array is not None else []
    except ValueError:
        return None
    if len(numbers) < _MATRIX_SIZE or not np.isfinite(numbers).all():
        return None
    matrix = np.array(numbers).reshape(4, 4)
    return matrix if abs(np.linalg.det(matrix)) > _MIN_DETERMINANT else None
