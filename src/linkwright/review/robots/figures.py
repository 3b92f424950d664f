"""Compare quantities of a whole robot."""

from __future__ import annotations

import zlib
from collections.abc import Callable, Hashable, Iterable, Iterator, Mapping
from functools import cached_property, partial

import numpy as np
from numpy.typing import NDArray

from linkwright.descriptions.pairs import Model
from linkwright.diagnostics import LinkwrightError, Phrase, phrase
from linkwright.geometry.mass import MassProperties, combine
from linkwright.geometry.shapes import Box, Capsule, Placement, SimpleShape, Sphere, placement
from linkwright.inertia.mesh_library import MeshLibrary
from linkwright.kinematics import KinematicTree
from linkwright.review.changes import Figure
from linkwright.review.frames import to_matrix
from linkwright.review.quantities import compare_quantity, compare_size
from linkwright.review.robots.reach import Chain, compare_reaches, have_equal_distances
from linkwright.urdf import Collision, Link, Mesh, Robot, Visual
from linkwright.xmltree import Element

_REACH_SAMPLES = 2_000
_MIN_CHAIN_JOINTS = 3
"""The minimum number of moving joints of a chain whose reach is compared."""
_MAX_CHAINS = 4
"""The maximum number of chains whose reach is compared. The fingers of a hand would fill the report."""
_MAX_CONTINUOUS_RAD = np.pi
"""The largest sampled position of a continuous joint in rad, on both sides of zero."""

Array = NDArray[np.float64]


def compare_figures(old: RobotMeasures, new: RobotMeasures) -> Iterator[Figure]:
    """Yield the quantities that differ between two robots."""
    for name, unit, measure in _QUANTITIES:
        yield from compare_quantity(name, unit, measure(old), measure(new))
    if old.visuals_key is None or old.visuals_key != new.visuals_key:
        yield from compare_size(old.size, new.size)
    if old.meshes_key is None or old.meshes_key != new.meshes_key:
        yield from _compare_mesh_files(old.mesh_files, new.mesh_files)
    old_chains, new_chains = old.chains(), new.chains()
    common = [link for link in new_chains if link in old_chains]
    if common:
        samples = old.sample_positions(_REACH_SAMPLES), new.sample_positions(_REACH_SAMPLES)
        for link in common:
            if have_equal_distances(old_chains[link], new_chains[link], samples[0]):
                continue
            reach = compare_reaches(old_chains[link], new_chains[link], *samples)
            yield from compare_quantity(phrase("reach of '{link}'", link=link), "m", *reach)


def _compare_mesh_files(old: tuple[int, int] | None, new: tuple[int, int] | None) -> Iterator[Figure]:
    """Yield the numbers of triangles and of bytes that differ."""
    if old is not None and new is not None:
        yield from compare_quantity(phrase("triangles of the meshes"), "", old[0], new[0])
        yield from compare_quantity(phrase("bytes of the meshes"), "", old[1], new[1])


class RobotMeasures:
    """The quantities of a whole robot.

    All joints are at the initial positions of joint_state_publisher.

    Args:
        robot: the robot with its links and joints.
        model: the description of the robot.
        root: the frame of the root link in the frame of the figures.
        frames: the frames of the links in the frame of the figures.
        old_joints: the old names of renamed joints, by new name.

    Attributes:
        robot: the robot with its links and joints.
        meshes: the meshes of the robot.
        frames: the frames of the links, shape (4, 4) each.
        link_names: the links in the order of the frames of `sample_frames`.
    """

    def __init__(
        self,
        robot: Robot,
        model: Model,
        root: Placement,
        frames: Mapping[str, Placement],
        old_joints: Mapping[str, str] | None = None,
    ) -> None:
        self.robot = robot
        self._old_joints = old_joints or {}
        self._root = to_matrix(root)
        self.frames = {name: to_matrix(frame) for name, frame in frames.items()}
        self.meshes = MeshLibrary(model.finder, model.path.parent)
        self._tree = KinematicTree(robot)
        self.link_names = self._tree.link_names

    @cached_property
    def mass_properties(self) -> MassProperties:
        """The mass properties of the whole robot in the frame of the figures."""
        parts = []
        for name, frame in self.frames.items():
            inertial = self.robot.links[name].inertial
            if inertial is not None and inertial.has_mass:
                own = inertial.properties
                rotation = frame[:3, :3]
                center = rotation @ own.center + frame[:3, 3]
                parts.append(MassProperties(own.mass, center, rotation @ own.inertia @ rotation.T))
        return combine(parts)

    @cached_property
    def visuals_key(self) -> tuple[Hashable, ...] | None:
        """A key that is equal for robots of the same size, without reading the triangles of meshes.

        The result is None if the triangles must be read.
        """
        keys: list[Hashable] = []
        for name, frame in self.frames.items():
            for visual in self.robot.links[name].visuals:
                geometry: Hashable = visual.geometry
                if isinstance(visual.geometry, Mesh):
                    content = self.meshes.find_content_key(visual.geometry.filename, visual.element)
                    if content is None:
                        return None
                    geometry = content, visual.geometry.scale
                keys.append((frame.tobytes(), visual.origin, geometry))
        return tuple(keys)

    @cached_property
    def size(self) -> Array | None:
        """The lengths of the box around all visuals in m, shape (3,).

        The result is None if a mesh cannot be read, or if there are no visuals.
        """
        if not self._has_files(shape for name in self.frames for shape in self.robot.links[name].visuals):
            return None  # before the other meshes are read
        boxes = []
        for name, frame in self.frames.items():
            for visual in self.robot.links[name].visuals:
                box = self._compute_bounds(visual, frame)
                if box is None:
                    return None
                boxes.append(box)
        if not boxes:
            return None
        edges: Array = np.max([box[1] for box in boxes], axis=0) - np.min([box[0] for box in boxes], axis=0)
        return edges

    @cached_property
    def mesh_files(self) -> tuple[int, int] | None:
        """The number of triangles and of bytes of all mesh files, or None if a mesh cannot be read."""
        if not self._has_files(shape for link in self.robot.links.values() for shape in _list_shapes(link)):
            return None
        triangles = size = 0
        try:
            for uri, element in self._mesh_elements.items():
                path = self.meshes.locate(uri, element)
                triangles += self.meshes.read(path).count
                size += path.stat().st_size
        except (LinkwrightError, OSError):
            return None
        return triangles, size

    @cached_property
    def meshes_key(self) -> tuple[Hashable, ...] | None:
        """A key that is equal for robots with the same `mesh_files`, without reading the triangles.

        The result is None if the triangles must be read.
        """
        keys = [self.meshes.find_content_key(uri, element) for uri, element in self._mesh_elements.items()]
        return None if None in keys else tuple(keys)

    @cached_property
    def _mesh_elements(self) -> dict[str, Element | None]:
        """The last visual or collision with each mesh file, by the URI of the file."""
        elements: dict[str, Element | None] = {}
        for link in self.robot.links.values():
            for shape in _list_shapes(link):
                if isinstance(shape.geometry, Mesh):
                    elements[shape.geometry.filename] = shape.element
        return elements

    def _has_files(self, shapes: Iterable[Visual | Collision]) -> bool:
        """Return whether all meshes among some shapes are files that exist."""
        meshes = ((shape.geometry, shape.element) for shape in shapes)
        try:
            return all(
                self.meshes.locate(mesh.filename, element).is_file()
                for mesh, element in meshes
                if isinstance(mesh, Mesh)
            )
        except (LinkwrightError, OSError):
            return False

    def chains(self) -> dict[str, Chain]:
        """Return the chains of several moving joints, by the name of their last link."""
        low, high = self._limits
        names = self._tree.joint_names
        turns = [self.robot.joints[name].type != "prismatic" for name in names]
        chains = {}
        for link, joints in self._find_chain_ends().items():
            moving = [index for index, name in enumerate(names) if name in joints]
            chains[link] = Chain(
                names, moving, turns, low, high, partial(self._compute_distances, self._tree.link_index(link))
            )
        return chains

    def _compute_distances(self, link: int, positions: Array) -> Array:
        """Return the distances of a link from the origin of the figures in m, shape (count,)."""
        distances: Array = np.linalg.norm(self.compute_frames(positions)[:, link, :3, 3], axis=-1)
        return distances

    def compute_frames(self, positions: Array) -> Array:
        """Return the frames of the links in the frame of the figures.

        Args:
            positions: the positions of the joints in rad or m, shape (count, joints).

        Returns:
            Homogeneous matrices, shape (count, links, 4, 4).
        """
        frames: Array = self._root @ self._tree.forward(positions)
        return frames

    def sample_frames(self, count: int) -> Array:
        """Return the frames of the links at the positions of `sample_positions`.

        Args:
            count: the number of configurations.

        Returns:
            Homogeneous matrices, shape (count, links, 4, 4).
        """
        return self.compute_frames(self.sample_positions(count))

    def sample_positions(self, count: int) -> Array:
        """Return random positions within the limits.

        They depend only on the old names and the limits of the joints.

        Returns:
            Positions in rad or m, shape (count, joints).
        """
        low, high = self._limits
        names = self._tree.joint_names
        samples = np.zeros((count, len(names)))
        for index, name in enumerate(names):
            seed = zlib.crc32(self._old_joints.get(name, name).encode())
            samples[:, index] = np.random.default_rng(seed).random(count)
        positions: Array = low + samples * (high - low)
        return positions

    def _find_chain_ends(self) -> dict[str, set[str]]:
        """Return the joints that move the end of each chain, by the last link of the chain."""
        joints_by_child = {joint.child: joint for joint in self.robot.joints.values()}
        parents = {joint.parent for joint in self.robot.joints.values()}
        farthest: dict[str, tuple[int, str, set[str]]] = {}
        for link in self._tree.link_names:
            if link in parents:
                continue
            chain = []
            name = link
            while name in joints_by_child:
                joint = joints_by_child[name]
                chain.append(joint)
                name = joint.parent
            moving = [joint.name for joint in chain if joint.name in self._tree.joint_names]
            if len(moving) >= _MIN_CHAIN_JOINTS and (moving[0] not in farthest or farthest[moving[0]][0] < len(chain)):
                leaders = {joint.mimic.joint for joint in chain if joint.mimic is not None}
                farthest[moving[0]] = len(chain), link, leaders.union(moving)
        return {link: joints for _, link, joints in list(farthest.values())[:_MAX_CHAINS]}

    @cached_property
    def _limits(self) -> tuple[Array, Array]:
        """The limits of the joints in rad or m, shape (joints,) each."""
        low, high = np.full((2, len(self._tree.joint_names)), _MAX_CONTINUOUS_RAD) * np.array([[-1.0], [1.0]])
        for index, name in enumerate(self._tree.joint_names):
            joint = self.robot.joints[name]
            if joint.limit is not None and joint.type != "continuous":
                low[index], high[index] = sorted((joint.limit.lower, joint.limit.upper))
        return low, high

    def _compute_bounds(self, visual: Visual, link_frame: Array) -> tuple[Array, Array] | None:
        """Return the corners of the box around a visual, in the frame of the figures.

        Each has the shape (3,).
        """
        pose = placement(visual.origin)
        rotation = link_frame[:3, :3] @ np.array(pose.rotation)
        center = link_frame[:3, :3] @ np.array(pose.position) + link_frame[:3, 3]
        if isinstance(visual.geometry, Mesh):
            try:
                mesh = self.meshes.load(visual.geometry, visual.element)
            except LinkwrightError:
                return None
            if not mesh.count:
                return center, center
            points = mesh.used_vertices @ rotation.T + center
            return points.min(axis=0), points.max(axis=0)
        half = _compute_half_lengths(visual.geometry, rotation)
        return center - half, center + half


def _list_shapes(link: Link) -> tuple[Visual | Collision, ...]:
    return (*link.visuals, *link.collisions)


def _compute_half_lengths(shape: SimpleShape, rotation: Array) -> Array:
    """Return half the lengths of the box around a rotated shape in m, shape (3,)."""
    if isinstance(shape, Box):
        half: Array = np.abs(rotation) @ np.array(shape.size) / 2.0
        return half
    if isinstance(shape, Sphere):
        return np.full(3, shape.radius)
    along = np.abs(rotation[:, 2]) * shape.length / 2.0
    across = 1.0 if isinstance(shape, Capsule) else np.sqrt(np.maximum(0.0, 1.0 - rotation[:, 2] ** 2))
    return np.asarray(along + shape.radius * across)


def _count_moving_joints(measures: RobotMeasures) -> int:
    return sum(joint.type != "fixed" for joint in measures.robot.joints.values())


def _compute_principal_moments(measures: RobotMeasures) -> Array | None:
    properties = measures.mass_properties
    return properties.principal().moments if properties.mass > 0 else None


def _get_center_of_mass(measures: RobotMeasures) -> Array | None:
    properties = measures.mass_properties
    return properties.center if properties.mass > 0 else None


_QUANTITIES: tuple[tuple[Phrase, str, Callable[[RobotMeasures], object]], ...] = (
    (phrase("links"), "", lambda measures: len(measures.robot.links)),
    (phrase("joints"), "", lambda measures: len(measures.robot.joints)),
    (phrase("moving joints"), "", _count_moving_joints),
    (phrase("mass"), "kg", lambda measures: measures.mass_properties.mass),
    (phrase("center of mass"), "m", _get_center_of_mass),
    (phrase("principal moments of inertia"), "kg m2", _compute_principal_moments),
)
"""The quantities that need no meshes: their names, their units, and the functions that measure them."""
