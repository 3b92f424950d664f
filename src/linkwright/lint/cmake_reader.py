"""What a ``CMakeLists.txt`` installs, as far as that can be read without CMake.

Commands are read with their arguments; variables that ``set()`` gives one value are put in. Where a file uses loops,
functions or included files, what it installs is not known in full.
"""

from __future__ import annotations

import re
from collections.abc import Iterator
from dataclasses import dataclass, field

from linkwright.diagnostics import SourceText, Span

_PIECE = re.compile(
    r"""
    (?P<blank>\s+)
  | (?P<comment>\#\[(?P<level>=*)\[.*?\](?P=level)\] | \#[^\n]*)
  | \[(?P<equals>=*)\[(?P<bracket>.*?)\](?P=equals)\]
  | "(?P<quoted>(?:[^"\\]|\\.)*)"
  | (?P<open>\() | (?P<close>\))
  | (?P<word>(?:[^\s()"\#\\]|\\.|"(?:[^"\\]|\\.)*")+)
    """,
    re.VERBOSE | re.DOTALL,
)
_VARIABLE = re.compile(r"\$\{([A-Za-z0-9_]+)\}")
_UNREADABLE = frozenset({"foreach", "function", "macro", "while", "include", "add_subdirectory", "file"})
_KEYWORDS = frozenset(
    {
        *("DESTINATION", "PERMISSIONS", "CONFIGURATIONS", "COMPONENT", "OPTIONAL", "EXCLUDE_FROM_ALL", "RENAME"),
        *("FILES_MATCHING", "PATTERN", "REGEX", "USE_SOURCE_PERMISSIONS", "FILE_PERMISSIONS", "MESSAGE_NEVER"),
        *("DIRECTORY_PERMISSIONS", "TYPE", "EXCLUDE"),
    }
)


@dataclass(frozen=True, slots=True)
class Argument:
    """An argument of a command: its text with known variables put in, and its offsets in the file."""

    text: str
    start: int
    end: int


@dataclass
class CMakeFile:
    """A ``CMakeLists.txt``.

    Attributes:
        project: the name of the project, or None.
        directories: the folders that it installs, as written, relative to the file.
        files: the files that it installs.
        executables: the names of the programs that it installs or builds.
        programs: those of them that are files of the package: name -> path relative to the file.
        is_complete: whether it installs nothing but what was read here.
    """

    source: SourceText
    project: Argument | None = None
    directories: list[Argument] = field(default_factory=list)
    files: list[Argument] = field(default_factory=list)
    executables: set[str] = field(default_factory=set)
    programs: dict[str, str] = field(default_factory=dict)
    is_complete: bool = True
    is_ament: bool = False

    def span(self, argument: Argument) -> Span:
        """The place of an argument."""
        return self.source.span(argument.start, argument.end)


def read_cmake(source: SourceText) -> CMakeFile:
    """What a ``CMakeLists.txt`` says."""
    file = CMakeFile(source)
    for command, given in commands_of(source):
        if command in _UNREADABLE:
            file.is_complete = False
        elif command == "project" and given:
            file.project = given[0]
        elif command == "add_executable" and given:
            file.executables.add(given[0].text)
        elif command in ("install", "catkin_install_python"):
            _install(file, command, given)
        elif command in ("ament_package", "ament_auto_package"):
            file.is_ament = True
            _install_to_share(file, given)
    return file


def commands_of(source: SourceText) -> Iterator[tuple[str, list[Argument]]]:
    """The commands of a file in lower case, each with its arguments, in which known variables are put in."""
    variables = {"CMAKE_CURRENT_SOURCE_DIR": ".", "CMAKE_SOURCE_DIR": ".", "PROJECT_SOURCE_DIR": "."}
    for command, arguments in _commands(source.text):
        given = [Argument(_filled(each.text, variables), each.start, each.end) for each in arguments]
        if command == "project" and given:
            variables["PROJECT_NAME"] = given[0].text
        elif command == "set" and given:
            if len(given) == 2 and given[0].text not in variables:
                variables[given[0].text] = given[1].text
            else:
                variables[given[0].text] = "${}"  # not known
        yield command, given


def _install(file: CMakeFile, command: str, given: list[Argument]) -> None:
    kind = "PROGRAMS" if command == "catkin_install_python" else given[0].text if given else ""
    items = _items(given[1:] if command == "install" else given)
    if any("$" in item.text for item in items):
        file.is_complete = False
    items = [item for item in items if "$" not in item.text]
    if kind == "DIRECTORY":
        file.directories += items
    elif kind in ("FILES", "PROGRAMS"):
        file.files += items
        if kind == "PROGRAMS":
            renamed = _following(given, "RENAME")
            names = [renamed] if renamed else [item.text.rpartition("/")[2] for item in items]
            file.executables.update(names)
            file.programs.update(zip(names, (item.text for item in items), strict=False))
    elif kind == "TARGETS":
        file.executables.update(item.text for item in items)
    elif kind in ("CODE", "SCRIPT"):
        file.is_complete = False


def _install_to_share(file: CMakeFile, given: list[Argument]) -> None:
    words = [argument.text for argument in given]
    if "INSTALL_TO_SHARE" in words:
        for item in given[words.index("INSTALL_TO_SHARE") + 1 :]:
            if "$" in item.text:
                file.is_complete = False
            else:
                file.directories.append(item)


def _items(given: list[Argument]) -> list[Argument]:
    items = []
    for argument in given:
        if argument.text in _KEYWORDS:
            break
        items.append(argument)
    return items


def _following(given: list[Argument], keyword: str) -> str | None:
    words = [argument.text for argument in given]
    at = words.index(keyword) + 1 if keyword in words else len(words)
    return words[at] if at < len(words) else None


def _filled(text: str, variables: dict[str, str]) -> str:
    filled = _VARIABLE.sub(lambda match: variables.get(match[1], match[0]), text)
    return filled.removeprefix("./")


def _commands(text: str) -> Iterator[tuple[str, list[Argument]]]:
    """The commands with their arguments; nested parentheses are flattened, comments left out."""
    at, name, depth = 0, "", 0
    arguments: list[Argument] = []
    while at < len(text):
        piece = _PIECE.match(text, at)
        if piece is None:
            at += 1
            continue
        at = piece.end()
        if piece["open"]:
            depth += 1
        elif piece["close"]:
            depth = max(0, depth - 1)
            if depth == 0 and name:
                yield name.lower(), arguments
                name, arguments = "", []
        elif piece["word"] and depth == 0:
            name, arguments = piece["word"], []
        elif depth and piece["blank"] is None and piece["comment"] is None:
            value = piece["word"] or piece["quoted"] or piece["bracket"] or ""
            quote = 1 if piece["quoted"] is not None else 0
            arguments += _split(value, piece.start() + quote, piece.end() - quote)


def _split(value: str, start: int, end: int) -> list[Argument]:
    return [Argument(value, start, end)]
