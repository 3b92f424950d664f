"""CMake's language as far as it says what a package installs: commands in the order in which CMake would run them.

Variables, lists, loops over them, functions and macros of the file, subdirectories and included files are followed, and
so are patterns of files. What only CMake itself knows (conditions, what ``find_package`` sets) is not: all branches of
a condition are read, and a variable that two branches set differently has no value. A variable whose value is not
known stays in the text as ``${...}``.
"""

from __future__ import annotations

import posixpath
import re
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, field
from pathlib import Path

from linkwright.diagnostics import SourceText

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
_ENDS = {"foreach": "endforeach", "function": "endfunction", "macro": "endmacro", "while": "endwhile"}
_DEEPEST = 20
_MOST_COMMANDS = 20_000
UNKNOWN = "${}"
"""The value of a variable that cannot be told."""

SOURCE, BUILD, PREFIX = "<source>", "<build>", "<prefix>"
"""What the folder of the package, that of the build and that of the installation are called in values of variables."""


@dataclass(frozen=True, slots=True)
class Argument:
    """An argument of a command: its text with known variables put in, its offsets in a file, and that file."""

    text: str
    start: int
    end: int
    source: SourceText


@dataclass(frozen=True, slots=True)
class Command:
    """A command that CMake would run.

    Attributes:
        name: in lower case.
        arguments: what it is given.
        folder: the folder of its ``CMakeLists.txt``, relative to the package; empty for the package's own.
        is_conditional: whether it stands in a branch of an ``if``.
    """

    name: str
    arguments: tuple[Argument, ...]
    folder: str
    is_conditional: bool

    @property
    def words(self) -> list[str]:
        """The texts of its arguments."""
        return [each.text for each in self.arguments]


class _TooMuchError(Exception):
    """A file that would keep CMake busy for long; it carries the name of a command."""


@dataclass(frozen=True, slots=True)
class _Token:
    text: str
    start: int
    end: int
    is_list: bool
    has_variables: bool


_Statement = tuple[str, list[_Token], SourceText]


@dataclass(slots=True)
class _Routine:
    parameters: list[str]
    body: list[_Statement]
    has_scope: bool


@dataclass(slots=True)
class CMakeProgram:
    """A ``CMakeLists.txt`` that is run as far as that can be done.

    Args:
        package: the folder of the package, for subdirectories, included files and patterns; None when there is none.

    Attributes:
        variables: name -> value; items of a list are separated by semicolons.
        unknown: the commands, such as ``foreach``, of which it is not known what they do.
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
        }
    )
    unknown: list[str] = field(default_factory=list)
    _routines: dict[str, _Routine] = field(default_factory=dict)
    _folder: str = ""
    _conditions: int = 0
    _depth: int = 0
    _count: int = 0

    def run(self, source: SourceText) -> Iterator[Command]:
        """The commands of a file, and of what it calls and includes."""
        try:
            yield from self._run_file(source)
        except _TooMuchError as error:
            self.unknown.append(str(error))

    def _run_file(self, source: SourceText) -> Iterator[Command]:
        yield from self._run_block([(name, tokens, source) for name, tokens in _statements(source.text)])

    # --- blocks ------------------------------------------------------------------------------------------------------

    def _run_block(self, statements: Sequence[_Statement]) -> Iterator[Command]:
        at = 0
        while at < len(statements):
            name, tokens, source = statements[at]
            at += 1
            if name in _ENDS:
                end = _end_of(statements, at, name)
                yield from self._run_compound(name, [*self._arguments(tokens, source)], list(statements[at:end]))
                at = end + 1
            else:
                yield from self._run_command(name, tokens, source)

    def _run_compound(self, name: str, given: Sequence[Argument], body: list[_Statement]) -> Iterator[Command]:
        words = [each.text for each in given]
        if name in ("function", "macro") and words:
            self._routines[words[0].lower()] = _Routine(words[1:], body, name == "function")
        elif name == "foreach" and words:
            items = self._loop_items(words[1:])
            if items is None:
                self.unknown.append(name)
                return
            before = self.variables.get(words[0])
            for item in items:
                self._tick(name)
                self.variables[words[0]] = item
                yield from self._run_block(body)
            _restore(self.variables, words[0], before)
        else:
            self.unknown.append(name)

    def _loop_items(self, words: Sequence[str]) -> list[str] | None:
        if words[:1] == ["RANGE"] or words[:2] == ["IN", "ZIP_LISTS"]:
            return None
        items, kind = list[str](), "ITEMS"
        for word in words[1:] if words[:1] == ["IN"] else words:
            if words[0] == "IN" and word in ("LISTS", "ITEMS"):
                kind = word
            elif kind == "LISTS":
                items += _items_of(self.variables.get(word, UNKNOWN))
            else:
                items.append(word)
        return None if any("$" in item for item in items) else items

    def _tick(self, name: str) -> None:
        self._count += 1
        if self._count > _MOST_COMMANDS:
            raise _TooMuchError(name)

    # --- commands ----------------------------------------------------------------------------------------------------

    def _run_command(self, name: str, tokens: Sequence[_Token], source: SourceText) -> Iterator[Command]:
        self._tick(name)
        command = Command(name, tuple(self._arguments(tokens, source)), self._folder, self._conditions > 0)
        words = command.words
        if name in ("if", "endif"):
            self._conditions = max(0, self._conditions + (1 if name == "if" else -1))
        elif name in self._routines:
            yield from self._call(self._routines[name], words)
        elif name in ("add_subdirectory", "include") and words:
            yield from self._read_other(name, words[0])
        else:
            self._assign(name, words)
            yield command

    def _call(self, routine: _Routine, words: list[str]) -> Iterator[Command]:
        if self._depth >= _DEEPEST:
            self.unknown.append("function")
            return
        outside = dict(self.variables)
        bound = dict(zip(routine.parameters, words, strict=False))
        bound |= {"ARGV": ";".join(words), "ARGN": ";".join(words[len(routine.parameters) :]), "ARGC": str(len(words))}
        self.variables.update(bound)
        self._depth += 1
        yield from self._run_block(routine.body)
        self._depth -= 1
        if routine.has_scope:
            self.variables = outside
        else:
            for name in bound:
                _restore(self.variables, name, outside.get(name))

    def _read_other(self, command: str, word: str) -> Iterator[Command]:
        is_folder = command == "add_subdirectory"
        if not is_folder and "/" not in word and not word.endswith(".cmake"):
            return  # a module of CMake, which installs nothing
        place = within_package(word, self._folder)
        path = (
            None
            if self.package is None or "$" in place
            else self.package / place / ("CMakeLists.txt" if is_folder else "")
        )
        try:
            text = None if path is None else path.read_text(encoding="utf-8", errors="replace")
        except OSError:
            text = None
        if text is None or self._depth >= _DEEPEST:
            self.unknown.append(command)
            return
        outside, folder = dict(self.variables), self._folder
        self.variables["CMAKE_CURRENT_LIST_DIR"] = posixpath.join(
            SOURCE, place if is_folder else posixpath.dirname(place)
        )
        if is_folder:
            self._folder = "" if place == "." else place
            self.variables["CMAKE_CURRENT_SOURCE_DIR"] = posixpath.join(SOURCE, place)
            self.variables["CMAKE_CURRENT_BINARY_DIR"] = posixpath.join(BUILD, place)
        self._depth += 1
        yield from self._run_file(SourceText(str(path), text))
        self._depth -= 1
        self._folder = folder
        if is_folder:
            self.variables = outside
        else:
            self.variables["CMAKE_CURRENT_LIST_DIR"] = outside["CMAKE_CURRENT_LIST_DIR"]

    def _assign(self, name: str, words: list[str]) -> None:
        """Keep what a command says about variables."""
        if name == "project" and words:
            self.variables["PROJECT_NAME"] = self.variables["CMAKE_PROJECT_NAME"] = words[0]
            for variable in ("CATKIN_PACKAGE_SHARE_DESTINATION", "CATKIN_PACKAGE_BIN_DESTINATION"):
                self.variables[variable] = f"{'share' if 'SHARE' in variable else 'lib'}/{words[0]}"
        elif name == "set" and words and not words[0].startswith("ENV{"):
            values = words[1:]
            for keyword in ("CACHE", "PARENT_SCOPE"):
                values = values[: values.index(keyword)] if keyword in values else values
            self._set(words[0], ";".join(values))
        elif name == "list" and len(words) > 1:
            self._change_list(words[0], words[1], words[2:])
        elif name == "get_filename_component" and len(words) > 2:
            self._set(words[0], _part_of_name(words[1], words[2]))
        elif name == "file" and len(words) > 1 and words[0] in ("GLOB", "GLOB_RECURSE"):
            self._set(words[1], self._matching(words[2:], recursive=words[0] == "GLOB_RECURSE"))
        elif name == "cmake_parse_arguments" and len(words) >= 4:
            self._parse_arguments(words)

    def _set(self, name: str, value: str) -> None:
        is_certain = not self._conditions or self.variables.get(name, value) == value
        self.variables[name] = value if is_certain and "$" not in value else UNKNOWN

    def _change_list(self, what: str, name: str, words: list[str]) -> None:
        before = self.variables.get(name, "")
        if what in ("APPEND", "PREPEND"):
            items = [*_items_of(before), *words] if what == "APPEND" else [*words, *_items_of(before)]
            self.variables[name] = UNKNOWN if any("$" in item for item in items) else ";".join(items)
        elif what in ("REMOVE_ITEM", "REMOVE_AT", "REVERSE", "SORT", "FILTER", "TRANSFORM", "INSERT"):
            self.variables[name] = UNKNOWN

    def _matching(self, words: list[str], *, recursive: bool) -> str:
        words = [word for word in words if word != "CONFIGURE_DEPENDS"]
        base = None
        if words[:1] == ["RELATIVE"]:
            base, words = within_package(words[1], self._folder) if len(words) > 1 else "", words[2:]
        if self.package is None or any("$" in word for word in words):
            return UNKNOWN
        found: set[str] = set()
        for word in words:
            pattern = within_package(word, self._folder)
            if pattern.startswith(("/", "..", "<")):
                return UNKNOWN
            folder, _, last = pattern.rpartition("/")
            paths = (self.package / folder).rglob(last) if recursive else self.package.glob(pattern)
            found |= {
                path.relative_to(self.package).as_posix() for path in paths if recursive is False or path.is_file()
            }
        if base is None:
            return ";".join(f"{SOURCE}/{path}" for path in sorted(found))
        return ";".join(posixpath.relpath(path, base or ".") for path in sorted(found))

    def _parse_arguments(self, words: list[str]) -> None:
        prefix, options, single, many, *given = words
        kinds = {name: kind for kind, names in enumerate((options, single, many)) for name in _items_of(names)}
        values: dict[str, list[str]] = {}
        current = "UNPARSED_ARGUMENTS"
        for word in (item for text in given for item in _items_of(text)):
            if word in kinds:
                values[word] = ["TRUE"] if kinds[word] == 0 else []
                current = "UNPARSED_ARGUMENTS" if kinds[word] == 0 else word
            else:
                values.setdefault(current, []).append(word)
                if kinds.get(current) == 1:
                    current = "UNPARSED_ARGUMENTS"
        for name in (*kinds, "UNPARSED_ARGUMENTS"):
            self.variables[f"{prefix}_{name}"] = ";".join(values.get(name, ["FALSE"] if kinds.get(name) == 0 else []))

    def _arguments(self, tokens: Sequence[_Token], source: SourceText) -> Iterator[Argument]:
        for token in tokens:
            text = self.filled(token.text) if token.has_variables else token.text
            for each in _items_of(text) if token.is_list else [text]:
                yield Argument(each, token.start, token.end, source)

    def filled(self, text: str) -> str:
        """A text with the values of known variables in it."""
        for _ in range(_DEEPEST):  # ${${NAME}_FILES}
            filled = _VARIABLE.sub(lambda match: self.variables.get(match[1], match[0]), text)
            if filled == text:
                break
            text = filled
        return text


def within_package(text: str, folder: str) -> str:
    """A path of a command relative to the package, ending with a slash where it did.

    Args:
        text: as the command has it.
        folder: the folder of the command, relative to the package.
    """
    if text.startswith(("/", "$<", BUILD)):
        return text
    below = text[len(SOURCE) :].lstrip("/") if text.startswith(SOURCE) else posixpath.join(folder, text)
    path = posixpath.normpath(below or ".")
    return f"{path}/" if text.endswith("/") and not path.endswith("/") else path


def _items_of(text: str) -> list[str]:
    return [item for item in text.split(";") if item]


def _restore(variables: dict[str, str], name: str, value: str | None) -> None:
    if value is None:
        variables.pop(name, None)
    else:
        variables[name] = value


def _part_of_name(path: str, part: str) -> str:
    name = posixpath.basename(path)
    parts = {
        "NAME": name,
        "NAME_WE": name.partition(".")[0],
        "NAME_WLE": posixpath.splitext(name)[0],
        "DIRECTORY": posixpath.dirname(path),
        "PATH": posixpath.dirname(path),
    }
    return parts.get(part, UNKNOWN)


def _end_of(statements: Sequence[_Statement], at: int, name: str) -> int:
    depth = 1
    for index in range(at, len(statements)):
        depth += (statements[index][0] == name) - (statements[index][0] == _ENDS[name])
        if not depth:
            return index
    return len(statements)


def _statements(text: str) -> Iterator[tuple[str, list[_Token]]]:
    """The commands as they are written; nested parentheses are flattened, comments left out."""
    at, name, depth = 0, "", 0
    tokens: list[_Token] = []
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
                yield name.lower(), tokens
                name, tokens = "", []
        elif piece["word"] and depth == 0:
            name, tokens = piece["word"], []
        elif depth and piece["blank"] is None and piece["comment"] is None:
            value = piece["word"] or piece["quoted"] or piece["bracket"] or ""
            quote = 1 if piece["quoted"] is not None else 0
            is_word = piece["word"] is not None
            tokens.append(_Token(value, piece.start() + quote, piece.end() - quote, is_word, piece["bracket"] is None))
