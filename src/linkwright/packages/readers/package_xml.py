"""Reader for ``package.xml`` (REP 149), which also returns the locations of values."""

from __future__ import annotations

from functools import cached_property

from linkwright.loading.lean_dataclasses import dataclass
from linkwright.xmltree import Document, Element

DEPENDENCY_TAGS = frozenset(
    {
        *("depend", "build_depend", "build_export_depend", "exec_depend", "run_depend", "buildtool_depend"),
        *("buildtool_export_depend", "test_depend", "doc_depend"),
    }
)


@dataclass(frozen=True, slots=True)
class Dependency:
    """A dependency on another package or a system key."""

    name: str
    tag: str
    element: Element


class Manifest:
    """A parsed ``package.xml``."""

    def __init__(self, document: Document) -> None:
        self.document = document

    @property
    def root(self) -> Element:
        """The ``<package>`` element."""
        return self.document.root

    def text(self, tag: str) -> str | None:
        """Return the text of the first element with a tag, or None if there is no such element.

        Whitespace is stripped at the ends and collapsed inside.
        """
        element = self.root.first(tag)
        return None if element is None else " ".join(element.text().split())

    @property
    def name(self) -> str | None:
        """The name of the package, or None if the file has none."""
        return self.text("name") or None

    @property
    def build_type(self) -> str | None:
        """The text of ``<build_type>``, or None if the file does not declare it."""
        export = self.root.first("export")
        element = None if export is None else export.first("build_type")
        return None if element is None else element.text().strip()

    @cached_property
    def dependencies(self) -> tuple[Dependency, ...]:
        """All dependencies in the order of the text, except dependencies in groups."""
        return tuple(
            Dependency(element.text().strip(), element.tag, element)
            for element in self.root.elements()
            if element.tag in DEPENDENCY_TAGS
        )

    @property
    def is_ros1(self) -> bool:
        """Whether the package builds with catkin, for ROS 1 only or for ROS 1 and ROS 2."""
        return self.build_type == "catkin" or self.declares("catkin")

    def declares(self, package: str) -> bool:
        """Return whether a name is the package's own name or the name of a dependency of any kind."""
        return package == self.name or any(dependency.name == package for dependency in self.dependencies)
