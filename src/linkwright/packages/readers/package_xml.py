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

CATKIN = "catkin"
"""The build tool of ROS 1, and the type of packages that build with it."""
_AMENT = "ament_"
"""The beginning of the names of the build tools of ROS 2, and of the types of packages that build with them."""


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
        return self.build_type == CATKIN or self.declares(CATKIN)

    @property
    def ros_versions(self) -> frozenset[int]:
        """The versions of ROS for which the package builds: 1 with catkin, 2 with ament; empty for other tools."""
        export = self.root.first("export")
        types = [] if export is None else [element.text().strip() for element in export.elements("build_type")]
        names = [*types, *(dependency.name for dependency in self.dependencies if "buildtool" in dependency.tag)]
        is_ros2 = any(name.startswith(_AMENT) for name in names)
        return frozenset({1} if self.is_ros1 or CATKIN in types else ()) | frozenset({2} if is_ros2 else ())

    def declares(self, package: str) -> bool:
        """Return whether a name is the package's own name or the name of a dependency of any kind."""
        return package == self.name or any(dependency.name == package for dependency in self.dependencies)
