"""Reader for the install rules of a ``CMakeLists.txt``, without CMake.

In packages of descriptions, launch files, scripts and interfaces, CMake compiles nothing and only copies files.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence
from fnmatch import fnmatchcase
from itertools import takewhile
from pathlib import Path, PurePosixPath

from linkwright.diagnostics import SourceText, Span
from linkwright.loading.lean_dataclasses import dataclass, field, replace
from linkwright.packages.readers.cmake_commands import has_known_effect
from linkwright.packages.readers.cmake_conditions import find_matches
from linkwright.packages.readers.cmake_language import (
    BUILD,
    PREFIX,
    Argument,
    CMakeProgram,
    Command,
    to_package_path,
)
from linkwright.packages.readers.cmake_syntax import is_open
from linkwright.packages.readers.installed import InstalledFile

_KEYWORDS = frozenset(
    {
        *("DESTINATION", "PERMISSIONS", "CONFIGURATIONS", "COMPONENT", "OPTIONAL", "EXCLUDE_FROM_ALL", "RENAME"),
        *("FILES_MATCHING", "PATTERN", "REGEX", "USE_SOURCE_PERMISSIONS", "FILE_PERMISSIONS", "MESSAGE_NEVER"),
        *("DIRECTORY_PERMISSIONS", "TYPE", "EXCLUDE"),
    }
)
_COMPILED_TARGET_COMMANDS = frozenset(
    {
        *("add_executable", "add_library", "ament_auto_add_executable", "ament_auto_add_library"),
        *("rclcpp_components_register_node", "pybind11_add_module", "python3_add_library"),
    }
)
_INTERFACE_SUFFIXES = (".msg", ".srv", ".action", ".idl")
_FOLDERS_BY_TYPE = {
    "BIN": "bin",
    "SBIN": "sbin",
    "LIB": "lib",
    "INCLUDE": "include",
    "SYSCONF": "etc",
    "DATA": "share",
    "INFO": "share/info",
    "LOCALE": "share/locale",
    "MAN": "share/man",
    "DOC": "share/doc",
}
_FILE_NAME = "CMakeLists.txt"
_INDEX_FOLDER = "share/ament_index/resource_index"


@dataclass(frozen=True, slots=True)
class PathPattern:
    """A ``PATTERN`` or ``REGEX`` for the files and folders in a copied folder.

    Attributes:
        text: the pattern.
        is_regex: whether the pattern is a regular expression, which may match anywhere in the path.
        is_excluded: whether matching files are excluded.
    """

    text: str
    is_regex: bool
    is_excluded: bool

    def matches(self, path: str) -> bool:
        """Return whether the pattern matches a file or folder.

        Args:
            path: the path relative to the package, with a leading slash.
        """
        if self.is_regex:
            return bool(find_matches(self.text, path))
        components = path.split("/")
        depth = self.text.count("/") + 1
        return fnmatchcase("/".join(components[-depth:]), self.text)


@dataclass(frozen=True, slots=True)
class CopyRule:
    """An install rule that copies files or folders.

    Attributes:
        kind: ``FILES``, ``PROGRAMS`` or ``DIRECTORY``.
        items: the sources, relative to the package; a trailing slash means the content of a folder.
        destination: the target folder, relative to the prefix; None if it is not known.
        new_name: the new name of a single file; None to keep the name.
        patterns: the patterns for files and folders in a copied folder.
        only_matching: whether only files that match a pattern are copied.
        is_optional: whether the sources may be missing.
    """

    kind: str
    items: tuple[Argument, ...]
    destination: str | None
    new_name: str | None = None
    patterns: tuple[PathPattern, ...] = ()
    only_matching: bool = False
    is_optional: bool = False

    def copies(self, folder: str, relative_path: PurePosixPath) -> bool:
        """Return whether the rule copies a file in a folder.

        Args:
            folder: the folder, relative to the package.
            relative_path: the path of the file, relative to the folder.
        """
        if not self.patterns:
            return not self.only_matching
        return self._selects(
            [f"/{folder.rstrip('/')}/{path}" for path in (*list(relative_path.parents)[:-1], relative_path)]
        )

    def may_be_missing(self, item: str) -> bool:
        """Return whether the build continues if an item is missing.

        CMake applies the patterns first: a missing item is not treated as a folder, so ``FILES_MATCHING`` skips it.
        """
        return self.is_optional or not self._selects([f"/{item.rstrip('/')}"])

    def _selects(self, paths: Sequence[str]) -> bool:
        """Return whether the patterns select a file.

        Args:
            paths: the paths of the folders around the file, outermost first, and the path of the file.
        """
        if any(pattern.is_excluded and pattern.matches(path) for pattern in self.patterns for path in paths):
            return False
        include_patterns = (pattern for pattern in self.patterns if not pattern.is_excluded)
        return not self.only_matching or any(pattern.matches(paths[-1]) for pattern in include_patterns)


@dataclass
class CMakeFile:
    """The targets and install rules of a ``CMakeLists.txt`` and the files that it includes.

    Attributes:
        project: the name of the project, or None.
        copies: the install rules that copy files.
        targets: the names of the programs that are built or installed as targets.
        output_names: the file names of targets whose files have another name.
        interfaces: the interface files for which code is generated, relative to the package.
        modules: the installed Python packages and modules, as folders and files relative to the package.
        python_packages: the folders of the installed Python packages by name, relative to the package.
        required_modules: the ``__init__.py`` that these folders need, relative to the package.
        hooks: the installed files that set environment variables, relative to the prefix.
        compiled: the compiled targets.
        foreign: the commands of other packages, which may install additional files.
        unknown: the reasons why additional files may be installed.
        is_ament: whether the package is an ament package.
    """

    source: SourceText
    project: Argument | None = None
    copies: list[CopyRule] = field(default_factory=list)
    targets: set[str] = field(default_factory=set)
    output_names: dict[str, str] = field(default_factory=dict)
    interfaces: list[str] = field(default_factory=list)
    modules: list[str] = field(default_factory=list)
    python_packages: dict[str, str] = field(default_factory=dict)
    required_modules: list[Argument] = field(default_factory=list)
    hooks: list[str] = field(default_factory=list)
    compiled: list[str] = field(default_factory=list)
    foreign: list[str] = field(default_factory=list)
    unknown: list[str] = field(default_factory=list)
    is_ament: bool = False
    _generated: dict[str, InstalledFile] = field(default_factory=dict)
    _generated_files: dict[str, InstalledFile] = field(default_factory=dict)

    @property
    def is_complete(self) -> bool:
        """Whether all installed files are known, except compiled targets."""
        return not self.unknown

    @property
    def directories(self) -> list[Argument]:
        """The installed folders, relative to the package."""
        return [item for rule in self.copies if rule.kind == "DIRECTORY" for item in rule.items]

    @property
    def files(self) -> list[Argument]:
        """The installed files, relative to the package."""
        return [item for rule in self.copies if rule.kind != "DIRECTORY" for item in rule.items]

    @property
    def required_paths(self) -> list[Argument]:
        """The files and folders that must exist for the build to succeed."""
        copied = [item for rule in self.copies for item in rule.items if not rule.may_be_missing(item.text)]
        return [*copied, *self.required_modules]

    @property
    def programs(self) -> dict[str, str]:
        """The installed programs that are files: name -> path relative to the package."""
        return {
            rule.new_name or PurePosixPath(item.text).name: item.text
            for rule in self.copies
            if rule.kind == "PROGRAMS"
            for item in rule.items
        }

    @property
    def executables(self) -> set[str]:
        """The names of all programs that are built or installed."""
        return {self.output_names.get(target, target) for target in self.targets} | set(self.programs)

    def span(self, argument: Argument) -> Span:
        """Return the location of an argument."""
        return argument.source.span(argument.start, argument.end)

    def installed_files(self, package: Path) -> Iterator[InstalledFile]:
        """Yield each installed file, except compiled targets.

        Args:
            package: the package's folder.

        Raises:
            FileNotFoundError: a file or folder does not exist; the exception contains its name.
        """
        return self._list_files(package, None)

    def moved_files(self, package: Path, share: str) -> Iterator[InstalledFile]:
        """Yield the installed files whose paths in the share folder and in the package differ.

        A folder is not read if all of its files keep their paths. Missing files, and some files that are installed
        outside the share folder, are omitted.

        Args:
            package: the package's folder.
            share: the share folder, relative to the prefix.
        """
        return self._list_files(package, PurePosixPath(share))

    def _list_files(self, package: Path, share: PurePosixPath | None) -> Iterator[InstalledFile]:
        for file in self._generated_files.values():
            if share is None or file.content is not None or (package / file.source).is_file():
                yield file
        for rule in self.copies:
            if rule.destination is not None:
                for item in rule.items:
                    yield from self._list_copied_files(rule, item.text, rule.destination, package, share)

    def _list_copied_files(
        self, rule: CopyRule, item: str, destination: str, package: Path, share: PurePosixPath | None
    ) -> Iterator[InstalledFile]:
        target, source = PurePosixPath(destination), PurePosixPath(item)
        if item.startswith(BUILD):
            yield from self._list_copied_build_files(rule, item, target)
            return
        target_file = target / (rule.new_name or source.name)
        if share is not None and rule.kind != "DIRECTORY" and target_file == share / source:
            return
        path = package / item
        if not path.exists():
            if share is not None or rule.may_be_missing(item) or item.startswith("$<"):
                return
            raise FileNotFoundError(item)
        if path.is_file():
            yield InstalledFile(item, str(target_file))
            return
        target_folder = target if item.endswith("/") else target / path.resolve().name
        if share is not None and (target_folder == share / source or not _is_nested(target_folder, share)):
            return
        for file in sorted(path.rglob("*")):
            relative_path = PurePosixPath(file.relative_to(path).as_posix())
            if file.is_file() and rule.copies(item, relative_path):
                yield InstalledFile((source / relative_path).as_posix(), str(target_folder / relative_path))

    def _list_copied_build_files(self, rule: CopyRule, item: str, target: PurePosixPath) -> Iterator[InstalledFile]:
        target_folder = target if item.endswith("/") else target / PurePosixPath(item).name
        for path, file in self._generated.items():
            if path == item:
                yield file._replace(destination=str(target / (rule.new_name or PurePosixPath(path).name)))
            elif path.startswith(f"{item.rstrip('/')}/"):
                relative_path = PurePosixPath(path).relative_to(item)
                if rule.copies(item, relative_path):
                    yield file._replace(destination=str(target_folder / relative_path))

    def _add_generated_file(
        self, source: str, destination: str, values: dict[str, str] | None = None, content: str = ""
    ) -> None:
        """Record a file that the build generates and installs.

        If the same file is recorded again, the content is appended.
        """
        previous = self._generated_files.get(destination)
        text = None if values is not None else (previous.content or "" if previous else "") + content
        self._generated_files[destination] = InstalledFile(source, destination, values, text)


def _is_nested(first: PurePosixPath, second: PurePosixPath) -> bool:
    """Return whether two folders are the same or one contains the other."""
    return first.is_relative_to(second) or second.is_relative_to(first)


def read_cmake(source: SourceText, package: Path | None = None, options: Iterable[str] = ()) -> CMakeFile:
    """Read the install rules of a ``CMakeLists.txt``.

    Args:
        source: the text of the file.
        package: the package's folder, in which subdirectories, included files and matches of patterns are searched;
            None if there is no folder.
        options: the options that are off unless the file declares them.
    """
    file = CMakeFile(source)
    program = CMakeProgram(package)
    program.variables |= dict.fromkeys(options, "OFF")
    for command in program.run(source):
        _read_command(file, command, program)
    file.unknown += [f"the effect of its command {name}() is not known here" for name in program.unknown]
    return file


def _read_command(file: CMakeFile, command: Command, program: CMakeProgram) -> None:
    name, arguments, words = command.name, command.arguments, command.words
    if not has_known_effect(name):
        file.foreign.append(name)
    if name in _COMPILED_TARGET_COMMANDS and "INTERFACE" not in words and words:
        file.compiled.append(words[0])
    if name == "project" and arguments:
        file.project = file.project or arguments[0]
    elif name in ("add_executable", "ament_auto_add_executable") and words and not is_open(words[0]):
        file.targets.add(words[0])
    elif name == "rclcpp_components_register_node":
        executable = _find_argument_after(words, "EXECUTABLE")
        if executable is not None and not is_open(executable):
            file.targets.add(executable)
    elif name in ("set_target_properties", "set_property"):
        _read_output_name(file, name, words)
    elif name == "externalproject_add":
        file.unknown.append(f"the effect of its command {name}() is not known here")
    elif name == "configure_file" and len(words) > 1 and not is_open(words[0]):
        source = to_package_path(words[0], command.folder)
        file._generated[_resolve_build_path(words[1], program)] = InstalledFile(source, "", dict(program.variables))
    elif name == "file" and len(words) > 1 and words[0] in ("WRITE", "APPEND"):
        path = _resolve_build_path(words[1], program)
        previous = file._generated.get(path) if words[0] == "APPEND" else None
        content = (previous.content or "" if previous else "") + "".join(words[2:])
        file._generated[path] = InstalledFile(_FILE_NAME, "", None, content)
    elif name in ("install", "catkin_install_python") and words:
        _read_install(file, command)
    elif name == "rosidl_generate_interfaces":
        file.interfaces += [
            to_package_path(word, command.folder) for word in words if word.endswith(_INTERFACE_SUFFIXES)
        ]
    elif name == "ament_python_install_package" and words:
        folder = to_package_path(_find_argument_after(words, "PACKAGE_DIR") or words[0], command.folder)
        file.modules.append(folder)
        file.python_packages[words[0]] = folder
        if not (command.is_conditional or folder.startswith(BUILD) or is_open(folder)):
            argument = command.arguments[0]
            path = str(PurePosixPath(folder, "__init__.py"))
            file.required_modules.append(Argument(path, argument.start, argument.end, argument.source))
    elif name == "ament_python_install_module" and words:
        file.modules.append(to_package_path(words[0], command.folder))
    elif name == "ament_environment_hooks":
        _read_hooks(file, command, program)
    elif name in ("ament_index_register_resource", "pluginlib_export_plugin_description_file") and words:
        _read_resource(file, command)
    elif name == "xacro_add_files" and "INSTALL" in words:
        file.unknown += [f"'{word.removesuffix('.xacro')}' would have to be made by xacro" for word in words[:1]]
    elif name in ("ament_package", "ament_auto_package"):
        file.is_ament = True
        if "INSTALL_TO_SHARE" in words:
            share = f"share/{file.project.text if file.project else ''}"
            _add_rule(file, CopyRule("DIRECTORY", arguments[words.index("INSTALL_TO_SHARE") + 1 :], share), command)


def _read_output_name(file: CMakeFile, command: str, words: Sequence[str]) -> None:
    """Record the file names that a command gives to targets."""
    end, start = ("PROPERTIES", 0) if command == "set_target_properties" else ("PROPERTY", 1)
    if end not in words or (command == "set_property" and words[0] != "TARGET"):
        return
    output_name = _find_argument_after(words, "OUTPUT_NAME") or _find_argument_after(words, "RUNTIME_OUTPUT_NAME")
    if output_name is not None and not is_open(output_name):
        file.output_names.update(dict.fromkeys(words[start : words.index(end)], output_name))


def _resolve_build_path(word: str, program: CMakeProgram) -> str:
    return word if word.startswith(BUILD) else f"{program.variables['CMAKE_CURRENT_BINARY_DIR']}/{word}"


def _read_hooks(file: CMakeFile, command: Command, program: CMakeProgram) -> None:
    """Record the environment hooks that are copied or, from a template ``.in``, generated."""
    for word in command.words:
        if is_open(word):
            continue
        hook = to_package_path(word, command.folder)
        name = PurePosixPath(hook).name
        target = f"share/{file.project.text if file.project else ''}/environment/{name.removesuffix('.in')}"
        file.hooks.append(target)
        if name.endswith(".in"):
            file._add_generated_file(hook, target, dict(program.variables))
        else:
            file._generated_files[target] = InstalledFile(hook, target)


def _read_resource(file: CMakeFile, command: Command) -> None:
    """Record an entry of the resource index, and the plugin description that it refers to."""
    words, project = command.words, file.project.text if file.project else ""
    if command.name == "ament_index_register_resource":
        name, content = (
            _find_argument_after(words, "PACKAGE_NAME") or project,
            _find_argument_after(words, "CONTENT") or "",
        )
        file._add_generated_file(_FILE_NAME, f"{_INDEX_FOLDER}/{words[0]}/{name}", content=content)
    elif len(words) > 1 and not is_open(words[1]):
        path = PurePosixPath(to_package_path(words[1], command.folder))
        share = f"share/{project}"
        file._add_generated_file(
            _FILE_NAME, f"{_INDEX_FOLDER}/{words[0]}__pluginlib__plugin/{project}", content=f"{share}/{path.name}\n"
        )
        rule = CopyRule("FILES", command.arguments[1:2], share, is_optional=command.is_conditional)
        _add_rule(file, rule, command)


def _read_install(file: CMakeFile, command: Command) -> None:
    arguments, words = command.arguments, command.words
    kind = words[0]
    items = tuple(takewhile(lambda argument: argument.text not in _KEYWORDS, arguments[1:]))
    if kind in ("FILES", "PROGRAMS", "DIRECTORY"):
        destination = _find_argument_after(words, "DESTINATION") or _FOLDERS_BY_TYPE.get(
            _find_argument_after(words, "TYPE") or ""
        )
        if destination is None or is_open(destination):
            file.unknown.append(f"'install({' '.join(words)})' cannot be read without CMake")
            destination = None
        else:
            destination = destination.removeprefix(f"{PREFIX}/")
        new_name = _find_argument_after(words, "RENAME")
        is_optional = command.is_conditional or "OPTIONAL" in words
        patterns, only_matching = tuple(_parse_path_patterns(words)), "FILES_MATCHING" in words
        rule = CopyRule(kind, items, destination, new_name, patterns, only_matching, is_optional)
        _add_rule(file, rule, command)
    elif kind == "TARGETS":
        file.targets |= {item.text for item in items}
    elif kind in ("CODE", "SCRIPT"):
        file.unknown.append(f"the effect of install({kind}) is not known here")


def _add_rule(file: CMakeFile, rule: CopyRule, command: Command) -> None:
    """Add an install rule without the items that only CMake can evaluate."""
    known_items = tuple(
        Argument(to_package_path(item.text, command.folder), item.start, item.end, item.source)
        for item in rule.items
        if not is_open(item.text)
    )
    if len(known_items) < len(rule.items):
        file.unknown.append(f"'{command.name}({' '.join(command.words)})' cannot be read without CMake")
    if known_items:
        file.copies.append(replace(rule, items=known_items))


def _find_argument_after(words: Sequence[str], keyword: str) -> str | None:
    """Return the argument after a keyword, or None if there is none."""
    index = words.index(keyword) + 1 if keyword in words else len(words)
    return words[index] if index < len(words) else None


def _parse_path_patterns(words: Sequence[str]) -> Iterator[PathPattern]:
    for index, word in enumerate(words[:-1]):
        if word in ("PATTERN", "REGEX"):
            is_excluded = words[index + 2 : index + 3] == ["EXCLUDE"]
            yield PathPattern(words[index + 1], word == "REGEX", is_excluded)
