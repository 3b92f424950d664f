"""An interpreter for the part of CMake's language that determines a package's files.

Commands are yielded in the order in which CMake runs them. The interpreter evaluates variables, lists, texts, loops,
functions and macros of the file, and runs subdirectories and included files. It also evaluates patterns of files, and
conditions with known values. Facts that only CMake knows, such as the variables of ``find_package``, are unknown. If a
condition is unknown, all branches are run, and a variable that two branches set differently has no value. A variable
with an unknown value remains in the text as ``${...}``.
"""

from __future__ import annotations

import os
import posixpath
import re
import sys
from collections.abc import Iterable, Iterator, Sequence
from contextlib import contextmanager
from pathlib import Path

from linkwright.diagnostics import SourceText
from linkwright.loading.deferred import lazy_pattern
from linkwright.loading.lean_dataclasses import dataclass, field
from linkwright.packages.ament import ROS_VARIABLES
from linkwright.packages.readers.cmake_conditions import YES, Condition, Word
from linkwright.packages.readers.cmake_syntax import ENDS, Statement, Token, branches, end_of_block, is_open, statements
from linkwright.packages.readers.cmake_values import (
    UNKNOWN,
    evaluate_math,
    filename_component,
    items_of,
    list_command,
    string_command,
    version_variables,
)

_VARIABLE = lazy_pattern(r"\$\{([A-Za-z0-9_.+/-]+)\}")
_ENVIRONMENT = lazy_pattern(r"\$ENV\{(\w+)\}")
_DEEPEST = 20
_MOST_COMMANDS = 20_000
_LONGEST_TEXT = 1_000_000
_OF_A_COMMAND = 1_000
"""So many characters count as much as a command."""

SOURCE, BUILD, PREFIX = "<source>", "<build>", "<prefix>"
"""The names of the package's, build's and installation's folders in values of variables."""

_PLATFORM = {
    "WIN32": "1" if os.name == "nt" else "0",
    "MSVC": "1" if os.name == "nt" else "0",
    "UNIX": "0" if os.name == "nt" else "1",
    "APPLE": "1" if sys.platform == "darwin" else "0",
}
_FOUND = {"catkin_FOUND": "0", **dict.fromkeys(("ament_cmake_FOUND", "ament_cmake_auto_FOUND"), "1")}


@dataclass(frozen=True, slots=True)
class Argument:
    """An argument of a command.

    Attributes:
        text: the text with known variables substituted.
        start: the character offset where the argument starts in the file.
        end: the character offset where the argument ends, exclusive.
        source: the file.
    """

    text: str
    start: int
    end: int
    source: SourceText


@dataclass(frozen=True, slots=True)
class Command:
    """A command that CMake would run.

    Attributes:
        name: the name in lower case.
        arguments: the arguments.
        folder: the folder of the ``CMakeLists.txt``, relative to the package; empty for the package's own.
        is_conditional: whether the command is in a branch of an ``if`` whose condition is not known.
    """

    name: str
    arguments: tuple[Argument, ...]
    folder: str
    is_conditional: bool

    @property
    def words(self) -> list[str]:
        """The texts of the arguments."""
        return [argument.text for argument in self.arguments]


class _TooMuchError(Exception):
    """Raised with a command's name when a file takes too many steps or a text is too long."""


@dataclass(slots=True)
class _Routine:
    parameters: list[str]
    body: list[Statement]
    has_scope: bool


@dataclass(slots=True)
class CMakeProgram:
    """An interpreter that runs a ``CMakeLists.txt`` without CMake.

    Args:
        package: the folder of the package, in which subdirectories, included files and matches of patterns are
            searched; None if there is no folder.

    Attributes:
        variables: name -> value; the items of a list are separated by semicolons.
        unknown: the commands, such as ``foreach``, whose effect is not known.
    """

    package: Path | None
    variables: dict[str, str] = field(
        default_factory=lambda: {
            **dict.fromkeys(("CMAKE_CURRENT_SOURCE_DIR", "CMAKE_SOURCE_DIR", "PROJECT_SOURCE_DIR"), SOURCE),
            **dict.fromkeys(("CMAKE_CURRENT_BINARY_DIR", "CMAKE_BINARY_DIR", "PROJECT_BINARY_DIR"), BUILD),
            "CMAKE_CURRENT_LIST_DIR": SOURCE,
            "CMAKE_INSTALL_PREFIX": PREFIX,
            "CMAKE_INSTALL_DATADIR": "share",
            "CMAKE_INSTALL_DATAROOTDIR": "share",
            "CMAKE_INSTALL_BINDIR": "bin",
            "CMAKE_INSTALL_LIBDIR": "lib",
            "CMAKE_INSTALL_INCLUDEDIR": "include",
            **_PLATFORM,
            **_FOUND,
        }
    )
    unknown: list[str] = field(default_factory=list)
    _routines: dict[str, _Routine] = field(default_factory=dict)
    _folder: str = ""
    _conditions: int = 0
    _around: dict[str, int] = field(default_factory=dict)  # leaving command -> nesting of unknown conditions
    _leaving: str = ""
    _for_parent: dict[str, str] = field(default_factory=dict)
    _depth: int = 0
    _count: int = 0

    def run(self, source: SourceText) -> Iterator[Command]:
        """Yield the commands of a file, including those of called functions and included files."""
        try:
            yield from self._run_file(source)
        except _TooMuchError as error:
            self.unknown.append(str(error))

    def _run_file(self, source: SourceText) -> Iterator[Command]:
        with self._leavable_block("return"):
            yield from self._run_block(list(statements(source)))

    # --- blocks ------------------------------------------------------------------------------------------------------

    @contextmanager
    def _leavable_block(self, *commands: str) -> Iterator[None]:
        """Run a block that the given commands, such as ``break``, leave."""
        before = self._around
        self._around = {**before, **dict.fromkeys(commands, self._conditions)}
        try:
            yield
        finally:
            self._around = before
            if self._leaving in commands:
                self._leaving = ""

    def _run_block(self, body: Sequence[Statement]) -> Iterator[Command]:
        at = 0
        while at < len(body) and not self._leaving:
            statement = body[at]
            at += 1
            if statement.name in ENDS:
                end = end_of_block(body, at, statement.name)
                yield from self._run_compound(statement, list(body[at:end]))
                at = end + 1
            else:
                yield from self._run_command(statement)

    def _run_compound(self, opening: Statement, body: list[Statement]) -> Iterator[Command]:
        words = [argument.text for argument in self._arguments(opening)]
        if opening.name == "if":
            yield from self._run_branches(opening, body)
        elif opening.name == "while":
            yield from self._run_while(opening, body)
        elif opening.name in ("function", "macro") and words:
            self._routines[words[0].lower()] = _Routine(words[1:], body, opening.name == "function")
        elif opening.name == "foreach" and words:
            yield from self._run_foreach(words, body)

    def _run_branches(self, opening: Statement, body: Sequence[Statement]) -> Iterator[Command]:
        """Yield the commands of the branch with a true condition, and of unknown ones before it."""
        is_uncertain = False
        for condition, branch in branches(opening, body):
            answer = True if condition is None else self._holds(condition)
            if answer is False:
                continue
            is_uncertain = is_uncertain or answer is None
            self._conditions += is_uncertain
            yield from self._run_block(branch)
            self._conditions -= is_uncertain
            if answer:
                return

    def _holds(self, condition: Statement) -> bool | None:
        words = list[Word]()
        for token in condition.tokens:
            text = self._substituted(token)
            parts = [text] if token.is_quoted else items_of(text)
            words += [Word(part, token.is_quoted) for part in parts]
        return Condition(words, self.variables, self._is_there).answer()

    def _is_there(self, what: str, path: str) -> bool | None:
        if self.package is None or not path.startswith(SOURCE):
            return None
        found = self.package / within_package(path, self._folder)
        return found.is_dir() if what == "IS_DIRECTORY" else found.exists()

    def _run_while(self, opening: Statement, body: list[Statement]) -> Iterator[Command]:
        with self._leavable_block("break"):
            while not self._leaving:
                self._tick("while")
                answer = self._holds(opening)
                if answer is None:
                    self.unknown.append("while")
                if not answer:
                    return
                yield from self._run_once(body)

    def _run_foreach(self, words: list[str], body: list[Statement]) -> Iterator[Command]:
        loop = self._loop(words)
        if loop is None:
            self.unknown.append("foreach")
            return
        names, rounds = loop
        before = {name: self.variables.get(name) for name in names}
        with self._leavable_block("break"):
            for values in rounds:
                self._tick("foreach")
                self.variables.update(zip(names, values, strict=True))
                yield from self._run_once(body)
                if self._leaving:
                    break
        for name, value in before.items():
            _restore(self.variables, name, value)

    def _run_once(self, body: list[Statement]) -> Iterator[Command]:
        with self._leavable_block("continue"):
            yield from self._run_block(body)

    def _loop(self, words: list[str]) -> tuple[list[str], list[tuple[str, ...]]] | None:
        """Return the variables that a ``foreach`` loop sets, and their values in each iteration.

        The result is None if the values are not known.
        """
        if "IN" in words[1:] and words[words.index("IN", 1) :][1:2] == ["ZIP_LISTS"]:
            at = words.index("IN", 1)
            names, lists = words[:at], [items_of(self.variables.get(word, UNKNOWN)) for word in words[at + 2 :]]
            if len(names) != len(lists) or len({len(items) for items in lists}) != 1:
                return None
            rounds = list(zip(*lists, strict=True))
        elif words[1:2] == ["RANGE"]:
            names, rounds = words[:1], [(str(number),) for number in _range(words[2:])]
            if not rounds:
                return None
        else:
            names, rounds = words[:1], [(item,) for item in self._loop_items(words[1:])]
        return None if any(is_open(item) for values in rounds for item in values) else (names, rounds)

    def _loop_items(self, words: Sequence[str]) -> list[str]:
        items, kind = list[str](), "ITEMS"
        for word in words[1:] if words[:1] == ["IN"] else words:
            if words[0] == "IN" and word in ("LISTS", "ITEMS"):
                kind = word
            elif kind == "LISTS":
                items += items_of(self.variables.get(word, UNKNOWN))
            else:
                items.append(word)
        return items

    def _tick(self, name: str) -> None:
        self._count += 1
        if self._count > _MOST_COMMANDS:
            raise _TooMuchError(name)

    # --- commands ----------------------------------------------------------------------------------------------------

    def _run_command(self, statement: Statement) -> Iterator[Command]:
        name = statement.name
        self._tick(name)
        command = Command(name, tuple(self._arguments(statement)), self._folder, self._conditions > 0)
        words = command.words
        if name in ("return", "break", "continue"):
            self._leaving = name if self._conditions == self._around.get(name) else ""
        elif name in self._routines:
            yield from self._call(self._routines[name], words)
        elif name in ("add_subdirectory", "include") and words:
            yield from self._run_other_file(name, words[0])
        else:
            self._apply_assignment(name, words)
            yield command

    def _call(self, routine: _Routine, words: list[str]) -> Iterator[Command]:
        if self._depth >= _DEEPEST:
            self.unknown.append("function")
            return
        outside = dict(self.variables)
        bound = dict(zip(routine.parameters, words, strict=False))
        bound |= {f"ARGV{number}": word for number, word in enumerate(words)}
        bound |= {"ARGV": ";".join(words), "ARGN": ";".join(words[len(routine.parameters) :]), "ARGC": str(len(words))}
        self.variables.update(bound)
        self._depth += 1
        for_parent = self._for_parent
        if routine.has_scope:
            self._for_parent = {}
        with self._leavable_block("return"):
            yield from self._run_block(routine.body)
        self._depth -= 1
        if routine.has_scope:
            self.variables = outside | self._for_parent
            self._for_parent = for_parent
        else:
            for name in bound:
                _restore(self.variables, name, outside.get(name))

    def _run_other_file(self, command: str, word: str) -> Iterator[Command]:
        is_folder = command == "add_subdirectory"
        if not is_folder and "/" not in word and not word.endswith(".cmake"):
            return  # a module of CMake itself, which installs nothing
        place = within_package(word, self._folder)
        path = (
            None
            if self.package is None or is_open(place)
            else self.package / place / ("CMakeLists.txt" if is_folder else "")
        )
        try:
            text = None if path is None else path.read_text(encoding="utf-8", errors="replace")
        except OSError:
            text = None
        if text is None or self._depth >= _DEEPEST:
            self.unknown.append(command)
            return
        outside, folder, for_parent = dict(self.variables), self._folder, self._for_parent
        self.variables["CMAKE_CURRENT_LIST_DIR"] = posixpath.join(
            SOURCE, place if is_folder else posixpath.dirname(place)
        )
        if is_folder:
            self._folder = "" if place == "." else place
            self._for_parent = {}
            self.variables["CMAKE_CURRENT_SOURCE_DIR"] = posixpath.join(SOURCE, place)
            self.variables["CMAKE_CURRENT_BINARY_DIR"] = posixpath.join(BUILD, place)
        self._depth += 1
        yield from self._run_file(SourceText(str(path), text))
        self._depth -= 1
        self._folder = folder
        if is_folder:
            self.variables = outside | self._for_parent
            self._for_parent = for_parent
        else:
            self.variables["CMAKE_CURRENT_LIST_DIR"] = outside["CMAKE_CURRENT_LIST_DIR"]

    # --- variables ---------------------------------------------------------------------------------------------------

    def _apply_assignment(self, name: str, words: list[str]) -> None:
        """Set the variables that a command such as ``set`` or ``list`` changes."""
        if name == "project" and words:
            self.variables["PROJECT_NAME"] = self.variables["CMAKE_PROJECT_NAME"] = words[0]
            self.variables |= {f"{words[0]}_SOURCE_DIR": SOURCE, f"{words[0]}_BINARY_DIR": BUILD}
            self.variables |= version_variables(words)
            for variable in ("CATKIN_PACKAGE_SHARE_DESTINATION", "CATKIN_PACKAGE_BIN_DESTINATION"):
                self.variables[variable] = f"{'share' if 'SHARE' in variable else 'lib'}/{words[0]}"
        elif name == "set" and words:
            self._set_values(words)
        elif name == "option" and words:
            self._set(words[0], words[2] if len(words) > 2 else "OFF")
        elif name == "unset" and words:
            self.variables.pop(words[0], None)
        elif name == "list" and len(words) > 1:
            self._change_list(words)
        elif name == "string" and len(words) > 1:
            for target, value in string_command(words, self._value).items():
                self._set(target, value)
        elif name == "math" and len(words) > 2:
            self._set(words[1], evaluate_math(words[2]))
        elif name == "get_filename_component" and len(words) > 2:
            self._set(words[0], filename_component(words[1], words[2]))
        elif name == "file" and len(words) > 1 and words[0] in ("GLOB", "GLOB_RECURSE"):
            self._set(words[1], self._glob_files(words[2:], recursive=words[0] == "GLOB_RECURSE"))
        elif name == "cmake_parse_arguments" and len(words) >= 4:
            self._parse_arguments(words)

    def _set_values(self, words: list[str]) -> None:
        name, values = words[0], words[1:]
        if name.startswith("ENV{"):
            return
        if "CACHE" in values:
            values = values[: values.index("CACHE")]
        if values[-1:] == ["PARENT_SCOPE"]:
            value = ";".join(values[:-1])
            self._for_parent[name] = UNKNOWN if self._conditions or is_open(value) else value
        else:
            self._set(name, ";".join(values))

    def _value(self, name: str) -> str:
        return self.variables.get(name, "")

    def _set(self, name: str, value: str) -> None:
        is_certain = not self._conditions or self.variables.get(name, value) == value
        self.variables[name] = value if is_certain and not is_open(value) else UNKNOWN

    def _change_list(self, words: list[str]) -> None:
        for target, value in list_command(words[0], words[1:], self._value).items():
            if words[0] in ("APPEND", "PREPEND"):
                self.variables[target] = value  # also in a branch: a possible item counts as an item
            else:
                self._set(target, value)

    def _glob_files(self, words: list[str], *, recursive: bool) -> str:
        """Return the files that match the patterns of ``file(GLOB ...)``, as a CMake list."""
        base: str | None = None
        with_folders = not recursive
        patterns: list[str] = []
        rest = iter(words)
        for word in rest:
            if word == "RELATIVE":
                base = within_package(next(rest, ""), self._folder)
            elif word == "LIST_DIRECTORIES":
                with_folders = next(rest, "").upper() in YES
            elif word not in ("CONFIGURE_DEPENDS", "FOLLOW_SYMLINKS"):
                patterns.append(within_package(word, self._folder))
        if self.package is None or any(map(is_open, words)):
            return UNKNOWN
        if any(pattern.startswith(("/", "..", "<")) for pattern in patterns):
            return UNKNOWN
        found = {
            path.relative_to(self.package).as_posix()
            for pattern in patterns
            for path in _glob_paths(self.package, pattern, recursive=recursive)
            if with_folders or path.is_file()
        }
        if base is None:
            return ";".join(f"{SOURCE}/{path}" for path in sorted(found))
        return ";".join(posixpath.relpath(path, base or ".") for path in sorted(found))

    def _parse_arguments(self, words: list[str]) -> None:
        if words[0] == "PARSE_ARGV":
            arguments = items_of(self._value("ARGV"))[int(words[1]) if words[1].isdecimal() else 0 :]
            words = [*words[2:6], *arguments]
        prefix, options, single, many, *arguments = words
        kinds = {name: kind for kind, names in enumerate((options, single, many)) for name in items_of(names)}
        values: dict[str, list[str]] = {}
        current = "UNPARSED_ARGUMENTS"
        for word in (item for text in arguments for item in items_of(text)):
            if word in kinds:
                values[word] = ["TRUE"] if kinds[word] == 0 else []
                current = "UNPARSED_ARGUMENTS" if kinds[word] == 0 else word
            else:
                values.setdefault(current, []).append(word)
                if kinds.get(current) == 1:
                    current = "UNPARSED_ARGUMENTS"
        for name in (*kinds, "UNPARSED_ARGUMENTS"):
            self.variables[f"{prefix}_{name}"] = ";".join(values.get(name, ["FALSE"] if kinds.get(name) == 0 else []))

    def _arguments(self, statement: Statement) -> Iterator[Argument]:
        for token in statement.tokens:
            text = self._substituted(token)
            self._count += len(text) // _OF_A_COMMAND
            for item in [text] if token.is_quoted else items_of(text):
                yield Argument(item, token.start, token.end, statement.source)

    def _substituted(self, token: Token) -> str:
        """Substitute the values of known variables in an argument, and return the text."""
        text, room = token.text, _LONGEST_TEXT

        def value(match: re.Match[str]) -> str:
            nonlocal room
            found = self.variables.get(match[1], match[0])
            room -= len(found)
            if room < 0:
                raise _TooMuchError(token.text)
            return found

        for _ in range(_DEEPEST if token.has_variables else 0):  # nested references: ${${NAME}_FILES}
            filled = _ENVIRONMENT.sub(lambda match: _environment(match[1]) or match[0], text)
            filled = _VARIABLE.sub(value, filled)
            if filled == text:
                break
            text = filled
        return text


def _environment(name: str) -> str | None:
    """Return the value of one of ROS's environment variables, or None for any other variable."""
    return os.environ.get(name, ROS_VARIABLES[name]) if name in ROS_VARIABLES else None


def _range(words: Sequence[str]) -> range:
    """Return the numbers of ``foreach(i RANGE ...)``, including the last.

    The result is empty if an argument is not an integer or the range is too long.
    """
    try:
        numbers = [int(word) for word in words]
    except ValueError:
        return range(0)
    start, stop, step = [0, *numbers, 1][:3] if len(numbers) == 1 else [*numbers, 1, 1][:3]
    return range(start, stop + 1, step) if step > 0 and stop - start < _MOST_COMMANDS else range(0)


def _glob_paths(package: Path, pattern: str, *, recursive: bool) -> Iterable[Path]:
    """Return the paths in a package that match a CMake pattern.

    As in CMake, ``**`` has the same meaning as ``*``.
    """
    folder, _, last = re.sub(r"\*+", "*", pattern).rpartition("/")
    if last in ("", "."):
        return ()  # the pattern matches only the folder itself
    return (package / folder).rglob(last) if recursive else package.glob(posixpath.join(folder, last))


def within_package(text: str, folder: str) -> str:
    """Convert a path in a command to a path relative to the package.

    A trailing slash is preserved. Other absolute paths, generator expressions and paths in the build folder are
    returned unchanged.

    Args:
        text: the path in the command.
        folder: the folder of the command, relative to the package.
    """
    if text.startswith(("/", "$<", BUILD)):
        return text
    below = text[len(SOURCE) :].lstrip("/") if text.startswith(SOURCE) else posixpath.join(folder, text)
    path = posixpath.normpath(below or ".")
    return f"{path}/" if text.endswith("/") and not path.endswith("/") else path


def _restore(variables: dict[str, str], name: str, value: str | None) -> None:
    if value is None:
        variables.pop(name, None)
    else:
        variables[name] = value
