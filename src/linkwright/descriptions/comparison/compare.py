"""The comparison of two descriptions."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping, Sequence
from functools import cached_property
from math import dist, hypot
from pathlib import Path

from linkwright.descriptions.comparison.difference import Difference, DifferenceLocation, Subject, location_of
from linkwright.descriptions.comparison.elements import ElementComparison
from linkwright.descriptions.comparison.facts import (
    MATERIAL,
    Block,
    Fact,
    collision_blocks,
    joint_blocks,
    link_blocks,
    match_blocks,
    nearest,
    visual_blocks,
)
from linkwright.descriptions.comparison.file_contents import content_hash, content_size, has_same_contents
from linkwright.descriptions.comparison.hardware import ROS2_CONTROL, find_renamed_hardware
from linkwright.descriptions.comparison.matching import Matches, match
from linkwright.descriptions.comparison.renames import RenameSearch
from linkwright.diagnostics import LinkwrightError
from linkwright.loading.lean_dataclasses import dataclass, field
from linkwright.loading.lean_typing import TypeVar
from linkwright.urdf import Collision, Joint, Link, Mesh, Robot, Visual
from linkwright.xmltree import Element

_Pair = tuple[Element | None, Element | None]
"""The elements in the old and in the new description, each None if there is none."""
_MIN_DISPLACEMENT = 1e-3
"""The distance above which two origins certainly differ, in m or as a fraction of the distance from the parent."""
_MESH_PREFIX, _SCALE_SUFFIX = "mesh ", " scale"
"""The words around the address of a mesh in the text of a geometry."""
_Part = TypeVar("_Part", Link, Joint)


@dataclass(frozen=True, slots=True)
class Comparison:
    """The differences between two descriptions.

    Attributes:
        differences: the differences of the robot itself, then of links and joints in the order of the new description,
            then of removed links and joints, and finally of the elements that other programs read.
        links: the name in the new description of each matched link, by its name in the old description.
        joints: the name in the new description of each matched joint, by its name in the old description.
    """

    differences: tuple[Difference, ...]
    links: Mapping[str, str]
    joints: Mapping[str, str]


@dataclass(frozen=True)
class Side:
    """One of two compared descriptions.

    Attributes:
        robot: the robot of the description.
        normalize: a function that makes texts comparable, such as paths in a folder that replaces another folder.
        resolve: a function that returns the file of a mesh's URI; with this function, the contents of mesh files are
            compared, too. None to compare only the URIs.
    """

    robot: Robot
    normalize: Callable[[str], str] = field(default=lambda text: text)
    resolve: Callable[[str], Path] | None = None

    def mesh(self, address: str) -> Path | None:
        """Return the file of a mesh's URI, or None if the file is unknown or does not exist."""
        if self.resolve is None:
            return None
        try:
            path = self.resolve(address)
        except LinkwrightError:
            return None
        return path if path.is_file() else None

    def by_contents(self) -> Side:
        """Return this side with the contents of mesh files instead of their names."""
        texts: dict[str, str] = {}

        def contents(text: str) -> str:
            uri = text.removeprefix(_MESH_PREFIX).removesuffix(_SCALE_SUFFIX)
            if not text.startswith(_MESH_PREFIX):
                return self.normalize(text)
            if text not in texts:
                file = self.mesh(uri)
                texts[text] = self.normalize(text) if file is None else text.replace(uri, content_hash(file))
            return texts[text]

        return Side(self.robot, contents, self.resolve)


def compare(old: Side, new: Side) -> Comparison:
    """Return the differences between two descriptions.

    Links and joints are matched by name. An object with a new name is recognized if everything else is equal, or if
    enough of the rest is equal and no other object is as similar. Poses are compared as poses, not as text, with the
    tolerances in `linkwright.descriptions.comparison.facts`. Elements outside the robot model (``<gazebo>``,
    ``<ros2_control>``, sensors) are compared as XML, ignoring white space, comments and the order of attributes.
    """
    return _Comparer(old, new).run()


class _Comparer:
    def __init__(self, old: Side, new: Side) -> None:
        self.old = old
        self.new = new
        self.matches = Matches({}, {})

    def run(self) -> Comparison:
        old, new = self.old.robot, self.new.robot
        links, joints = match(old, new, self._is_same_link, self._is_same_joint)
        normalizers = self.old.normalize, self.new.normalize
        RenameSearch(old, new, links, joints, *normalizers, self._have_same_inertial).run()
        self.matches = Matches(links, joints)
        differences = [
            *self._compare_robot(),
            *self._link_differences(),
            *self._joint_differences(),
            *self._extension_differences(),
        ]
        return Comparison(tuple(differences), self.matches.links, self.matches.joints)

    # --- matching ------------------------------------------------------------------------------------------------

    def _are_equal_blocks(self, old: Block, new: Block) -> bool:
        return old.equals(new, self.old.normalize, self.new.normalize)

    @cached_property
    def _by_contents(self) -> _Comparer:
        """A comparison by the contents of mesh files instead of their names."""
        return _Comparer(self.old.by_contents(), self.new.by_contents())

    def _is_same_link(self, old: Link, new: Link) -> bool:
        return not any(self._by_contents._link_property_differences(old, new))

    def _have_same_inertial(self, old: Link, new: Link) -> bool:
        old_blocks, new_blocks = link_blocks(old), link_blocks(new)
        return bool(old_blocks and new_blocks) and all(map(self._are_equal_blocks, old_blocks, new_blocks))

    def _is_same_joint(self, old: Joint, new: Joint) -> bool:
        if old.type != new.type or dist(old.origin.xyz, new.origin.xyz) > _MIN_DISPLACEMENT * (
            1.0 + hypot(*old.origin.xyz)
        ):
            return False  # Skip the facts of both joints, because a link with many joints has many pairs.
        return all(
            difference.property in ("parent", "child", "mimic joint")
            for difference in self._joint_property_differences(old, new)
        )

    # --- subjects -----------------------------------------------------------------------------------------------

    def _compare_robot(self) -> Iterator[Difference]:
        old, new = self.old.robot, self.new.robot
        if old.name != new.name:
            locations = location_of(old.element, "name"), location_of(new.element, "name")
            yield Difference("robot", new.name, "changed", "name", old.name, new.name, "", *locations)

    def _link_differences(self) -> Iterator[Difference]:
        def inside(old: Link, new: Link) -> Iterator[Difference]:
            comparer = self if old.name == new.name else self._by_contents
            return comparer._link_property_differences(old, new)

        old, new = self.old.robot.links, self.new.robot.links
        yield from _compare_named("link", old, new, self.matches.links, inside)

    def _joint_differences(self) -> Iterator[Difference]:
        def inside(old: Joint, new: Joint) -> Iterator[Difference]:
            yield from (
                difference
                for difference in self._joint_property_differences(old, new)
                if not self._follows_a_name(difference)
            )

        old, new = self.old.robot.joints, self.new.robot.joints
        yield from _compare_named("joint", old, new, self.matches.joints, inside)

    def _extension_differences(self) -> Iterator[Difference]:
        comparison = ElementComparison(self.old.normalize, self.new.normalize, self._find_renamed())
        old, new = list(self.old.robot.extensions), list(self.new.robot.extensions)
        for old_element, new_element in list(find_renamed_hardware(old, new)):
            old.remove(old_element)
            new.remove(new_element)
            old_name, name = (f"{ROS2_CONTROL} {element.attributes['name']}" for element in (old_element, new_element))
            locations = location_of(old_element, "name"), location_of(new_element, "name")
            yield Difference("extension", name, "renamed", "name", old_name, name, "", *locations)
            yield from (
                difference
                for difference in comparison.element_differences(name, "", old_element, new_element)
                if difference.property != "@name"
            )
        yield from comparison.child_differences(old, new)

    def _find_renamed(self) -> dict[str, str]:
        """Return the new names of renamed links and joints, without names that have several new names."""
        links, joints = self.matches.links, self.matches.joints
        pairs = ((name, links.get(name, joints.get(name, name))) for name in (*links, *joints))
        return {old: new for old, new in pairs if old != new and joints.get(old, new) == new}

    def _follows_a_name(self, difference: Difference) -> bool:
        """Return whether a value differs only because it names a renamed link or joint."""
        if difference.property in ("parent", "child"):
            return self.matches.links.get(difference.old or "") == difference.new
        return difference.property == "mimic joint" and self.matches.joints.get(difference.old or "") == difference.new

    def _joint_property_differences(self, old: Joint, new: Joint) -> Iterator[Difference]:
        elements = old.element, new.element
        yield from self._all_block_differences("joint", new.name, joint_blocks(old), joint_blocks(new), elements)

    def _link_property_differences(self, old: Link, new: Link) -> Iterator[Difference]:
        elements = old.element, new.element
        yield from self._all_block_differences("link", new.name, link_blocks(old), link_blocks(new), elements)
        yield from self._shape_differences(new.name, visual_blocks(old), visual_blocks(new), elements)
        yield from self._shape_differences(new.name, collision_blocks(old), collision_blocks(new), elements)
        yield from self._mesh_differences(old, new)

    def _shape_differences(
        self, link: str, old: Sequence[Block], new: Sequence[Block], elements: _Pair
    ) -> Iterator[Difference]:
        for old_index, new_index in match_blocks(old, new, self._are_equal_blocks):
            number = new_index if new_index is not None else old_index or 0
            block = new[number] if new_index is not None else old[number]
            has_several = max(len(old), len(new)) > 1
            name = (
                f"{block.name} '{block.label}'"
                if block.label
                else f"{block.name} {number + 1}"
                if has_several
                else block.name
            )
            old_block = None if old_index is None else old[old_index]
            new_block = None if new_index is None else new[new_index]
            yield from self._compare_block("link", link, name, old_block, new_block, elements)

    def _mesh_differences(self, old: Link, new: Link) -> Iterator[Difference]:
        """Yield the differences of mesh files that have the same URI but different contents."""
        for tag, old_shapes, new_shapes in (
            ("visual", old.visuals, new.visuals),
            ("collision", old.collisions, new.collisions),
        ):
            old_uris = {self.old.normalize(uri): uri for uri in _find_mesh_elements(old_shapes)}
            old_meshes, new_meshes = _find_mesh_elements(old_shapes), _find_mesh_elements(new_shapes)
            for name, new_element in new_meshes.items():
                old_name = old_uris.get(self.new.normalize(name))
                old_file, new_file = None if old_name is None else self.old.mesh(old_name), self.new.mesh(name)
                if old_name and old_file and new_file and not has_same_contents(old_file, new_file):
                    values = _compare_contents(old_file, new_file)
                    locations = location_of(old_meshes[old_name]), location_of(new_element)
                    yield Difference("link", new.name, "changed", f"{tag} mesh {name}", *values, *locations)

    # --- blocks of facts ------------------------------------------------------------------------------------------

    def _all_block_differences(
        self, subject: Subject, name: str, old: Sequence[Block], new: Sequence[Block], elements: _Pair
    ) -> Iterator[Difference]:
        old_blocks, new_blocks = {block.name: block for block in old}, {block.name: block for block in new}
        for block in dict.fromkeys([*new_blocks, *old_blocks]):
            yield from self._compare_block(subject, name, block, old_blocks.get(block), new_blocks.get(block), elements)

    def _compare_block(
        self, subject: Subject, name: str, block: str, old: Block | None, new: Block | None, elements: _Pair
    ) -> Iterator[Difference]:
        if old is None or new is None:
            texts = None if old is None else old.text, None if new is None else new.text
            old_element, new_element = (
                elements[0] if old is None else old.element,
                elements[1] if new is None else new.element,
            )
            yield Difference(
                subject, name, "changed", block, *texts, "", location_of(old_element), location_of(new_element)
            )
            return
        for fact in dict.fromkeys([*new.facts, *old.facts]):
            old_fact, new_fact = old.facts.get(fact), new.facts.get(fact)
            if old_fact and new_fact and old_fact.equals(new_fact, self.old.normalize, self.new.normalize):
                continue
            if fact == MATERIAL and None in (old_fact, new_fact) and old.has_color_of(new):
                continue  # a material with and without a name looks the same
            yield _make_change(subject, name, f"{block} {fact}".strip(), (old_fact, old), (new_fact, new))


def _compare_named(
    subject: Subject,
    old: Mapping[str, _Part],
    new: Mapping[str, _Part],
    matches: Mapping[str, str],
    compare_pair: Callable[[_Part, _Part], Iterator[Difference]],
) -> Iterator[Difference]:
    """Yield the added, renamed, changed and removed links or joints."""
    names = {new_name: old_name for old_name, new_name in matches.items()}
    for name, item in new.items():
        if name not in names:
            yield Difference(subject, name, "added", new_place=location_of(item.element))
            continue
        old_item = old[names[name]]
        if old_item.name != name:
            locations = location_of(old_item.element, "name"), location_of(item.element, "name")
            yield Difference(subject, name, "renamed", "name", old_item.name, name, "", *locations)
        yield from compare_pair(old_item, item)
    for name, item in old.items():
        if name not in matches:
            yield Difference(subject, name, "removed", old_place=location_of(item.element))


def _make_change(
    subject: Subject, name: str, fact: str, old: tuple[Fact | None, Block], new: tuple[Fact | None, Block]
) -> Difference:
    def place(pair: tuple[Fact | None, Block]) -> DifferenceLocation | None:
        compared_fact, block = pair
        return (
            location_of(block.element)
            if compared_fact is None
            else location_of(compared_fact.element, compared_fact.attribute)
        )

    old_fact, new_fact = old[0], new[0]
    present_fact = new_fact or old_fact
    texts = None if old_fact is None else old_fact.text, None if new_fact is None else new_fact.text
    return Difference(
        subject, name, "changed", fact, *texts, present_fact.unit if present_fact else "", place(old), place(new)
    )


def _find_mesh_elements(shapes: Sequence[Visual | Collision]) -> dict[str, Element | None]:
    """Return the ``<mesh>`` elements of shapes, by the URI of the mesh."""
    return {
        shape.geometry.filename: nearest(shape.element, "geometry", "mesh")
        for shape in shapes
        if isinstance(shape.geometry, Mesh)
    }


def _compare_contents(old: Path, new: Path) -> tuple[str, str, str]:
    """Return the old value, the new value and the unit of the difference between two files.

    The values are the sizes or, if these are equal, the beginnings of the hashes. For Git LFS pointers, they are those
    of the files that the pointers replace.
    """
    sizes = [content_size(path) for path in (old, new)]
    if sizes[0] != sizes[1]:
        return str(sizes[0]), str(sizes[1]), "bytes"
    first, second = (content_hash(path)[:8] for path in (old, new))
    return first, second, f"(SHA-256), both of {sizes[0]} bytes"
