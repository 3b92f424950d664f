"""Compare the targets, interfaces and files that ``CMakeLists.txt`` files install."""

from __future__ import annotations

import re
from collections.abc import Collection, Iterable, Iterator, Mapping, Sequence
from functools import partial
from itertools import takewhile
from pathlib import Path, PurePosixPath

from linkwright.diagnostics import SourceText
from linkwright.loading.lean_dataclasses import replace
from linkwright.packages.readers.cmake import CMakeFile, read_cmake
from linkwright.packages.readers.cmake_language import BUILD, Argument, CMakeProgram, Command, to_package_path
from linkwright.packages.readers.cmake_syntax import is_open
from linkwright.review.caching import cached_in_review
from linkwright.review.file_pair import FilePair
from linkwright.review.files.build.cmake_branches import (
    find_conditions,
    is_test_condition,
    iterate_conditional_commands,
)
from linkwright.review.files.build.cmake_headers import find_header_paths, find_include_folders
from linkwright.review.files.build.cmake_targets import (
    builds_test,
    compare_targets,
    find_private_libraries,
    has_unknown_sources,
    read_targets,
)
from linkwright.review.files.build.comparison import compare_build_files
from linkwright.review.files.build.facts import (
    ANY_VERSION,
    WITHOUT_NOTHING,
    BuildFacts,
    EnvironmentVariables,
    Fact,
    FactKind,
)
from linkwright.review.versions import Version

CMAKE_FILE = "CMakeLists.txt"
CMAKE_SUFFIX = ".cmake"
"""The suffix of files that a ``CMakeLists.txt`` may include."""
_COMMANDS_AFTER_TARGETS = (
    *("install", "target_", "set_target_properties", "add_dependencies", "ament_target_dependencies"),
    *("ament_export_", "catkin_package", "project"),
)
"""The prefixes of commands that refer to targets without creating them."""
_EXECUTABLE_COMMANDS = ("add_executable", "ament_auto_add_executable", "rosbuild_add_executable", "cuda_add_executable")
_LIBRARY_COMMANDS = ("add_library", "ament_auto_add_library", "rosbuild_add_library", "cuda_add_library")
_INSTALLING_COMMANDS = ("ament_auto_add_executable", "ament_auto_add_library")
"""The commands whose targets `ament_auto_package` installs. ``ament_auto_add_gtest`` makes a test."""
_GENERATED_LIBRARY_COMMANDS = ("generate_parameter_library", "generate_parameter_module")
"""The commands of generate_parameter_library, which make a library from a YAML file."""
_LIBRARY_TYPES = ("SHARED", "STATIC", "MODULE", "INTERFACE", "OBJECT")
_ROS1_INTERFACE_COMMANDS = {
    "add_message_files": ("msg", ".msg"),
    "add_service_files": ("srv", ".srv"),
    "add_action_files": ("action", ".action"),
    "rosbuild_genmsg": ("msg", ".msg"),
    "rosbuild_gensrv": ("srv", ".srv"),
    "genaction": ("action", ".action"),
}
"""The commands of ROS 1 that build interfaces: the default folder, and the suffix."""
_COMPONENT_KEYWORDS = {"PLUGIN": FactKind.COMPONENT, "EXECUTABLE": FactKind.EXECUTABLE}
_GUARD = (
    r"\bif\s*\(\s*NOT\s+\"?(?:\$\{{)?{name}_FOUND\}}?\"?\s*\)"
    r"(?:(?!\bif\s*\(|\b(?:end|else)\w*\s*\()[^#])*?\breturn\s*\("
)
"""A branch that ends the build if a package is not found."""
_VERSION = re.compile(r"\d+(\.\d+)*")
_INSTALL_KEYWORDS = frozenset(
    {"EXPORT", "ARCHIVE", "LIBRARY", "RUNTIME", "OBJECTS", "INCLUDES", "DESTINATION", "COMPONENT", "OPTIONAL"}
)
_TEST_COMMAND = re.compile(r"(\w+_)?add_(\w*_)?(\w*tests?|gmock|gbenchmark|catch2|file_check)")
_LAUNCH_SUFFIXES = (".launch", ".test", ".xml")
_PACKAGE_KEYWORDS = frozenset(
    {
        *("INCLUDE_DIRS", "LIBRARIES", "CATKIN_DEPENDS", "DEPENDS", "CFG_EXTRAS", "EXPORTED_TARGETS", "DEPENDENCIES"),
        *("LIBRARY_NAME", "ADD_LINTER_TESTS", "SKIP_INSTALL"),
        *("SKIP_CMAKE_CONFIG_GENERATION", "SKIP_PKG_CONFIG_GENERATION"),
    }
)
"""The keywords of ``catkin_package`` and of the commands that build interfaces."""
_IRRELEVANT_VARIABLE = re.compile(
    r"CMAKE_(EXPORT_COMPILE_COMMANDS|VERBOSE_MAKEFILE|COLOR_\w+|RULE_MESSAGES|INSTALL_MESSAGE|MESSAGE_\w+|"
    r"\w+_COMPILER_LAUNCHER|TLS_VERIFY|SUPPRESS_\w+|WARN_\w+|ERROR_\w+)"
)
"""The variables that affect neither the build nor the installation."""
_COMMENT = re.compile(r"#[^\n]*")
_VARIABLE = re.compile(r"\$\{(\w+)\}")
_OPTION = re.compile(r"^[ \t]*option\s*\(\s*(?P<name>\w+)", re.IGNORECASE | re.MULTILINE)
_ENVIRONMENT = re.compile(r"\bENV\{(\w+)\}")
_BUILD_VARIABLES = ("CMAKE_CXX_STANDARD", "CMAKE_C_STANDARD", "CMAKE_BUILD_TYPE")
_INTERFACE_SUFFIXES = (".msg", ".srv", ".action", ".idl")


def compare_cmake_files(pair: FilePair) -> None:
    """Compare two versions of a ``CMakeLists.txt`` without running CMake.

    Its subdirectories are included. An option that only one version declares is off in the other one, as in CMake.
    """
    texts = pair.versions.old.text(pair.old_path), pair.versions.new.text(pair.new_path)
    options = [match["name"] for text in texts for match in _OPTION.finditer(_COMMENT.sub("", text))]
    compare_build_files(pair, partial(read_cmake_facts, options=options), compare_targets)


def read_cmake_facts(version: Version, path: str, options: Iterable[str] = ()) -> BuildFacts:
    """Return the facts of a ``CMakeLists.txt`` with its subdirectories.

    Args:
        version: the version that contains the file.
        path: the path of the file relative to the root.
        options: the options that are off unless the file declares them; all others are unknown.
    """
    file = version.file(path)
    source = SourceText(str(file), file.read_text(encoding="utf-8", errors="replace"))
    facts = BuildFacts(package=_get_parent_folder(path))
    program = CMakeProgram(file.parent)
    program.variables |= dict.fromkeys(options, "OFF")
    commands = list(program.run(source))
    facts.routines = program.routines
    for reader in (
        _read_installed_targets,
        _read_interfaces,
        _read_exports,
        _read_packages,
        _read_tests,
        _read_settings,
        _read_include_folders,
    ):
        facts.facts += reader(commands)
    facts.facts += _read_ros1_interfaces(commands, file.parent)
    facts.facts += _read_built_targets(commands)
    folder_name = PurePosixPath(facts.package).name
    if folder_name and any(command.name == "rosbuild_init" for command in commands):
        program.variables.setdefault("PROJECT_NAME", folder_name)
    facts.facts += _read_skipped_targets(source, commands, program.variables)
    facts.facts += _read_build_failures(source, commands)
    facts.targets = read_targets(commands)
    exported_folders = [fact.name for fact in facts.facts if fact.kind is FactKind.EXPORTED_FOLDER]
    facts.header_paths = frozenset(find_header_paths(commands, exported_folders))
    facts.component_programs = dict(_read_component_programs(commands))
    facts.private_libraries = frozenset(find_private_libraries(commands, facts.targets, file.parent))
    facts.has_unknown_sources = has_unknown_sources(commands) or bool(program.unknown)
    facts.has_library = not _builds_only_programs(commands) or bool(program.unknown)
    facts.include_folders = frozenset(find_include_folders(commands))
    text = _COMMENT.sub(lambda comment: " " * len(comment[0]), source.text)
    facts.environment = EnvironmentVariables(
        (match[1], source.span(match.start(), match.end())) for match in _ENVIRONMENT.finditer(text)
    )
    cmake = read_cmake(source, file.parent, options)
    facts.output_names = cmake.output_names
    _read_files(facts, cmake, file.parent)
    facts.other_commands = [
        (_get_compared_name(command), _normalize_arguments(command, facts.project))
        for command in commands
        if command.name not in _FACT_COMMANDS and not _is_test(command) and not _sets_local_variable(command)
    ]
    return facts


def _get_compared_name(command: Command) -> str:
    """Return the name of a command, or of the variable that it sets."""
    return command.words[0] if command.name == "set" else command.name


def _normalize_arguments(command: Command, project: str) -> str:
    """Return the arguments of a command without interfaces and the name of the project."""
    words = [word for word in command.words if not word.endswith(_INTERFACE_SUFFIXES)]
    return " ".join("${PROJECT_NAME}" if word == project else word for word in words)


def _sets_local_variable(command: Command) -> bool:
    """Return whether a command sets a variable of the file.

    The uses of the variable are compared instead.
    """
    if command.name != "set":
        return False
    name = "".join(command.words[:1])
    return not name.startswith("CMAKE_") or name in _BUILD_VARIABLES or _IRRELEVANT_VARIABLE.fullmatch(name) is not None


def _get_parent_folder(path: str) -> str:
    parent = PurePosixPath(path).parent.as_posix()
    return "" if parent == "." else parent


def _read_files(facts: BuildFacts, cmake: CMakeFile, package: Path) -> None:
    """Add the copied files to the facts. Copied programs count as executables."""
    facts.unknown = frozenset(cmake.unknown)
    programs = cmake.programs
    spans = {item.text: cmake.span(item) for item in cmake.files}
    _drop_missing_sources(facts, cmake, package)
    facts.project = "" if cmake.project is None else cmake.project.text
    try:
        facts.files = {file.destination: file.source for file in cmake.installed_files(package) if file.content is None}
        facts.test_files = _find_test_files(cmake, package)
    except FileNotFoundError as error:
        facts.unknown |= {str(error)}
    for name, path in programs.items():
        facts.facts.append(Fact(FactKind.EXECUTABLE, name, span=spans.get(path)))
    sources = set(programs.values())
    facts.files = {target: source for target, source in facts.files.items() if source not in sources}
    facts.facts += [Fact(FactKind.MODULE, module) for module in cmake.modules]


def _find_test_files(cmake: CMakeFile, package: Path) -> frozenset[str]:
    """Return the destinations of the files that are installed only for tests."""
    copies, found = cmake.copies, []
    for is_test in (True, False):
        cmake.copies = [rule for rule in copies if all(map(_is_for_tests, rule.items)) is is_test]
        found.append({file.destination for file in cmake.installed_files(package) if file.content is None})
    cmake.copies = copies
    return frozenset(found[0] - found[1])


def _is_for_tests(item: Argument) -> bool:
    return is_test_condition(_get_conditions(item.source).get(item.start, ""))


def _drop_missing_sources(facts: BuildFacts, cmake: CMakeFile, package: Path) -> None:
    """Remove sources that the repository lacks from the copy rules.

    Missing folders are added as facts.
    """
    for index, rule in enumerate(cmake.copies):
        missing = [item for item in rule.items if not _exists(package, item.text)]
        if rule.kind == "DIRECTORY":
            facts.facts += [_make_fact(FactKind.FOLDER, item, rule.destination or "") for item in missing]
        cmake.copies[index] = replace(rule, items=tuple(item for item in rule.items if item not in missing))


def _exists(package: Path, item: str) -> bool:
    return item.startswith((BUILD, "$<")) or (package / item).exists()


def _make_fact(kind: FactKind, argument: Argument, value: str = "", name: str | None = None) -> Fact:
    span = argument.source.span(argument.start, argument.end)
    is_value_used = kind in (FactKind.EXECUTABLE, FactKind.PLUGIN_DESCRIPTION)
    condition = _get_conditions(argument.source).get(argument.start, "")
    return Fact(kind, argument.text if name is None else name, value, span, is_value_used, condition)


@cached_in_review(maxsize=16)
def _get_conditions(source: SourceText) -> dict[int, str]:
    return find_conditions(source)


def _read_installed_targets(commands: Sequence[Command]) -> Iterator[Fact]:
    """Yield the installed and exported targets, and the executables of components."""
    library_commands = _LIBRARY_COMMANDS + _GENERATED_LIBRARY_COMMANDS
    libraries = {command.words[0] for command in commands if command.name in library_commands and command.words}
    built = _BuiltTargetNames(commands)
    for command in commands:
        arguments = command.arguments
        if command.name in _INSTALLING_COMMANDS and arguments:
            kind = FactKind.EXECUTABLE if command.name in _EXECUTABLE_COMMANDS else FactKind.LIBRARY
            yield _make_fact(kind, arguments[0])
        if command.name == "install" and command.words[:1] == ["TARGETS"]:
            targets = takewhile(lambda argument: argument.text not in _INSTALL_KEYWORDS, arguments[1:])
            for target in (target for target in targets if not is_open(target.text)):
                if target.text not in built:
                    continue
                if target.text in libraries:
                    yield _make_fact(FactKind.LIBRARY, target)
                else:
                    yield _make_fact(FactKind.EXECUTABLE, target, _find_installation_folder(command.words))
                if "EXPORT" in command.words:
                    yield _make_fact(FactKind.EXPORTED_TARGET, target)
        if command.name == "rclcpp_components_register_node":
            yield from _read_argument_after(command, "EXECUTABLE", FactKind.EXECUTABLE)
            yield from _read_argument_after(command, "PLUGIN", FactKind.COMPONENT)
        if command.name == "rclcpp_components_register_nodes":
            yield from (_make_fact(FactKind.COMPONENT, argument) for argument in arguments[1:])


def _builds_only_programs(commands: Sequence[Command]) -> bool:
    """Return whether a package builds programs and no library."""
    names = {command.name for command in commands}
    return not names.isdisjoint(_EXECUTABLE_COMMANDS) and not any(name.endswith("add_library") for name in names)


def _read_component_programs(commands: Sequence[Command]) -> Iterator[tuple[str, str]]:
    """Yield the class of each component that has an executable of its own, with the executable."""
    for command in commands:
        if command.name == "rclcpp_components_register_node":
            found = [_read_argument_after(command, keyword, kind) for keyword, kind in _COMPONENT_KEYWORDS.items()]
            yield from ((plugin.name, program.name) for plugin, program in zip(*found, strict=False))


class _BuiltTargetNames:
    """The possible names of built targets.

    CMake fails if a target is installed that nothing builds.
    """

    def __init__(self, commands: Sequence[Command]) -> None:
        target_commands = [
            command for command in commands if not command.name.startswith(_COMMANDS_AFTER_TARGETS) and command.words
        ]
        self._names = {word for command in target_commands for word in command.words}
        self._has_unknown_name = any(
            is_open(command.words[0])
            for command in target_commands
            if command.name in _EXECUTABLE_COMMANDS + _LIBRARY_COMMANDS
        )

    def __contains__(self, name: str) -> bool:
        return self._has_unknown_name or name in self._names


def _read_built_targets(commands: Sequence[Command]) -> Iterator[Fact]:
    """Yield the targets that are built."""
    for command in commands:
        if (
            command.name not in _EXECUTABLE_COMMANDS + _LIBRARY_COMMANDS
            or not command.arguments
            or is_open(command.words[0])
        ):
            continue
        library_type = next((word for word in command.words[1:2] if word in _LIBRARY_TYPES), "")
        yield _make_fact(_find_built_kind(command.name, commands), command.arguments[0], library_type)


def _read_skipped_targets(
    source: SourceText, commands: Sequence[Command], variables: Mapping[str, str]
) -> Iterator[Fact]:
    """Yield the targets of unfulfilled conditions, such as a different version of ROS."""

    def substitute_variables(text: str) -> str:
        return _VARIABLE.sub(lambda match: variables.get(match[1], match[0]), text)

    target_commands = [
        command for command in commands if command.name in _EXECUTABLE_COMMANDS + _LIBRARY_COMMANDS and command.words
    ]
    built = {substitute_variables(command.words[0]) for command in target_commands}
    for statement, condition in iterate_conditional_commands(source):
        if not condition or statement.name not in _EXECUTABLE_COMMANDS + _LIBRARY_COMMANDS or not statement.tokens:
            continue
        token = statement.tokens[0]
        name = substitute_variables(token.text)
        if name not in built and not is_open(name):
            kind = _find_built_kind(statement.name, commands)
            yield Fact(kind, name, span=source.span(token.start, token.end), condition=condition)


def _find_built_kind(command: str, commands: Sequence[Command]) -> FactKind:
    """Return the kind of the targets of a command.

    In ROS 1, targets can be used without being installed.
    """
    if not any(command.name in ("catkin_package", "rosbuild_init") for command in commands):
        return FactKind.BUILT_TARGET
    return FactKind.BUILT_EXECUTABLE if command in _EXECUTABLE_COMMANDS else FactKind.BUILT_LIBRARY


def _read_build_failures(source: SourceText, commands: Sequence[Command]) -> Iterator[Fact]:
    """Yield the messages of possible build failures, including unfulfilled conditions."""
    sources = {source.name: source}
    for command in commands:
        sources |= {argument.source.name: argument.source for argument in command.arguments[:1]}
    for source in sources.values():
        for statement, condition in iterate_conditional_commands(source):
            tokens = statement.tokens
            if statement.name == "message" and len(tokens) > 1 and tokens[0].text in ("FATAL_ERROR", "SEND_ERROR"):
                text = " ".join(" ".join(token.text for token in tokens[1:]).split())
                yield Fact(FactKind.STOP, text, span=source.span(tokens[1].start, tokens[1].end), condition=condition)


def _find_installation_folder(words: Sequence[str]) -> str:
    """Return the installation folder of executables; empty if it is unknown."""
    start = words.index("RUNTIME") if "RUNTIME" in words else 0
    arguments = words[start:]
    target = arguments[arguments.index("DESTINATION") + 1] if "DESTINATION" in arguments[:-1] else ""
    return "" if is_open(target) else target.rstrip("/")


def _read_argument_after(command: Command, keyword: str, kind: FactKind) -> Iterator[Fact]:
    words = command.words
    if keyword in words[:-1]:
        yield _make_fact(kind, command.arguments[words.index(keyword) + 1])


def _read_interfaces(commands: Sequence[Command]) -> Iterator[Fact]:
    for command in commands:
        if command.name == "rosidl_generate_interfaces":
            for argument in command.arguments:
                if argument.text.endswith(_INTERFACE_SUFFIXES):
                    yield _make_fact(FactKind.INTERFACE, argument, name=to_package_path(argument.text, command.folder))
                elif argument.text == "DEPENDENCIES":
                    break
        if command.name in ("rosidl_generate_interfaces", "generate_messages"):
            yield from _read_arguments_after(command, "DEPENDENCIES", FactKind.INTERFACE_DEPENDENCY)
        if command.name in ("generate_dynamic_reconfigure_options", "gencfg"):
            yield from (_make_fact(FactKind.DYNAMIC, argument) for argument in command.arguments)


def _read_ros1_interfaces(commands: Sequence[Command], package: Path) -> Iterator[Fact]:
    """Yield the interfaces that ROS 1 commands build.

    A command without a list builds all interfaces of a folder.
    """
    for command in commands:
        if command.name not in _ROS1_INTERFACE_COMMANDS:
            continue
        folder, suffix = _ROS1_INTERFACE_COMMANDS[command.name]
        words = command.words
        folder = words[words.index("DIRECTORY") + 1] if "DIRECTORY" in words[:-1] else folder
        named = [argument for argument in command.arguments if argument.text.endswith(suffix)]
        for argument in named:
            yield _make_fact(FactKind.INTERFACE, argument, name=f"{folder}/{argument.text}")
        if not named and "FILES" not in words:
            for file in sorted((package / folder).glob(f"*{suffix}")):
                yield Fact(FactKind.INTERFACE, f"{folder}/{file.name}")


def _read_exports(commands: Sequence[Command]) -> Iterator[Fact]:
    project = next((command.words[0] for command in commands if command.name == "project" and command.words), "")
    for command in commands:
        if command.name == "pluginlib_export_plugin_description_file" and len(command.arguments) > 1:
            base, description = command.arguments[:2]
            yield _make_fact(FactKind.PLUGIN_DESCRIPTION, description, base.text)
        elif command.name == "ament_export_dependencies":
            yield from (_make_fact(FactKind.EXPORTED_DEPENDENCY, item) for item in _select_known(command.arguments))
        elif command.name == "ament_export_libraries":
            yield from (_make_fact(FactKind.EXPORTED_TARGET, item) for item in _select_known(command.arguments))
        elif command.name == "ament_export_include_directories":
            yield from (_make_exported_folder_fact(item, project) for item in command.arguments)
        elif command.name == "catkin_package":
            yield from _read_arguments_after(command, "INCLUDE_DIRS", FactKind.EXPORTED_FOLDER)
            yield from _read_arguments_after(command, "LIBRARIES", FactKind.EXPORTED_TARGET)
            yield from _read_arguments_after(command, "CATKIN_DEPENDS", FactKind.EXPORTED_DEPENDENCY)
            yield from _read_arguments_after(command, "DEPENDS", FactKind.EXPORTED_DEPENDENCY)


def _select_known(arguments: Iterable[Argument]) -> Iterator[Argument]:
    """Yield the arguments without variables that the file does not set, which are empty or name other packages."""
    return (item for item in arguments if not _VARIABLE.fullmatch(item.text))


def _make_exported_folder_fact(argument: Argument, project: str) -> Fact:
    """Return the fact about an exported folder. The name of the project in it is ignored."""
    return _make_fact(FactKind.EXPORTED_FOLDER, argument, name=argument.text.removesuffix(f"/{project}"))


def _read_arguments_after(command: Command, keyword: str, kind: FactKind) -> Iterator[Fact]:
    """Yield the arguments between a keyword and the next one."""
    if keyword in command.words:
        arguments = command.arguments[command.words.index(keyword) + 1 :]
        yield from (
            _make_fact(kind, item)
            for item in takewhile(lambda argument: argument.text not in _PACKAGE_KEYWORDS, arguments)
            if not item.text.startswith("$")
        )


def _read_packages(commands: Sequence[Command]) -> Iterator[Fact]:
    for command in commands:
        if command.name in _FIND_COMMANDS and command.arguments:
            package, *options = command.arguments
            if command.name != "find_package":
                options = [item for item in _list_before(options, _GAZEBO_KEYWORDS) if item.text != "VERSION"]
            version = next((other.text for other in options[:1] if _VERSION.fullmatch(other.text)), ANY_VERSION)
            value = version if "REQUIRED" in command.words or package.text == "catkin" else f"{version}, optional"
            if value != version and _is_guarded(package):
                value = f"{version}{WITHOUT_NOTHING}"
            yield _make_fact(FactKind.PACKAGE, package, value)
            words = [item.text for item in options]
            start = words.index("COMPONENTS") + 1 if "COMPONENTS" in words else len(options)
            if package.text == "catkin":
                start = 0  # the keyword is optional
            for component in options[start:]:
                if not component.text.isupper():  # a keyword, such as REQUIRED
                    name = component.text if package.text == "catkin" else f"{package.text} {component.text}"
                    required = ANY_VERSION if package.text == "catkin" else ""
                    yield _make_fact(FactKind.PACKAGE, component, required, name)


def _list_before(arguments: Sequence[Argument], keywords: Collection[str]) -> list[Argument]:
    """Return the arguments before the first one of several keywords."""
    return list(takewhile(lambda argument: argument.text not in keywords, arguments))


def _is_guarded(package: Argument) -> bool:
    """Return whether the build file of a package returns if it does not find another package."""
    text = package.source.text
    guard = re.search(_GUARD.format(name=re.escape(package.text)), text)
    return guard is not None and re.search(r"^\s*project\s*\(", text, re.MULTILINE) is not None


def _read_tests(commands: Sequence[Command]) -> Iterator[Fact]:
    for command in commands:
        if _is_test(command):
            words = command.words
            index = words.index("NAME") + 1 if "NAME" in words[:-1] and command.name == "add_test" else 0
            yield _make_fact(FactKind.TEST, command.arguments[index], _find_launch_file(command))


def _find_launch_file(command: Command) -> str:
    """Return the launch file of a test program, or an empty text if it has none."""
    files = command.words[1:2] if builds_test(command.name) else []
    return next((file for file in files if file.endswith(_LAUNCH_SUFFIXES) and not is_open(file)), "")


def _is_test(command: Command) -> bool:
    is_test = _TEST_COMMAND.fullmatch(command.name) is not None or builds_test(command.name)
    return bool(command.arguments) and is_test


def _read_settings(commands: Sequence[Command]) -> Iterator[Fact]:
    """Yield the settings of the whole build: versions of languages and of CMake, and options."""
    for command in commands:
        words, arguments = command.words, command.arguments
        if command.name == "cmake_minimum_required" and len(words) > 1:
            yield _make_fact(FactKind.SETTING, arguments[1], words[1], command.name)
        elif command.name == "set" and len(words) > 1 and words[0] in _BUILD_VARIABLES:
            yield _make_fact(FactKind.SETTING, arguments[0], words[1])
        elif command.name == "option" and words:
            yield _make_fact(FactKind.SETTING, arguments[0], words[2] if len(words) > 2 else "OFF")


def _read_include_folders(commands: Sequence[Command]) -> Iterator[Fact]:
    """Yield the absolute folders of headers as written, which other computers may not have.

    Folders below variables and in generator expressions are left out.
    """
    for command in commands:
        if command.name in _INCLUDE_COMMANDS:
            for argument in command.arguments:
                if argument.text.startswith(("/", "~/")) and "$" not in argument.text:
                    yield _make_fact(FactKind.INCLUDE_FOLDER, argument)


_FIND_COMMANDS = ("find_package", "gz_find_package", "ign_find_package")
"""The commands that find a package; those of the build tools of Gazebo call ``find_package``."""
_GAZEBO_KEYWORDS = frozenset({"REQUIRED_BY", "PRIVATE_FOR", "PKGCONFIG", "PRETTY", "PURPOSE", "EXTRA_ARGS"})
"""The keywords of the commands of Gazebo whose values are neither a version nor a component."""
_INCLUDE_COMMANDS = ("include_directories", "target_include_directories")
_FACT_COMMANDS = frozenset(
    {
        *("ament_auto_add_executable", "ament_auto_add_library", "rclcpp_components_register_node"),
        *("rclcpp_components_register_nodes", "pluginlib_export_plugin_description_file"),
        *("ament_export_dependencies", *_FIND_COMMANDS, "cmake_minimum_required", "option"),
        *("ament_python_install_package", "ament_python_install_module"),
        *("add_executable", "add_library", "add_dependencies", "target_link_libraries", "target_include_directories"),
        *("ament_target_dependencies", "include_directories", "target_sources", "catkin_package", "generate_messages"),
        *("ament_export_libraries", "ament_export_include_directories", "rosidl_generate_interfaces", "gencfg"),
        *("generate_dynamic_reconfigure_options", "rosbuild_add_executable", "rosbuild_add_library", "rosbuild_init"),
        *("rosbuild_link_boost", "rosbuild_find_ros_package", "cuda_add_executable", "cuda_add_library"),
        *_ROS1_INTERFACE_COMMANDS,
        *("message", "project", "list", "unset", "install", "ament_package", "file", "string"),
        *("cmake_parse_arguments", "math"),
    }
)
"""The commands that are compared as facts, or that do not affect users."""
