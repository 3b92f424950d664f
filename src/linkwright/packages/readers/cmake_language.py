"""An interpreter for the part of CMake's language that determines a package's files.

Commands are yielded in the order in which CMake runs them. The interpreter evaluates variables, lists, texts, loops,
functions and macros of the file, and runs subdirectories and included files. It also evaluates file patterns, and
conditions with known values. Values that only CMake can compute, such as the variables of ``find_package``, are
unknown. If a condition is unknown, all branches are run, and a variable that two branches set differently becomes
unknown. A variable with an unknown value remains in the text as ``${...}``.
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
from linkwright.packages.readers.cmake_conditions import TRUE_CONSTANTS, Condition, Word
from linkwright.packages.readers.cmake_syntax import (
    BLOCK_ENDS,
    MAX_NESTED_BLOCKS,
    Statement,
    Token,
    find_end_of_block,
    is_open,
    parse_statements,
    split_branches,
)
from linkwright.packages.readers.cmake_values import (
    UNKNOWN,
    compute_version_variables,
    evaluate_list_command,
    evaluate_math,
    evaluate_string_command,
    extract_filename_component,
    find_major_version,
    split_items,
)

_VARIABLE = lazy_pattern(r"\$\{([A-Za-z0-9_.+/-]+)\}")
_ENVIRONMENT = lazy_pattern(r"\$ENV\{(\w+)\}")
_MAX_DEPTH = 20
_MAX_COMMANDS = 20_000
_MAX_TEXT_LENGTH = 1_000_000
_CHARACTERS_PER_COMMAND = 1_000
"""The number of characters that count as one command towards `_MAX_COMMANDS`."""

SOURCE, BUILD, PREFIX = "<source>", "<build>", "<prefix>"
"""The placeholders for the package, build and installation folders in the values of variables."""

_PLATFORM_VARIABLES = {
    "WIN32": "1" if os.name == "nt" else "0",
    "MSVC": "1" if os.name == "nt" else "0",
    "UNIX": "0" if os.name == "nt" else "1",
    "APPLE": "1" if sys.platform == "darwin" else "0",
}
_FOUND_VARIABLES = {"catkin_FOUND": "0", **dict.fromkeys(("ament_cmake_FOUND", "ament_cmake_auto_FOUND"), "1")}
_CATKIN_FOLDERS = {
    "PACKAGE_SHARE": "share/{}",
    "PACKAGE_BIN": "lib/{}",
    "PACKAGE_LIB": "lib",
    "PACKAGE_INCLUDE": "include/{}",
    "PACKAGE_ETC": "etc/{}",
    "GLOBAL_SHARE": "share",
    "GLOBAL_BIN": "bin",
    "GLOBAL_LIB": "lib",
    "GLOBAL_INCLUDE": "include",
}
"""The folders of catkin's variables, such as ``CATKIN_PACKAGE_BIN_DESTINATION``, with a place for the project."""


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
        arguments: the arguments, with the values of known variables.
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


class _LimitExceededError(Exception):
    """Raised when a file runs too many commands, nests too many blocks, or a text is too long.

    The argument names the command or text.
    """


@dataclass(slots=True)
class _Routine:
    parameters: list[str]
    body: list[Statement]
    has_scope: bool


@dataclass(slots=True)
class CMakeProgram:
    """An interpreter for a ``CMakeLists.txt``, without CMake.

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
            **_PLATFORM_VARIABLES,
            **_FOUND_VARIABLES,
        }
    )
    unknown: list[str] = field(default_factory=list)
    _routines: dict[str, _Routine] = field(default_factory=dict)
    _folder: str = ""
    _unknown_conditions: int = 0
    _replaced_values: dict[str, str | None] = field(default_factory=dict)  # before the current branch of an `if`
    _enclosing_depths: dict[str, int] = field(default_factory=dict)  # e.g. `break` -> unknown conditions around it
    _exit_command: str = ""
    _parent_values: dict[str, str] = field(default_factory=dict)
    _depth: int = 0
    _block_depth: int = 0
    _count: int = 0

    @property
    def routines(self) -> frozenset[str]:
        """The names of the functions and macros that the run file and its included files define."""
        return frozenset(self._routines)

    def run(self, source: SourceText) -> Iterator[Command]:
        """Yield the commands of a file, including commands in called functions and included files."""
        try:
            yield from self._run_file(source)
        except _LimitExceededError as error:
            self.unknown.append(str(error))

    def _run_file(self, source: SourceText) -> Iterator[Command]:
        with self._leavable_block("return"):
            yield from self._run_block(list(parse_statements(source)))

    # --- blocks ------------------------------------------------------------------------------------------------------

    @contextmanager
    def _leavable_block(self, *commands: str) -> Iterator[None]:
        """Return a context manager for a block that the given commands, such as ``break``, leave."""
        outer_depths = self._enclosing_depths
        self._enclosing_depths = {**outer_depths, **dict.fromkeys(commands, self._unknown_conditions)}
        try:
            yield
        finally:
            self._enclosing_depths = outer_depths
            if self._exit_command in commands:
                self._exit_command = ""

    def _run_block(self, body: Sequence[Statement]) -> Iterator[Command]:
        index = 0
        while index < len(body) and not self._exit_command:
            statement = body[index]
            index += 1
            if statement.name in BLOCK_ENDS:
                end = find_end_of_block(body, index, statement.name)
                self._block_depth += 1
                if self._block_depth > MAX_NESTED_BLOCKS:
                    raise _LimitExceededError(statement.name)
                yield from self._run_compound(statement, list(body[index:end]))
                self._block_depth -= 1
                index = end + 1
            else:
                yield from self._run_command(statement)

    def _run_compound(self, opening: Statement, body: list[Statement]) -> Iterator[Command]:
        words = [argument.text for argument in self._expand_arguments(opening)]
        if opening.name == "if":
            yield from self._run_branches(opening, body)
        elif opening.name == "while":
            yield from self._run_while(opening, body)
        elif opening.name in ("function", "macro") and words:
            self._routines[words[0].lower()] = _Routine(words[1:], body, opening.name == "function")
        elif opening.name == "foreach" and words:
            yield from self._run_foreach(words, body)

    def _run_branches(self, opening: Statement, body: Sequence[Statement]) -> Iterator[Command]:
        """Yield the commands of the first true branch, and of possible branches before it."""
        is_uncertain = False
        for condition, branch in split_branches(opening, body):
            is_true = True if condition is None else self._evaluate_condition(condition)
            if is_true is False:
                continue
            is_uncertain = is_uncertain or is_true is None
            self._unknown_conditions += is_uncertain
            outer_values, self._replaced_values = self._replaced_values, {}
            yield from self._run_block(branch)
            self._unknown_conditions -= is_uncertain
            for name, value in self._replaced_values.items():
                outer_values.setdefault(name, value)
                if is_uncertain and value is not None and self.variables.get(name) != value:
                    self.variables[name] = UNKNOWN
            self._replaced_values = outer_values
            if is_true:
                return

    def _evaluate_condition(self, condition: Statement) -> bool | None:
        condition_words = list[Word]()
        for token in condition.tokens:
            text = self._substitute(token)
            items = [text] if token.is_quoted else split_items(text)
            condition_words += [Word(part, token.is_quoted) for part in items]
        return Condition(condition_words, self.variables, self._path_exists).evaluate()

    def _path_exists(self, test: str, path: str) -> bool | None:
        if self.package is None or not path.startswith(SOURCE):
            return None
        full_path = self.package / to_package_path(path, self._folder)
        return full_path.is_dir() if test == "IS_DIRECTORY" else full_path.exists()

    def _run_while(self, opening: Statement, body: list[Statement]) -> Iterator[Command]:
        with self._leavable_block("break"):
            while not self._exit_command:
                self._count_command("while")
                is_true = self._evaluate_condition(opening)
                if is_true is None:
                    self.unknown.append("while")
                if not is_true:
                    return
                yield from self._run_once(body)

    def _run_foreach(self, words: list[str], body: list[Statement]) -> Iterator[Command]:
        loop = self._read_loop(words)
        if loop is None:
            self.unknown.append("foreach")
            return
        names, iterations = loop
        old_values = {name: self.variables.get(name) for name in names}
        with self._leavable_block("break"):
            for values in iterations:
                self._count_command("foreach")
                self.variables.update(zip(names, values, strict=True))
                yield from self._run_once(body)
                if self._exit_command:
                    break
        for name, value in old_values.items():
            _restore(self.variables, name, value)

    def _run_once(self, body: list[Statement]) -> Iterator[Command]:
        with self._leavable_block("continue"):
            yield from self._run_block(body)

    def _read_loop(self, words: list[str]) -> tuple[list[str], list[tuple[str, ...]]] | None:
        """Return the variables that a ``foreach`` loop sets, and their values in each iteration.

        The result is None if the values are not known.
        """
        if "IN" in words[1:] and words[words.index("IN", 1) :][1:2] == ["ZIP_LISTS"]:
            index = words.index("IN", 1)
            names, lists = (
                words[:index],
                [split_items(self.variables.get(word, UNKNOWN)) for word in words[index + 2 :]],
            )
            if len(names) != len(lists) or len({len(items) for items in lists}) != 1:
                return None
            rounds = list(zip(*lists, strict=True))
        elif words[1:2] == ["RANGE"]:
            names, rounds = words[:1], [(str(number),) for number in _parse_foreach_range(words[2:])]
            if not rounds:
                return None
        else:
            names, rounds = words[:1], [(item,) for item in self._read_loop_items(words[1:])]
        return None if any(is_open(item) for values in rounds for item in values) else (names, rounds)

    def _read_loop_items(self, words: Sequence[str]) -> list[str]:
        items, kind = list[str](), "ITEMS"
        for word in words[1:] if words[:1] == ["IN"] else words:
            if words[0] == "IN" and word in ("LISTS", "ITEMS"):
                kind = word
            elif kind == "LISTS":
                items += split_items(self.variables.get(word, UNKNOWN))
            else:
                items.append(word)
        return items

    def _count_command(self, name: str) -> None:
        self._count += 1
        if self._count > _MAX_COMMANDS:
            raise _LimitExceededError(name)

    # --- commands ----------------------------------------------------------------------------------------------------

    def _run_command(self, statement: Statement) -> Iterator[Command]:
        name = statement.name
        self._count_command(name)
        command = Command(name, tuple(self._expand_arguments(statement)), self._folder, self._unknown_conditions > 0)
        words = command.words
        if name in ("return", "break", "continue"):
            self._exit_command = name if self._unknown_conditions == self._enclosing_depths.get(name) else ""
        elif name in self._routines:
            yield from self._call(self._routines[name], words)
        elif name in ("add_subdirectory", "rosbuild_add_subdirectory", "include") and words:
            yield from self._run_other_file(name.removeprefix("rosbuild_"), words[0])
        else:
            self._apply_assignment(name, words)
            yield command

    def _call(self, routine: _Routine, words: list[str]) -> Iterator[Command]:
        if self._depth >= _MAX_DEPTH:
            self.unknown.append("function")
            return
        outer_variables = dict(self.variables)
        bindings = dict(zip(routine.parameters, words, strict=False))
        bindings |= {f"ARGV{index}": word for index, word in enumerate(words)}
        bindings |= {
            "ARGV": ";".join(words),
            "ARGN": ";".join(words[len(routine.parameters) :]),
            "ARGC": str(len(words)),
        }
        self.variables.update(bindings)
        self._depth += 1
        for_parent, replaced_values = self._parent_values, self._replaced_values
        if routine.has_scope:
            self._parent_values, self._replaced_values = {}, {}
        with self._leavable_block("return"):
            yield from self._run_block(routine.body)
        self._depth -= 1
        if routine.has_scope:
            self.variables = outer_variables | self._parent_values
            self._parent_values, self._replaced_values = for_parent, replaced_values
        else:
            for name in bindings:
                _restore(self.variables, name, outer_variables.get(name))

    def _run_other_file(self, command: str, file_argument: str) -> Iterator[Command]:
        is_folder = command == "add_subdirectory"
        if not is_folder and "/" not in file_argument and not file_argument.endswith(".cmake"):
            return  # a module of CMake itself, which installs nothing
        relative_path = to_package_path(file_argument, self._folder)
        path = (
            None
            if self.package is None or is_open(relative_path)
            else self.package / relative_path / ("CMakeLists.txt" if is_folder else "")
        )
        try:
            text = None if path is None else path.read_text(encoding="utf-8", errors="replace")
        except OSError:
            text = None
        if text is None or self._depth >= _MAX_DEPTH:
            self.unknown.append(command)
            return
        outer_variables, folder, for_parent = dict(self.variables), self._folder, self._parent_values
        replaced_values = self._replaced_values
        self.variables["CMAKE_CURRENT_LIST_DIR"] = posixpath.join(
            SOURCE, relative_path if is_folder else posixpath.dirname(relative_path)
        )
        if is_folder:
            self._folder = "" if relative_path == "." else relative_path
            self._parent_values, self._replaced_values = {}, {}
            self.variables["CMAKE_CURRENT_SOURCE_DIR"] = posixpath.join(SOURCE, relative_path)
            self.variables["CMAKE_CURRENT_BINARY_DIR"] = posixpath.join(BUILD, relative_path)
        self._depth += 1
        yield from self._run_file(SourceText(str(path), text))
        self._depth -= 1
        self._folder = folder
        if is_folder:
            self.variables = outer_variables | self._parent_values
            self._parent_values, self._replaced_values = for_parent, replaced_values
        else:
            self.variables["CMAKE_CURRENT_LIST_DIR"] = outer_variables["CMAKE_CURRENT_LIST_DIR"]

    # --- variables ---------------------------------------------------------------------------------------------------

    def _apply_assignment(self, name: str, words: list[str]) -> None:
        """Set the variables that a command such as ``set`` or ``list`` changes."""
        if name == "project" and words:
            self.variables["PROJECT_NAME"] = self.variables["CMAKE_PROJECT_NAME"] = words[0]
            self.variables |= {f"{words[0]}_SOURCE_DIR": SOURCE, f"{words[0]}_BINARY_DIR": BUILD}
            self.variables |= compute_version_variables(words)
            self.variables |= {
                f"CATKIN_{name}_DESTINATION": folder.format(words[0]) for name, folder in _CATKIN_FOLDERS.items()
            }
        elif name == "set" and words:
            self._set_values(words)
        elif name == "option" and words:
            self._set(words[0], words[2] if len(words) > 2 else "OFF")
        elif name == "unset" and words:
            self.variables.pop(words[0], None)
        elif name == "list" and len(words) > 1:
            self._change_list(words)
        elif name == "string" and len(words) > 1:
            for target, value in evaluate_string_command(words, self._get_variable).items():
                self._set(target, value)
        elif name == "math" and len(words) > 2:
            self._set(words[1], evaluate_math(words[2]))
        elif name == "get_filename_component" and len(words) > 2:
            self._set(words[0], extract_filename_component(words[1], words[2]))
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
            self._parent_values[name] = UNKNOWN if self._unknown_conditions or is_open(value) else value
        else:
            self._set(name, ";".join(values))

    def _get_variable(self, name: str) -> str:
        return self.variables.get(name, "")

    def _set(self, name: str, value: str) -> None:
        self._replaced_values.setdefault(name, self.variables.get(name))
        self.variables[name] = UNKNOWN if is_open(value) else value

    def _change_list(self, words: list[str]) -> None:
        for target, value in evaluate_list_command(words[0], words[1:], self._get_variable).items():
            if words[0] in ("APPEND", "PREPEND"):
                self.variables[target] = value  # even if the command is uncertain, so that a possible item is added
            else:
                self._set(target, value)

    def _glob_files(self, words: list[str], *, recursive: bool) -> str:
        """Return the files that match the patterns of ``file(GLOB ...)``, as a CMake list."""
        relative_to: str | None = None
        includes_folders = not recursive
        patterns: list[str] = []
        word_iterator = iter(words)
        for word in word_iterator:
            if word == "RELATIVE":
                relative_to = to_package_path(next(word_iterator, ""), self._folder)
            elif word == "LIST_DIRECTORIES":
                includes_folders = next(word_iterator, "").upper() in TRUE_CONSTANTS
            elif word not in ("CONFIGURE_DEPENDS", "FOLLOW_SYMLINKS"):
                patterns.append(to_package_path(word, self._folder))
        if self.package is None or any(map(is_open, words)):
            return UNKNOWN
        if any(pattern.startswith(("/", "..", "<")) for pattern in patterns):
            return UNKNOWN
        paths = {
            path.relative_to(self.package).as_posix()
            for pattern in patterns
            for path in _glob_paths(self.package, pattern, recursive=recursive)
            if includes_folders or path.is_file()
        }
        if relative_to is None:
            return ";".join(f"{SOURCE}/{path}" for path in sorted(paths))
        return ";".join(posixpath.relpath(path, relative_to or ".") for path in sorted(paths))

    def _parse_arguments(self, words: list[str]) -> None:
        if words[0] == "PARSE_ARGV":
            arguments = split_items(self._get_variable("ARGV"))[int(words[1]) if words[1].isdecimal() else 0 :]
            words = [*words[2:6], *arguments]
        prefix, options, one_value_names, multi_value_names, *arguments = words
        kinds = {
            name: kind
            for kind, names in enumerate((options, one_value_names, multi_value_names))
            for name in split_items(names)
        }
        values: dict[str, list[str]] = {}
        current = "UNPARSED_ARGUMENTS"
        for word in (item for text in arguments for item in split_items(text)):
            if word in kinds:
                values[word] = ["TRUE"] if kinds[word] == 0 else []
                current = "UNPARSED_ARGUMENTS" if kinds[word] == 0 else word
            else:
                values.setdefault(current, []).append(word)
                if kinds.get(current) == 1:
                    current = "UNPARSED_ARGUMENTS"
        for name in (*kinds, "UNPARSED_ARGUMENTS"):
            self.variables[f"{prefix}_{name}"] = ";".join(values.get(name, ["FALSE"] if kinds.get(name) == 0 else []))

    def _expand_arguments(self, statement: Statement) -> Iterator[Argument]:
        for token in statement.tokens:
            text = self._substitute(token)
            self._count += len(text) // _CHARACTERS_PER_COMMAND
            for item in [text] if token.is_quoted else split_items(text):
                yield Argument(item, token.start, token.end, statement.source)

    def _substitute(self, token: Token) -> str:
        """Substitute the values of known variables in an argument, and return the text."""
        text, remaining_length = token.text, _MAX_TEXT_LENGTH

        def value(match: re.Match[str]) -> str:
            nonlocal remaining_length
            value = self.variables.get(match[1], UNKNOWN)
            value = find_major_version(match[1]) or match[0] if value == UNKNOWN else value
            remaining_length -= len(value)
            if remaining_length < 0:
                raise _LimitExceededError(token.text)
            return value

        for _ in range(_MAX_DEPTH if token.has_variables else 0):  # nested references: ${${NAME}_FILES}
            substituted = _ENVIRONMENT.sub(lambda match: _get_environment_variable(match[1]) or match[0], text)
            substituted = _VARIABLE.sub(value, substituted)
            if substituted == text:
                break
            text = substituted
        return text


def _get_environment_variable(name: str) -> str | None:
    """Return the value of one of ROS's environment variables, or None for any other variable."""
    return os.environ.get(name, ROS_VARIABLES[name]) if name in ROS_VARIABLES else None


def _parse_foreach_range(words: Sequence[str]) -> range:
    """Return the numbers of ``foreach(i RANGE ...)``, including the last.

    The result is empty if an argument is not an integer or the range is too long.
    """
    try:
        numbers = [int(word) for word in words]
    except ValueError:
        return range(0)
    start, stop, step = [0, *numbers, 1][:3] if len(numbers) == 1 else [*numbers, 1, 1][:3]
    return range(start, stop + 1, step) if step > 0 and stop - start < _MAX_COMMANDS else range(0)


def _glob_paths(package: Path, pattern: str, *, recursive: bool) -> Iterable[Path]:
    """Return the paths in a package that match a CMake pattern.

    As in CMake, ``**`` has the same meaning as ``*``.
    """
    folder, _, name_pattern = re.sub(r"\*+", "*", pattern).rpartition("/")
    if name_pattern in ("", "."):
        return ()  # the pattern matches only the folder itself
    return (package / folder).rglob(name_pattern) if recursive else package.glob(posixpath.join(folder, name_pattern))


def to_package_path(text: str, folder: str) -> str:
    """Convert a path in a command to a path relative to the package.

    A trailing slash is preserved. Other absolute paths, generator expressions and paths in the build folder are
    returned unchanged.

    Args:
        text: the path in the command.
        folder: the folder of the command, relative to the package.
    """
    if text.startswith(("/", "$<", BUILD)):
        return text
    relative_path = text[len(SOURCE) :].lstrip("/") if text.startswith(SOURCE) else posixpath.join(folder, text)
    path = posixpath.normpath(relative_path or ".")
    return f"{path}/" if text.endswith("/") and not path.endswith("/") else path


def _restore(variables: dict[str, str], name: str, value: str | None) -> None:
    if value is None:
        variables.pop(name, None)
    else:
        variables[name] = value
