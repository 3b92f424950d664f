"""Completion, hover and definitions for attribute values in XML and YAML launch files."""

from __future__ import annotations

import re
from collections.abc import Iterable, Iterator, Mapping
from dataclasses import dataclass, field, replace
from functools import cached_property
from pathlib import Path

from linkwright.language.completion import Completion, ItemKind
from linkwright.language.definitions import NameKind, definitions_in
from linkwright.language.format import Document, Target
from linkwright.language.grammar import rule_at
from linkwright.language.hover import Explanation
from linkwright.language.launch_arguments import LaunchArgument, arguments_in, list_likely_values
from linkwright.language.launch_schema import LAUNCH, choices_of
from linkwright.language.launch_text import (
    evaluate,
    find_open_substitution,
    find_typed_word,
    path_words,
    substitution_around,
    substitution_names,
)
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
from linkwright.language.source_parameters import parameters_in_sources
from linkwright.packages.share_layout import find_source
from linkwright.schema import describe_attribute

_PACKAGE_COMMANDS = frozenset({"find-pkg-share", "find-pkg-prefix", "find"})
_VARIABLE_COMMANDS = frozenset({"var", "arg"})
_USE = re.compile(r"\$\((?:var|arg)\s+([\w./-]+)")
_PATH_ATTRIBUTES = frozenset({"file", "from", "filename", "world_sdf_file", "config_file", "new_log_dir", "cwd"})
_ARGUMENT_TAGS = frozenset({"arg", "let"})
_WITH_VARIABLES = frozenset({"value", "default", "args", "cmd", "if", "unless", "namespace", "ros_args"})
_DESCRIPTION_SUFFIXES = (".xacro", ".urdf", ".sdf")
_BEGINNINGS = ("$(find-pkg-share ", "$(dirname)/")


@dataclass(frozen=True, slots=True)
class LaunchValue:
    """An attribute value in a launch file, with its element.

    Attributes:
        tags: the names of the enclosing elements, from the root to the element of the value.
        name: the name of the attribute.
        text: the whole value.
        start: the offset of the value.
        offset: the offset of the cursor.
        attributes: the attributes of the element.
        parent_attributes: the attributes of the parent element.
        sibling_names: the names of the other children of the parent or, for remappings, the names that they replace.
    """

    tags: tuple[str, ...]
    name: str
    text: str
    start: int
    offset: int
    attributes: Mapping[str, str]
    parent_attributes: Mapping[str, str]
    sibling_names: frozenset[str] = frozenset()

    @property
    def typed(self) -> str:
        """The part of the value before the cursor."""
        return self.text[: max(0, self.offset - self.start)]

    @property
    def is_included(self) -> bool:
        """Whether the element is an argument for an included file."""
        return self.tags[-1] in _ARGUMENT_TAGS and "include" in self.tags[:-1]


@dataclass
class LaunchText:
    """A launch file in XML or YAML, with the arguments that it declares."""

    document: Document
    offered: set[str] = field(default_factory=set)

    @cached_property
    def arguments(self) -> list[LaunchArgument]:
        """The arguments and launch configurations that the file declares."""
        return arguments_in(self.document.text, self.document.file)

    @cached_property
    def configurations(self) -> Mapping[str, str | None]:
        """The default of each declared argument by name, for ``$(var NAME)``, or None."""
        return {argument.name: argument.default for argument in self.arguments}

    def undeclared_names(self, excluded_offset: int) -> list[str]:
        """Return the names in ``$(var NAME)`` that are not declared, except at an offset."""
        uses = (use for use in _USE.finditer(self.document.text) if use.start(1) != excluded_offset)
        return [name for name in dict.fromkeys(use[1] for use in uses) if name not in self.configurations]

    def path_of(self, path_text: str) -> Path | None:
        """Resolve a path in the launch file, or return None if it is empty or unknown."""
        text = evaluate(path_text, self.document.file, self.document.finder, self.configurations)
        return None if not text or "\0" in text else self.document.file.parent / text

    def included_arguments(self, value: LaunchValue) -> list[LaunchArgument]:
        """Return the arguments of the launch file that is included around a value."""
        path_text = value.parent_attributes.get("file", "")
        path = self.path_of(path_text) if path_text else None
        if path is None or not path.is_file():
            return []
        path = Path(find_source(str(path)))
        arguments = arguments_in(self.document.other(path), path)
        return [argument for argument in arguments if argument.is_argument]

    def package_of(self, value: LaunchValue) -> str | None:
        """Return the package in the element of a value, or None if it has none or it is unknown."""
        package_text = value.attributes.get("pkg", "")
        return (
            evaluate(package_text, self.document.file, self.document.finder, self.configurations)
            if package_text
            else None
        )

    def program_of(self, value: LaunchValue) -> NodeProgram:
        """Return the program of the node around a value."""
        package = value.parent_attributes.get("pkg", "")
        package_name = (
            evaluate(package, self.document.file, self.document.finder, self.configurations) if package else ""
        )
        return NodeProgram(package_name or "", value.parent_attributes.get("exec", ""))


# --- completion -----------------------------------------------------------------------------------------------


def complete_value(launch: LaunchText, value: LaunchValue) -> Iterator[Completion]:
    """Yield the completions in a value of a launch file."""
    substitution = find_open_substitution(value.typed)
    if substitution is None:
        yield from _offer_plain_values(launch, value)
        return
    start = value.offset - len(substitution.typed)
    if not substitution.arguments:
        for name, purpose in substitution_names().items():
            yield Completion(name, ItemKind.FUNCTION, start, purpose)
    elif substitution.command in _PACKAGE_COMMANDS:
        yield from offer_packages(launch.document, start)
    elif substitution.command in _VARIABLE_COMMANDS and len(substitution.arguments) == 1:
        yield from _offer_arguments(launch.arguments, start)
        for name in launch.undeclared_names(start):
            yield Completion(name, ItemKind.NAME, start)
    elif substitution.command == "exec-in-pkg" and len(substitution.arguments) > 1:
        yield from offer_packages(launch.document, start)
    elif substitution.command == "command":
        yield from _offer_command(launch, value)
    elif substitution.command == "find-exec":
        yield from offer_values(("xacro", "python3", "ros2"), start)


def _offer_command(launch: LaunchText, value: LaunchValue) -> Iterator[Completion]:
    """Yield the paths in a command, and the arguments of a description in it."""
    command = value.typed.rpartition("$(command")[2].strip()
    words = [command[start:end] for start, end in path_words(command)]
    word = find_typed_word(value.typed)
    for name in (
        other_word for other_word in words if other_word != word and other_word.endswith(_DESCRIPTION_SUFFIXES)
    ):
        path = launch.path_of(name)
        if path is not None and path.is_file() and ":=" not in word:
            path = Path(find_source(str(path)))
            for definition in definitions_in(launch.document.other(path), path):
                label = f"{definition.name}:="
                is_given = any(other_word.startswith(label) for other_word in words)
                if definition.kind is NameKind.ARGUMENT and not is_given:
                    yield Completion(label, ItemKind.NAME, value.offset - len(word), definition.detail, path.name)
    if "/" in word:
        yield from _offer_path(launch, word, value.offset, launch_files=False)


def _offer_arguments(arguments: Iterable[LaunchArgument], start: int) -> Iterator[Completion]:
    for argument in arguments:
        detail = "" if argument.default is None else argument.default
        yield Completion(argument.name, ItemKind.NAME, start, detail, argument.describe())


def _offer_plain_values(launch: LaunchText, value: LaunchValue) -> Iterator[Completion]:
    document, offset, name, start = launch.document, value.offset, value.name, value.start
    rule = rule_at(LAUNCH, value.tags)
    attribute = None if rule is None else rule.attribute_rules.get(name)
    if value.tags[-1] == "remap":
        yield from _offer_remapped_names(launch, value)
        return
    if name == "pkg":
        yield from offer_packages(document, start)
    elif name == "exec":
        yield from offer_programs(document, launch.package_of(value), start)
    elif name == "plugin":
        yield from offer_components(document, launch.package_of(value), start)
    elif value.is_included and name == "name":
        arguments = launch.included_arguments(value) or launch.arguments
        yield from _offer_arguments(
            (argument for argument in arguments if argument.name not in value.sibling_names), start
        )
    elif name in ("if", "unless"):
        yield from _offer_variables(launch, start, [argument for argument in launch.arguments if argument.is_condition])
        yield from offer_values(("true", "false"), start)
    elif attribute is not None and choices_of(attribute):
        yield from offer_values(choices_of(attribute), start)
    elif name in ("value", "default"):
        if value.is_included:
            yield from _offer_variables(
                launch, start, _find_arguments(launch.arguments, value.attributes.get("name", ""))
            )
        yield from offer_values(_list_choices(launch, value), start)
    elif value.tags[-1] in ("param", "set_parameter") and name == "name":
        yield from _offer_parameters(launch, value)
    yield from _offer_texts(launch, value, offset)


def _offer_texts(launch: LaunchText, value: LaunchValue, offset: int) -> Iterator[Completion]:
    """Yield the paths that complete the word before the cursor, and ``$(var NAME)``."""
    word, name = find_typed_word(value.typed), value.name
    if name in _PATH_ATTRIBUTES:
        yield from offer_values((begin for begin in _BEGINNINGS if begin.startswith(word)), offset - len(word))
    if "/" in word or name in _PATH_ATTRIBUTES:
        yield from _offer_path(launch, word, offset, launch_files=value.tags[-1] == "include")
    if (name in _PATH_ATTRIBUTES or name in _WITH_VARIABLES) and (not word or word.startswith("$")):
        yield from _offer_variables(launch, offset - len(word), launch.arguments)


def _offer_variables(launch: LaunchText, start: int, arguments: Iterable[LaunchArgument]) -> Iterator[Completion]:
    """Yield ``$(var NAME)`` for the arguments that were not offered before."""
    for argument in arguments:
        if argument.name not in launch.offered:
            launch.offered.add(argument.name)
            yield Completion(f"$(var {argument.name})", ItemKind.NAME, start, argument.default or "")


def _offer_remapped_names(launch: LaunchText, value: LaunchValue) -> Iterator[Completion]:
    """Yield the names for a remapping: topics of the node, or other forms of the old name."""
    if value.name == "from":
        programs = [launch.program_of(value)]
        yield from offer_topics(launch.document, programs, value.typed, value.start, value.sibling_names)
        return
    name = plain_name(value.attributes.get("from", ""))
    for label in dict.fromkeys((name, f"/{name}", name.rpartition("/")[2])) if name else ():
        if label != value.attributes.get("from"):
            yield Completion(label, ItemKind.NAME, value.start)


def _list_known_parameters(launch: LaunchText, value: LaunchValue) -> tuple[ParameterInfo, ...]:
    """Return the known parameters of the node around a value."""
    program = launch.program_of(value)
    names = (node_name(*program), program.executable, value.parent_attributes.get("name", ""))
    program_parameters = next((parameters for name in names if (parameters := node_parameters(name))), ())
    return program_parameters or parameters_in_sources(launch.document, program)


def _offer_parameters(launch: LaunchText, value: LaunchValue) -> Iterator[Completion]:
    """Yield completions of the parameters of the node around a value."""
    known_parameters = _list_known_parameters(launch, value)
    for parameter in known_parameters:
        if parameter.name not in value.sibling_names and "*" not in parameter.name:
            detail = f"{parameter.type} {parameter.default_text}".strip()
            yield Completion(parameter.name, ItemKind.NAME, value.start, detail, parameter.description)
    if not any(parameter.name == "use_sim_time" for parameter in known_parameters):
        yield Completion("use_sim_time", ItemKind.NAME, value.start, "bool false")


def _list_choices(launch: LaunchText, value: LaunchValue) -> tuple[str, ...]:
    """Return the likely values of an argument: its choices, or both values of a condition."""
    name = value.attributes.get("name", "")
    if not value.is_included:
        return (
            list_likely_values(None, name, launch.document.text)
            if value.name == "default"
            else _list_boolean_choices(name)
        )
    argument = next((candidate for candidate in launch.included_arguments(value) if candidate.name == name), None)
    return () if argument is None else list_likely_values(argument, name, launch.document.text)


def _list_boolean_choices(name: str) -> tuple[str, ...]:
    return ("true", "false") if name.startswith(("use_", "enable", "is_", "publish_")) else ()


def _offer_path(launch: LaunchText, word: str, offset: int, *, launch_files: bool) -> Iterator[Completion]:
    folder, slash, name = word.rpartition("/")
    if slash and not folder:
        return
    base = launch.path_of(folder) if folder else launch.document.file.parent
    if base is not None:
        yield from offer_files(base, name, offset, launch_files=launch_files)


# --- hover and definition -------------------------------------------------------------------------------------


@dataclass(frozen=True, slots=True)
class _ValueMeaning:
    """The object that a position in a launch file refers to.

    Attributes:
        kind: "package", "program", "component", "argument", "file", "topic" or "substitution".
        name: the name or path.
        start: the offset of the name.
        end: the offset after the name.
        package: the package of a program or component.
        arguments: the launch arguments with this name.
        program: the program of the node that has a topic.
    """

    kind: str
    name: str
    start: int
    end: int
    package: str | None = None
    arguments: tuple[LaunchArgument, ...] = ()
    program: NodeProgram | None = None


def _meaning_at(launch: LaunchText, value: LaunchValue) -> _ValueMeaning | None:
    substitution = substitution_around(value.text, value.offset - value.start)
    meaning = (
        None if substitution is None else _meaning_in_substitution(launch, substitution, value.offset - value.start)
    )
    if meaning is not None:
        return replace(meaning, start=value.start + meaning.start, end=value.start + meaning.end)
    return _meaning_of_attribute(launch, value)


def _meaning_in_substitution(launch: LaunchText, match: re.Match[str], offset: int) -> _ValueMeaning | None:
    command, arguments = match[1], (match[2] or "").strip("'\" ")
    if offset <= match.end(1):
        return _ValueMeaning("substitution", command, *match.span(1)) if command in substitution_names() else None
    name = arguments.partition(" ")[0]
    start = match.start(2) + (match[2] or "").find(name) if match[2] else match.end(1)
    name_range = start, start + len(name)
    if command in _PACKAGE_COMMANDS:
        return _ValueMeaning("package", name, *name_range)
    if command in _VARIABLE_COMMANDS:
        return _ValueMeaning("argument", name, *name_range, arguments=_find_arguments(launch.arguments, name))
    if command == "exec-in-pkg" and " " in arguments:
        return _ValueMeaning("program", name, *name_range, package=arguments.split()[-1])
    return None


def _find_arguments(arguments: Iterable[LaunchArgument], name: str) -> tuple[LaunchArgument, ...]:
    return tuple(argument for argument in arguments if argument.name == name)


def _meaning_of_attribute(launch: LaunchText, value: LaunchValue) -> _ValueMeaning | None:
    name, begin = value.name, value.start
    whole_range = begin, begin + len(value.text)
    if value.tags[-1] == "remap" and name in ("from", "to"):
        return _ValueMeaning("topic", value.attributes.get("from", ""), *whole_range, program=launch.program_of(value))
    kinds = {"pkg": "package", "exec": "program", "plugin": "component"}
    if name in kinds:
        return _ValueMeaning(kinds[name], value.text, *whole_range, package=launch.package_of(value))
    if name == "name" and value.tags[-1] in _ARGUMENT_TAGS:
        arguments = launch.included_arguments(value) if value.is_included else launch.arguments
        return _ValueMeaning("argument", value.text, *whole_range, arguments=_find_arguments(arguments, value.text))
    for start, end in path_words(value.text):
        word = value.text[start:end]
        if begin + start <= value.offset <= begin + end and ("/" in word or name in _PATH_ATTRIBUTES):
            path = launch.path_of(word)
            if path is not None and (path.exists() or name in _PATH_ATTRIBUTES):
                return _ValueMeaning("file", str(path), begin + start, begin + end)
    return None


def explain_value(launch: LaunchText, value: LaunchValue) -> Explanation | None:
    """Explain the object at the cursor in a value, or else the attribute, or return None."""
    meaning = _meaning_at(launch, value)
    text = None if meaning is None else _explain_meaning(launch.document, meaning)
    if meaning is not None and text:
        return Explanation(text, meaning.start, meaning.end)
    end = value.start + len(value.text)
    if value.tags[-1] in ("param", "set_parameter") and value.name in ("name", "value"):
        known_parameters = _list_known_parameters(launch, value)
        parameter = next(
            (candidate for candidate in known_parameters if candidate.matches(value.attributes.get("name", ""))), None
        )
        if parameter is not None:
            default = f" = `{parameter.default_text}`" if parameter.default_text else ""
            head = f"**{parameter.name}**: {parameter.type}{default}"
            return Explanation(f"{head}\n\n{parameter.description}".strip(), value.start, end)
    rule = rule_at(LAUNCH, value.tags)
    attribute = None if rule is None else rule.attribute_rules.get(value.name)
    return None if attribute is None else Explanation(describe_attribute(attribute), value.start, end)


def _explain_meaning(document: Document, meaning: _ValueMeaning) -> str | None:
    if meaning.kind == "package":
        return explain_package(document, meaning.name)
    if meaning.kind == "program":
        return explain_program(document, meaning.package, meaning.name)
    if meaning.kind == "argument":
        return "\n\n".join(argument.describe() for argument in meaning.arguments)
    if meaning.kind == "file":
        return explain_file(Path(meaning.name))
    if meaning.kind == "topic" and meaning.program is not None:
        return explain_topic(document, [meaning.program], meaning.name)
    if meaning.kind == "substitution":
        return f"**$({meaning.name} ...)**: {substitution_names()[meaning.name]}"
    return None


def define_value(launch: LaunchText, value: LaunchValue) -> Iterator[Target]:
    """Yield the definitions of the object at the cursor in a value."""
    document, meaning = launch.document, _meaning_at(launch, value)
    if meaning is None:
        return
    if meaning.kind == "package":
        yield from target_of_package(document, meaning.name)
    elif meaning.kind == "program":
        yield from target_of_program(document, meaning.package, meaning.name)
    elif meaning.kind == "component":
        yield from target_of_component(document, meaning.package, meaning.name)
    elif meaning.kind == "file":
        yield from target_of_file(Path(meaning.name))
    elif meaning.kind == "topic" and meaning.program is not None:
        yield from find_topic_targets(document, [meaning.program], meaning.name)
    for argument in meaning.arguments:
        yield Target(argument.file, argument.start, argument.end)


def links_in(launch: LaunchText, name: str, text: str, begin: int) -> Iterator[FileReference]:
    """Yield the references to files in a value.

    Args:
        launch: the launch file.
        name: the name of the attribute.
        text: the value.
        begin: the offset of the value.
    """
    for start, end in path_words(text):
        word = text[start:end]
        if "/" in word or name in _PATH_ATTRIBUTES:
            path = launch.path_of(word)
            if path is not None and path.is_file():
                yield FileReference(begin + start, begin + end, Path(find_source(str(path))))
