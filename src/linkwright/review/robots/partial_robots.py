"""Read robots without the files and packages that neither version has.

Without ROS, sensor packages are often missing. The rest of the robot is still compared.
"""

from __future__ import annotations

import os
from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from pathlib import PurePosixPath

from linkwright.descriptions import Description
from linkwright.descriptions.comparison import Difference
from linkwright.descriptions.pairs import Model
from linkwright.diagnostics import Diagnostic, LinkwrightError, Severity
from linkwright.xacro.omissions import UNEVALUATED, Omissions, expand_with_omissions
from linkwright.xacro.session import Inputs
from linkwright.xmltree import Element

_KEPT_AS_WRITTEN = frozenset({"name", "link", "joint", "filename", "type"})
"""Attributes that may contain any text, so that unevaluated values are compared as written."""
_XACRO_PREFIX = "xacro:"
_EXPRESSION = "${"
_COLORS = (" color rgba", " texture")
"""The ends of properties that a material gives to a visual. It may be defined in a missing file."""


@dataclass(frozen=True)
class PartialRobot:
    """A robot without the missing files and packages.

    Attributes:
        description: the expanded description.
        omissions: the missing packages and files, and the parts that need them.
        stand_ins: the names of links and joints that replace missing links and joints to connect the tree.
        unevaluated: the tags and names of links, joints and materials with values that could not be evaluated.
        incomplete: the tags and names of links and joints that contain a call of a missing macro.
    """

    description: Description
    omissions: Omissions
    stand_ins: frozenset[str]
    unevaluated: frozenset[tuple[str, str]]
    incomplete: frozenset[tuple[str, str]]

    @property
    def error(self) -> Diagnostic | None:
        """The first error that prevents reading the robot; None if it was read."""
        if self.description.robot is not None:
            return None
        errors = (item for item in self.description.diagnostics if item.severity is Severity.ERROR)
        return next(errors, None)


@dataclass(frozen=True)
class PartialPair:
    """Both versions of a robot without the files and packages that neither version has."""

    old: PartialRobot
    new: PartialRobot

    @property
    def has_stand_ins(self) -> bool:
        """Whether links are missing, so that the poses of other links are unknown."""
        return bool(self.old.stand_ins | self.new.stand_ins)

    @property
    def unevaluated_names(self) -> list[str]:
        """The names of links, joints and materials with values that are not compared."""
        incomplete = self.old.incomplete ^ self.new.incomplete
        return sorted({name for _, name in self.old.unevaluated | self.new.unevaluated | incomplete})

    def has_certain_roots(self) -> bool:
        """Return whether the roots of both robots are not due to missing files."""
        return not self.has_stand_ins and self.has_same_omissions()

    def has_same_omissions(self) -> bool:
        """Return whether both versions omit the same parts."""
        return not _has_more_omissions(self.old, self.new) and not _has_more_omissions(self.new, self.old)

    def may_be_defined_elsewhere(self, difference: Difference) -> bool:
        """Return whether a removed part may be among those that only the new version omits."""
        is_removed = difference.kind == "removed" and not self._is_of_stand_in(difference)
        return is_removed and _has_more_omissions(self.new, self.old)

    def lacks_file(self, path: str) -> bool:
        """Return whether only the new version does not find a file, by its name."""
        files = self.new.omissions.files - self.old.omissions.files
        return PurePosixPath(path).name in {PurePosixPath(file).name for file in files}

    def has_unevaluated_side(self, difference: Difference) -> bool:
        """Return whether only one version of an argument of a call needs a name that a missing file defines."""
        values = difference.old, difference.new
        is_changed = difference.kind == "changed" and None not in values
        return is_changed and len({_EXPRESSION in (value or "") for value in values}) > 1

    def _is_of_stand_in(self, difference: Difference) -> bool:
        """Return whether a difference is about a link or joint that replaces a missing one."""
        names = {difference.name, difference.old or "" if difference.kind == "renamed" else ""}
        return difference.subject in ("link", "joint") and bool(names & (self.old.stand_ins | self.new.stand_ins))

    def is_certain(self, difference: Difference) -> bool:
        """Return whether a difference cannot be due to omitted parts."""
        if difference.subject == "extension" and difference.name.startswith(_XACRO_PREFIX):
            return not self.has_unevaluated_side(difference)
        if self._is_of_stand_in(difference):
            return False
        if difference.kind == "added":
            return not _has_more_omissions(self.old, self.new)
        if difference.kind in ("removed", "renamed"):
            return not _has_more_omissions(self.new, self.old)
        part = difference.subject, difference.name
        if difference.property.endswith(_COLORS) and None in (difference.old, difference.new):
            lacking, other = (self.new, self.old) if difference.new is None else (self.old, self.new)
            if _has_more_omissions(lacking, other):
                return False  # a missing file may define the material
        may_be_in_call = (difference.old is None and part in self.old.incomplete) or (
            difference.new is None and part in self.new.incomplete
        )
        return not may_be_in_call and part not in self.old.unevaluated | self.new.unevaluated


def read_partial_robot(model: Model) -> PartialRobot | None:
    """Return a robot without the missing files and packages.

    The result is None if the robot cannot be expanded without them.
    """
    try:
        expansion, omissions = expand_with_omissions(
            Inputs(str(model.path), model.values, overlay=model.overlay), model.finder
        )
    except LinkwrightError:
        return None
    root = expansion.document.root
    unevaluated = frozenset(_drop_unevaluated(root))
    incomplete = frozenset(
        (element.tag, element.attributes.get("name", ""))
        for element in root.elements()
        if element.tag in ("link", "joint") and any(part.tag.startswith(_XACRO_PREFIX) for part in element.walk())
    )
    stand_ins = frozenset(_connect_links(root))
    return PartialRobot(
        Description.of_expansion(str(model.path), expansion), omissions, stand_ins, unevaluated, incomplete
    )


def _has_more_omissions(one: PartialRobot, other: PartialRobot) -> bool:
    """Return whether one version omits more than the other, so that parts may be absent."""
    return (
        one.omissions.packages > other.omissions.packages
        or len(one.omissions.files) > len(other.omissions.files)
        or any(count > other.omissions.macros.get(name, 0) for name, count in one.omissions.macros.items())
        or not one.omissions.tags <= other.omissions.tags
    )


def _drop_unevaluated(root: Element) -> Iterator[tuple[str, str]]:
    """Remove unevaluated numbers from links, joints and materials.

    The tags and names of these elements are yielded. Unevaluated texts elsewhere remain, and are compared as written.
    """
    root.attributes.pop(UNEVALUATED, None)
    for child in root.elements():
        for element in child.walk():
            names = element.attributes.pop(UNEVALUATED, None)
            if names is None or child.tag not in ("link", "joint", "material"):
                continue
            for name in names.split():
                if name not in _KEPT_AS_WRITTEN:
                    del element.attributes[name]
            yield child.tag, child.attributes.get("name", "")


def _connect_links(root: Element) -> Iterator[str]:
    """Add missing links, and joints to links without a parent, and yield the names of both."""
    links = {element.attributes.get("name", "") for element in root.elements("link")}
    parents: dict[str, str] = {}
    for joint in root.elements("joint"):
        parent, child = joint.first("parent"), joint.first("child")
        if parent is not None and child is not None:
            parents[child.attributes.get("link", "")] = parent.attributes.get("link", "")
    missing = dict.fromkeys(name for pair in parents.items() for name in pair if name not in links)
    for name in missing:
        root.children.append(Element("link", {"name": name}))
        yield name
    roots = sorted((links | missing.keys()) - parents.keys())
    if len(roots) < 2:
        return
    counts = dict.fromkeys(roots, 0)
    for name in parents:
        counts[_find_root(name, parents)] = counts.get(_find_root(name, parents), 0) + 1
    main_root = max(roots, key=lambda name: counts[name])
    for name in roots:
        if name != main_root:
            joint = Element("joint", {"name": f"{main_root} to {name}", "type": "fixed"})
            joint.children += [Element("parent", {"link": main_root}), Element("child", {"link": name})]
            root.children.append(joint)
            yield f"{main_root} to {name}"


def _find_root(link: str, parents: Mapping[str, str]) -> str:
    for _ in range(len(parents)):
        if link not in parents:
            break
        link = parents[link]
    return link


def find_missing_names(pair: PartialPair, old: Model, new: Model) -> list[str]:
    """Return the names of the packages and files that are omitted because they are not found.

    The list is empty if nothing is missing, or if one of the versions has something that the other version needs.
    """
    names: dict[str, None] = {}
    for robot, model, other in ((pair.old, old, new), (pair.new, new, old)):
        for package in sorted(robot.omissions.packages):
            if other.finder.find(package) is not None:
                return []
            names[package] = None
        for file in sorted(robot.omissions.files):
            relative = os.path.relpath(os.path.realpath(file), model.path.parent)
            if os.path.exists(other.path.parent / relative):  # noqa: PTH110 - the path may be odd
                return []
            names[os.path.basename(file)] = None  # noqa: PTH119 - see above
    return list(names)
