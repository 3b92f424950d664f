"""Finds the pairs of links whose collisions need no checks, as MoveIt's Setup Assistant does.

Source: ``compute_default_collisions`` of ``moveit_setup_srdf_plugins``. The samples are the same in each run.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Collection, Iterable, Mapping
from dataclasses import dataclass
from itertools import combinations

import numpy as np

from linkwright.geometry.arrays import Array
from linkwright.planning.collision_scene import AllowedCollisions, CollisionScene
from linkwright.planning.robot_model import Shapes
from linkwright.planning.setup.bodies import find_bodies
from linkwright.planning.setup.contact_search import ContactSearch
from linkwright.planning.setup.link_surfaces import LinkSurfaces
from linkwright.planning.setup.position_sampler import PositionSampler
from linkwright.urdf import Robot, parent_joints

LinkPair = tuple[str, str]
"""Two links in alphabetical order."""

ADJACENT, DEFAULT, ALWAYS, NEVER = "Adjacent", "Default", "Always", "Never"
REASONS = (ADJACENT, DEFAULT, ALWAYS, NEVER)
"""The reasons for which collisions of two links are not checked, in the order in which they are looked for."""

_ALWAYS_SAMPLES = 200
_ALWAYS_SHARE = 0.95
_DEFAULT_SHARE = 0.5
_SAMPLES = 10_000
_MESH_SAMPLES = 20
_TOUCH_M = 0.001
"""The distance in m at which links of a closed gripper touch."""
_SEED = 0


@dataclass(frozen=True, slots=True)
class CollisionPairs:
    """The pairs of links with collision shapes.

    Attributes:
        disabled: the reasons of the pairs whose collisions are not checked.
        checked: the number of all other pairs.
    """

    disabled: Mapping[LinkPair, str]
    checked: int

    def allowed(self) -> AllowedCollisions:
        """Return the disabled pairs as pairs that may collide."""
        return AllowedCollisions({frozenset(pair): True for pair in self.disabled})


@dataclass(frozen=True, slots=True, eq=False)
class ClosedGripper:
    """A gripper in its closed state, in which its links may touch.

    Attributes:
        links: the links of the gripper.
        positions: the positions of all joints of the robot, shape (joints,).
    """

    links: frozenset[str]
    positions: Array


def link_pair(links: Iterable[str]) -> LinkPair:
    """Return two links in alphabetical order."""
    first, second = sorted(links)
    return first, second


def find_collision_pairs(
    robot: Robot,
    shapes: Shapes,
    surfaces: LinkSurfaces,
    grippers: Collection[ClosedGripper] = (),
    samples: int = _SAMPLES,
) -> CollisionPairs:
    """Return the pairs of links whose collisions need no checks.

    Links are adjacent if joints connect one below the other, also through links without shapes. Of the others, those
    are left out that collide in the default positions, in 95 % of 200 random positions, or in none of many random
    positions and in none that a search finds. Where the convex hulls of meshes collide, the meshes decide.

    Unlike the Setup Assistant, links that collide in the default positions are left out only if they also collide in
    half of the random positions, or belong to the same gripper. Otherwise a robot whose hand reaches its forearm in the
    default positions would never be kept from it. Links of a gripper that touch when it is closed are left out as well.

    Args:
        robot: the robot.
        shapes: the collision shapes of its links.
        surfaces: the surfaces of its links.
        grippers: the grippers in their closed states.
        samples: the number of random positions.
    """
    sampler, random = PositionSampler(robot), np.random.default_rng(_SEED)
    finder = _PairFinder(robot, shapes, surfaces, sampler, random)
    seen = finder.disable_default(grippers)
    seen.update(finder.disable_always())
    seen.update(finder.count_collisions(samples))
    finder.disable_never(seen)
    links = finder.links
    checked = len(links) * (len(links) - 1) // 2 - len(finder.disabled)
    return CollisionPairs(dict(sorted(finder.disabled.items())), checked)


class _PairFinder:
    """The steps of the search, in their order.

    Attributes:
        disabled: the pairs that have been found, with their reasons.
    """

    def __init__(
        self,
        robot: Robot,
        shapes: Shapes,
        surfaces: LinkSurfaces,
        sampler: PositionSampler,
        random: np.random.Generator,
    ) -> None:
        self._robot, self._shapes, self._surfaces, self._sampler, self._random = (
            robot,
            shapes,
            surfaces,
            sampler,
            random,
        )
        self.links = [name for name in robot.links if shapes.get(name)]
        self.disabled = dict.fromkeys(_adjacent_pairs(robot, set(self.links)), ADJACENT)
        self._search = ContactSearch(robot, shapes, sampler)
        self._fixed = set(_pairs_of_bodies(robot, shapes, self.disabled))

    def disable_default(self, grippers: Collection[ClosedGripper]) -> set[LinkPair]:
        """Disable pairs that collide in the default positions, and those that do not move but touch.

        Links of a gripper that touch in its closed state are disabled, too.

        Args:
            grippers: the grippers in their closed states.

        Returns:
            The pairs that collide in the default positions.
        """
        positions = self._sampler.default()
        touching = {link_pair(pair) for pair in self._scene().colliding_pairs(positions)}
        self._search.model.move(positions)
        fixed = [pair for pair in self._fixed if self._search.distance(*pair) < 0.0]
        counts = self.count_collisions(_ALWAYS_SAMPLES) if touching else Counter()
        often = [
            pair
            for pair in touching
            if counts[pair] >= _DEFAULT_SHARE * _ALWAYS_SAMPLES
            or any(gripper.links.issuperset(pair) for gripper in grippers)
        ]
        self._search.model.move(positions)
        meshes = [pair for pair in (*fixed, *often) if self._surfaces.touch(*pair, self._search.model)]
        self.disabled.update(dict.fromkeys(meshes, DEFAULT))
        for gripper in grippers:
            self._disable_closed(gripper)
        return touching

    def _disable_closed(self, gripper: ClosedGripper) -> None:
        self._search.model.move(gripper.positions)
        links = [name for name in self.links if name in gripper.links]
        for pair in map(link_pair, combinations(links, 2)):
            if pair in self.disabled:
                continue
            distance = self._search.distance(*pair)
            if abs(distance) < _TOUCH_M or (distance < 0.0 and self._surfaces.touch(*pair, self._search.model)):
                self.disabled[pair] = DEFAULT

    def disable_always(self) -> Counter[LinkPair]:
        """Disable the pairs that nearly always collide.

        Pairs of links whose convex hulls nearly always collide but whose meshes never do are disabled as well, as
        pairs that never collide.

        Returns:
            The number of collisions of the remaining pairs.
        """
        while True:
            counts = self.count_collisions(_ALWAYS_SAMPLES)
            always = [pair for pair, count in counts.items() if count >= _ALWAYS_SHARE * _ALWAYS_SAMPLES]
            if not always:
                return counts
            collided = self._count_mesh_collisions(always)
            self.disabled.update({pair: ALWAYS if collided[pair] else NEVER for pair in always})

    def disable_never(self, seen: Collection[LinkPair]) -> None:
        """Disable the pairs that never collide.

        Args:
            seen: the pairs that collided in random positions.
        """
        for pair in map(link_pair, combinations(self.links, 2)):
            if pair in self.disabled or pair in seen:
                continue
            if pair in self._fixed or not self._search.can_touch(*pair, self._random):
                self.disabled[pair] = NEVER

    def count_collisions(self, samples: int) -> Counter[LinkPair]:
        """Return in how many random positions pairs of links collide that are not disabled."""
        scene = self._scene()
        counts: Counter[LinkPair] = Counter()
        for _ in range(samples):
            counts.update(map(link_pair, scene.colliding_pairs(self._sampler.sample(self._random))))
        return counts

    def _count_mesh_collisions(self, pairs: Collection[LinkPair]) -> Counter[LinkPair]:
        """Return in how many of some random positions the meshes of links collide."""
        counts: Counter[LinkPair] = Counter()
        for _ in range(_MESH_SAMPLES):
            self._search.model.move(self._sampler.sample(self._random))
            counts.update(pair for pair in pairs if self._surfaces.touch(*pair, self._search.model))
        return counts

    def _scene(self) -> CollisionScene:
        allowed = AllowedCollisions({frozenset(pair): True for pair in self.disabled})
        return CollisionScene(self._robot, self._shapes, (), allowed)


def _adjacent_pairs(robot: Robot, links: set[str]) -> list[LinkPair]:
    """Return each link with the next link above it that has shapes."""
    parents = parent_joints(robot)
    pairs = []
    for link in robot.links:
        above = parents[link].parent if link in parents else ""
        while above not in links and above in parents:
            above = parents[above].parent
        if link in links and above in links:
            pairs.append(link_pair((link, above)))
    return pairs


def _pairs_of_bodies(robot: Robot, shapes: Shapes, known: Mapping[LinkPair, str]) -> list[LinkPair]:
    """Return the pairs of links that do not move relative to each other, without those that are known."""
    pairs = (
        link_pair(pair)
        for body in find_bodies(robot)
        for pair in combinations([link for link in body.links if shapes.get(link)], 2)
    )
    return [pair for pair in pairs if pair not in known]
