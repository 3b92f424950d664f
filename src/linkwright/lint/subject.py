"""What rules look at: a description as written, as expanded and as read, and what is around it."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from contextlib import suppress
from functools import cached_property
from pathlib import Path
from typing import TYPE_CHECKING, TypeVar

from linkwright.diagnostics import LinkwrightError
from linkwright.lint.rule import Rule
from linkwright.lint.settings import Settings
from linkwright.urdf import Joint, Link, Reading, Robot
from linkwright.xmltree import Document, Element

if TYPE_CHECKING:
    from linkwright.kinematics import KinematicTree
    from linkwright.lint.bodies import Bodies
    from linkwright.lint.extents import Extents
    from linkwright.lint.meshes import MeshFacts
    from linkwright.lint.package import PackageContext
    from linkwright.workspace import PackageFinder
    from linkwright.xacro import Expansion

Value = TypeVar("Value", bool, int, float, str, list[str])


class Subject:
    """One description on the table.

    What is expensive is worked out when a rule first asks for it and kept for the next one.

    Attributes:
        path: the file that is checked; relative addresses in the description start at its folder.
        document: the expanded document; its elements know the file and place they were written at.
        reading: what the URDF reader made of it.
        expansion: the expansion, or None for plain URDF.
        finder: where packages are.
        settings: the settings in force for this file.
    """

    def __init__(
        self,
        path: Path,
        document: Document,
        reading: Reading,
        *,
        expansion: Expansion | None,
        finder: PackageFinder,
        settings: Settings,
    ) -> None:
        self.path = path
        self.document = document
        self.reading = reading
        self.expansion = expansion
        self.finder = finder
        self.settings = settings

    @property
    def robot(self) -> Robot | None:
        """The robot; None when the model is so wrong that urdfdom would refuse it."""
        return self.reading.robot

    @property
    def root(self) -> Element:
        """The root element of the expanded document."""
        return self.document.root

    def elements(self, tag: str | None = None) -> Iterator[Element]:
        """The elements directly in ``<robot>``, all or those of one tag, in document order."""
        return self.root.elements(tag)

    @cached_property
    def joints(self) -> tuple[Joint, ...]:
        """All joints in file order, those of a refused model as far as they can be read; names may repeat there."""
        if self.robot is not None:
            return tuple(self.robot.joints.values())
        from linkwright.urdf.findings import Findings
        from linkwright.urdf.joints import read_joint

        return tuple(read_joint(element, Findings()) for element in self.elements("joint"))

    @cached_property
    def links(self) -> tuple[Link, ...]:
        """All links in file order, those of a refused model as far as they can be read; names may repeat there."""
        if self.robot is not None:
            return tuple(self.robot.links.values())
        from linkwright.urdf.findings import Findings
        from linkwright.urdf.links import read_link
        from linkwright.urdf.materials import MaterialTable

        findings = Findings()
        table = MaterialTable(findings)
        return tuple(read_link(element, table, findings) for element in self.elements("link"))

    @cached_property
    def sources(self) -> Mapping[Path, Document]:
        """Every XML file that was read, as it is written (not expanded), the checked file first."""
        if self.expansion is None:
            return {self.path: self.document}
        from linkwright.xacro import sources

        found: dict[Path, Document] = {}
        for path in self.expansion.dependencies:
            with suppress(LinkwrightError):  # YAML files are among them
                found[path] = sources.read(str(path))
        return found

    @cached_property
    def tree(self) -> KinematicTree | None:
        """The kinematic tree, or None when there is no robot."""
        if self.robot is None:
            return None
        from linkwright.kinematics import KinematicTree

        try:
            return KinematicTree(self.robot)
        except LinkwrightError:
            return None

    @cached_property
    def meshes(self) -> MeshFacts:
        """What is known of the mesh files that the description names."""
        from linkwright.lint.meshes import MeshFacts

        return MeshFacts(self)

    @cached_property
    def bodies(self) -> Bodies:
        """The links that fixed joints make one body."""
        from linkwright.lint.bodies import Bodies

        return Bodies(self)

    @cached_property
    def extents(self) -> Extents:
        """The space that shapes take, and the mass properties of bodies."""
        from linkwright.lint.extents import Extents

        return Extents(self)

    @cached_property
    def package(self) -> PackageContext | None:
        """The ROS package that the file lies in, or None."""
        from linkwright.lint.package import find_package

        return find_package(self.path)

    def option(self, rule: Rule, name: str, kind: type[Value]) -> Value:
        """The value of a rule's option, from the settings or its default.

        Args:
            rule: the rule.
            name: of the option, which the rule declares in `Rule.options`.
            kind: its type; ``float`` takes a whole number too.
        """
        declared = next(option for option in rule.options if option.name == name)
        value = self.settings.options.get(rule.name, {}).get(name, declared.default)
        if kind is float and isinstance(value, int):
            return kind(value)
        assert isinstance(value, kind), "the settings were checked against the option's default"
        return value
