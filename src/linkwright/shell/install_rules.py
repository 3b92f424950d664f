"""What an ``ament_cmake`` package installs, read from its ``CMakeLists.txt``, for machines without ament.

Packages of descriptions, launch files, scripts and interfaces compile nothing; what CMake would do for them is to copy.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from fnmatch import fnmatch
from pathlib import Path, PurePosixPath

from linkwright.diagnostics import SourceText
from linkwright.lint.cmake_reader import commands_of

_COMPILED = frozenset(
    {
        *("add_executable", "add_library", "ament_auto_add_executable", "ament_auto_add_library"),
        *("rclcpp_components_register_node", "pybind11_add_module", "python3_add_library"),
    }
)
_UNKNOWN = frozenset({"foreach", "function", "macro", "while", "include", "add_subdirectory"})
_PLACES = frozenset({"DESTINATION", "RENAME", "TYPE"})
_ENDS = _PLACES | {
    *("PERMISSIONS", "CONFIGURATIONS", "COMPONENT", "OPTIONAL", "EXCLUDE_FROM_ALL", "FILES_MATCHING", "PATTERN"),
    *("REGEX", "USE_SOURCE_PERMISSIONS", "FILE_PERMISSIONS", "MESSAGE_NEVER", "DIRECTORY_PERMISSIONS"),
}
_INTERFACES = (".msg", ".srv", ".action", ".idl")


@dataclass(frozen=True, slots=True)
class CopyRule:
    """Files or folders that are copied.

    Attributes:
        kind: ``FILES``, ``PROGRAMS`` or ``DIRECTORY``.
        items: what, relative to the package; the content of a folder where the name ends with a slash.
        destination: where to, relative to the prefix.
        renamed: the name of the one file at its destination, where it changes.
        matching: of a folder only files that match one of these patterns; all when empty.
        without: of a folder nothing that matches one of these patterns.
    """

    kind: str
    items: tuple[str, ...]
    destination: str
    renamed: str | None = None
    matching: tuple[str, ...] = ()
    without: tuple[str, ...] = ()


@dataclass(frozen=True, slots=True)
class InstallRules:
    """What a ``CMakeLists.txt`` installs.

    Attributes:
        copies: what is copied.
        interfaces: the interface files that it generates code for, relative to the package.
        modules: the Python packages that it installs, folders relative to the package.
        obstacle: why that is not all that it does; None when it is.
    """

    copies: tuple[CopyRule, ...]
    interfaces: tuple[str, ...]
    modules: tuple[str, ...]
    obstacle: str | None

    def files(self, package: Path) -> Iterator[tuple[str, str]]:
        """What is copied, file by file: source relative to the package, destination relative to the prefix.

        Args:
            package: the package's folder.

        Raises:
            FileNotFoundError: a file or folder is not there; the exception carries its name.
        """
        for rule in self.copies:
            yield from _copied(rule, package)


def read_install_rules(source: SourceText, package_name: str) -> InstallRules:
    """What a package's ``CMakeLists.txt`` installs.

    Args:
        source: the file.
        package_name: the package's name, which destinations may contain.
    """
    copies: list[CopyRule] = []
    interfaces: list[str] = []
    modules: list[str] = []
    obstacle = None
    for command, given in commands_of(source):
        words = [each.text for each in given]
        if command in _COMPILED and "INTERFACE" not in words:
            obstacle = obstacle or f"it compiles '{words[0] if words else command}'"
        elif command in _UNKNOWN:
            obstacle = obstacle or f"what its command {command}() installs is not known here"
        elif command == "install" and words and words[0] in ("FILES", "PROGRAMS", "DIRECTORY"):
            rule = _copy_rule(words)
            if rule is None:
                obstacle = obstacle or f"'install({' '.join(words)})' cannot be read without CMake"
            else:
                copies.append(rule)
        elif command == "rosidl_generate_interfaces":
            interfaces += [word for word in words if word.endswith(_INTERFACES)]
        elif command == "ament_python_install_package" and words:
            modules.append(words[words.index("PACKAGE_DIR") + 1] if "PACKAGE_DIR" in words else words[0])
        elif command == "ament_auto_package" and "INSTALL_TO_SHARE" in words:
            shared = tuple(words[words.index("INSTALL_TO_SHARE") + 1 :])
            copies.append(CopyRule("DIRECTORY", shared, f"share/{package_name}"))
    return InstallRules(tuple(copies), tuple(interfaces), tuple(modules), obstacle)


def _copy_rule(words: Sequence[str]) -> CopyRule | None:
    """The rule of an ``install()``; None where a variable in it is not known."""
    items = tuple(_until_keyword(words[1:]))
    destination = _following(words, "DESTINATION")
    if destination is None or not items or any("$" in word for word in (*items, destination)):
        return None
    matching, without = _patterns(words)
    return CopyRule(words[0], items, destination, _following(words, "RENAME"), matching, without)


def _patterns(words: Sequence[str]) -> tuple[tuple[str, ...], tuple[str, ...]]:
    patterns = [(words[at + 1], words[at + 2 : at + 3] == ["EXCLUDE"]) for at in _places(words, "PATTERN")]
    matching = tuple(pattern for pattern, excluded in patterns if not excluded)
    without = tuple(pattern for pattern, excluded in patterns if excluded)
    return (matching if "FILES_MATCHING" in words else ()), without


def _places(words: Sequence[str], keyword: str) -> list[int]:
    return [at for at, word in enumerate(words[:-1]) if word == keyword]


def _following(words: Sequence[str], keyword: str) -> str | None:
    places = _places(words, keyword)
    return words[places[0] + 1] if places else None


def _until_keyword(words: Sequence[str]) -> Iterator[str]:
    for word in words:
        if word in _ENDS:
            return
        yield word


def _copied(rule: CopyRule, package: Path) -> Iterator[tuple[str, str]]:
    destination = PurePosixPath(rule.destination)
    for item in rule.items:
        path = package / item
        if not path.exists():
            raise FileNotFoundError(item)
        if path.is_file():
            yield item, str(destination / (rule.renamed or path.name))
            continue
        below = destination if item.endswith("/") else destination / path.name
        for file in sorted(path.rglob("*")):
            inside = PurePosixPath(file.relative_to(path).as_posix())
            if file.is_file() and _is_taken(rule, inside):
                yield file.relative_to(package).as_posix(), str(below / inside)


def _is_taken(rule: CopyRule, inside: PurePosixPath) -> bool:
    parts = inside.parts
    if any(fnmatch(part, pattern) for part in parts for pattern in rule.without):
        return False
    return not rule.matching or any(fnmatch(inside.name, pattern) for pattern in rule.matching)
