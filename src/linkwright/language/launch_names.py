"""The launch arguments and includes in launch files in XML, YAML and Python."""

from __future__ import annotations

import re
from collections.abc import Iterator
from dataclasses import dataclass, field
from pathlib import Path

from linkwright.language.format import Document
from linkwright.language.includes import real_path
from linkwright.language.launch_arguments import arguments_in
from linkwright.language.launch_python import CONFIGURATIONS, PythonLaunchText, is_python_launch_file
from linkwright.language.launch_values import LaunchText
from linkwright.language.launch_yaml import is_yaml_launch_file
from linkwright.language.python_text import Group, Item, Name, Text
from linkwright.language.yaml_outline import YamlEntry, YamlOutline
from linkwright.packages.share_layout import find_source
from linkwright.xmltree.tokens import Kind, tokens

_USE = re.compile(r"\$\(\s*(?:var|arg)\s+(['\"]?)([\w./-]+)\1(?=[\s)])|\barg\(\s*(['\"])([\w./-]+)\3\s*\)")
_DECLARING_CLASSES = ("DeclareLaunchArgument", "DeclareBooleanLaunchArgument")
_SETTING_CLASSES = ("SetLaunchConfiguration", "UnsetLaunchConfiguration")
_CONTEXT = "launch_configurations"
_MAX_TEXT_LENGTH = 300_000


@dataclass(frozen=True, slots=True, order=True)
class LaunchName:
    """An occurrence of the name of a launch argument or configuration.

    Attributes:
        file: the launch file that contains it.
        start: the offset of the name.
        name: the name as written.
        is_declared: whether the argument is declared or set here.
    """

    file: Path
    start: int
    name: str
    is_declared: bool = False

    @property
    def end(self) -> int:
        """The offset after the name."""
        return self.start + len(self.name)


@dataclass(slots=True)
class LaunchInclude:
    """An included launch file.

    Attributes:
        target: the file, or None if it is unknown.
        path_text: the path as written or, in Python, the last string of it.
        passed_names: the names of the arguments that are passed to it.
        is_known: whether `passed_names` is complete.
    """

    target: Path | None
    path_text: str
    passed_names: list[LaunchName] = field(default_factory=list)
    is_known: bool = True


@dataclass(slots=True)
class LaunchNames:
    """The launch arguments in a launch file.

    Attributes:
        names: the occurrences that declare, set or use a launch argument of the file.
        includes: the included files.
        texts: the other strings that may be the name of an argument.
    """

    names: list[LaunchName] = field(default_factory=list)
    includes: list[LaunchInclude] = field(default_factory=list)
    texts: list[LaunchName] = field(default_factory=list)


def is_launch_file(file: Path) -> bool:
    """Return whether a file is a launch file, by its name."""
    is_markup = file.name.endswith((".launch", ".launch.xml", "_launch.xml")) or is_yaml_launch_file(file)
    return is_markup or is_python_launch_file(file)


def find_launch_names(document: Document) -> LaunchNames:
    """Return the launch arguments in a launch file, whose text may be incomplete."""
    if len(document.text) > _MAX_TEXT_LENGTH:
        return LaunchNames()
    if document.file.name.endswith(".py"):
        return _names_in_python(document)
    if document.file.name.endswith((".yaml", ".yml")):
        return _names_in_yaml(document)
    return _names_in_xml(document)


def _resolve_target(path: Path | None) -> Path | None:
    return None if path is None or not path.is_file() else real_path(find_source(str(path)))


def _find_uses(text: str, start: int, file: Path) -> Iterator[LaunchName]:
    for match in _USE.finditer(text):
        group = 2 if match[2] else 4
        yield LaunchName(file, start + match.start(group), match[group])


# --- XML --------------------------------------------------------------------------------------------------------------


def _names_in_xml(document: Document) -> LaunchNames:
    names, launch, file = LaunchNames(), LaunchText(document), document.file
    includes: list[LaunchInclude | None] = []
    for token in tokens(document.text):
        if token.kind is Kind.END and includes:
            includes.pop()
        if token.kind is not Kind.START or not token.name:
            continue
        attributes = {attribute.name: attribute for attribute in token.attributes() if attribute.value}
        for attribute in attributes.values():
            names.names += _find_uses(attribute.value or "", attribute.value_start, file)
        outer_include = next((include for include in reversed(includes) if include is not None), None)
        name = attributes.get("name")
        if token.name in ("arg", "bool_arg", "let") and name is not None and name.value:
            name_use = LaunchName(file, name.value_start, name.value, is_declared=True)
            if "$" not in name.value:
                (names.names if outer_include is None else outer_include.passed_names).append(name_use)
        include = None
        if token.name == "include" and "file" in attributes:
            path_text = attributes["file"].value or ""
            include = LaunchInclude(_resolve_target(launch.path_of(path_text)), path_text)
            names.includes.append(include)
        if not token.is_empty_element:
            includes.append(include)
    return names


# --- YAML -------------------------------------------------------------------------------------------------------------


def _names_in_yaml(document: Document) -> LaunchNames:
    names, launch, file = LaunchNames(), LaunchText(document), document.file
    for entry in YamlOutline(document.text).root.all():
        if entry.value:
            names.names += _find_uses(entry.value, entry.value_start, file)
        if entry.key == "include" and entry.child("file") is not None:
            path_entry = entry.child("file")
            path = "" if path_entry is None else path_entry.scalar
            passed_names = [*_passed_names_in_yaml(entry, file)]
            names.includes.append(LaunchInclude(_resolve_target(launch.path_of(path)), path, passed_names))
        elif entry.key in ("arg", "let") and "include" not in entry.path[:-1]:
            names.names += _names_in_list(entry, file)
    return names


def _names_in_list(entry: YamlEntry, file: Path) -> Iterator[LaunchName]:
    name = entry.child("name")
    if name is not None and name.scalar and "$" not in name.scalar:
        start = name.value_start + (1 if name.value[:1] in ("'", '"') else 0)
        yield LaunchName(file, start, name.scalar, is_declared=True)


def _passed_names_in_yaml(include: YamlEntry, file: Path) -> Iterator[LaunchName]:
    for entry in include.all():
        if entry.is_item and entry.parent is not None and entry.parent.key in ("arg", "let"):
            yield from _names_in_list(entry, file)


# --- Python -----------------------------------------------------------------------------------------------------------


def _names_in_python(document: Document) -> LaunchNames:
    names, file = LaunchNames(), document.file
    launch = PythonLaunchText(document)
    python = launch.python
    names_by_offset: dict[int, LaunchName] = {}

    def add(text: Text | None, *, is_declared: bool = False) -> None:
        if text is not None and text.value and not text.is_format:
            names_by_offset.setdefault(text.start, LaunchName(file, text.start, text.value, is_declared))

    for argument in arguments_in(document.text, file):
        names_by_offset[argument.start] = LaunchName(file, argument.start, argument.name, is_declared=True)
    for call in python.calls:
        if call.function in _DECLARING_CLASSES:
            add(_find_first_text(call.argument("name", 0)), is_declared=True)
        elif call.function in CONFIGURATIONS:
            item = call.argument("variable_name", 0) or call.argument("launch_configuration_name", 0)
            add(_find_first_text(item))
        elif call.function in _SETTING_CLASSES:
            add(_find_first_text(call.argument("name", 0)), is_declared=True)
        elif call.function == "get" and call.callee.rpartition(".")[0].endswith(_CONTEXT):
            add(_find_first_text(call.argument("key", 0)))
    passed_starts: set[int] = set()
    for call in python.calls_of("IncludeLaunchDescription"):
        include = _read_include(launch, call, file)
        passed_starts.update(name.start for name in include.passed_names)
        names.includes.append(include)
    for text, item in python.strings:
        if text.start in names_by_offset or text.start in passed_starts or not text.value.isidentifier():
            continue
        if _is_subscript(item):
            add(text)
        else:
            names.texts.append(LaunchName(file, text.start, text.value))
    names.names = [*names_by_offset.values()]
    return names


def _find_first_text(item: Item | None) -> Text | None:
    only = item.parts[0] if item is not None and len(item.parts) == 1 else None
    return only if isinstance(only, Text) else None


def _is_subscript(item: Item) -> bool:
    """Return whether an item is the key in ``context.launch_configurations[...]``."""
    parent = item.group.parent
    if item.group.opening != "[" or parent is None:
        return False
    index = next((number for number, part in enumerate(parent.parts) if part is item.group), 0)
    previous_part = parent.parts[index - 1] if index else None
    return isinstance(previous_part, Name) and previous_part.value.endswith(_CONTEXT)


def _read_include(launch: PythonLaunchText, call: Group, file: Path) -> LaunchInclude:
    source = call.argument("launch_description_source", 0)
    words = [] if source is None else [*_find_texts(source)]
    include = LaunchInclude(_resolve_target(launch.find_included_file(call)), words[-1].value if words else "")
    arguments = call.argument("launch_arguments")
    if arguments is not None:
        include.is_known = False
        for part in arguments.parts:
            for group in _find_argument_groups(launch, part):
                is_dict = group.function == "dict" and bool(group.callee)
                if is_dict or not group.callee:
                    include.is_known = True
                    text = launch.document.text
                    include.passed_names += _read_keywords(group, text, file) if is_dict else _read_keys(group, file)
    return include


def _find_argument_groups(launch: PythonLaunchText, part: object) -> list[Group]:
    """Return the brackets with launch arguments in an expression, or in its variable."""
    name = part.value if isinstance(part, Name) else part.callee if isinstance(part, Group) else ""
    bound = launch.python.bindings.get(name.partition(".")[0].strip()) if name else None
    parts = [part] if bound is None else bound.parts
    return [group for group in parts if isinstance(group, Group) and not group.callee.startswith(".")]


def _read_keys(group: Group, file: Path) -> Iterator[LaunchName]:
    """Yield the keys of a dictionary or of a list of pairs."""
    for item in group.items:
        first = item.parts[0] if item.parts else None
        if isinstance(first, Group) and first.opening in ("(", "[") and not first.callee and first.items:
            first = first.items[0].parts[0] if first.items[0].parts else None
        if isinstance(first, Text) and not first.is_format:
            yield LaunchName(file, first.start, first.value, is_declared=True)


def _read_keywords(call: Group, text: str, file: Path) -> Iterator[LaunchName]:
    """Yield the names of the arguments in ``dict(name=value)``."""
    for item in call.items:
        if item.keyword:
            yield LaunchName(file, text.index(item.keyword, item.start), item.keyword, is_declared=True)


def _find_texts(item: Item) -> Iterator[Text]:
    for part in item.parts:
        if isinstance(part, Text):
            yield part
        elif isinstance(part, Group):
            for inner in part.items:
                yield from _find_texts(inner)
