"""Language features for ``CMakeLists.txt``: packages, targets, paths and commands."""

from __future__ import annotations

import re
from collections.abc import Iterable, Iterator
from dataclasses import dataclass
from functools import cached_property
from pathlib import Path

from linkwright.language.completion import Completion, ItemKind
from linkwright.language.format import Document, Format, Symbol, SymbolKind, Target
from linkwright.language.hover import Explanation
from linkwright.language.links import FileReference
from linkwright.language.offers import explain_file, explain_package, offer_files, offer_packages, target_of_package
from linkwright.language.programs import BUILD_DEPENDENCY
from linkwright.packages.readers.entry_points import read_text
from linkwright.packages.share_layout import find_source

_FILE_NAME = "CMakeLists.txt"
_COMMANDS = {
    "find_package": "finds a package that the build needs",
    "ament_target_dependencies": "adds the headers and libraries of packages to a target",
    "target_link_libraries": "links a target with libraries",
    "target_include_directories": "adds folders with headers to a target",
    "add_executable": "builds a program from sources",
    "add_library": "builds a library from sources",
    "install": "installs targets, programs, files or folders",
    "ament_python_install_package": "installs a Python package",
    "ament_package": "registers the package; it must be the last command",
    "ament_export_dependencies": "names packages that users of this package need, too",
    "ament_export_targets": "exports targets to other packages",
    "ament_export_include_directories": "exports folders with headers",
    "rosidl_generate_interfaces": "generates the code of messages, services and actions",
    "rclcpp_components_register_node": "registers a component, and builds a program that runs it",
    "rclcpp_components_register_nodes": "registers components",
    "pluginlib_export_plugin_description_file": "registers the plugins that a file describes",
    "ament_auto_find_build_dependencies": "finds the packages on which package.xml depends",
    "ament_auto_add_executable": "builds a program with all found packages",
    "ament_auto_add_library": "builds a library with all found packages",
    "ament_auto_package": "installs all targets and some folders, and registers the package",
    "ament_lint_auto_find_test_dependencies": "runs the linters on which package.xml depends",
    "add_launch_test": "runs a test of a launch file",
    "ament_add_gtest": "builds and runs a test with GoogleTest",
    "ament_add_pytest_test": "runs a test with pytest",
    "project": "names the project, as package.xml does",
    "cmake_minimum_required": "names the oldest CMake that can build the project",
    "set": "sets a variable",
    "if": "begins commands for a condition",
    "foreach": "repeats commands",
}
_PACKAGE_COMMANDS = frozenset({"find_package", "ament_target_dependencies", "ament_export_dependencies"})
_KEYWORDS = {
    "install": ("DIRECTORY", "TARGETS", "PROGRAMS", "FILES", "DESTINATION"),
    "find_package": ("REQUIRED", "QUIET", "COMPONENTS"),
    "rosidl_generate_interfaces": ("DEPENDENCIES",),
    "rclcpp_components_register_node": ("PLUGIN", "EXECUTABLE"),
}
_DESTINATIONS = ("share/${PROJECT_NAME}", "lib/${PROJECT_NAME}", "include", "lib", "bin")
_INTERFACE_SUFFIXES = (".msg", ".srv", ".action")
_SOURCE_SUFFIXES = (".cpp", ".cc", ".cxx", ".c")
_COMMAND_OPENING = re.compile(r"(\w+)\s{0,9}\(")
_CALL = re.compile(r"(?i)\b([a-z_]\w*)\s{0,9}\(([^()]*)\)?")
_COMMENT = re.compile(r"#[^\n]*")
_WORD_BEFORE_CURSOR = re.compile(r"[^\s\"();#]*$")
_WHOLE_WORD = re.compile(r"[^\s\"();#]+")
_TARGET = re.compile(r"(?i)\badd_(?:executable|library)\s{0,9}\(\s{0,99}([\w-]+)")
_FIND_PACKAGE = re.compile(r"(?i)\bfind_package\s{0,9}\(\s{0,99}([\w-]+)")
_STATEMENT_START = re.compile(r"(?:^|\n)[ \t]*(\w*)$")
_MAX_CHARACTERS_BEFORE = 20_000


@dataclass
class _CMakeCursor:
    """A build file, and a cursor position in it."""

    document: Document
    offset: int

    @cached_property
    def before(self) -> str:
        """The text before the cursor, with spaces instead of comments."""
        begin = max(0, self.offset - _MAX_CHARACTERS_BEFORE)
        text = self.document.text[begin : self.offset]
        return _COMMENT.sub(lambda comment: " " * len(comment[0]), text)

    @cached_property
    def call(self) -> tuple[str, list[str]] | None:
        """The command around the cursor, and its arguments before the one being typed, or None."""
        start = self.before.rfind("(")
        if start < 0 or ")" in self.before[start:]:
            return None
        opening = next((match for match in _COMMAND_OPENING.finditer(self.before) if match.end() == start + 1), None)
        words = self.before[start + 1 : len(self.before) - len(self.typed)].split()
        return None if opening is None else (opening[1].lower(), [word.strip('"') for word in words])

    @cached_property
    def typed(self) -> str:
        """The word that ends at the cursor."""
        match = _WORD_BEFORE_CURSOR.search(self.before)
        return "" if match is None else match[0]

    @cached_property
    def word(self) -> tuple[int, int]:
        """The start and end offset of the whole word around the cursor."""
        start = self.offset - len(self.typed)
        match = _WHOLE_WORD.match(self.document.text, start)
        return (start, start) if match is None else match.span()

    @property
    def folder(self) -> Path:
        """The folder of the package."""
        return self.document.file.parent

    def keyword(self, words: Iterable[str]) -> str:
        """Return the last keyword in capitals, or an empty string if there is none."""
        return next((word for word in reversed([*words]) if word.isupper() and not word.startswith("$")), "")

    def targets(self) -> list[str]:
        """Return the names of the targets that the file builds."""
        return [*dict.fromkeys(_TARGET.findall(self.document.text))]

    def packages(self, start: int) -> Iterator[Completion]:
        """Yield completions of packages that the file does not find yet.

        Declared dependencies come first.
        """
        found_packages = set(_FIND_PACKAGE.findall(self.document.text[:start] + self.document.text[self.offset :]))
        declared = BUILD_DEPENDENCY.findall(read_text(self.folder / "package.xml"))
        for name in dict.fromkeys(dependency for dependency in declared if dependency not in found_packages):
            yield Completion(name, ItemKind.PACKAGE, start, "package.xml")
        yield from (item for item in offer_packages(self.document, start) if item.label not in found_packages)


def _complete(document: Document, offset: int) -> Iterator[Completion]:
    completions: dict[str, Completion] = {}
    for item in _offer_completions(_CMakeCursor(document, offset)):
        completions.setdefault(item.label, item)
    yield from completions.values()


def _offer_completions(build: _CMakeCursor) -> Iterator[Completion]:
    start = build.offset - len(build.typed)
    if build.call is None:
        if _STATEMENT_START.search(build.before):
            for name, purpose in _COMMANDS.items():
                yield Completion(name, ItemKind.FUNCTION, start, "", purpose, f"{name}($0)")
        return
    command, words = build.call
    keyword = build.keyword(words)
    if command == "find_package" and not words:
        yield from build.packages(start)
    elif (command == "ament_target_dependencies" and words) or command == "ament_export_dependencies":
        names = dict.fromkeys(_FIND_PACKAGE.findall(build.document.text))
        yield from _make_value_completions((name for name in names if name not in words), start, ItemKind.PACKAGE)
    elif command == "install" and keyword in ("DIRECTORY", "FILES", "PROGRAMS"):
        yield from offer_files(build.folder, build.typed, build.offset)
    elif keyword.endswith("DESTINATION"):
        yield from _make_value_completions(_DESTINATIONS, start)
    elif command == "rosidl_generate_interfaces" and words and keyword != "DEPENDENCIES":
        yield from _make_value_completions(
            (name for name in _list_interface_files(build.folder) if name not in words), start, ItemKind.FILE
        )
    elif command == "rosidl_generate_interfaces" and words:
        yield from build.packages(start)
    elif command == "pluginlib_export_plugin_description_file" and words:
        yield from offer_files(build.folder, build.typed, build.offset)
    elif command == "pluginlib_export_plugin_description_file":
        yield from _make_value_completions(
            ("hardware_interface", "controller_interface", "nav2_core", "rviz_common"), start
        )
        yield from build.packages(start)
    elif command in ("add_executable", "add_library", "ament_auto_add_executable", "ament_auto_add_library"):
        if words:
            yield from offer_files(build.folder, build.typed, build.offset)
    elif command == "project" and not words:
        yield Completion(build.folder.name, ItemKind.PACKAGE, start)
    elif (
        command.startswith("target_") or (command == "install" and keyword == "TARGETS") or command in _TARGET_COMMANDS
    ):
        yield from _make_value_completions((name for name in build.targets() if name not in words), start)
    yield from _make_value_completions((word for word in _KEYWORDS.get(command, ()) if word not in words), start)
    if not build.typed or build.typed.startswith("$"):
        yield Completion("${PROJECT_NAME}", ItemKind.VALUE, start)


_TARGET_COMMANDS = frozenset({"ament_target_dependencies", "rclcpp_components_register_node", "ament_export_targets"})


def _make_value_completions(names: Iterable[str], start: int, kind: ItemKind = ItemKind.VALUE) -> Iterator[Completion]:
    for name in names:
        yield Completion(name, kind, start)


def _list_interface_files(folder: Path) -> list[str]:
    """Return the paths of the message, service and action files, relative to the package."""
    files = (file for part in ("msg", "srv", "action") for file in sorted((folder / part).glob("*")))
    return [file.relative_to(folder).as_posix() for file in files if file.suffix in _INTERFACE_SUFFIXES]


# --- hover, definition and links --------------------------------------------------------------------------------------


def _explain(document: Document, offset: int) -> Explanation | None:
    build = _CMakeCursor(document, offset)
    start, end = build.word
    word = document.text[start:end]
    if build.call is None:
        purpose = _COMMANDS.get(word.lower())
        return None if purpose is None else Explanation(f"`{word}`: {purpose}", start, end)
    text = explain_package(document, word) if build.call[0] in _PACKAGE_COMMANDS and word.isidentifier() else None
    path = _find_path(document, word)
    if text is None and path is not None:
        text = explain_file(path)
    return Explanation(text, start, end) if text else None


def _find_path(document: Document, word: str) -> Path | None:
    """Return the existing file or folder that a word names, or None."""
    if not word or "$" in word or "\0" in word:
        return None
    try:
        path = document.file.parent / word
        return path if path.exists() and path != document.file.parent else None
    except OSError:
        return None


def _define(document: Document, offset: int) -> Iterator[Target]:
    build = _CMakeCursor(document, offset)
    start, end = build.word
    word = document.text[start:end]
    if build.call is None or not word:
        return
    if build.call[0] in _PACKAGE_COMMANDS:
        yield from target_of_package(document, word)
    for match in _TARGET.finditer(document.text):
        if match[1] == word:
            yield Target(document.file, *match.span(1))
            return
    path = _find_path(document, word)
    if path is not None and path.is_file():
        yield Target(Path(find_source(str(path))))


def _links(document: Document) -> Iterator[FileReference]:
    text = _COMMENT.sub(lambda comment: " " * len(comment[0]), document.text)
    for call in _CALL.finditer(text):
        for word in _WHOLE_WORD.finditer(text, *call.span(2)):
            path = _find_path(document, word[0])
            if path is not None and path.is_file():
                yield FileReference(*word.span(), path)


def _symbols(document: Document) -> Iterator[Symbol]:
    for match in _TARGET.finditer(document.text):
        yield Symbol(match[1], SymbolKind.FUNCTION, *match.span(1))


CMAKE_FILES = Format(lambda file: file.name == _FILE_NAME, _complete, _explain, _define, _links, _symbols)
"""The format of ``CMakeLists.txt``."""
