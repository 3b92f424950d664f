"""Find links of a robot that collide only in the new version, with MuJoCo.

Each mesh is replaced by its convex hull, as in simulations. Links that are connected directly by a joint, or only by
fixed joints, are left out, because they touch at their connection.
"""

from __future__ import annotations

from collections.abc import Collection, Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from importlib.util import find_spec
from itertools import chain
from typing import Any

import numpy as np
from numpy.typing import NDArray

from linkwright.descriptions.comparison import Difference
from linkwright.diagnostics import LinkwrightError, Phrase, joined_first, phrase
from linkwright.planning.robot_model import PlacedShape, add_shape
from linkwright.planning.shapes import convert_collision
from linkwright.review.changes import MAX_NAMES, Change
from linkwright.review.robots.figures import RobotMeasures
from linkwright.simulation.library import load_mujoco
from linkwright.urdf import Collision
from linkwright.urdf.bodies import Bodies

_SAMPLES = 300
_MIN_COLLIDING_SAMPLES = 3
"""The minimum number of colliding samples of a reported collision. Small changes affect a few samples."""
_MIN_DEPTH_M = 1e-4
"""The minimum depth in m of a collision. Shapes that only touch do not collide."""

_MAX_LINES = 4
"""The maximum number of pairs that have a line each."""

Array = NDArray[np.float64]
Pair = tuple[str, str]


def may_change_collisions(differences: Iterable[Difference]) -> bool:
    """Return whether differences can change collisions.

    These are differences in shapes, poses of links, and limits of joints.
    """
    return any(
        difference.kind != "renamed"
        and (
            difference.subject == "joint"
            or (difference.subject == "link" and (not difference.property or difference.property.startswith("coll")))
        )
        for difference in differences
    )


def compare_collisions(
    old: RobotMeasures, new: RobotMeasures, links: Mapping[str, str], disabled: Collection[frozenset[str]]
) -> Iterator[Change]:
    """Yield the pairs of links that collide only in the new version.

    Nothing is yielded without MuJoCo (extra ``sim``) or for links that the old version lacks.

    Args:
        old: the robot of the old version.
        new: the robot of the new version.
        links: the new names of the links that both robots have, by old name.
        disabled: the pairs of links whose collisions do not count, such as the disabled pairs of SRDF.
    """
    if find_spec("mujoco") is None or not any(link.collisions for link in new.robot.links.values()):
        return
    try:
        old_model, new_model = _CollisionModel(old), _CollisionModel(new)
        counts_before, new_counts = old_model.count_collisions(), new_model.count_collisions()
    except ValueError:
        return
    old_counts = {frozenset(links.get(name, "") for name in pair): counts for pair, counts in counts_before.items()}
    known = {new_name for name, new_name in links.items() if name not in old_model.unreadable}
    found = []
    for pair, (is_home, count) in new_counts.items():
        was_home, old_count = old_counts.get(frozenset(pair), (False, 0))
        if not known.issuperset(pair) or frozenset(pair) in disabled:
            continue
        if is_home and not was_home:
            found.append(_NewCollision(pair, 1.0, is_home))
        elif count >= _MIN_COLLIDING_SAMPLES and not old_count and not was_home:
            found.append(_NewCollision(pair, count / _SAMPLES, is_home))
    yield from _make_changes(found)


@dataclass(frozen=True)
class _NewCollision:
    """Two links that collide only in the new version.

    Attributes:
        pair: the names of the links.
        share: the share of the configurations in which they collide.
        is_home: whether they collide at home.
    """

    pair: Pair
    share: float
    is_home: bool

    @property
    def change(self) -> Change:
        """The change in a line of its own."""
        first, second = self.pair
        if self.is_home:
            return Change(phrase("links '{first}' and '{second}' collide at home", first=first, second=second))
        return Change(
            phrase(
                "links '{first}' and '{second}' can collide: in {share:.2g} % of {total} configurations, "
                "in none before",
                first=first,
                second=second,
                share=100.0 * self.share,
                total=_SAMPLES,
            )
        )

    @property
    def item(self) -> Phrase:
        """The links and how often they collide, in a list."""
        values: dict[str, object] = {"first": self.pair[0], "second": self.pair[1]}
        if self.is_home:
            return phrase("'{first}' and '{second}' (at home)", **values)
        return phrase("'{first}' and '{second}' ({share:.2g} %)", **values, share=100.0 * self.share)


def _make_changes(found: Sequence[_NewCollision]) -> Iterator[Change]:
    """Yield the changes about links that newly collide, many of them in one line, the most frequent first."""
    if len(found) <= _MAX_LINES:
        yield from (collision.change for collision in found)
        return
    ordered = sorted(found, key=lambda collision: (collision.is_home, collision.share), reverse=True)
    yield Change(
        phrase(
            "{count} pairs of links newly collide in {total} configurations: {pairs}",
            count=len(found),
            total=_SAMPLES,
            pairs=joined_first([collision.item for collision in ordered], MAX_NAMES),
        )
    )


class _CollisionModel:
    """A model of MuJoCo in which each link with collisions is a free body.

    Attributes:
        model: the model, or None if fewer than two links have shapes that can be used.
        unreadable: the links with a mesh that cannot be read. Their collisions are unknown.

    Raises:
        ValueError: MuJoCo refuses a shape.
    """

    def __init__(self, measures: RobotMeasures) -> None:
        self._mujoco = mujoco = load_mujoco()
        self._links: list[str] = []
        self.unreadable: set[str] = set()
        self._measures = measures
        spec = mujoco.MjSpec()
        for name in measures.link_names:
            self._add_link(spec, name)
        self.model: Any = spec.compile() if len(self._links) > 1 else None
        if self.model is not None:
            self._data = mujoco.MjData(self.model)
            self._indexes = [measures.link_names.index(name) for name in self._links]
            self._ignored = _find_connected_pairs(measures)

    def count_collisions(self) -> dict[Pair, tuple[bool, int]]:
        """Return whether each colliding pair collides at home, and in how many configurations."""
        if self.model is None:
            return {}
        home = np.array([self._measures.frames[name] for name in self._measures.link_names])
        at_home = self.find_colliding_pairs(home)
        counts: dict[Pair, int] = dict.fromkeys(at_home, 0)
        for frames in self._measures.sample_frames(_SAMPLES):
            for pair in self.find_colliding_pairs(frames):
                counts[pair] = counts.get(pair, 0) + 1
        return {pair: (pair in at_home, count) for pair, count in sorted(counts.items())}

    def find_colliding_pairs(self, frames: Array) -> set[Pair]:
        """Return the pairs of links that collide.

        Args:
            frames: the frames of all links, shape (links, 4, 4).
        """
        positions = self._data.qpos.reshape(-1, 7)
        positions[:, :3] = frames[self._indexes, :3, 3]
        rotations = frames[self._indexes, :3, :3].reshape(-1, 9)
        for position, rotation in zip(positions, rotations, strict=True):
            self._mujoco.mju_mat2Quat(position[3:], rotation)
        self._mujoco.mj_kinematics(self.model, self._data)
        self._mujoco.mj_collision(self.model, self._data)
        contact = self._data.contact
        deep = contact.geom[contact.dist < -_MIN_DEPTH_M]
        bodies = self.model.geom_bodyid[deep].reshape(-1, 2) - 1
        pairs = {(self._links[min(pair)], self._links[max(pair)]) for pair in bodies.tolist()}
        return pairs - self._ignored

    def _add_link(self, spec: Any, name: str) -> None:
        collisions = self._measures.robot.links[name].collisions
        shapes = [shape for collision in collisions if (shape := self._read_shape(name, collision)) is not None]
        if not shapes:
            return
        body = spec.worldbody.add_body(mass=1.0, inertia=[1.0, 1.0, 1.0], explicitinertial=True)
        for shape in shapes:
            add_shape(spec, body, shape)
        body.add_freejoint()
        self._links.append(name)

    def _read_shape(self, link: str, collision: Collision) -> PlacedShape | None:
        """Return a collision shape, or None if it has no volume or its mesh cannot be read."""
        try:
            return convert_collision(collision, self._measures.meshes)
        except LinkwrightError:
            self.unreadable.add(link)
            return None


def _find_connected_pairs(measures: RobotMeasures) -> set[Pair]:
    """Return the pairs of links in the same rigid body, or in bodies that a joint connects."""
    bodies = Bodies(measures.robot)
    order = {name: index for index, name in enumerate(measures.link_names)}
    pairs: set[Pair] = set()
    for body in bodies.all:
        parent = bodies.of(body.joint.parent) if body.joint is not None else None
        group = [name for name in chain(body.links, parent.links if parent is not None else ()) if name in order]
        for first in body.links:
            for second in group:
                if first in order and first != second:
                    low, high = sorted((first, second), key=order.__getitem__)
                    pairs.add((low, high))
    return pairs
