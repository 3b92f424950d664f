"""Launch files in Python: the meaning of strings in calls such as ``Node(package="...")``.

The files are not run.
"""

from __future__ import annotations

import re
from collections.abc import Iterator
from dataclasses import dataclass
from functools import cached_property
from pathlib import Path

from linkwright.language.completion import Completion, ItemKind
from linkwright.language.cursor import name_at
from linkwright.language.format import Document, Format, Symbol, SymbolKind, Target
from linkwright.language.hover import Explanation
from linkwright.language.launch_arguments import LaunchArgument, arguments_in, list_likely_values
from linkwright.language.launch_classes import class_arguments, describe_class, find_first_argument, load_classes
from linkwright.language.links import FileReference
from linkwright.language.node_topics import (
    NodeProgram,
    explain_topic,
    find_topic_targets,
    node_name,
    offer_topics,
    plain_name,
)
from linkwright.language.offers import (
    explain_file,
    explain_package,
    explain_program,
    offer_components,
    offer_files,
    offer_packages,
    offer_programs,
    offer_values,
    target_of_component,
    target_of_file,
    target_of_package,
    target_of_program,
)
from linkwright.language.parameter_catalog import ParameterInfo, node_parameters
from linkwright.language.parameter_completion import describe_parameter_info
from linkwright.language.python_paths import JOINS, PACKAGE_FUNCTIONS, PythonPaths, Value
from linkwright.language.python_text import Group, Item, Name, Text, python_text
from linkwright.language.source_parameters import parameters_in_sources
from linkwright.packages.share_layout import find_source

_PACKAGE_KEYWORDS = frozenset({"package", "package_name", "node_package"})
_PROGRAM_KEYWORDS = frozenset({"executable", "node_executable"})
CONFIGURATIONS = frozenset({"LaunchConfiguration", "LaunchConfigurationEquals", "LaunchConfigurationNotEquals"})
"""The classes whose first argument is the name of a launch configuration."""
_ACTIONS = ("Node", "LifecycleNode", "ComposableNode", "ComposableNodeContainer", "IncludeLaunchDescription")
_OUTPUT_CHOICES = ("screen", "log", "both", "own_log", "full")
_REMAPPINGS, _PARAMETERS = re.compile(r"(?i)remap"), re.compile(r"(?i)^parameters$|_params$|_parameters$")
_PAIR_LENGTH, _MAX_LIST_DEPTH = 2, 4
_PACKAGE_SCHEME = "package://"
_WORD_BEFORE = re.compile(r"[^\W\d]\w*\Z")


def is_python_launch_file(path: Path) -> bool:
    """Return whether a file is a Python launch file, or a Python file in a launch folder."""
    is_launch = path.name.endswith((".launch.py", "_launch.py")) or path.name == "launch.py"
    return is_launch or (path.suffix == ".py" and "launch" in path.parts[-4:-1])


@dataclass(frozen=True, slots=True)
class _StringMeaning:
    """The meaning of a string in a launch file.

    Attributes:
        kind: "package", "program", "component", "configuration", "argument", "output", "choice", "topic", "parameter"
            or "path".
        text: the string.
        package: the package of a program or component.
        arguments: the launch arguments that a configuration or argument may refer to.
        base: the path that the string continues.
        choices: the likely values.
        programs: the programs of the nodes that have a topic or parameter.
        excluded_names: the other names in the list of a topic or parameter.
    """

    kind: str
    text: Text
    package: str | None = None
    arguments: tuple[LaunchArgument, ...] = ()
    base: Value | None = None
    choices: tuple[str, ...] = ()
    programs: tuple[NodeProgram, ...] = ()
    excluded_names: frozenset[str] = frozenset()


class PythonLaunchText:
    """A launch file in Python, with the arguments that it declares."""

    def __init__(self, document: Document) -> None:
        self.document = document
        self.python = python_text(document.text)
        texts = {
            argument.name: argument.default
            for argument in self.arguments
            if argument.default and "(" not in argument.default
        }
        self.paths = PythonPaths(self.python, document.file, document.finder, texts)

    @cached_property
    def arguments(self) -> tuple[LaunchArgument, ...]:
        """The arguments that the file declares."""
        return tuple(arguments_in(self.document.text, self.document.file))

    def meaning_at(self, offset: int) -> _StringMeaning | None:
        """Return the meaning of the string at an offset, or None outside of strings."""
        string = self.python.string_at(offset)
        return None if string is None else self._meaning_of(*string)

    def _meaning_of(self, text: Text, item: Item) -> _StringMeaning:
        group, keyword = item.group, item.keyword
        index = group.items.index(item)
        if keyword in _PACKAGE_KEYWORDS or (group.function in PACKAGE_FUNCTIONS and index == 0):
            return _StringMeaning("package", text)
        if group.function == "MoveItConfigsBuilder" and keyword == "package_name":
            return _StringMeaning("package", text)
        if keyword in _PROGRAM_KEYWORDS or keyword in ("plugin", "node_plugin"):
            package_item = next((other for other in group.items if other.keyword in _PACKAGE_KEYWORDS), None)
            kind = "program" if keyword in _PROGRAM_KEYWORDS else "component"
            return _StringMeaning(kind, text, package=self.paths.text_of(package_item))
        if group.function in CONFIGURATIONS and (index == 0 or keyword == "variable_name"):
            return _StringMeaning("configuration", text, arguments=self.arguments)
        if keyword == "output":
            return _StringMeaning("output", text, choices=_OUTPUT_CHOICES)
        if keyword == "default_value":
            name = self.paths.text_of(group.argument("name", 0)) or ""
            choices = self._read_choices(group) or list_likely_values(None, name, self.document.text)
            return _StringMeaning("choice", text, base=self.paths.path_before(text, item), choices=choices)
        node_meaning = self._meaning_in_node(text, item)
        if node_meaning is not None:
            return node_meaning
        included = self._meaning_in_include(text, item)
        if included is not None:
            return included
        if group.function == "DeclareLaunchArgument" and (index == 0 or keyword == "name"):
            own_arguments = tuple(argument for argument in self.arguments if argument.start == text.start)
            return _StringMeaning("argument", text, arguments=own_arguments)
        return _StringMeaning("path", text, base=self.paths.path_before(text, item))

    def _meaning_in_node(self, text: Text, item: Item) -> _StringMeaning | None:
        """Return the meaning of a name in a remapping or in the parameters of a node, or None."""
        group, outer = item.group, item.group.parent
        if outer is None or group.callee or not item.parts or item.parts[0] is not text:
            return None
        if group.opening == "(" and _is_in_list_named(outer, _REMAPPINGS) and len(group.items) <= _PAIR_LENGTH:
            pairs = [sibling.parts[0] for sibling in outer.group.items if sibling is not outer and sibling.parts]
            first_parts = (pair.items[0].parts[:1] for pair in pairs if isinstance(pair, Group) and pair.items)
            remapped_names = frozenset(part.value for parts in first_parts for part in parts if isinstance(part, Text))
            programs = self._list_programs(outer, "remappings")
            first = group.items[0].parts[0] if group.items[0].parts else None
            if item is not group.items[0]:  # This string is the new name.
                old = first.value if isinstance(first, Text) else ""
                return _StringMeaning("topic", text, choices=_list_name_forms(old), programs=programs)
            return _StringMeaning("topic", text, programs=programs, excluded_names=remapped_names)
        if group.opening == "{" and _is_in_list_named(outer, _PARAMETERS):
            names = (sibling.parts[0] for sibling in group.items if sibling is not item and sibling.parts)
            parameter_names = frozenset(part.value for part in names if isinstance(part, Text))
            return _StringMeaning(
                "parameter", text, programs=self._list_programs(outer, "parameters"), excluded_names=parameter_names
            )
        return None

    def _list_programs(self, item: Item, keyword: str) -> tuple[NodeProgram, ...]:
        """Return the programs of the nodes that use a list of remappings or parameters."""
        bound = item
        current: Item | None = item
        while current is not None:
            if current.keyword == keyword and current.group.callee:
                return (self._read_program(current.group),)
            bound, current = current, current.group.parent
        names = {bound.keyword, *(part.value for part in bound.parts[:1] if isinstance(part, Name))}
        users = [call for call in self.python.calls_of(*_ACTIONS) if _collect_names(call.argument(keyword)) & names]
        programs = map(self._read_program, users or self.python.calls_of(*_ACTIONS))
        return tuple(dict.fromkeys(program for program in programs if any(program)))

    def _read_program(self, call: Group) -> NodeProgram:
        package, executable = (
            next((candidate for candidate in call.items if candidate.keyword in keywords), None)
            for keywords in (_PACKAGE_KEYWORDS, _PROGRAM_KEYWORDS)
        )
        return NodeProgram(self.paths.text_of(package) or "", self.paths.text_of(executable) or "")

    def parameters(self, meaning: _StringMeaning) -> list[ParameterInfo]:
        """Return the parameters of the nodes that a string configures."""
        parameters: dict[str, ParameterInfo] = {}
        for program in meaning.programs:
            names = (node_name(*program), program.executable)
            known_parameters = next(
                (found_parameters for name in names if (found_parameters := node_parameters(name))), ()
            )
            for parameter in known_parameters or parameters_in_sources(self.document, program):
                parameters.setdefault(parameter.name, parameter)
        parameters.setdefault("use_sim_time", ParameterInfo("use_sim_time", "bool", False))
        return list(parameters.values())

    def undeclared_names(self, excluded: Text) -> list[str]:
        """Return the names of configurations that the file uses but does not declare."""
        calls = self.python.calls_of(*CONFIGURATIONS)
        parts = (part for call in calls for item in call.items[:1] for part in item.parts[:1])
        names = dict.fromkeys(part.value for part in parts if isinstance(part, Text) and part is not excluded)
        declared = {argument.name for argument in self.arguments}
        return [name for name in names if name and name not in declared]

    def _read_choices(self, call: Group) -> tuple[str, ...]:
        choices = call.argument("choices")
        part = choices.parts[0] if choices is not None and choices.parts else None
        inner = part.items if isinstance(part, Group) else []
        return tuple(part_text.value for item in inner for part_text in item.parts[:1] if isinstance(part_text, Text))

    def _meaning_in_include(self, text: Text, item: Item) -> _StringMeaning | None:
        """Return the meaning of a key or value in the launch arguments of an include, or None."""
        include = _find_include_around(item)
        if include is None:
            return None
        path = self.find_included_file(include)
        declared = tuple(self._read_declared_arguments(path)) if path is not None else self.arguments
        group = item.group
        is_pair = group.opening == "(" and not group.callee
        first = group.items[0].parts[:1] if is_pair else item.parts[:1]
        name = first[0].value if first and isinstance(first[0], Text) else ""
        if first and first[0] is text:
            return _StringMeaning("argument", text, arguments=declared) if is_pair or group.opening == "{" else None
        if not is_pair and group.opening != "{":
            return None
        argument = next((candidate for candidate in declared if candidate.name == name), None)
        choices = () if argument is None else list_likely_values(argument, name, self.document.text)
        known_arguments = () if argument is None else (argument,)
        return _StringMeaning("choice", text, None, known_arguments, self.paths.path_before(text, item), choices)

    def find_included_file(self, include: Group) -> Path | None:
        """Return the file of an ``IncludeLaunchDescription``, or None if it is unknown or missing."""
        value = self.paths.value_of(include.argument("launch_description_source", 0))
        return None if value is None else self.find_file(value.text)

    def find_file(self, path: str) -> Path | None:
        """Return the existing file or folder of a path, or None."""
        try:
            file = self.document.file.parent / path
            return file if path and "\n" not in path and file.exists() else None
        except (OSError, ValueError):
            return None

    def _read_declared_arguments(self, path: Path) -> Iterator[LaunchArgument]:
        path = Path(find_source(str(path)))
        for argument in arguments_in(self.document.other(path), path):
            if argument.is_argument:
                yield argument

    def path_through(self, meaning: _StringMeaning, end: int) -> str | None:
        """Return the path of a string up to the first slash at or after an offset."""
        base = "" if meaning.base is None else meaning.base.text
        component = meaning.text.value[end - meaning.text.start :].partition("/")[0]
        path_text = meaning.text.value[: end - meaning.text.start] + component
        return base.rstrip("/") + "/" + path_text.lstrip("/") if base.endswith("/") else base + path_text


def _is_in_list_named(item: Item, name_pattern: re.Pattern[str]) -> bool:
    """Return whether an item is in a list for an argument or variable with a matching name."""
    current: Item | None = item
    for _ in range(_MAX_LIST_DEPTH):
        if current is None:
            return False
        words = [current.keyword] + [part.value for part in current.parts[:1] if isinstance(part, Name)]
        if any(name_pattern.search(word) for word in words):
            return True
        current = current.group.parent if not current.group.callee else None
    return False


def _collect_names(item: Item | None) -> set[str]:
    return {part.value for part in item.parts if isinstance(part, Name)} if item is not None else set()


def _list_name_forms(old: str) -> tuple[str, ...]:
    """Return the other forms of a name: relative, absolute, and without namespaces."""
    name = plain_name(old)
    forms = dict.fromkeys((name, f"/{name}", name.rpartition("/")[2])) if name else ()
    return tuple(form for form in forms if form != old)


def _find_include_around(item: Item) -> Group | None:
    """Return the ``IncludeLaunchDescription`` whose launch arguments contain an item, or None."""
    current: Item | None = item
    for _ in range(5):
        if current is None:
            return None
        if current.keyword == "launch_arguments" and current.group.function == "IncludeLaunchDescription":
            return current.group if current is not item else None
        current = current.group.parent
    return None


# --- completion -----------------------------------------------------------------------------------------------


def _complete(document: Document, offset: int) -> Iterator[Completion]:
    launch = PythonLaunchText(document)
    meaning = launch.meaning_at(offset)
    if meaning is None:
        yield from _offer_arguments(launch, offset)
        return
    start = meaning.text.start
    if meaning.kind == "package":
        yield from offer_packages(document, start)
    elif meaning.kind == "program":
        yield from offer_programs(document, meaning.package, start)
    elif meaning.kind == "component":
        yield from offer_components(document, meaning.package, start)
    elif meaning.kind in ("configuration", "argument"):
        for argument in meaning.arguments:
            if meaning.text.start != argument.start or argument.file != document.file:
                detail = argument.default or ""
                yield Completion(argument.name, ItemKind.NAME, start, detail, argument.describe())
        if meaning.kind == "configuration":
            for name in launch.undeclared_names(meaning.text):
                yield Completion(name, ItemKind.NAME, start)
    elif meaning.kind == "parameter":
        for parameter in launch.parameters(meaning):
            if parameter.name not in meaning.excluded_names and "*" not in parameter.name:
                detail = f"{parameter.type} {parameter.default_text}".strip()
                yield Completion(parameter.name, ItemKind.NAME, start, detail, parameter.description)
    elif meaning.kind == "topic" and not meaning.choices:
        yield from offer_topics(document, meaning.programs, document.text[start:offset], start, meaning.excluded_names)
    else:
        yield from offer_values(meaning.choices, start)
        yield from _offer_paths(launch, meaning, offset)


def _offer_paths(launch: PythonLaunchText, meaning: _StringMeaning, offset: int) -> Iterator[Completion]:
    typed = meaning.text.value[: offset - meaning.text.start]
    if typed.startswith(_PACKAGE_SCHEME):
        name, slash, subpath = typed[len(_PACKAGE_SCHEME) :].partition("/")
        share = launch.document.finder.find(name) if slash else None
        if share is not None:
            yield from offer_files(share, subpath, offset)
        elif not slash:
            yield from offer_packages(launch.document, meaning.text.start + len(_PACKAGE_SCHEME))
        return
    if meaning.base is None or not meaning.base.is_path:
        return
    if not meaning.base.text.endswith("/") and not typed.startswith("/"):
        return
    yield from offer_files(Path(meaning.base.text), typed, offset, launch_files="launch" in meaning.base.text)


# --- hover, definition and links ------------------------------------------------------------------------------


def _explain(document: Document, offset: int) -> Explanation | None:
    launch = PythonLaunchText(document)
    meaning = launch.meaning_at(offset)
    if meaning is None:
        return _explain_name(launch, offset)
    text = _explain_meaning(launch, meaning, offset) or _explain_argument(launch, meaning)
    return Explanation(text, meaning.text.start, meaning.text.end) if text else None


def _explain_meaning(launch: PythonLaunchText, meaning: _StringMeaning, offset: int) -> str | None:
    value = meaning.text.value
    if meaning.kind == "package":
        return explain_package(launch.document, value)
    if meaning.kind == "program":
        return explain_program(launch.document, meaning.package, value)
    if meaning.kind in ("configuration", "argument"):
        return "\n\n".join(argument.describe() for argument in meaning.arguments if argument.name == value)
    if meaning.kind == "topic":
        return explain_topic(launch.document, meaning.programs, value)
    if meaning.kind == "parameter":
        parameter = next((candidate for candidate in launch.parameters(meaning) if candidate.matches(value)), None)
        return None if parameter is None else describe_parameter_info(parameter, value)
    path = launch.path_through(meaning, offset)
    file = None if path is None else launch.find_file(path)
    if file is not None and (meaning.base is not None or "/" in value):
        return explain_file(file)
    is_path = meaning.base is not None and meaning.base.is_path and path is not None
    return explain_file(Path(path or "")) if is_path else None


def _explain_argument(launch: PythonLaunchText, string_meaning: _StringMeaning) -> str | None:
    """Explain the argument whose value is a string, or return None if there is no explanation."""
    if string_meaning.kind == "choice" and string_meaning.arguments:
        return string_meaning.arguments[0].describe()
    string = launch.python.string_at(string_meaning.text.start)
    if string is None or not string[1].keyword:
        return None
    meaning = class_arguments(string[1].group.function).get(string[1].keyword)
    return f"`{string[1].keyword}`: {meaning}" if meaning else None


def _offer_arguments(launch: PythonLaunchText, offset: int) -> Iterator[Completion]:
    """Yield completions of the arguments that the call around an offset does not have yet."""
    text = launch.document.text
    typed = _WORD_BEFORE.search(text, text.rfind("\n", 0, offset) + 1, offset)
    call = launch.python.call_at(offset)
    start = offset if typed is None else typed.start()
    if call is None or not text[:start].rstrip().endswith(("(", ",")):
        return
    if any(item.start <= start and item.parts for item in call.items if _find_group_around(item, start) is not None):
        return
    keywords = {item.keyword for item in call.items}
    if call.items[0].parts and not call.items[0].keyword and text[:start].rstrip().endswith(","):
        keywords.add(find_first_argument(call.function) or "")
    for name, meaning in class_arguments(call.function).items():
        if name not in keywords:
            yield Completion(f"{name}=", ItemKind.ATTRIBUTE, start, call.function, meaning)


def _find_group_around(item: Item, offset: int) -> Group | None:
    """Return the brackets directly inside an item that contain an offset, or None."""
    groups = (part for part in item.parts if isinstance(part, Group))
    return next((group for group in groups if group.start < offset < group.end), None)


def _explain_name(launch: PythonLaunchText, offset: int) -> Explanation | None:
    """Explain the class, argument or path variable at an offset, or return None."""
    name_and_start = name_at(launch.document.text, offset)
    if name_and_start is None:
        return None
    name, start = name_and_start
    call = launch.python.call_at(offset)
    text = describe_class(name.rpartition(".")[2])
    if text is None and call is not None and any(item.keyword == name for item in call.items):
        meaning = class_arguments(call.function).get(name)
        text = f"`{name}`: {meaning}" if meaning else None
    if text is None:
        value = launch.paths.value_of(Item(launch.python.root, start, parts=[Name(name, start)]))
        text = explain_file(Path(value.text)) if value is not None and value.is_path else None
    return Explanation(text, start, start + len(name)) if text else None


def _define(document: Document, offset: int) -> Iterator[Target]:
    launch = PythonLaunchText(document)
    meaning = launch.meaning_at(offset)
    if meaning is None:
        return
    value = meaning.text.value
    if meaning.kind == "package":
        yield from target_of_package(document, value)
    elif meaning.kind == "program":
        yield from target_of_program(document, meaning.package, value)
    elif meaning.kind == "component":
        yield from target_of_component(document, meaning.package, value)
    elif meaning.kind == "topic":
        yield from find_topic_targets(document, meaning.programs, value)
    elif meaning.kind in ("configuration", "argument"):
        for argument in meaning.arguments:
            if argument.name == value:
                yield Target(argument.file, argument.start, argument.end)
    else:
        path = launch.path_through(meaning, meaning.text.end)
        yield from target_of_file(None if path is None else launch.find_file(path))


def _links(document: Document) -> Iterator[FileReference]:
    launch = PythonLaunchText(document)
    for text, item in launch.python.strings:
        if text.value and item.parts[-1] is text and not _is_continued(item):
            base = launch.paths.path_before(text, item)
            if base is not None and base.is_path:
                file = launch.find_file(base.text.rstrip("/") + "/" + text.value.lstrip("/"))
                if file is not None and file.is_file():
                    yield FileReference(text.start, text.end, Path(find_source(str(file))))


def _is_continued(item: Item) -> bool:
    """Return whether an item is a component of a joined path other than the last one."""
    return item.group.function in JOINS and item is not item.group.items[-1]


# --- symbols --------------------------------------------------------------------------------------------------


def _symbols(document: Document) -> Iterator[Symbol]:
    launch = PythonLaunchText(document)
    for argument in launch.arguments:
        yield Symbol(
            f"arg {argument.name}", SymbolKind.ARGUMENT, argument.start, argument.end, detail=argument.default or ""
        )
    for call in launch.python.calls_of(*_ACTIONS):
        is_include = call.function == "IncludeLaunchDescription"
        kind = SymbolKind.FILE if is_include else SymbolKind.NODE
        detail = launch.paths.text_of(call.argument("package")) or ""
        yield Symbol(
            _make_label(launch, call), kind, call.start - len(call.callee), max(call.end, call.start), (), detail
        )


def _make_label(launch: PythonLaunchText, call: Group) -> str:
    if call.function == "IncludeLaunchDescription":
        file = launch.find_included_file(call)
        return f"include {file.name}" if file is not None else "include"
    names = (launch.paths.text_of(call.argument(key)) for key in ("name", "executable", "plugin"))
    return f"{call.function} {next(filter(None, names), '')}".strip()


LAUNCH_PYTHON = Format(is_python_launch_file, _complete, _explain, _define, _links, _symbols, prepare=load_classes)
"""The format of launch files in Python."""
