"""The comparison of two descriptions."""

from __future__ import annotations

import filecmp
import hashlib
from collections.abc import Callable, Iterator, Mapping, Sequence
from pathlib import Path

from linkwright.descriptions.comparison.facts import (
    Block,
    Fact,
    blocks_of_joint,
    blocks_of_link,
    collisions_of,
    nearest,
    pairs_of,
    visuals_of,
)
from linkwright.descriptions.comparison.matching import Matches, match
from linkwright.diagnostics import LinkwrightError, Span
from linkwright.loading.lean_dataclasses import dataclass, field
from linkwright.loading.lean_typing import Literal, TypeVar
from linkwright.urdf import Collision, Joint, Link, Mesh, Robot, Visual
from linkwright.xacro.faults import Frame, frames
from linkwright.xmltree import Element

Kind = Literal["added", "removed", "renamed", "changed"]
Subject = Literal["robot", "link", "joint", "extension"]
_Pair = tuple[Element | None, Element | None]
"""Where something is written in the old and in the new description."""
_Part = TypeVar("_Part", Link, Joint)


@dataclass(frozen=True, slots=True)
class Place:
    """The location of a difference.

    `calls` are the macro calls and includes that led there, innermost first.
    """

    span: Span
    calls: tuple[Span, ...] = ()


@dataclass(frozen=True, slots=True)
class Difference:
    """A difference between two descriptions.

    Attributes:
        subject: the kind of the changed object; ``extension`` is a ``<gazebo>``, ``<ros2_control>``,
            ``<transmission>``, ...
        name: the object's name in the new description or, for a removed object, in the old one.
        kind: the kind of change.
        property: the changed property, such as ``mass`` or ``visual 2 origin xyz``; empty for the whole object.
        old: the value in the old description without its unit, or None if there is none.
        new: the value in the new description without its unit, or None if there is none.
        unit: the unit of both values; empty for text.
        old_place: the location of the value in the old description, or of the beginning of its object.
        new_place: the location of the value in the new description, or of the beginning of its object.
    """

    subject: Subject
    name: str
    kind: Kind
    property: str = ""
    old: str | None = None
    new: str | None = None
    unit: str = ""
    old_place: Place | None = None
    new_place: Place | None = None


@dataclass(frozen=True, slots=True)
class Comparison:
    """The differences between two descriptions.

    Attributes:
        differences: first the differences of the robot itself, then those of links and joints in the order of the new
            description, then removed links and joints, and finally the differences of the elements that other programs
            read.
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
        resolve: a function that returns the file of a mesh's URI, or None. With such a function, the contents of mesh
            files are compared, too.
    """

    robot: Robot
    normalize: Callable[[str], str] = field(default=lambda words: words)
    resolve: Callable[[str], Path] | None = None

    def mesh(self, address: str) -> Path | None:
        """Return the file of a mesh's URI, or None if it is unknown or does not exist."""
        if self.resolve is None:
            return None
        try:
            path = self.resolve(address)
        except LinkwrightError:
            return None
        return path if path.is_file() else None


def compare(old: Side, new: Side) -> Comparison:
    """Return the differences between two descriptions.

    Links and joints are matched by name. An object with a new name is recognised if everything else is equal. Poses are
    compared as poses, not as text, with the tolerances in `linkwright.descriptions.comparison.facts`. Elements outside
    the robot model (``<gazebo>``, ``<ros2_control>``, sensors) are compared as XML, ignoring blanks, comments and the
    order of attributes.
    """
    return _Comparer(old, new).run()


class _Comparer:
    def __init__(self, old: Side, new: Side) -> None:
        self.old = old
        self.new = new
        self.matches = Matches({}, {})

    def run(self) -> Comparison:
        old, new = self.old.robot, self.new.robot
        self.matches = match(old, new, self._same_link, self._same_joint)
        found = [*self._robot(), *self._links(), *self._joints(), *self._extensions()]
        return Comparison(tuple(found), self.matches.links, self.matches.joints)

    # --- matching ------------------------------------------------------------------------------------------------

    def _same(self, old: Block, new: Block) -> bool:
        return old.equals(new, self.old.normalize, self.new.normalize)

    def _same_link(self, old: Link, new: Link) -> bool:
        return not any(self._in_link(old, new))

    def _same_joint(self, old: Joint, new: Joint) -> bool:
        return all(difference.property in ("parent", "child", "mimic joint") for difference in self._in_joint(old, new))

    # --- subjects -----------------------------------------------------------------------------------------------

    def _robot(self) -> Iterator[Difference]:
        old, new = self.old.robot, self.new.robot
        if old.name != new.name:
            places = _place(old.element, "name"), _place(new.element, "name")
            yield Difference("robot", new.name, "changed", "name", old.name, new.name, "", *places)

    def _links(self) -> Iterator[Difference]:
        old, new = self.old.robot.links, self.new.robot.links
        yield from _named("link", old, new, self.matches.links, self._in_link)

    def _joints(self) -> Iterator[Difference]:
        def inside(old: Joint, new: Joint) -> Iterator[Difference]:
            yield from (difference for difference in self._in_joint(old, new) if not self._follows_a_name(difference))

        old, new = self.old.robot.joints, self.new.robot.joints
        yield from _named("joint", old, new, self.matches.joints, inside)

    def _follows_a_name(self, difference: Difference) -> bool:
        """Return whether a value differs only because the link or joint that it names was renamed."""
        if difference.property in ("parent", "child"):
            return self.matches.links.get(difference.old or "") == difference.new
        return difference.property == "mimic joint" and self.matches.joints.get(difference.old or "") == difference.new

    def _in_joint(self, old: Joint, new: Joint) -> Iterator[Difference]:
        around = old.element, new.element
        yield from self._blocks("joint", new.name, blocks_of_joint(old), blocks_of_joint(new), around)

    def _in_link(self, old: Link, new: Link) -> Iterator[Difference]:
        around = old.element, new.element
        yield from self._blocks("link", new.name, blocks_of_link(old), blocks_of_link(new), around)
        yield from self._shapes(new.name, visuals_of(old), visuals_of(new), around)
        yield from self._shapes(new.name, collisions_of(old), collisions_of(new), around)
        yield from self._meshes(old, new)

    def _shapes(self, link: str, old: Sequence[Block], new: Sequence[Block], around: _Pair) -> Iterator[Difference]:
        for before, after in pairs_of(old, new, self._same):
            number = after if after is not None else before or 0
            some = new[number] if after is not None else old[number]
            several = max(len(old), len(new)) > 1
            name = (
                f"{some.name} '{some.label}'" if some.label else f"{some.name} {number + 1}" if several else some.name
            )
            first = None if before is None else old[before]
            second = None if after is None else new[after]
            yield from self._block("link", link, name, first, second, around)

    def _meshes(self, old: Link, new: Link) -> Iterator[Difference]:
        """Yield the differences of mesh files that have the same URI but different contents."""
        for tag, before, after in (("visual", old.visuals, new.visuals), ("collision", old.collisions, new.collisions)):
            known, wanted = _meshes_of(before), _meshes_of(after)
            for name in (name for name in wanted if name in known):
                old_file, new_file = self.old.mesh(name), self.new.mesh(name)
                if old_file and new_file and not _same_bytes(old_file, new_file):
                    values = _difference_of_bytes(old_file, new_file)
                    places = _place(known[name]), _place(wanted[name])
                    yield Difference("link", new.name, "changed", f"{tag} mesh {name}", *values, *places)

    # --- blocks of facts ------------------------------------------------------------------------------------------

    def _blocks(
        self, subject: Subject, name: str, old: Sequence[Block], new: Sequence[Block], around: _Pair
    ) -> Iterator[Difference]:
        before, after = {block.name: block for block in old}, {block.name: block for block in new}
        for block in dict.fromkeys([*after, *before]):
            yield from self._block(subject, name, block, before.get(block), after.get(block), around)

    def _block(
        self, subject: Subject, name: str, block: str, old: Block | None, new: Block | None, around: _Pair
    ) -> Iterator[Difference]:
        if old is None or new is None:
            texts = None if old is None else old.text, None if new is None else new.text
            first, second = around[0] if old is None else old.element, around[1] if new is None else new.element
            yield Difference(subject, name, "changed", block, *texts, "", _place(first), _place(second))
            return
        for fact in dict.fromkeys([*new.facts, *old.facts]):
            before, after = old.facts.get(fact), new.facts.get(fact)
            if before and after and before.equals(after, self.old.normalize, self.new.normalize):
                continue
            yield _changed(subject, name, f"{block} {fact}".strip(), (before, old), (after, new))

    # --- extensions ------------------------------------------------------------------------------------------------

    def _extensions(self) -> Iterator[Difference]:
        yield from self._elements(self.old.robot.extensions, self.new.robot.extensions, "", None)

    def _elements(
        self,
        old: Sequence[Element],
        new: Sequence[Element],
        path: str,
        around: tuple[str, Element, Element] | None,
    ) -> Iterator[Difference]:
        """Yield the differences between the elements of two robots, or of a pair of elements.

        Args:
            old: the elements of the old description.
            new: the elements of the new description.
            path: the names of the enclosing elements.
            around: the name of the enclosing pair and the pair itself, or None for direct children of the robots.
        """
        before, after = _elements_by_key(old), _elements_by_key(new)
        for key in dict.fromkeys([*after, *before]):
            first, second = before.get(key), after.get(key)
            here = f"{path} {key}".strip()
            if first is not None and second is not None:
                name, start = (key, "") if around is None else (around[0], here)
                yield from self._element(name, start, first, second)
            elif around is None:
                kind: Kind = "added" if first is None else "removed"
                yield Difference("extension", key, kind, "", None, None, "", _place(first), _place(second))
            else:
                texts = None if first is None else _flat(first), None if second is None else _flat(second)
                places = _place(first or around[1]), _place(second or around[2])
                yield Difference("extension", around[0], "changed", here, *texts, "", *places)

    def _element(self, name: str, path: str, old: Element, new: Element) -> Iterator[Difference]:
        for attribute in dict.fromkeys([*new.attributes, *old.attributes]):
            before, after = old.attributes.get(attribute), new.attributes.get(attribute)
            if not self._same_words(before, after):
                places = _place(old, attribute), _place(new, attribute)
                yield Difference(
                    "extension", name, "changed", f"{path} @{attribute}".strip(), before, after, "", *places
                )
        texts = " ".join(old.text().split()), " ".join(new.text().split())
        if not self._same_words(*texts):
            yield Difference("extension", name, "changed", path, *texts, "", _place(old), _place(new))
        yield from self._elements(list(old.elements()), list(new.elements()), path, (name, old, new))

    def _same_words(self, old: str | None, new: str | None) -> bool:
        if old is None or new is None:
            return old is new
        return " ".join(self.old.normalize(old).split()) == " ".join(self.new.normalize(new).split())


def _elements_by_key(elements: Sequence[Element]) -> dict[str, Element]:
    """Return elements in document order, by tag and name or reference.

    The keys of elements with the same tag and name are numbered.
    """
    found: dict[str, Element] = {}
    for element in elements:
        name = element.attributes.get("name") or element.attributes.get("reference")
        key = f"{element.tag} {name}" if name else element.tag
        number = 2
        unique = key
        while unique in found:
            unique = f"{key} {number}"
            number += 1
        found[unique] = element
    return found


def _flat(element: Element) -> str:
    """Return an element's attributes, text and child tags as one line."""
    words = [f"{name}={value}" for name, value in element.attributes.items()]
    words += element.text().split()
    words += [f"<{child.tag}>" for child in element.elements()]
    return " ".join(words)


def _named(
    subject: Subject,
    old: Mapping[str, _Part],
    new: Mapping[str, _Part],
    matched: Mapping[str, str],
    inside: Callable[[_Part, _Part], Iterator[Difference]],
) -> Iterator[Difference]:
    """Yield the differences of links or joints: added, renamed, changed and removed ones."""
    names = {after: before for before, after in matched.items()}
    for name, part in new.items():
        if name not in names:
            yield Difference(subject, name, "added", new_place=_place(part.element))
            continue
        before = old[names[name]]
        if before.name != name:
            places = _place(before.element, "name"), _place(part.element, "name")
            yield Difference(subject, name, "renamed", "name", before.name, name, "", *places)
        yield from inside(before, part)
    for name, part in old.items():
        if name not in matched:
            yield Difference(subject, name, "removed", old_place=_place(part.element))


def _changed(
    subject: Subject, name: str, fact: str, old: tuple[Fact | None, Block], new: tuple[Fact | None, Block]
) -> Difference:
    def place(side: tuple[Fact | None, Block]) -> Place | None:
        found, block = side
        return _place(block.element) if found is None else _place(found.element, found.attribute)

    before, after = old[0], new[0]
    some = after or before
    texts = None if before is None else before.text, None if after is None else after.text
    return Difference(subject, name, "changed", fact, *texts, some.unit if some else "", place(old), place(new))


def _place(element: Element | None, attribute: str = "") -> Place | None:
    """Return the location of an element or of one of its attributes, or None if unknown."""
    if element is None:
        return None
    span = element.attribute_span(attribute) if attribute in element.attributes else element.span()
    if span is None:
        return None
    calls = (frame.site.span() for frame in frames(element.origin if isinstance(element.origin, Frame) else None))
    return Place(span, tuple(call for call in calls if call is not None))


def _meshes_of(shapes: Sequence[Visual | Collision]) -> dict[str, Element | None]:
    """Return the elements in which meshes are written, by the URI of the mesh."""
    return {
        shape.geometry.filename: nearest(shape.element, "geometry", "mesh")
        for shape in shapes
        if isinstance(shape.geometry, Mesh)
    }


def _difference_of_bytes(old: Path, new: Path) -> tuple[str, str, str]:
    """Return the old value, the new value and the unit of the difference between two files.

    The values are the sizes or, if these are equal, the beginnings of the hashes.
    """
    sizes = [path.stat().st_size for path in (old, new)]
    if sizes[0] != sizes[1]:
        return str(sizes[0]), str(sizes[1]), "bytes"
    first, second = (hashlib.sha256(path.read_bytes()).hexdigest()[:8] for path in (old, new))
    return first, second, f"(SHA-256), both of {sizes[0]} bytes"


def _same_bytes(old: Path, new: Path) -> bool:
    try:
        return old.samefile(new) or filecmp.cmp(old, new, shallow=False)
    except OSError:
        return True
