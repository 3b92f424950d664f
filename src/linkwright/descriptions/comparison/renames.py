"""Links and joints that were renamed and have other changes, too.

Several facts about an old and a new link indicate a rename: the same shapes, the same parent, the same children, the
same joint, the same inertial, names with the same words, or the prefix that all other renamed links newly have. Each
fact has a weight. A pair is accepted if its sum is high enough, and higher than that of any other pair with one of the
two links. A missed rename costs two lines in a report, but a false rename hides that a part was removed.
"""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Callable, Hashable, Iterable, Iterator, Mapping, Sequence

from linkwright.descriptions.comparison.facts import Block, collision_blocks, visual_blocks
from linkwright.descriptions.comparison.matching import WORLD
from linkwright.loading.deferred import lazy_pattern
from linkwright.loading.lean_dataclasses import dataclass
from linkwright.urdf import Collision, Joint, Link, Mesh, Robot, Visual, children_of, parent_joints

SameInertial = Callable[[Link, Link], bool]

Key = tuple[str, Hashable]
"""A kind of fact, and its value."""

_WEIGHTS = {"mesh": 2, "words": 3, "joint": 3, "children": 3, "prefix": 3}
_SHAPES, _INERTIAL, _PARENT = 1, 1, 1
_MIN_WEIGHT = 4
"""The minimum sum of weights for a rename. No single fact is sufficient."""
_MIN_PREFIXED = 3
"""The minimum number of renamed links that have the same new prefix, if all renamed ones have it."""
_MAX_CANDIDATES = 40
"""The maximum number of links that share a fact, such as a mesh. A fact of more links is ignored."""
_MAX_PASSES = 20
_WORD = lazy_pattern(r"[a-z]+|\d+")
_CAMEL_CASE_BOUNDARY = lazy_pattern(r"(?<=[a-z0-9])(?=[A-Z])")
_GENERAL_WORDS = frozenset({"frame", "joint", "link"})
_SIDES = frozenset({"left", "right", "front", "rear", "back", "upper", "lower", "top", "bottom", "inner", "outer"})
_CORNERS = frozenset({"fl", "fr", "rl", "rr", "bl", "br", "lf", "rf", "lr", "lh", "rh"})
"""Words that distinguish equal parts. Numbers and single letters also distinguish them."""


@dataclass(slots=True)
class _Side:
    """The unmatched links of one robot, with their neighbors and properties.

    Attributes:
        robot: the old or the new robot.
        names: the names of the links without a match.
        parents: the parent joint of each link.
        children: the child joints of each link.
        shapes: the shapes of each link without a match; see `_make_shape_key`.
    """

    robot: Robot
    names: dict[str, None]
    parents: Mapping[str, Joint]
    children: Mapping[str, Sequence[Joint]]
    shapes: dict[str, Hashable]

    @classmethod
    def of(cls, robot: Robot, matched: Mapping[str, str], normalize: Callable[[str], str]) -> _Side:
        names = [name for name in robot.links if name not in matched and name != WORLD]
        shapes = {name: _make_shape_key(robot.links[name], normalize) for name in names}
        return cls(robot, dict.fromkeys(names), parent_joints(robot), children_of(robot), shapes)

    def own_keys(self, name: str) -> Iterator[Key]:
        """Yield the distinctive facts of a link: its meshes and the words of its name."""
        link = self.robot.links[name]
        shapes: tuple[Visual | Collision, ...] = (*link.visuals, *link.collisions)
        if any(isinstance(shape.geometry, Mesh) for shape in shapes):
            yield "mesh", self.shapes[name]
        words = tuple(_split_words(name))
        if words:
            yield "words", words


class RenameSearch:
    """The search for renamed links and joints, which adds its results to the matches.

    Args:
        old: the old robot.
        new: the new robot.
        links: the new names of matched links, by old name.
        joints: the new names of matched joints, by old name.
        normalize_old: the function that makes texts of the old description comparable.
        normalize_new: the function that makes texts of the new description comparable.
        same_inertial: a function that returns whether both links have equal mass properties.
    """

    def __init__(
        self,
        old: Robot,
        new: Robot,
        links: dict[str, str],
        joints: dict[str, str],
        normalize_old: Callable[[str], str],
        normalize_new: Callable[[str], str],
        same_inertial: SameInertial,
    ) -> None:
        self._links, self._joints = links, joints
        self._old = _Side.of(old, links, normalize_old)
        self._new = _Side.of(new, dict.fromkeys(links.values(), ""), normalize_new)
        self._same_inertial = same_inertial
        self._prefix = ""

    def run(self) -> None:
        """Match links until no more matches are found, and then the joints between matched links."""
        for _ in range(_MAX_PASSES):
            self._prefix = self._find_prefix()
            pairs = list(self._find_unambiguous_pairs()) if self._old.names and self._new.names else []
            for old_name, new_name in pairs:
                self._links[old_name] = new_name
                del self._old.names[old_name], self._new.names[new_name]
            if not pairs:
                break
        self._match_joints()

    def _match_joints(self) -> None:
        """Match the renamed joints of the same type that attach the same link, also to another parent."""
        matched = set(self._joints.values())
        for joint in self._old.robot.joints.values():
            if joint.name in self._joints or self._old.parents.get(joint.child) is not joint:
                continue
            other = self._new.parents.get(self._links.get(joint.child, ""))
            if other is not None and other.name not in matched and joint.type == other.type:
                self._joints[joint.name] = other.name

    # --- pairs of links -----------------------------------------------------------------------------------------

    def _find_unambiguous_pairs(self) -> Iterator[tuple[str, str]]:
        """Yield the pairs with a higher sum than any other pair with one of the two links."""
        sums = {pair: self._sum_weights(*pair) for pair in self._find_candidates()}
        by_link: dict[tuple[bool, str], list[int]] = defaultdict(list)
        for (old_name, new_name), value in sums.items():
            by_link[True, old_name].append(value)
            by_link[False, new_name].append(value)
        for (old_name, new_name), value in sums.items():
            others = (by_link[True, old_name], by_link[False, new_name])
            if value >= _MIN_WEIGHT and all(max(values) == value and values.count(value) == 1 for values in others):
                yield old_name, new_name

    def _find_candidates(self) -> Mapping[tuple[str, str], None]:
        """Return the pairs of links that share a fact of high weight."""
        old_names = _index_by_key(self._old.names, self._old_keys)
        new_names = _index_by_key(self._new.names, self._new_keys)
        return {
            (old_name, new_name): None
            for key, names in old_names.items()
            if len(names) <= _MAX_CANDIDATES and len(new_names.get(key, ())) <= _MAX_CANDIDATES
            for old_name in names
            for new_name in new_names.get(key, ())
        }

    def _find_prefix(self) -> str:
        """The prefix that all renamed links newly have; empty if there is none."""
        renamed = [(name, new_name) for name, new_name in self._links.items() if name != new_name]
        prefixes = {new_name[: -len(name)] if new_name.endswith(name) else "" for name, new_name in renamed}
        return prefixes.pop() if len(renamed) >= _MIN_PREFIXED and len(prefixes) == 1 else ""

    def _old_keys(self, name: str) -> Iterator[Key]:
        yield from self._old.own_keys(name)
        if self._prefix:
            yield "prefix", self._prefix + name
        joint = self._old.parents.get(name)
        if joint is not None and joint.name in self._joints:
            yield "joint", self._joints[joint.name]
        children = frozenset(
            self._links[joint.child] for joint in self._old.children[name] if joint.child in self._links
        )
        if children:
            yield "children", children

    def _new_keys(self, name: str) -> Iterator[Key]:
        yield from self._new.own_keys(name)
        yield "prefix", name
        joint = self._new.parents.get(name)
        if joint is not None:
            yield "joint", joint.name
        children = frozenset(joint.child for joint in self._new.children[name] if joint.child not in self._new.names)
        if children:
            yield "children", children

    def _sum_weights(self, old_name: str, new_name: str) -> int:
        """Return the sum of the weights of the facts for a rename, or 0 if a fact excludes it."""
        common = set(self._old_keys(old_name)) & set(self._new_keys(new_name))
        kinds = {kind for kind, _ in common}
        old_joint, new_joint = self._old.parents.get(old_name), self._new.parents.get(new_name)
        has_same_shapes = self._old.shapes[old_name] == self._new.shapes[new_name]
        if (old_joint is None) != (new_joint is None) or not (has_same_shapes or kinds & {"words", "prefix"}):
            return 0
        if not kinds & {"joint", "prefix"} and _are_different_sides(old_name, new_name):
            return 0
        is_below_same = True
        if old_joint is not None and new_joint is not None:
            if old_joint.type != new_joint.type:
                return 0
            is_below_same = self._links.get(old_joint.parent) == new_joint.parent
        old_link, new_link = self._old.robot.links[old_name], self._new.robot.links[new_name]
        return (
            sum(_WEIGHTS[kind] for kind in kinds)
            + (_SHAPES if has_same_shapes and self._old.shapes[old_name] else 0)
            + (_PARENT if is_below_same else 0)
            + (_INERTIAL if self._same_inertial(old_link, new_link) else 0)
        )


def _index_by_key(names: Iterable[str], keys_of: Callable[[str], Iterator[Key]]) -> dict[Key, list[str]]:
    """Return the link names by their keys."""
    names_by_key: dict[Key, list[str]] = defaultdict(list)
    for name in names:
        for key in keys_of(name):
            names_by_key[key].append(name)
    return names_by_key


def _make_shape_key(link: Link, normalize: Callable[[str], str]) -> Hashable:
    """Return a key that is equal for links with the same shapes.

    Poses and colors are ignored.
    """
    blocks: list[Block] = [*visual_blocks(link), *collision_blocks(link)]
    facts = ((block.name, block.facts["geometry"]) for block in blocks)
    return tuple(
        sorted((tag, normalize(fact.words), tuple(f"{number:.6g}" for number in fact.numbers)) for tag, fact in facts)
    )


def _are_different_sides(old_name: str, new_name: str) -> bool:
    """Return whether two names differ in their numbers or side words.

    Such names denote two similar parts.
    """
    old_sides, new_sides = (
        sorted(word for word in _split_words(name) if word in _SIDES | _CORNERS or word.isdigit() or len(word) == 1)
        for name in (old_name, new_name)
    )
    return bool(old_sides and new_sides) and old_sides != new_sides


def _split_words(name: str) -> list[str]:
    """Return the words and numbers of a name in lower case, sorted, without general words."""
    parts = (part for word in _CAMEL_CASE_BOUNDARY.sub("_", name).lower().split("_") for part in _WORD.findall(word))
    return sorted(part for part in parts if part not in _GENERAL_WORDS)
