"""The facts of build files that other packages depend on."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, field
from enum import Enum
from pathlib import PurePosixPath

from linkwright.diagnostics import Phrase, Span, joined_first, phrase, quoted
from linkwright.review.changes import MAX_NAMES
from linkwright.review.environment_names import is_read_by_others
from linkwright.review.file_pair import FilePair
from linkwright.review.versions import Versions

_MIN_FOLDER_PARTS = 3
"""The minimum number of path parts of a folder that replaces its files in a report."""

UNSHARED_PACKAGES = frozenset(
    {
        *("ament_cmake", "ament_cmake_auto", "ament_cmake_core", "ament_cmake_python", "ament_cmake_ros", "catkin"),
        *("ament_lint_auto", "ament_lint_common", "message_generation", "rosidl_default_generators"),
        *("launch", "launch_ros", "rclpy", "ros2launch", "roslaunch", "rospy", "xacro"),
    }
)
"""The packages without which another package builds, although it has them only through a third one.

They are build tools, which each package names itself, and packages that have no code in C++.
"""
_HEADER_FOLDER = "include"
"""The folder of a package below which its own sources find headers."""


class FactKind(Enum):
    """The kind of a fact: its title, and the reason why removing such a fact is breaking."""

    EXECUTABLE = (
        phrase("installed executables"),
        phrase("launch files and users that start them do not find them"),
    )
    LIBRARY = (
        phrase("installed libraries"),
        phrase("packages and programs that link to them or load them do not build or start"),
    )
    BUILT_EXECUTABLE = (
        phrase("built executables"),
        phrase("launch files and users that start them do not find them"),
    )
    BUILT_LIBRARY = (
        phrase("built libraries"),
        phrase("packages and programs that link to them or load them do not build or start"),
    )
    BUILT_TARGET = (phrase("built targets"), None)
    EXPORTED_TARGET = (phrase("exported targets"), phrase("packages that link to them do not build"))
    EXPORTED_FOLDER = (
        phrase("exported include folders"),
        phrase("packages that include their headers do not build"),
    )
    COMPONENT = (
        phrase("components"),
        phrase("launch files that load them into a container do not find them"),
    )
    PLUGIN_DESCRIPTION = (
        phrase("exported plugin descriptions"),
        phrase("programs that load their classes do not find them"),
    )
    INTERFACE = (phrase("built interfaces"), phrase("programs that use the types do not build or start"))
    INTERFACE_DEPENDENCY = (phrase("dependencies of interfaces"), None)
    DYNAMIC = (
        phrase("descriptions for dynamic_reconfigure"),
        phrase("programs that change the parameters do not build or start"),
    )
    MODULE = (phrase("installed Python modules"), phrase("programs that import them do not find them"))
    ENTRY_POINT = (phrase("entry points"), phrase("programs that load them do not find them"))
    PACKAGE = (phrase("calls of find_package"), None)
    EXPORTED_DEPENDENCY = (
        phrase("exported dependencies"),
        phrase("packages that have them only through this package do not build"),
    )
    STOP = (phrase("errors that stop the build"), None)
    TEST = (phrase("tests"), None)
    SETTING = (phrase("settings"), None)
    INCLUDE_FOLDER = (phrase("absolute include folders"), None)
    FOLDER = (phrase("installed folders that the repository does not have"), None)

    def __init__(self, title: Phrase, reason: Phrase | None) -> None:
        self.title = title
        self.reason = reason


INSTALLED_KINDS = (FactKind.EXECUTABLE, FactKind.LIBRARY)
"""The kinds of targets that are installed."""
BUILT_KINDS = (FactKind.BUILT_EXECUTABLE, FactKind.BUILT_LIBRARY, FactKind.BUILT_TARGET)
"""The kinds of built targets that are reported even if they are not installed."""
ANY_VERSION = "any version"
"""The value for a package without a required version."""

_UNUSED_SUFFIXES = (".orig", ".rej", ".bak", ".swp", "~", ".pyc")
"""The ends of the names of the files that editors, merges and Python leave."""
_PACKAGE_MARKERS = "share/ament_index/resource_index/packages/"
WITHOUT_NOTHING = ", without which nothing is built"
"""The end of the value for a package without which the build file returns."""


@dataclass(frozen=True)
class Fact:
    """A fact of a build file.

    Attributes:
        kind: the kind of thing that the fact describes, such as an installed library.
        name: the name of the target, package or other subject.
        value: a property that may change, such as the function of an executable; empty if there is none.
        span: the location in the file.
        is_value_used: whether other packages use the value, so that a different value is breaking.
        condition: the condition under which the fact holds, as written in the file; empty for always.
    """

    kind: FactKind
    name: str
    value: str = ""
    span: Span | None = None
    is_value_used: bool = False
    condition: str = ""


class EnvironmentVariables:
    """The environment variables that the build reads, by name, with their locations.

    Args:
        variables: the names and locations. Variables that ROS and build tools read themselves are left out.
    """

    def __init__(self, variables: Iterable[tuple[str, Span | None]]) -> None:
        self._spans: dict[str, Span | None] = {}
        for name, span in variables:
            if not is_read_by_others(name):
                self._spans.setdefault(name, span)

    def compare(self, pair: FilePair, new: EnvironmentVariables) -> None:
        """Report the variables that only one version reads."""
        for name, span in new._spans.items():
            if name not in self._spans:
                text = phrase("environment variable '{name}' decides what is built", name=name)
                pair.add(text, pair.location(span))
        for name, span in self._spans.items():
            if name not in new._spans:
                text = phrase("environment variable '{name}' no longer decides what is built", name=name)
                reason = phrase("a value that a user sets for '{name}' has no effect", name=name)
                pair.add(text, pair.location(span, is_old=True), reason)


@dataclass
class TargetParts:
    """The parts of a target of CMake.

    Attributes:
        libraries: the names of packages and libraries that are linked to it, with their locations.
        sources: its sources relative to the package, with their locations.
        is_test: whether it is a test.
        is_test_program: whether it is a test that is built as a program.
    """

    libraries: dict[str, Span] = field(default_factory=dict)
    sources: dict[str, Span] = field(default_factory=dict)
    is_test: bool = False
    is_test_program: bool = False


@dataclass
class BuildFacts:
    """The facts of a build file.

    Attributes:
        facts: the known facts.
        files: the sources of the installed files relative to the package, by destination relative to the prefix.
        unknown: the reasons why more files may be installed than `files` contains.
        other_commands: the other commands or settings, each with its name and its text.
        routines: the names of the functions and macros that the file and the files that it includes define.
        package: the path of the folder of the package relative to the root.
        project: the name of the package; empty if it is not known.
        environment: the environment variables that the file reads.
        targets: the parts of targets, by target.
        header_paths: the headers and folders of headers relative to the package that other packages find although
            `files` does not contain them.
        component_programs: the executables that run a component alone, by the class of the component.
        has_unknown_sources: whether targets may have other sources than `targets` contains.
        has_library: whether others may call code outside of headers, because the package does not only build programs.
        include_folders: the folders relative to the prefix below which other packages find headers.
        private_libraries: the libraries that only targets of the package use.
        output_names: the names of the files of targets that have another name, by target.
        test_files: the destinations of the files that are installed only for tests.
    """

    facts: list[Fact] = field(default_factory=list)
    files: dict[str, str] = field(default_factory=dict)
    unknown: frozenset[str] = frozenset()
    other_commands: list[tuple[str, str]] = field(default_factory=list)
    routines: frozenset[str] = frozenset()
    package: str = ""
    project: str = ""
    environment: EnvironmentVariables = field(default_factory=lambda: EnvironmentVariables(()))
    targets: dict[str, TargetParts] = field(default_factory=dict)
    header_paths: frozenset[str] = frozenset()
    include_folders: frozenset[str] = frozenset()
    component_programs: dict[str, str] = field(default_factory=dict)
    has_library: bool = True
    has_unknown_sources: bool = False
    private_libraries: frozenset[str] = frozenset()
    output_names: Mapping[str, str] = field(default_factory=dict)
    test_files: frozenset[str] = frozenset()

    @property
    def is_complete(self) -> bool:
        """Whether `files` contains all installed files."""
        return not self.unknown

    def offers_file(self, target: str) -> bool:
        """Return whether others may look for an installed file.

        They do not look for files of tests, for backup copies of files, for bytecode of Python, or for the marker of
        the package, which ``ament_package()`` also installs.
        """
        is_own = target in self.test_files or target.startswith(_PACKAGE_MARKERS)
        return not is_own and not target.endswith(_UNUSED_SUFFIXES)

    def find_include_texts(self, target: str) -> set[str]:
        """Return the texts by which other packages include an installed header; empty if they are unknown."""
        path = PurePosixPath(target)
        folders = [folder for folder in self.include_folders if path.is_relative_to(folder)]
        return {path.relative_to(folder).as_posix() for folder in folders}

    def strip_project(self, path: str) -> str:
        """Return an installed path without the name of the package.

        The manifest reports a new package name.
        """
        parts = PurePosixPath(path).parts
        is_own = len(parts) > 1 and parts[1] == self.project
        return PurePosixPath(parts[0], *parts[2:]).as_posix() if is_own else path


def find_new_source(versions: Versions, old: BuildFacts, new: BuildFacts, source: str) -> str:
    """Return the path of a source in the new version.

    Args:
        versions: the repository before and after the change.
        old: the facts of the old version.
        new: the facts of the new version.
        source: the path in the old version.

    Returns:
        The path relative to the package; the old path if the file was not renamed.
    """
    path = (PurePosixPath(old.package) / source).as_posix()
    new_path = next((file.new_path for file in versions.changed_files if file.old_path == path), None)
    is_inside = new_path is not None and PurePosixPath(new_path).is_relative_to(new.package)
    return PurePosixPath(new_path).relative_to(new.package).as_posix() if new_path and is_inside else source


def find_renamed_targets(versions: Versions, old: BuildFacts, new: BuildFacts) -> dict[str, str]:
    """Return the new names of renamed targets by old name.

    A renamed target keeps its first source, and a renamed executable runs the same component.
    """
    sources = {
        next(iter(parts.sources)): name
        for name, parts in new.targets.items()
        if parts.sources and not old.targets.get(name, TargetParts()).sources
    }
    renamed = {}
    for name, parts in old.targets.items():
        source = next((find_new_source(versions, old, new, item) for item in parts.sources), None)
        if source in sources and not new.targets.get(name, TargetParts()).sources:
            renamed[name] = sources[source]
    programs = {name: new.component_programs.get(component) for component, name in old.component_programs.items()}
    return renamed | {name: other for name, other in programs.items() if other is not None and other != name}


def find_own_include_text(source: str) -> str:
    """Return the path of a header below the folder ``include`` of its package; empty if it is elsewhere.

    Args:
        source: the path relative to the package.
    """
    path = PurePosixPath(source)
    folder = next((parent for parent in path.parents if parent.name == _HEADER_FOLDER), None)
    return "" if folder is None else path.relative_to(folder).as_posix()


def list_names(names: Sequence[str]) -> Phrase:
    """Return the names as a list, or the first names and the number of the remaining ones."""
    return joined_first(map(quoted, names), MAX_NAMES)


def summarize_files(targets: Sequence[str], others: Mapping[str, str]) -> list[str]:
    """Return installed files, or their folders.

    A folder replaces its files if the other version installs nothing in it.
    """
    other_folders = {parent.as_posix() for target in others for parent in PurePosixPath(target).parents}
    names: dict[str, None] = {}
    for target in targets:
        parents = (parent for parent in PurePosixPath(target).parents if len(parent.parts) >= _MIN_FOLDER_PARTS)
        folders = [parent.as_posix() for parent in parents]
        outermost = next((folder for folder in reversed(folders) if folder not in other_folders), None)
        names[target if outermost is None else f"{outermost}/"] = None
    return list(names)
