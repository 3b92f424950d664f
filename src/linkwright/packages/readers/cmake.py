"""What a ``CMakeLists.txt`` installs, read without CMake.

Packages of descriptions, launch files, scripts and interfaces compile nothing; what CMake would do for them is to copy.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, field, replace
from fnmatch import fnmatch
from itertools import takewhile
from pathlib import Path, PurePosixPath

from linkwright.diagnostics import SourceText, Span
from linkwright.packages.readers.cmake_language import (
    BUILD,
    PREFIX,
    Argument,
    CMakeProgram,
    Command,
    within_package,
)
from linkwright.packages.readers.installed_file import InstalledFile

_KEYWORDS = frozenset(
    {
        *("DESTINATION", "PERMISSIONS", "CONFIGURATIONS", "COMPONENT", "OPTIONAL", "EXCLUDE_FROM_ALL", "RENAME"),
        *("FILES_MATCHING", "PATTERN", "REGEX", "USE_SOURCE_PERMISSIONS", "FILE_PERMISSIONS", "MESSAGE_NEVER"),
        *("DIRECTORY_PERMISSIONS", "TYPE", "EXCLUDE"),
    }
)
_COMPILED = frozenset(
    {
        *("add_executable", "add_library", "ament_auto_add_executable", "ament_auto_add_library"),
        *("rclcpp_components_register_node", "pybind11_add_module", "python3_add_library"),
    }
)
_INTERFACES = (".msg", ".srv", ".action", ".idl")


@dataclass(frozen=True, slots=True)
class CopyRule:
    """Files or folders that are copied.

    Attributes:
        kind: ``FILES``, ``PROGRAMS`` or ``DIRECTORY``.
        items: what, relative to the package; the content of a folder where the text ends with a slash.
        destination: where to, relative to the prefix; None where that is not known.
        renamed: the name of the one file at its destination, where it changes.
        matching: of a folder only files that match one of these patterns; all when empty.
        without: of a folder nothing that matches one of these patterns.
        is_optional: whether it may be missing.
    """

    kind: str
    items: tuple[Argument, ...]
    destination: str | None
    renamed: str | None = None
    matching: tuple[str, ...] = ()
    without: tuple[str, ...] = ()
    is_optional: bool = False


@dataclass
class CMakeFile:
    """A ``CMakeLists.txt`` with what it calls and includes.

    Attributes:
        project: the name of the project, or None.
        copies: what it copies.
        targets: the names of the programs that it builds or installs.
        interfaces: the interface files that it generates code for, relative to the package.
        modules: the Python packages that it installs, folders relative to the package.
        compiled: what it compiles.
        unknown: why it may install more than was read here; empty where that is all.
        is_ament: whether it is the one of an ament package.
    """

    source: SourceText
    project: Argument | None = None
    copies: list[CopyRule] = field(default_factory=list)
    targets: set[str] = field(default_factory=set)
    interfaces: list[str] = field(default_factory=list)
    modules: list[str] = field(default_factory=list)
    compiled: list[str] = field(default_factory=list)
    unknown: list[str] = field(default_factory=list)
    is_ament: bool = False
    _generated: dict[str, tuple[str, dict[str, str]]] = field(default_factory=dict)

    @property
    def is_complete(self) -> bool:
        """Whether it installs nothing but what was read here and what it compiles."""
        return not self.unknown

    @property
    def directories(self) -> list[Argument]:
        """The folders that it installs, relative to the package."""
        return [item for rule in self.copies if rule.kind == "DIRECTORY" for item in rule.items]

    @property
    def files(self) -> list[Argument]:
        """The files that it installs."""
        return [item for rule in self.copies if rule.kind != "DIRECTORY" for item in rule.items]

    @property
    def required(self) -> list[Argument]:
        """The files and folders that have to be there."""
        return [item for rule in self.copies if not rule.is_optional for item in rule.items]

    @property
    def programs(self) -> dict[str, str]:
        """The programs that are files of the package: name -> path relative to the package."""
        return {
            rule.renamed or PurePosixPath(item.text).name: item.text
            for rule in self.copies
            if rule.kind == "PROGRAMS"
            for item in rule.items
        }

    @property
    def executables(self) -> set[str]:
        """The names of the programs that it installs or builds."""
        return self.targets | set(self.programs)

    def span(self, argument: Argument) -> Span:
        """The place of an argument."""
        return argument.source.span(argument.start, argument.end)

    def installed(self, package: Path, *, missing_ok: bool = False) -> Iterator[InstalledFile]:
        """What is copied, file by file.

        Args:
            package: the package's folder.
            missing_ok: whether what is not there is passed over.

        Raises:
            FileNotFoundError: a file or folder is not there; the exception carries its name.
        """
        for rule in self.copies:
            if rule.destination is not None:
                for item in rule.items:
                    yield from self._copied(rule, item.text, rule.destination, package, missing_ok=missing_ok)

    def _copied(
        self, rule: CopyRule, item: str, destination: str, package: Path, *, missing_ok: bool
    ) -> Iterator[InstalledFile]:
        into, name = PurePosixPath(destination), PurePosixPath(item).name
        made = self._generated.get(item)
        if made is not None:
            yield InstalledFile(made[0], str(into / (rule.renamed or name)), made[1])
            return
        path = package / item
        if not path.exists():
            if missing_ok or rule.is_optional or item.startswith(("$<", BUILD)):
                return
            raise FileNotFoundError(item)
        if path.is_file():
            yield InstalledFile(item, str(into / (rule.renamed or name)))
            return
        below = into if item.endswith("/") else into / path.resolve().name
        for file in sorted(path.rglob("*")):
            inside = PurePosixPath(file.relative_to(path).as_posix())
            if file.is_file() and _is_taken(rule, inside):
                yield InstalledFile(file.relative_to(package).as_posix(), str(below / inside))


def read_cmake(source: SourceText, package: Path | None = None) -> CMakeFile:
    """What a ``CMakeLists.txt`` says.

    Args:
        source: the file.
        package: the package's folder, for subdirectories, included files and patterns of files.
    """
    file = CMakeFile(source)
    program = CMakeProgram(package)
    for command in program.run(source):
        _take(file, command, program)
    file.unknown += [f"what its command {name}() installs is not known here" for name in program.unknown]
    return file


def _take(file: CMakeFile, command: Command, program: CMakeProgram) -> None:
    name, given, words = command.name, command.arguments, command.words
    if name in _COMPILED and "INTERFACE" not in words and words:
        file.compiled.append(words[0])
    if name == "project" and given:
        file.project = file.project or given[0]
    elif name in ("add_executable", "ament_auto_add_executable") and words and "$" not in words[0]:
        file.targets.add(words[0])
    elif name == "rclcpp_components_register_node":
        executable = _following(words, "EXECUTABLE")
        if executable is not None and "$" not in executable:
            file.targets.add(executable)
    elif name == "configure_file" and len(words) > 1 and "$" not in words[0]:
        made = words[1] if words[1].startswith(BUILD) else f"{program.variables['CMAKE_CURRENT_BINARY_DIR']}/{words[1]}"
        file._generated[made] = within_package(words[0], command.folder), dict(program.variables)
    elif name in ("install", "catkin_install_python") and words:
        _install(file, command)
    elif name == "rosidl_generate_interfaces":
        file.interfaces += [within_package(word, command.folder) for word in words if word.endswith(_INTERFACES)]
    elif name == "ament_python_install_package" and words:
        file.modules.append(within_package(_following(words, "PACKAGE_DIR") or words[0], command.folder))
    elif name in ("ament_package", "ament_auto_package"):
        file.is_ament = True
        if "INSTALL_TO_SHARE" in words:
            share = f"share/{file.project.text if file.project else ''}"
            _add(file, CopyRule("DIRECTORY", given[words.index("INSTALL_TO_SHARE") + 1 :], share), command)


def _install(file: CMakeFile, command: Command) -> None:
    given, words = command.arguments, command.words
    kind = words[0]
    items = tuple(takewhile(lambda argument: argument.text not in _KEYWORDS, given[1:]))
    if kind in ("FILES", "PROGRAMS", "DIRECTORY"):
        destination = _following(words, "DESTINATION")
        if destination is None or "$" in destination:
            file.unknown.append(f"'install({' '.join(words)})' cannot be read without CMake")
            destination = None
        else:
            destination = destination.removeprefix(f"{PREFIX}/")
        matching, without = _patterns(words)
        renamed = _following(words, "RENAME")
        is_optional = command.is_conditional or "OPTIONAL" in words
        rule = CopyRule(kind, items, destination, renamed, matching, without, is_optional)
        _add(file, rule, command)
    elif kind == "TARGETS":
        file.targets |= {item.text for item in items}
    elif kind in ("CODE", "SCRIPT"):
        file.unknown.append(f"what install({kind}) does is not known here")


def _add(file: CMakeFile, rule: CopyRule, command: Command) -> None:
    """Take in a rule with the items of it that are known."""
    known = tuple(
        Argument(within_package(item.text, command.folder), item.start, item.end, item.source)
        for item in rule.items
        if "$" not in item.text
    )
    if len(known) < len(rule.items):
        file.unknown.append(f"'{command.name}({' '.join(command.words)})' cannot be read without CMake")
    if known:
        file.copies.append(replace(rule, items=known))


def _following(words: Sequence[str], keyword: str) -> str | None:
    """The word after a keyword; None where there is none."""
    at = words.index(keyword) + 1 if keyword in words else len(words)
    return words[at] if at < len(words) else None


def _patterns(words: Sequence[str]) -> tuple[tuple[str, ...], tuple[str, ...]]:
    patterns = [
        (words[at + 1], words[at + 2 : at + 3] == ["EXCLUDE"])
        for at, word in enumerate(words[:-1])
        if word == "PATTERN"
    ]
    matching = tuple(pattern for pattern, excluded in patterns if not excluded)
    without = tuple(pattern for pattern, excluded in patterns if excluded)
    return (matching if "FILES_MATCHING" in words else ()), without


def _is_taken(rule: CopyRule, inside: PurePosixPath) -> bool:
    parts = inside.parts
    if any(fnmatch(part, pattern) for part in parts for pattern in rule.without):
        return False
    return not rule.matching or any(fnmatch(inside.name, pattern) for pattern in rule.matching)
