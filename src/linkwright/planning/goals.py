"""Goals of a plan: positions of joints, or a region for the pose of a link."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field

import numpy as np

from linkwright.geometry.arrays import (
    Array,
    compose,
    invert,
    quaternion_from_rpy,
    quaternion_inverse,
    quaternion_multiply,
    rotate,
)
from linkwright.geometry.shapes import Box, Capsule, Cylinder, Sphere
from linkwright.geometry.single import rpy_from_quaternion
from linkwright.kinematics.tree import MimicRelation
from linkwright.planning.effort import ATTEMPT_S, elapsed_s, spend
from linkwright.planning.groups import JointGroup
from linkwright.planning.inverse_kinematics import ChainSolver
from linkwright.planning.robot_model import PlacedShape, RobotModel

_MAX_GOALS = 6
"""The maximum number of configurations in which a planner may end."""
_MAX_REPEATS = 20
"""The number of attempts in a row without a new configuration after which the search ends; many arms have few."""
_REPEATS_PER_FAILURE = 5
"""How many repeats an attempt counts that finds nothing, because it takes longer."""
_DISTINCT = 0.05
"""The distance between two configurations, in rad or m over all joints, above which they count as different."""


_TOLERANCE = 1e-3
"""How far a joint may be outside of its target, in rad or m."""


class ContradictionError(ValueError):
    """Raised when the targets of a joint and of one that mimics it cannot both be reached."""

    def __init__(self, name: str, leader: str) -> None:
        super().__init__(f"the constraints of '{name}' contradict those of other joints that move with '{leader}'")


@dataclass(frozen=True, slots=True)
class JointTarget:
    """The position of a joint in rad or m, with the tolerance in both directions."""

    position: float
    above: float = 0.0
    below: float = 0.0

    def for_leader(self, relation: MimicRelation) -> JointTarget:
        """Return the target of the joint that this joint mimics."""
        above, below = self.above / abs(relation.factor), self.below / abs(relation.factor)
        position = (self.position - relation.offset) / relation.factor
        return JointTarget(position, *((above, below) if relation.factor > 0.0 else (below, above)))

    def intersect(self, other: JointTarget) -> JointTarget | None:
        """Return the target that fulfills both, or None if there is none."""
        low = max(self.position - self.below, other.position - other.below)
        high = min(self.position + self.above, other.position + other.above)
        if low - high > _TOLERANCE:
            return None
        low, high = min(low, high), max(low, high)
        position = min(max(self.position, low), high)
        return JointTarget(position, high - position, position - low)


@dataclass(frozen=True, slots=True, eq=False)
class LinkTarget:
    """The region in which a point of a link must be, and the orientation of the link.

    Poses are in the frame of the root link.

    Attributes:
        regions: the volumes for the point; empty if any position is acceptable.
        offset: the point in the frame of the link in m, shape (3,).
        orientation: the quaternion of the link, shape (4,), or None if any orientation is acceptable.
        tolerances: the maximum rotations about x, y and z of the target orientation in rad, shape (3,).
    """

    link: str
    regions: Sequence[PlacedShape] = ()
    offset: Array = field(default_factory=lambda: np.zeros(3))
    orientation: Array | None = None
    tolerances: Array = field(default_factory=lambda: np.zeros(3))

    def sample(self, random: np.random.Generator | None, current: Array) -> Array:
        """Return a pose of the link that fulfills the target.

        Args:
            random: the source of random numbers; None for the middle of the region and the exact orientation.
            current: the current pose of the link, shape (7,), for what the target leaves free.
        """
        quaternion = current[3:] if self.orientation is None else self.orientation
        if random is not None:
            spread = self.tolerances if self.orientation is not None else np.full(3, np.pi)
            turn = quaternion_from_rpy(random.uniform(-np.minimum(spread, np.pi), np.minimum(spread, np.pi)))
            quaternion = quaternion_multiply(quaternion, turn)
        if not self.regions:
            return np.concatenate((current[:3], quaternion))
        region = self.regions[0 if random is None else int(random.integers(len(self.regions)))]
        point = region.pose[:3] if random is None else _sample_point(region, random)
        return np.concatenate((point - rotate(quaternion, self.offset), quaternion))

    def is_met(self, pose: Array) -> bool:
        """Return whether a pose of the link fulfills the target."""
        if self.regions:
            point = pose[:3] + rotate(pose[3:], self.offset)
            if not any(_contains(region, point) for region in self.regions):
                return False
        if self.orientation is None:
            return True
        turn = quaternion_multiply(quaternion_inverse(self.orientation), pose[3:])
        angles = np.abs(rpy_from_quaternion(tuple(turn.tolist())))
        return bool(np.all(angles <= self.tolerances + 1e-3))


@dataclass(frozen=True, slots=True, eq=False)
class Goal:
    """The conditions at the end of a path, or along it.

    Attributes:
        joints: the targets of joints, by name.
        links: the targets of links.
    """

    joints: Mapping[str, JointTarget] = field(default_factory=dict)
    links: Sequence[LinkTarget] = ()

    def follow_leaders(self, relations: Mapping[str, MimicRelation]) -> Goal:
        """Return the goal with targets of the joints that mimic joints follow, instead of those of the mimic joints.

        Args:
            relations: the relations of all moving joints, by name.

        Raises:
            ContradictionError: the targets of two joints cannot both be reached.
        """
        joints: dict[str, JointTarget] = {}
        for name, target in self.joints.items():
            relation = relations.get(name)
            leader = name
            if relation is not None and relation.leader != name and relation.factor:
                leader, target = relation.leader, target.for_leader(relation)
            both = target if leader not in joints else joints[leader].intersect(target)
            if both is None:
                raise ContradictionError(name, leader)
            joints[leader] = both
        return Goal(joints, self.links)

    def find_invalid_number(self) -> str:
        """Return the first joint or link whose target has a number that is not finite, or an empty string."""
        for name, joint in self.joints.items():
            if not np.all(np.isfinite((joint.position, joint.above, joint.below))):
                return name
        for link in self.links:
            rows = [link.offset, link.tolerances, *(region.pose for region in link.regions)]
            if not all(
                np.all(np.isfinite(row)) for row in (*rows, () if link.orientation is None else link.orientation)
            ):
                return link.link
        return ""

    def is_met(self, model: RobotModel, positions: Array) -> bool:
        """Return whether the goal is fulfilled at the positions of all joints; the model is moved."""
        for name, target in self.joints.items():
            position = positions[model.index(name)]
            low, high = target.position - target.below, target.position + target.above
            if not low - _TOLERANCE <= position <= high + _TOLERANCE:
                return False
        if self.links:
            model.move(positions)
        return all(target.is_met(model.link_pose(target.link)) for target in self.links)


def goal_configurations(
    goal: Goal,
    model: RobotModel,
    group: JointGroup,
    start: Array,
    is_valid: Callable[[Array], bool],
    timeout_s: float,
    is_canceled: Callable[[], bool],
    seed: int = 0,
) -> Iterator[Array]:
    """Yield different positions of all joints that fulfill a goal and are valid, at most six.

    Joints without a target stay where they are, unless a link target moves them.

    Args:
        goal: the goal, with targets of joints or of one link.
        model: the robot; it is moved.
        group: the joints to move.
        start: the positions of all joints at the start.
        is_valid: returns whether the positions of all joints are acceptable, such as free of collisions.
        timeout_s: the time after which the search for configurations of a link target ends.
        is_canceled: returns whether the search must stop.
        seed: the seed of the random numbers.
    """
    positions = start.copy()
    for name, joint_target in goal.joints.items():
        positions[model.index(name)] = joint_target.position
    if not goal.links:
        if is_valid(positions):
            yield positions
        return
    target = goal.links[0]
    solver = ChainSolver(model, group, target.link, seed)
    random = np.random.default_rng(seed)
    model.move(start)
    current = model.link_pose(target.link)
    deadline = elapsed_s() + timeout_s
    found: list[Array] = []
    attempt: np.random.Generator | None = None
    origin, repeats = positions, 0
    while len(found) < _MAX_GOALS and repeats < _MAX_REPEATS and not is_canceled():
        if (remaining := deadline - elapsed_s()) <= 0.0:
            return
        pose = target.sample(attempt, current)
        solution = solver.solve(pose, origin, min(remaining, 0.05), is_valid)
        spend(ATTEMPT_S)
        attempt = random if attempt is None else None  # Arms with few joints reach hardly another pose of the region.
        origin = start.copy()
        origin[solver.indexes] = group.sample(random)
        repeats += bool(found) * (1 if solution is not None else _REPEATS_PER_FAILURE)
        if solution is None:
            continue
        solution[solver.indexes] = group.unwind(solution[solver.indexes], start[solver.indexes])
        if any(np.linalg.norm(solution - other) < _DISTINCT for other in found) or not goal.is_met(model, solution):
            continue
        repeats = 0
        found.append(solution)
        yield solution


def _sample_point(region: PlacedShape, random: np.random.Generator) -> Array:
    """Return a random point of a region in the frame of its pose."""
    shape = region.shape
    if isinstance(shape, Box):
        point = random.uniform(-0.5, 0.5, 3) * shape.size
    elif isinstance(shape, Sphere):
        direction = random.normal(size=3)
        point = direction / np.linalg.norm(direction) * shape.radius * random.uniform() ** (1.0 / 3.0)
    else:
        assert isinstance(shape, (Cylinder, Capsule)), "regions are simple shapes"
        angle, radius = random.uniform(0.0, 2.0 * np.pi), shape.radius * np.sqrt(random.uniform())
        height = random.uniform(-0.5, 0.5) * shape.length
        point = np.array((radius * np.cos(angle), radius * np.sin(angle), height))
    return compose(region.pose, np.array((*point, 0.0, 0.0, 0.0, 1.0)))[:3]


def _contains(region: PlacedShape, point: Array, margin: float = 1e-4) -> bool:
    x, y, z = compose(invert(region.pose), np.array((*point, 0.0, 0.0, 0.0, 1.0)))[:3]
    shape = region.shape
    if isinstance(shape, Box):
        return all(abs(value) <= size / 2.0 + margin for value, size in zip((x, y, z), shape.size, strict=True))
    if isinstance(shape, Sphere):
        return bool(np.sqrt(x * x + y * y + z * z) <= shape.radius + margin)
    assert isinstance(shape, (Cylinder, Capsule)), "regions are simple shapes"
    return bool(np.hypot(x, y) <= shape.radius + margin and abs(z) <= shape.length / 2.0 + margin)
