"""Forward kinematics of all links of a robot.

Links joined by fixed joints move as one. So only moving joints matter: each carries a body, whose own frame is at the
joint with z along the joint's axis. Then a joint rotates its body about z or translates it along z, whatever its axis:

    body in root = parent body in root * mount * rotation or translation
    link in root = body in root * offset

There are two ways to compute link frames. For one configuration the overhead of array operations dominates, so frames
are composed along paths that double in length with each step. For many configurations memory access dominates: the last
axis counts the configurations, the tree is computed level by level for a block of them that fits in the cache, and
results are written once.
"""

from __future__ import annotations

from collections.abc import Collection, Mapping, Sequence
from math import prod

import numpy as np
from numpy.typing import ArrayLike, NDArray

from linkwright.diagnostics import Diagnostic, LinkwrightError, Phrase, did_you_mean, phrase, term
from linkwright.geometry.arrays import Array, matrix_from_pose, row_from_pose
from linkwright.loading.lean_dataclasses import dataclass
from linkwright.urdf import Joint, Robot, children_of, parent_joints

Indices = NDArray[np.intp]

_ROTATING_TYPES = ("revolute", "continuous")
MOVING_TYPES = (*_ROTATING_TYPES, "prismatic")


@dataclass(frozen=True, slots=True)
class Layout:
    """The bodies of a robot in the order of their depth, and its links, in arrays.

    Attributes:
        link_names: every link that is connected to the root, parents before children.
        body_joints: the joint of each body except the root's.
        parents: the index of each body's parent body; 0 is the root's body; shape (bodies,).
        depths: the number of moving joints above each body; shape (bodies,).
        slides: whether the body translates instead of rotating; shape (bodies,).
        mounts: the frame of the joint, with its axis along z, in the parent body's frame; shape (bodies, 4, 4).
        link_bodies: the body of each link; shape (links,).
        offsets: the frame of each link in its body's frame; shape (links, 4, 4).
    """

    link_names: tuple[str, ...]
    body_joints: tuple[Joint, ...]
    parents: Indices
    depths: Indices
    slides: NDArray[np.bool_]
    mounts: Array
    link_bodies: Indices
    offsets: Array


def compute_layout(robot: Robot) -> Layout:
    """Return the layout of a robot, without links that are not connected to its root."""
    children, joints_by_child = children_of(robot), parent_joints(robot)
    link_names = [robot.root]
    link_bodies = [0]
    offsets = [np.eye(4)]
    body_joints: list[Joint | None] = [None]
    parents, depths, mounts = [0], [0], [np.eye(4)]
    # A queue ensures that parents are processed before children and, level by level, bodies in the order of their
    # depth.
    index = 0
    while index < len(link_names):
        for joint in children[link_names[index]]:
            if joints_by_child[joint.child] is not joint:
                continue  # Like urdfdom, ignore a second parent.
            body = link_bodies[index]
            to_joint = offsets[index] @ matrix_from_pose(row_from_pose(joint.origin))
            align = _align_z(joint.axis) if joint.type in MOVING_TYPES else None
            if align is None:
                link_bodies.append(body)
                offsets.append(to_joint)
            else:
                link_bodies.append(len(body_joints))
                offsets.append(align.T)
                body_joints.append(joint)
                parents.append(body)
                depths.append(depths[body] + 1)
                mounts.append(to_joint @ align)
            link_names.append(joint.child)
        index += 1
    order = np.argsort(depths, kind="stable")
    new_indexes = np.empty_like(order)
    new_indexes[order] = np.arange(len(order))
    joints = tuple(joint for body in order if (joint := body_joints[body]) is not None)
    return Layout(
        tuple(link_names),
        joints,
        new_indexes[np.array(parents)[order]],
        np.array(depths)[order],
        np.array([False, *(joint.type == "prismatic" for joint in joints)]),
        np.array(mounts)[order],
        new_indexes[np.array(link_bodies)],
        np.array(offsets),
    )


def _align_z(axis: tuple[float, float, float]) -> Array | None:
    """Return a homogeneous matrix that rotates z to the axis, or None for a zero axis."""
    length = np.linalg.norm(axis)
    if not length > 0:
        return None
    z = np.array(axis) / length
    # Any x perpendicular to z works; the coordinate axis farthest from z keeps rotations between coordinate axes exact.
    x = np.cross(np.eye(3)[np.argmin(np.abs(z))], z)
    x /= np.linalg.norm(x)
    matrix = np.eye(4)
    matrix[:3, :3] = np.column_stack((x, np.cross(z, x), z))
    return matrix


@dataclass(frozen=True, slots=True)
class MimicRelation:
    """The relation of a joint to its leader: position = factor * position of `leader` + offset.

    A joint that mimics no other is its own leader.
    """

    leader: str
    factor: float = 1.0
    offset: float = 0.0


def resolve_mimics(robot: Robot, moving_joints: Collection[str]) -> tuple[tuple[str, ...], Mapping[str, MimicRelation]]:
    """Resolve each chain of mimic joints to its end.

    Args:
        robot: the robot.
        moving_joints: the names of the joints that move.

    Returns:
        The moving joints that have their own position, in the order of the file; and the relation of each moving joint
        to its leader, by name. A joint whose chain ends in a cycle or at a joint that does not exist moves
        independently.
    """
    relations: dict[str, MimicRelation] = {}
    for name in robot.joints:
        if name in moving_joints:
            relations[name] = _resolve_mimic(name, robot)
    return tuple(name for name, relation in relations.items() if relation.leader == name), relations


def _resolve_mimic(name: str, robot: Robot) -> MimicRelation:
    leader, factor, offset = name, 1.0, 0.0
    visited = {name}
    while (mimic := robot.joints[leader].mimic) is not None:
        if mimic.joint in visited or mimic.joint not in robot.joints:
            return MimicRelation(name)
        visited.add(mimic.joint)
        leader = mimic.joint
        offset += factor * mimic.offset
        factor *= mimic.multiplier
    return MimicRelation(leader, factor, offset)


_BLOCK_SIZE = 384


class OneConfiguration:
    """The computation of link frames for one configuration."""

    def __init__(self, layout: Layout) -> None:
        count = len(layout.parents)
        mounts = layout.mounts[1:]
        # The frame of a body in its parent is 1 * A + cos(q) * B + sin(q) * C + q * D, entry by entry.
        terms = np.zeros((count - 1, 4, 4, 4))
        is_rotating, is_sliding = ~layout.slides[1:], layout.slides[1:]
        terms[is_rotating, 0, :, 2:] = mounts[is_rotating, :, 2:]
        terms[is_rotating, 1, :, :2] = mounts[is_rotating, :, :2]
        terms[is_rotating, 2, :, 0] = mounts[is_rotating, :, 1]
        terms[is_rotating, 2, :, 1] = -mounts[is_rotating, :, 0]
        terms[is_sliding, 0] = mounts[is_sliding]
        terms[is_sliding, 3, :, 3] = mounts[is_sliding, :, 2]
        self._terms = terms.reshape(count - 1, 4, 16)
        self._jumps = _compute_doubling_jumps(layout.parents, layout.depths)
        self._link_bodies = layout.link_bodies
        self._offsets = layout.offsets

    def compute_frames(self, positions: Array) -> Array:
        """Return the links' frames in the root, shape (links, 4, 4).

        `positions` has shape (bodies - 1,).
        """
        count = len(positions)
        factors = np.empty((4, count))
        factors[0] = 1.0
        np.cos(positions, factors[1])
        np.sin(positions, factors[2])
        factors[3] = positions
        bodies = np.empty((count + 1, 4, 4))
        bodies[0] = _IDENTITY
        np.matmul(factors.T[:, None, :], self._terms, bodies[1:].reshape(count, 1, 16))
        for first_body, ancestors in self._jumps:
            deep_frames = bodies[first_body:]
            deep_frames[...] = bodies.take(ancestors, 0) @ deep_frames
        frames: Array = bodies.take(self._link_bodies, 0) @ self._offsets
        return frames


class ManyConfigurations:
    """The computation of link frames for many configurations."""

    def __init__(self, layout: Layout) -> None:
        self._levels = [_Level(layout, depth) for depth in range(1, int(layout.depths.max()) + 1)]
        self._bodies = len(layout.parents)
        self._link_bodies = layout.link_bodies
        self._offsets_transposed = np.ascontiguousarray(layout.offsets.transpose(0, 2, 1))

    def compute_frames(self, positions: Array) -> Array:
        """Return the links' frames in the root, shape (n, links, 4, 4).

        `positions` has shape (n, bodies - 1).
        """
        count, links = len(positions), len(self._link_bodies)
        frames = np.empty((count, links, 4, 4))
        frames[:, :, 3] = _IDENTITY[3]
        for start in range(0, count, _BLOCK_SIZE):
            block = positions[start : start + _BLOCK_SIZE]
            size = len(block)
            # Axes: body, column, row, configuration. The last row of the matrices is constant and not stored.
            bodies = np.empty((self._bodies, 4, 3, size))
            bodies[0] = _IDENTITY.T[:, :3, None]
            positions_by_joint = np.ascontiguousarray(block.T)
            cosines, sines = np.cos(positions_by_joint), np.sin(positions_by_joint)
            for level in self._levels:
                level.compute(bodies, positions_by_joint, cosines, sines)
            columns = bodies.reshape(self._bodies, 4, 3 * size).take(self._link_bodies, 0)
            columns = self._offsets_transposed @ columns
            frames[start : start + size, :, :3] = columns.reshape(links, 4, 3, size).transpose(3, 0, 2, 1)
        return frames


class _Level:
    """The bodies with the same number of moving joints above them, rotating bodies first."""

    def __init__(self, layout: Layout, depth: int) -> None:
        body_indices = np.flatnonzero(layout.depths == depth)
        self._rotating_bodies = body_indices[~layout.slides[body_indices]]
        self._translating_bodies = body_indices[layout.slides[body_indices]]
        body_indices = np.concatenate((self._rotating_bodies, self._translating_bodies))
        self._body_indices = body_indices
        self._parents = layout.parents[body_indices]
        self._mounts_transposed = np.ascontiguousarray(layout.mounts[body_indices].transpose(0, 2, 1))

    def compute(self, bodies: Array, positions: Array, cosines: Array, sines: Array) -> None:
        count, size = len(self._body_indices), bodies.shape[-1]
        parents = bodies.take(self._parents, 0).reshape(count, 4, 3 * size)
        mounted_frames = (self._mounts_transposed @ parents).reshape(count, 4, 3, size)
        rotating_count = len(self._rotating_bodies)
        if rotating_count:
            joints = self._rotating_bodies - 1
            cosine, sine = cosines[joints, None], sines[joints, None]
            x, y = mounted_frames[:rotating_count, 0], mounted_frames[:rotating_count, 1]
            rotated_x = x * cosine + y * sine
            y *= cosine
            y -= x * sine
            mounted_frames[:rotating_count, 0] = rotated_x
        if rotating_count < count:
            joints = self._translating_bodies - 1
            mounted_frames[rotating_count:, 3] += mounted_frames[rotating_count:, 2] * positions[joints, None]
        bodies[self._body_indices] = mounted_frames


def _compute_doubling_jumps(parents: Indices, depths: Indices) -> list[tuple[int, Indices]]:
    """Return the steps that compose frames along doubling paths.

    Each step consists of the first body that is deep enough, and the ancestors of this and all later bodies. The
    ancestors are 1, 2, 4, ... bodies up, excluding the root's body, whose frame is the identity.
    """
    jumps = []
    jump = parents
    distance = 1
    while distance < depths[-1]:
        first = int(np.searchsorted(depths, distance, side="right"))
        jumps.append((first, jump[first:]))
        jump = jump[jump]
        distance *= 2
    return jumps


_IDENTITY: Array = np.eye(4)


class UnknownNameError(LinkwrightError):
    """Raised for a joint or link that the robot does not have.

    Attributes:
        name: the requested name.
    """

    def __init__(self, code: str, kind: str, name: str, candidates: Sequence[str], hint: Phrase | None = None) -> None:
        self.name = name
        message = phrase("the robot has no {kind} '{name}'", kind=term(kind), name=name)
        super().__init__(Diagnostic(code, message, hint=hint or did_you_mean(name, candidates)))


class KinematicTree:
    """The kinematic tree of a robot, for computing link frames from joint positions.

    Revolute, continuous and prismatic joints move. A mimic joint follows the joint at the end of its chain of mimics;
    if that chain ends in a cycle or at a joint that does not exist, the joint moves independently. A planar joint does
    not move, because robot_state_publisher's kdl_parser treats it as fixed. A floating joint remains at its origin,
    because its transform is published by other nodes. An axis need not have unit length; nothing moves about a zero
    axis. Limits are not applied. Links that are not connected to the root are left out.

    Attributes:
        joint_names: the joints that have a position, in the order of the file; mimic joints have none.
        link_names: the links, parents before children, the root first.
    """

    def __init__(self, robot: Robot) -> None:
        layout = compute_layout(robot)
        moving_joints = {joint.name for joint in layout.body_joints}
        independent_joints, relations = resolve_mimics(robot, moving_joints)
        self.joint_names: tuple[str, ...] = independent_joints
        self.link_names: tuple[str, ...] = layout.link_names
        self._joint_indexes = {name: index for index, name in enumerate(independent_joints)}
        self._link_indexes = {name: link_index for link_index, name in enumerate(layout.link_names)}
        self._relations = relations
        self._types = {joint.name: joint.type for joint in robot.joints.values()}
        names = [joint.name for joint in layout.body_joints]
        leader_indexes = np.array(
            [self._joint_indexes.get(relations[name].leader, -1) for name in names], dtype=np.intp
        )
        self._sources = leader_indexes
        self._factors = np.array([relations[name].factor for name in names])
        self._offsets = np.array([relations[name].offset for name in names])
        self._copies_positions = bool(
            np.all(self._factors == 1) and np.all(self._offsets == 0) and np.all(leader_indexes >= 0) and len(names) > 0
        )
        self._one_configuration = OneConfiguration(layout)
        self._many_configurations = ManyConfigurations(layout)

    def forward(self, positions: ArrayLike | Mapping[str, float]) -> Array:
        """Return the frames of all links in the root link's frame.

        Args:
            positions: in rad or m, shape (joints,) or (..., joints) in the order of `joint_names`; or a mapping from
                names to positions, in which missing joints have position 0.

        Returns:
            Homogeneous matrices, shape (links, 4, 4) or (..., links, 4, 4) in the order of `link_names`, float64.

        Raises:
            ValueError: if the shape is wrong.
            UnknownNameError: if a name in the mapping is not one of `joint_names`.
        """
        if isinstance(positions, Mapping):
            positions = self.positions(positions)
        array = np.asarray(positions, dtype=np.float64)
        count = len(self.joint_names)
        if array.ndim == 0 or array.shape[-1] != count:
            raise ValueError(
                f"positions must have the shape ({count},) or (configurations, {count}), not {array.shape}"
            )
        if array.ndim == 1:
            return self._one_configuration.compute_frames(self._to_body_positions(array))
        shape = array.shape[:-1]
        flat = self._to_body_positions(array.reshape(prod(shape), count))
        return self._many_configurations.compute_frames(flat).reshape(*shape, len(self.link_names), 4, 4)

    def positions(self, positions_by_name: Mapping[str, float], default: float = 0.0) -> Array:
        """Convert positions by joint name to an array in the order of `joint_names`.

        Joints without a given position get the default.

        Raises:
            UnknownNameError: KIN101 if a name is not a joint of the robot, or KIN102 if a joint has no own position.
        """
        positions = np.full(len(self.joint_names), default, dtype=np.float64)
        for name, position in positions_by_name.items():
            index = self._joint_indexes.get(name)
            if index is None:
                raise self._unknown_joint_error(name)
            positions[index] = position
        return positions

    def link_index(self, name: str) -> int:
        """Return the index of a link in `link_names`.

        Raises:
            UnknownNameError: KIN103 if the robot has no such link.
        """
        try:
            return self._link_indexes[name]
        except KeyError:
            raise UnknownNameError("KIN103", "link", name, self.link_names) from None

    def mimic_relation(self, joint: str) -> MimicRelation:
        """Return the relation of a moving joint to the joint that it follows, which is itself if it mimics none."""
        return self._relations[joint]

    def _to_body_positions(self, positions: Array) -> Array:
        """Return the positions of all moving joints, including mimics, of shape (..., bodies - 1)."""
        if self._copies_positions:
            return positions.take(self._sources, axis=-1)
        if not len(self.joint_names):
            positions = np.zeros((*positions.shape[:-1], 1))
        body_positions = positions.take(np.maximum(self._sources, 0), axis=-1)
        body_positions[..., self._sources < 0] = 0.0  # Leaders that do not move stay at 0.
        body_positions *= self._factors
        body_positions += self._offsets
        return body_positions

    def _unknown_joint_error(self, name: str) -> UnknownNameError:
        follower = self._relations.get(name)
        if follower is not None:
            hint = phrase("it mimics '{leader}': give the position of that joint", leader=follower.leader)
            return UnknownNameError("KIN102", "independent joint", name, (), hint)
        if name in self._types and self._types[name] not in MOVING_TYPES:
            hint = phrase("it is {types} and does not move", types=self._types[name])
            return UnknownNameError("KIN102", "independent joint", name, (), hint)
        return UnknownNameError("KIN101", "joint", name, self.joint_names)
