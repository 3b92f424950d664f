"""Rules about packages that build files and Python sources use, but ``package.xml`` does not name."""

from __future__ import annotations

import ast
from abc import abstractmethod
from collections.abc import Iterator
from pathlib import PurePosixPath

from linkwright.diagnostics import Diagnostic, Phrase, Severity, SourceText, Span, phrase
from linkwright.lint.dependencies import is_covered
from linkwright.lint.package_fixes import make_dependency_fix
from linkwright.lint.rule import Rule, Scope
from linkwright.lint.rules.package_python import is_ament_python
from linkwright.lint.subject import Subject
from linkwright.loading.deferred import lazy_pattern
from linkwright.loading.lean_dataclasses import dataclass
from linkwright.loading.lean_typing import TYPE_CHECKING
from linkwright.packages.manifest import MANIFEST
from linkwright.packages.readers.python2 import as_python3
from linkwright.packages.readers.python_values import parse_python

if TYPE_CHECKING:
    from linkwright.lint.package import PackageContext
    from linkwright.packages.readers.cmake_language import Argument, Command
    from linkwright.packages.readers.package_xml import Manifest

_ROS_NAME = lazy_pattern(r"[a-z][a-z0-9]*(_[a-z0-9]+)+")
"""The form of the names of ROS packages: lower case, with an underscore. Few other projects have such a name."""
_CATKIN_NAME = lazy_pattern(r"[a-z][a-z0-9_]*")
"""The form of the names of components of catkin, all of which are packages of ROS."""
_OTHER_PROJECTS = frozenset(
    {
        *("console_bridge", "nlohmann_json", "yaml_cpp", "orocos_kdl", "range_v3", "fast_float", "magic_enum"),
        *("unofficial_sqlite3", "absl_cpp", "tinyxml2_vendor", "cmake_modules", "libfranka", "open3d_core"),
    }
)
"""Projects of CMake with such a name that package.xml names by another key, or that need none."""
_CATKIN = "catkin"
_CATKIN_KEYWORDS = frozenset({"REQUIRED", "COMPONENTS", "QUIET", "EXACT", "CONFIG", "OPTIONAL_COMPONENTS"})
_IMPORTED_TYPES = lazy_pattern(r"^from[ \t]+(?P<package>[A-Za-z]\w*)\.(?:msg|srv|action)\b")
_MAX_CHARACTERS = 1 << 20
_SKIPPED_FOLDERS = frozenset(
    {"test", "tests", "doc", "docs", "example", "examples", "tutorial", "tutorials", "tools", "utils", "launch"}
)
"""The folders with Python files that a package often does not install."""


@dataclass(frozen=True, slots=True)
class _Use:
    """The first use of a package."""

    name: str
    span: Span
    source: SourceText


class _DependencyRule(Rule):
    """The base class of rules about packages that ``package.xml`` does not name."""

    severity = Severity.INFO
    scope = Scope.PACKAGE

    def check(self, subject: Subject) -> Iterator[Diagnostic]:
        package = subject.package
        manifest = None if package is None else package.manifest
        if package is None or manifest is None or manifest.root.tag != "package":
            return
        if any("$" in dependency.name for dependency in manifest.dependencies):
            return
        reported = {package.name}
        for use in self.find_uses(package, subject):
            if use.name in reported or is_covered(use.name, manifest, subject.finder):
                continue
            reported.add(use.name)
            yield self.report(
                self.describe(use.name, manifest),
                span=use.span,
                source=use.source,
                hint=phrase("add <depend>{name}</depend> to {file}", name=use.name, file=MANIFEST),
                fix=make_dependency_fix(manifest, [use.name], "depend"),
            )

    @abstractmethod
    def find_uses(self, package: PackageContext, subject: Subject) -> Iterator[_Use]:
        """Yield the uses of other packages."""

    @abstractmethod
    def describe(self, name: str, manifest: Manifest) -> Phrase:
        """Return the message about a package that the manifest does not name."""


class UndeclaredBuildDependency(_DependencyRule):
    """``CMakeLists.txt`` requires a package that ``package.xml`` does not name.

    ## Why

    rosdep installs the packages that `package.xml` names, and colcon builds them first. On another machine, or in
    another order, `find_package` does not find the package, and the build fails. Some packages are not reported: those
    of every ROS installation, such as `rclcpp` and `std_msgs`, dependencies of declared packages, and those that only a
    branch of an `if` requires. A `CMakeLists.txt` is not read in a package of the build type `ament_python`, which
    colcon builds without it.

    ## Example

    ```cmake
    find_package(rosbag2_cpp REQUIRED)
    ```

    while `package.xml` does not mention the package.

    ## Use instead

    ```xml
    <depend>rosbag2_cpp</depend>
    ```
    """

    code = "LW812"
    name = "undeclared-build-dependency"

    def find_uses(self, package: PackageContext, subject: Subject) -> Iterator[_Use]:
        """Yield the packages that the build file requires."""
        if is_ament_python(package):
            return
        for command in package.cmake_commands:
            if command.is_conditional:
                continue
            for argument in _list_required_packages(command):
                form = _CATKIN_NAME if command.name == "find_package" and command.words[0] == _CATKIN else _ROS_NAME
                is_ros = form.fullmatch(argument.text) is not None and argument.text not in _OTHER_PROJECTS
                if is_ros or subject.finder.find(argument.text) is not None:
                    span = argument.source.span(argument.start, argument.end)
                    yield _Use(argument.text, span, argument.source)

    def describe(self, name: str, manifest: Manifest) -> Phrase:
        """Return the message about a package that the build file requires."""
        return phrase("the build requires '{name}', which package.xml does not name", name=name)


def _list_required_packages(command: Command) -> list[Argument]:
    """Return the packages without which a command fails."""
    words = command.words
    if command.name == "ament_target_dependencies":
        return [argument for argument in command.arguments[1:] if not argument.text.isupper()]
    if command.name != "find_package" or not words:
        return []
    if words[0] == _CATKIN:
        return [argument for argument in command.arguments[1:] if argument.text not in _CATKIN_KEYWORDS]
    return [command.arguments[0]] if "REQUIRED" in words else []


class UndeclaredPythonDependency(_DependencyRule):
    """A Python file imports messages of a package that ``package.xml`` does not name.

    ## Why

    rosdep only installs the packages that `package.xml` names. On a machine without the other packages, the import
    fails, and the program does not start. Some packages are not reported: those of every ROS installation, such as
    `std_msgs`, dependencies of declared packages, and those that only tests, examples, functions or `try` blocks
    import.

    ## Example

    ```python
    from nav2_msgs.action import NavigateToPose
    ```

    while `package.xml` does not mention the package.

    ## Use instead

    ```xml
    <depend>nav2_msgs</depend>
    ```
    """

    code = "LW813"
    name = "undeclared-python-dependency"

    def find_uses(self, package: PackageContext, subject: Subject) -> Iterator[_Use]:
        """Yield the packages whose interfaces the sources import."""
        parts = {part for file in package.files for part in PurePosixPath(file).parts}
        local_modules = {part.removesuffix(".py") for part in parts}
        for file in package.files:
            path = PurePosixPath(file)
            if path.suffix != ".py" or not _SKIPPED_FOLDERS.isdisjoint(path.parts) or path.name.startswith("test_"):
                continue
            source = package.text(file)
            if source is None or len(source.text) > _MAX_CHARACTERS:
                continue
            for use in _find_imports(source):
                if use.name not in local_modules:
                    yield use

    def describe(self, name: str, manifest: Manifest) -> Phrase:
        """Return the message about a package that a source imports."""
        return phrase("'{name}' is imported, but package.xml does not name it", name=name)


def _find_imports(source: SourceText) -> Iterator[_Use]:
    """Yield the imports of interfaces at the beginning of lines."""
    rows = [
        (number, match)
        for number, row in enumerate(source.text.splitlines(), 1)
        if (match := _IMPORTED_TYPES.match(row))
    ]
    lines = _list_import_lines(source.text) if rows else frozenset()
    for number, match in rows:
        if number in lines:
            start = source.offset(number, 1) + match.start("package")
            yield _Use(match["package"], source.span(start, start + len(match["package"])), source)


def _list_import_lines(text: str) -> frozenset[int]:
    """Return the lines at which statements of a module import; empty if it is neither Python 3 nor Python 2."""
    tree = _parse(text) or _parse(as_python3(text))
    body = [] if tree is None else tree.body
    return frozenset(node.lineno for node in body if isinstance(node, ast.ImportFrom))


def _parse(text: str) -> ast.Module | None:
    try:
        return parse_python(text)
    except (SyntaxError, ValueError):
        return None
