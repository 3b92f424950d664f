"""The comparison of ``CMakeLists.txt``: executables, libraries, interfaces and files that a package installs."""

from __future__ import annotations

import re
from collections.abc import Iterator, Sequence
from itertools import takewhile
from pathlib import Path, PurePosixPath

from linkwright.diagnostics import SourceText
from linkwright.loading.lean_dataclasses import replace
from linkwright.packages.readers.cmake import CMakeFile, read_cmake
from linkwright.packages.readers.cmake_language import BUILD, Argument, CMakeProgram, Command, within_package
from linkwright.packages.readers.cmake_syntax import is_open
from linkwright.review.file_pair import FilePair
from linkwright.review.files.build_facts import BuildFacts, EnvironmentVariables, Fact, FactKind, compare_build_files
from linkwright.review.versions import Version

CMAKE_FILE = "CMakeLists.txt"
_EXECUTABLES = ("add_executable", "ament_auto_add_executable")
_LIBRARIES = ("add_library", "ament_auto_add_library")
_INSTALL_KEYWORDS = frozenset(
    {"EXPORT", "ARCHIVE", "LIBRARY", "RUNTIME", "OBJECTS", "INCLUDES", "DESTINATION", "COMPONENT", "OPTIONAL"}
)
_TEST_COMMAND = re.compile(r"(\w+_)?add_(\w*_)?(\w*tests?|gmock|gbenchmark|catch2|file_check)")
_IRRELEVANT = re.compile(
    r"CMAKE_(EXPORT_COMPILE_COMMANDS|VERBOSE_MAKEFILE|COLOR_\w+|RULE_MESSAGES|INSTALL_MESSAGE|MESSAGE_\w+|"
    r"\w+_COMPILER_LAUNCHER|TLS_VERIFY|SUPPRESS_\w+|WARN_\w+|ERROR_\w+)"
)
"""The variables that change neither what is built nor what is installed."""
_COMMENT = re.compile(r"#[^\n]*")
_ENVIRONMENT = re.compile(r"\bENV\{(\w+)\}")
_STANDARDS = ("CMAKE_CXX_STANDARD", "CMAKE_C_STANDARD", "CMAKE_BUILD_TYPE")
_INTERFACE_SUFFIXES = (".msg", ".srv", ".action", ".idl")


def compare_cmake_files(pair: FilePair) -> None:
    """Compare two versions of a ``CMakeLists.txt``, with its subdirectories, as far as CMake is not needed for it."""
    compare_build_files(pair, read_cmake_facts)


def read_cmake_facts(version: Version, path: str) -> BuildFacts:
    """Return the facts of a ``CMakeLists.txt`` with its subdirectories."""
    file = version.file(path)
    source = SourceText(str(file), file.read_text(encoding="utf-8", errors="replace"))
    facts = BuildFacts(package=_parent(path))
    commands = list(CMakeProgram(file.parent).run(source))
    for reader in (_targets, _interfaces, _exports, _packages, _tests, _settings):
        facts.facts += reader(commands)
    text = _COMMENT.sub(lambda comment: " " * len(comment[0]), source.text)
    facts.environment = EnvironmentVariables(
        (match[1], source.span(match.start(), match.end())) for match in _ENVIRONMENT.finditer(text)
    )
    cmake = read_cmake(source, file.parent)
    _read_files(facts, cmake, file.parent)
    facts.rest = [
        (_name_of(command), _own_text(command, facts.project))
        for command in commands
        if command.name not in _FACT_COMMANDS and not _is_test(command) and not _is_variable(command)
    ]
    return facts


def _name_of(command: Command) -> str:
    """Return the name of a command, or of the variable that it sets."""
    return command.words[0] if command.name == "set" else command.name


def _own_text(command: Command, project: str) -> str:
    """Return the arguments of a command without interfaces, and without the name of the project."""
    words = [word for word in command.words if not word.endswith(_INTERFACE_SUFFIXES)]
    return " ".join("${PROJECT_NAME}" if word == project else word for word in words)


def _is_variable(command: Command) -> bool:
    """Return whether a command sets a variable of the file, whose uses are compared."""
    if command.name != "set":
        return False
    name = "".join(command.words[:1])
    return not name.startswith("CMAKE_") or name in _STANDARDS or _IRRELEVANT.fullmatch(name) is not None


def _parent(path: str) -> str:
    parent = PurePosixPath(path).parent.as_posix()
    return "" if parent == "." else parent


def _read_files(facts: BuildFacts, cmake: CMakeFile, package: Path) -> None:
    """Add the files that are copied. Programs are executables."""
    facts.is_complete = cmake.is_complete
    _move_missing_folders(facts, cmake, package)
    facts.project = "" if cmake.project is None else cmake.project.text
    try:
        facts.files = {file.destination: file.source for file in cmake.installed_files(package) if file.content is None}
    except FileNotFoundError:
        facts.is_complete = False
    spans = {item.text: cmake.span(item) for item in cmake.files}
    for name, path in cmake.programs.items():
        facts.facts.append(Fact(FactKind.EXECUTABLE, name, span=spans.get(path)))
    programs = set(cmake.programs.values())
    facts.files = {target: source for target, source in facts.files.items() if source not in programs}
    facts.facts += [Fact(FactKind.MODULE, module) for module in cmake.modules]


def _move_missing_folders(facts: BuildFacts, cmake: CMakeFile, package: Path) -> None:
    """Take the folders that the repository does not have from the rules that copy files, and add them as facts."""
    for index, rule in enumerate(cmake.copies):
        missing = [item for item in rule.items if rule.kind == "DIRECTORY" and not _exists(package, item.text)]
        facts.facts += [_fact(FactKind.FOLDER, item, rule.destination or "") for item in missing]
        cmake.copies[index] = replace(rule, items=tuple(item for item in rule.items if item not in missing))


def _exists(package: Path, item: str) -> bool:
    return item.startswith((BUILD, "$<")) or (package / item).exists()


def _fact(kind: FactKind, argument: Argument, value: str = "", name: str | None = None) -> Fact:
    span = argument.source.span(argument.start, argument.end)
    is_value_used = kind in (FactKind.EXECUTABLE, FactKind.PLUGIN_DESCRIPTION)
    return Fact(kind, argument.text if name is None else name, value, span, is_value_used)


def _targets(commands: Sequence[Command]) -> Iterator[Fact]:
    """Yield the targets that are installed and exported, and the executables of components."""
    libraries = {command.words[0] for command in commands if command.name in _LIBRARIES and command.words}
    for command in commands:
        arguments = command.arguments
        if command.name.startswith("ament_auto_add_") and arguments:
            kind = FactKind.EXECUTABLE if command.name in _EXECUTABLES else FactKind.LIBRARY
            yield _fact(kind, arguments[0])
        if command.name == "install" and command.words[:1] == ["TARGETS"]:
            targets = takewhile(lambda argument: argument.text not in _INSTALL_KEYWORDS, arguments[1:])
            for target in (target for target in targets if not is_open(target.text)):
                if target.text in libraries:
                    yield _fact(FactKind.LIBRARY, target)
                else:
                    yield _fact(FactKind.EXECUTABLE, target, _destination(command.words))
                if "EXPORT" in command.words:
                    yield _fact(FactKind.EXPORTED_TARGET, target)
        if command.name == "rclcpp_components_register_node":
            yield from _after(command, "EXECUTABLE", FactKind.EXECUTABLE)
            yield from _after(command, "PLUGIN", FactKind.COMPONENT)
        if command.name == "rclcpp_components_register_nodes":
            yield from (_fact(FactKind.COMPONENT, argument) for argument in arguments[1:])


def _destination(words: Sequence[str]) -> str:
    """Return the folder into which executables are installed, or an empty text if it is not known."""
    start = words.index("RUNTIME") if "RUNTIME" in words else 0
    rest = words[start:]
    target = rest[rest.index("DESTINATION") + 1] if "DESTINATION" in rest[:-1] else ""
    return "" if is_open(target) else target.rstrip("/")


def _after(command: Command, keyword: str, kind: FactKind) -> Iterator[Fact]:
    words = command.words
    if keyword in words[:-1]:
        yield _fact(kind, command.arguments[words.index(keyword) + 1])


def _interfaces(commands: Sequence[Command]) -> Iterator[Fact]:
    for command in commands:
        if command.name == "rosidl_generate_interfaces":
            for argument in command.arguments:
                if argument.text.endswith(_INTERFACE_SUFFIXES):
                    yield _fact(FactKind.INTERFACE, argument, name=within_package(argument.text, command.folder))
                elif argument.text == "DEPENDENCIES":
                    break


def _exports(commands: Sequence[Command]) -> Iterator[Fact]:
    for command in commands:
        if command.name == "pluginlib_export_plugin_description_file" and len(command.arguments) > 1:
            base, description = command.arguments[:2]
            yield _fact(FactKind.PLUGIN_DESCRIPTION, description, base.text)
        if command.name == "ament_export_dependencies":
            yield from (_fact(FactKind.EXPORTED_DEPENDENCY, item) for item in command.arguments)


def _packages(commands: Sequence[Command]) -> Iterator[Fact]:
    for command in commands:
        if command.name == "find_package" and command.arguments:
            package, *others = command.arguments
            yield _fact(FactKind.PACKAGE, package)
            start = command.words.index("COMPONENTS") if "COMPONENTS" in command.words else len(others)
            for component in others[start:]:
                if not component.text.isupper():  # a keyword, such as REQUIRED
                    name = component.text if package.text == "catkin" else f"{package.text} {component.text}"
                    yield _fact(FactKind.PACKAGE, component, name=name)


def _tests(commands: Sequence[Command]) -> Iterator[Fact]:
    for command in commands:
        if _is_test(command):
            words = command.words
            index = words.index("NAME") + 1 if "NAME" in words[:-1] and command.name == "add_test" else 0
            yield _fact(FactKind.TEST, command.arguments[index])


def _is_test(command: Command) -> bool:
    return bool(command.arguments) and _TEST_COMMAND.fullmatch(command.name) is not None


def _settings(commands: Sequence[Command]) -> Iterator[Fact]:
    """Yield the settings that concern the whole build: versions of languages and of CMake, and options."""
    for command in commands:
        words, arguments = command.words, command.arguments
        if command.name == "cmake_minimum_required" and len(words) > 1:
            yield _fact(FactKind.SETTING, arguments[1], words[1], command.name)
        elif command.name == "set" and len(words) > 1 and words[0] in _STANDARDS:
            yield _fact(FactKind.SETTING, arguments[0], words[1])
        elif command.name == "option" and words:
            yield _fact(FactKind.SETTING, arguments[0], words[2] if len(words) > 2 else "OFF")


_FACT_COMMANDS = frozenset(
    {
        *("ament_auto_add_executable", "ament_auto_add_library", "rclcpp_components_register_node"),
        *("rclcpp_components_register_nodes", "pluginlib_export_plugin_description_file"),
        *("ament_export_dependencies", "find_package", "cmake_minimum_required", "option"),
        *("ament_python_install_package", "ament_python_install_module"),
        *("add_executable", "add_library", "add_dependencies", "target_link_libraries", "target_include_directories"),
        *("ament_target_dependencies", "include_directories", "target_sources"),
        *("message", "project", "list", "unset", "install", "ament_package", "file", "string"),
    }
)
"""The commands whose content is compared as facts, or that change nothing for users."""
