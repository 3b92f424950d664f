"""The subject of rules: a description in its unexpanded, expanded and parsed forms."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping
from functools import cached_property
from pathlib import Path

from linkwright.descriptions import Description
from linkwright.diagnostics import LinkwrightError
from linkwright.lint.settings import Settings
from linkwright.loading.lean_typing import TYPE_CHECKING, Any, TypeVar
from linkwright.urdf import Inertial, Joint, Link, Robot
from linkwright.xmltree import Document, Element

if TYPE_CHECKING:
    from linkwright.geometry.shapes import Placement
    from linkwright.kinematics import KinematicTree
    from linkwright.lint.contexts import Contexts, FileContext
    from linkwright.lint.extents import Extents
    from linkwright.lint.meshes import MeshFacts
    from linkwright.lint.package import PackageContext
    from linkwright.lint.structure import Structure
    from linkwright.lint.tensors import Flaw
    from linkwright.lint.xacro_facts import XacroFacts
    from linkwright.packages import PackageFinder
    from linkwright.urdf.bodies import Bodies

Value = TypeVar("Value")

_DEFINITIONS = {"material", "xacro:macro", "xacro:property"}
"""Elements that only define something. A file without any other element is a library."""


class Subject:
    """One description under check.

    Expensive properties are computed on first use and cached.

    Args:
        description: the description to check.
        finder: the finder of packages.
        settings: the settings for the file.
        contexts: the data that checks share during one run.

    Attributes:
        description: the description to check.
        path: the checked file, whose folder is the base of relative paths in the description.
        document: the expanded document. Each element has its file and position in the source.
        reading: the result of the URDF reader.
        expansion: the expansion, or None for plain URDF.
        is_whole: whether the description is complete. An incomplete description only has the parts that could be
            expanded, and no robot.
    """

    def __init__(
        self, description: Description, finder: PackageFinder, settings: Settings, contexts: Contexts | None = None
    ) -> None:
        self.path = Path(description.name)
        self.document = description.document
        self.reading = description.reading
        self.expansion = description.expansion
        self.finder = finder
        self.settings = settings
        self.is_whole = not description.problems
        self.description = description
        self._contexts = contexts

    @cached_property
    def is_library(self) -> bool:
        """Whether the file is a xacro library, whose definitions alone do not describe a robot."""
        main = next(iter(self.sources.values()), None)
        if self.expansion is None or self.robot is not None or not self.is_whole or main is None:
            return False
        tags = {element.tag for element in main.root.elements()}
        if tags and tags <= _DEFINITIONS:
            return True
        expanded_tags = {element.tag for element in self.elements()}
        if "ros2_control" in expanded_tags and expanded_tags.isdisjoint(("link", "joint")):
            return True
        has_link = next(self.elements("link"), None) is not None
        return "xacro:macro" in tags and not ("name" in self.root.attributes and has_link)

    @property
    def robot(self) -> Robot | None:
        """The robot, or None if urdfdom would refuse the model."""
        return self.reading.robot

    @property
    def root(self) -> Element:
        """The root element of the expanded document."""
        return self.document.root

    def once(self, compute: Callable[[Subject], Value]) -> Value:
        """Return the result of a function for this subject, computed only once.

        All rules share the result, and so do subjects with the same expansion.
        """
        if compute not in self._cached_results:
            self._cached_results[compute] = compute(self)
        value: Value = self._cached_results[compute]
        return value

    @cached_property
    def _cached_results(self) -> dict[Any, Any]:
        """The cached results for all subjects with the same expansion, by function."""
        if self._shared is None:
            return {}
        return self._shared.results_for(self.xacro, self.root, is_whole=self.is_whole)

    def elements(self, tag: str | None = None) -> Iterator[Element]:
        """Return the direct children of ``<robot>`` with a tag, or all, in document order."""
        return self.root.elements() if tag is None else iter(self._elements_by_tag.get(tag, ()))

    @cached_property
    def _elements_by_tag(self) -> Mapping[str, list[Element]]:
        """The direct children of ``<robot>`` by tag, since most rules need elements with one tag."""
        elements_by_tag: dict[str, list[Element]] = {}
        for element in self.root.elements():
            elements_by_tag.setdefault(element.tag, []).append(element)
        return elements_by_tag

    @cached_property
    def joints(self) -> tuple[Joint, ...]:
        """All joints in source order.

        If urdfdom would refuse the model, these are the readable joints, including those with repeated names.
        """
        if self.robot is not None:
            return tuple(self.robot.joints.values())
        from linkwright.urdf.reader import read_joint
        from linkwright.urdf.report import UrdfReport

        return tuple(read_joint(element, UrdfReport()) for element in self.elements("joint"))

    @cached_property
    def links(self) -> tuple[Link, ...]:
        """All links in source order.

        If urdfdom would refuse the model, these are the readable links, including those with repeated names.
        """
        if self.robot is not None:
            return tuple(self.robot.links.values())
        from linkwright.urdf.reader import MaterialTable, read_link
        from linkwright.urdf.report import UrdfReport

        report = UrdfReport()
        table = MaterialTable(report)
        return tuple(read_link(element, table, report) for element in self.elements("link"))

    @property
    def sources(self) -> Mapping[Path, Document]:
        """The unexpanded XML files that were read, by path, starting with the checked file."""
        return self.description.sources

    @cached_property
    def tree(self) -> KinematicTree | None:
        """The kinematic tree, or None if there is no robot."""
        if self.robot is None:
            return None
        from linkwright.kinematics import KinematicTree

        try:
            return KinematicTree(self.robot)
        except LinkwrightError:
            return None

    @cached_property
    def structure(self) -> Structure:
        """The known and unknown elements of the description in the URDF schema."""
        from linkwright.lint.structure import Structure

        return Structure(self.root)

    @cached_property
    def meshes(self) -> MeshFacts:
        """The facts about the mesh files that the description names."""
        from linkwright.lint.meshes import MeshFacts

        return MeshFacts(self.links, self.finder, self.path.absolute().parent)

    @cached_property
    def xacro(self) -> XacroFacts:
        """The definitions and uses in the xacro files of the description."""
        from linkwright.lint.xacro_facts import XacroFacts

        arguments = {} if self.expansion is None else self.expansion.arguments
        facts = XacroFacts(self.path, self.sources, arguments, self.package, is_library=not self.links)
        return facts if self._shared is None else self._shared.facts(facts)

    @property
    def _shared(self) -> FileContext | None:
        """The data that checks with different argument sets share, or None for plain URDF."""
        if self._contexts is None or self.expansion is None or self.description.overlay is not None:
            return None
        return self._contexts.of_file(self.path)

    @cached_property
    def bodies(self) -> Bodies:
        """The bodies, each consisting of the links that fixed joints connect."""
        from linkwright.urdf.bodies import Bodies

        return Bodies(self.robot)

    @cached_property
    def extents(self) -> Extents:
        """The bounding boxes of the shapes, and the mass properties of the bodies."""
        from linkwright.lint.extents import Extents

        return Extents(self.links, self.bodies, self.meshes)

    @cached_property
    def tensor_flaws(self) -> list[tuple[Link, Inertial, Flaw]]:
        """The links with an impossible inertia tensor, each with its first flaw."""
        from linkwright.lint.tensors import find_first_flaw

        inertials = ((link, link.inertial) for link in self.links if link.inertial is not None)
        return [
            (link, inertial, flaw) for link, inertial in inertials if (flaw := find_first_flaw(inertial)) is not None
        ]

    @cached_property
    def frames(self) -> Mapping[str, Placement]:
        """The placement of every link in the root link's frame with all joints at zero, by name.

        The mapping is empty if there is no robot.
        """
        from linkwright.lint.frames import compute_placements

        return {} if self.robot is None else compute_placements(self.robot)

    @cached_property
    def package(self) -> PackageContext | None:
        """The ROS package that contains the file, or None."""
        from linkwright.lint.package import find_package

        packages = None if self._contexts is None else self._contexts.packages
        return find_package(self.path, self.description.overlay, packages)
