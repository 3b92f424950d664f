"""Define the outline of a launch file: its actions with their settings."""

from __future__ import annotations

import re
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, replace
from functools import cached_property
from pathlib import Path

from linkwright.diagnostics import Span
from linkwright.review.launches.chosen_texts import resolve_choices
from linkwright.review.launches.conditions import evaluate_condition, split_condition
from linkwright.review.launches.evaluations import replace_names_in_evaluations

TEST = "test"
"""The kind of the nodes of ROS 1 that test others."""
PROGRAM_KINDS = ("node", TEST)
"""The kinds of actions that start a program of a package."""
CONDITION = "condition"
NAMESPACE = "namespace"
NAMESPACE_OF_INCLUDED = "namespace of its nodes"
PASSES_ALL_ARGUMENTS = "pass_all_args"
"""The attribute of an include in ROS 1 that passes all arguments of the file."""
"""The setting of an include that is not a passed argument."""
REMAPPING = "remapping "
"""The prefix of the settings that are remappings of a node, before the remapped name."""
ENVIRONMENT = "environment variable "
ENVIRONMENT_KIND = "environment"
"""The kind of an action or statement that sets an environment variable for all nodes that follow."""
NAMES_AS_REMAPPINGS = "names instead of pairs in remappings"
"""The setting with the items of ``remappings`` in Python that are texts, for which the launch file fails."""
MISSING_ARGUMENT = "missing argument"
"""The setting with the required argument of a class in Python that a call lacks, for which the launch file fails."""
UNKNOWN_ARGUMENT = "unknown argument"
"""The setting with the argument of a call that a class in Python does not have, for which the launch file fails."""
FAILURES = (NAMES_AS_REMAPPINGS, MISSING_ARGUMENT, UNKNOWN_ARGUMENT)
"""The settings for which the launch file fails."""
LOG_MESSAGE = "log message"
"""The kind of an action that only writes a text to the log."""
READING = "reading"
"""The kind of an entry for an environment variable that the file reads."""
BUILDER = "builder"
"""The kind of an entry for an object that a chain of calls makes and that actions use."""
IGNORED_TAG = "ignored tag"
"""The kind of entries for tags of ROS 1 that roslaunch ignores, because their parent has no such children."""
DELETION = "deletion"
"""The kind of an action that deletes parameters of ROS 1."""
SERVER_PARAMETER = "server parameter"
"""The kind of a parameter of ROS 1 that does not belong to a node of the file."""
PARAMETER = "parameter "
"""The prefix of the settings that are parameters of a node, before the name of the parameter."""
ALLOW_SUBSTITUTIONS = "allow_substs"
"""The argument and attribute of a parameter file that lets it contain substitutions."""
_VARIABLE = re.compile(r"\$\((?:var|arg) (?P<name>[^() ]+)(?: (?P<default>[^()]*))?\)")
_ENVIRONMENT_SUBSTITUTION = re.compile(r"\$\((?:(?:opt)?env [^() ]+ (?P<default>[^()]*)|optenv [^() ]+)\)")
"""An environment variable with a default."""
_QUOTED_TEXT = re.compile(r"(?P<quote>['\"])(?P<text>[^'\"]*)(?P=quote)")
_SPLIT_TEXT = re.compile(r"(?P<text>[^$()]*)\.split\((?P<separator>[^$()]*)\)")
"""A call in Python that splits a known text."""
_SETTING_CONDITION = re.compile(r" \((?P<condition>(?:if|unless) .*)\)")
"""The condition of a setting after its name."""
_TEST = re.compile(r"`(?P<source>[^`]*)`")
"""The test of an ``if`` statement in a condition."""
_NAMESPACE_SEPARATOR = "\n"
"""The separator of pushed namespaces, which are joined when the defaults of arguments are known."""
_MAX_VARIABLE_DEPTH = 5
"""The maximum depth of variables in the values of variables."""
_MAX_CHARACTERS = 10_000
NODE_CLASSES = ("Node", "LifecycleNode", "ComposableNode", "ComposableNodeContainer")
"""The classes of Python launch files that make nodes."""


@dataclass(frozen=True)
class Entry:
    """An action of a launch file.

    Attributes:
        kind: ``argument``, ``variable``, ``node``, ``process``, ``include``; ``remapping``, ``parameter``,
            ``parameters`` or ``environment`` of all nodes that follow; ``server parameter`` of ROS 1; ``reading`` of an
            environment variable; ``handler`` of an event; ``builder`` of an object that actions use; ``action`` of a
            foreign package.
        name: the name of the argument or variable, ``package/executable`` of the node, the command, the path of the
            file, or the function that makes the action.
        settings: the values, by name. The value of an argument is its default.
        span: the location of the action.
        namespaces: the namespaces of the groups around a parameter, the outermost first; not among its settings.
        remappings: the names that the groups around an action of XML or YAML remap before it, with their new names.
        groups: the lines of the groups around it in ROS 2 that restore arguments at their end, the outermost first.
    """

    kind: str
    name: str
    settings: dict[str, str]
    span: Span
    namespaces: tuple[str, ...] = ()
    remappings: tuple[tuple[str, str], ...] = ()
    groups: tuple[int, ...] = field(default=(), compare=False)

    @property
    def has_value(self) -> bool:
        """Whether it declares an argument or sets a variable."""
        return self.kind in ("argument", "variable")

    @property
    def is_unknown_node(self) -> bool:
        """Whether it is a node of a Python launch file whose program is unknown, such as ``Node(**settings)``."""
        is_class = self.kind == "node" and self.name.rpartition(".")[2] in NODE_CLASSES
        return is_class and MISSING_ARGUMENT not in self.settings

    def is_identity_remapping(self, setting: str, old: str | None, new: str | None) -> bool:
        """Return whether a changed setting only adds or removes a remapping of a name to itself."""
        if self.kind in PROGRAM_KINDS and setting.startswith(REMAPPING):
            source = without_condition(setting).removeprefix(REMAPPING)
        elif self.kind == "remapping" and setting == "to":
            source = self.name
        else:
            return False
        return (old or source) == (new or source)


def with_condition(setting: str, condition: str) -> str:
    """Return the name of a conditional setting, such as one of two remappings of a name."""
    return f"{setting} ({condition})" if condition else setting


def without_condition(setting: str) -> str:
    """Return the name of a setting without its condition."""
    return _SETTING_CONDITION.sub("", setting)


def extract_condition(setting: str) -> str:
    """Return the condition of a setting; empty if there is none."""
    match = _SETTING_CONDITION.search(setting)
    return "" if match is None else match["condition"]


def split_text(text: str) -> str:
    """Return the list into which a call of ``split`` splits a known text, and any other text unchanged."""
    match = _SPLIT_TEXT.fullmatch(text)
    return text if match is None else f"[{', '.join(match['text'].split(match['separator'] or None))}]"


@dataclass(frozen=True)
class FailingTest:
    """A test of an ``if`` statement under which a launch file fails.

    Attributes:
        text: the test as it is written.
        subject: the expression that must have one of a few values; empty for other tests.
        accepted: these values.
        arguments: the arguments of the launch file whose values are tested.
        is_known: whether the values with which the function around it is called are known, and may fail.
    """

    text: str
    subject: str = ""
    accepted: frozenset[str] = frozenset()
    arguments: frozenset[str] = frozenset()
    is_known: bool = True


def imply(tests: Sequence[FailingTest], other: FailingTest) -> bool:
    """Return whether a test holds when several tests hold."""
    accepted = frozenset[str]().union(*(test.accepted for test in tests if test.subject == other.subject))
    is_narrower = bool(other.subject) and bool(other.accepted) and other.accepted <= accepted
    return is_narrower or any(test.text == other.text for test in tests)


@dataclass(frozen=True)
class CodePart:
    """A statement or element of a launch file that makes no action.

    Attributes:
        text: a comparable form without names of variables, comments and layout.
        source: the statement as it is written.
        span: the location of the action.
        failing_tests: the tests of the ``if`` statements around a statement that ends the launch with an error, the
            outermost first; empty for other statements.
        scopes: the qualified names of the functions and classes around the statement, the outermost first.
        condition: the test of the innermost ``if`` around the statement; empty if there is none.
    """

    text: str
    source: str
    span: Span
    failing_tests: tuple[FailingTest, ...] = ()
    scopes: tuple[str, ...] = ()
    condition: str = ""


@dataclass(frozen=True)
class LaunchOutline:
    """The outline of a launch file.

    Attributes:
        entries: the entries in the order of the text.
        code: the code besides the actions.
        definitions: the statements that assign a name. Its value is compared where the name is used.
        scope_sources: the source of each function and class, by qualified name.
        is_ros1: whether it is a launch file of ROS 1.
        root: the folder of the repository; None if it is unknown.
        has_unknown_actions: whether the file has imported actions whose values are unknown.
        tests: the tests of ``if`` statements as expressions of arguments of the file, by their source.
    """

    entries: list[Entry]
    code: list[CodePart]
    definitions: list[CodePart] = field(default_factory=list)
    scope_sources: Mapping[str, str] = field(default_factory=dict)
    is_ros1: bool = False
    root: Path | None = None
    has_unknown_actions: bool = False
    tests: Mapping[str, str] = field(default_factory=dict)

    def resolve(self, text: str) -> str:
        """Return a text with values in place of ``$(var NAME)``.

        The values are the defaults of arguments and environment variables. The tests of a Python file are expressions
        of these values. In ``$(eval ...)`` of ROS 1, names are replaced, too.
        """
        text = _TEST.sub(lambda match: self.tests.get(match["source"], match[0]), text)
        resolved = split_text(self._replace_variables(text))
        if self.is_ros1:
            resolved = replace_names_in_evaluations(resolved, self._find_value)
        return resolve_choices(resolved)

    def _replace_variables(self, text: str) -> str:
        for _ in range(_MAX_VARIABLE_DEPTH):
            resolved = _ENVIRONMENT_SUBSTITUTION.sub(_find_default, _VARIABLE.sub(self._replace_variable, text))
            if resolved == text or len(resolved) > _MAX_CHARACTERS:
                break
            text = resolved
        return text

    def _find_value(self, name: str) -> str | None:
        """Return the default or value of a name, or None if it is unknown."""
        value = self.values.get(name)
        return None if value is None else self._replace_variables(value)

    def with_defaults(self, values: Mapping[str, str]) -> LaunchOutline:
        """Return the outline with passed values in place of the defaults of arguments."""
        entries = [
            replace(entry, settings={**entry.settings, "default": values[entry.name]})
            if entry.kind == "argument" and "value" not in entry.settings and entry.name in values
            else entry
            for entry in self.entries
        ]
        return replace(self, entries=entries)

    def _replace_variable(self, variable: re.Match[str]) -> str:
        value = self.values.get(variable["name"], variable["default"])
        return variable[0] if value is None else value

    @cached_property
    def values(self) -> dict[str, str]:
        """The defaults and values of arguments and variables by name, if each is unique.

        If several conditional actions set a name, it has the value of the only action whose condition can hold.
        """
        values: dict[str, list[Entry]] = {}
        for entry in self.entries:
            if entry.has_value and not {"value", "default"}.isdisjoint(entry.settings):
                values.setdefault(entry.name, []).append(entry)
        result = {name: value for name, entries in values.items() if (value := _find_only_value(entries)) is not None}
        ambiguous = {name: entries for name, entries in values.items() if name not in result}
        known_outline = (
            replace(self, entries=[entry for name in result for entry in values[name][:1]]) if ambiguous else self
        )
        for name, entries in ambiguous.items():
            possible = [entry for entry in entries if _evaluate_entry_condition(entry, known_outline) is not False]
            value = (
                _find_only_value(possible)
                if all(_evaluate_entry_condition(entry, known_outline) for entry in possible)
                else None
            )
            if value is not None:
                result[name] = value
        return result


def find_own_default(name: str, text: str) -> str:
    """Return the default of an argument; that of ``$(var NAME DEFAULT)`` if it is its own value, as Python allows."""
    variable = _VARIABLE.fullmatch(text)
    is_own = variable is not None and variable["name"] == name
    return text if variable is None or not is_own else variable["default"] or ""


def _find_default(variable: re.Match[str]) -> str:
    """Return the default of an environment variable, without the quotes around a text."""
    default = (variable["default"] or "").strip()
    return _QUOTED_TEXT.sub(r"\g<text>", default)


def _find_only_value(entries: Sequence[Entry]) -> str | None:
    """Return the value of actions that set a name, or None if there are several."""
    values = {entry.settings.get("value", entry.settings.get("default")) for entry in entries}
    return next(iter(values)) if len(values) == 1 else None


def _evaluate_entry_condition(entry: Entry, outline: LaunchOutline) -> bool | None:
    return evaluate_condition(outline.resolve(entry.settings.get(CONDITION, "")))


@dataclass(frozen=True)
class Scope:
    """The settings that enclosing groups give to an action.

    Attributes:
        conditions: the conditions of the groups, the outermost first.
        namespaces: the namespaces that they push.
        remappings: the remappings that they set, each with the old and the new name.
        groups: the lines of the groups that restore arguments at their end.
    """

    conditions: tuple[str, ...] = ()
    namespaces: tuple[str, ...] = ()
    remappings: tuple[tuple[str, str], ...] = ()
    groups: tuple[int, ...] = ()

    @property
    def depth(self) -> int:
        """The number of settings and groups."""
        return len(self.conditions) + len(self.namespaces) + len(self.groups)

    def with_condition(self, condition: str) -> Scope:
        """Return the scope of the actions inside an action with a condition, which may be empty."""
        return replace(self, conditions=(*self.conditions, condition)) if condition else self

    def with_namespace(self, namespace: str) -> Scope:
        """Return the scope after a namespace is pushed."""
        return replace(self, namespaces=(*self.namespaces, namespace)) if namespace else self

    def with_group(self, line: int) -> Scope:
        """Return the scope of the actions in a group that restores arguments at its end."""
        return replace(self, groups=(*self.groups, line))

    def with_remapping(self, entry: Entry) -> Scope:
        """Return the scope after an action that remaps a name."""
        return replace(self, remappings=(*self.remappings, (entry.name, entry.settings.get("to", ""))))

    def add_to_settings(self, kind: str, own_settings: Mapping[str, str]) -> dict[str, str]:
        """Return the settings of an action together with the settings of its scope."""
        settings = dict(own_settings)
        conditions = [*self.conditions, *filter(None, [own_settings.get(CONDITION)])]
        settings.pop(CONDITION, None)
        if conditions:
            settings[CONDITION] = " and ".join(dict.fromkeys(conditions))
        key = NAMESPACE if kind in PROGRAM_KINDS else NAMESPACE_OF_INCLUDED
        if self.namespaces and kind in (*PROGRAM_KINDS, "include"):
            settings[key] = _NAMESPACE_SEPARATOR.join([*self.namespaces, *filter(None, [own_settings.get(key)])])
        return settings


def join_namespaces(outline: LaunchOutline) -> LaunchOutline:
    """Return an outline with one namespace for each action.

    It joins the namespaces that groups push.
    """
    entries = [
        replace(entry, settings={name: _join_namespace(name, text, outline) for name, text in entry.settings.items()})
        for entry in outline.entries
    ]
    return replace(outline, entries=entries)


def _join_namespace(setting: str, text: str, outline: LaunchOutline) -> str:
    """Return the namespace after all pushes.

    A name whose default begins with ``/`` replaces the previous ones.
    """
    if setting not in (NAMESPACE, NAMESPACE_OF_INCLUDED):
        return text
    joined = ""
    for name in text.split(_NAMESPACE_SEPARATOR):
        joined = name if not joined or outline.resolve(name).startswith("/") else f"{joined}/{name}"
    return joined


def merge_branches(entries: Sequence[Entry]) -> list[Entry]:
    """Return the actions of a Python file, with equal actions of both branches of a test as one without the test."""
    merged: list[Entry] = []
    for entry in entries:
        terms = split_condition(entry.settings.get(CONDITION, ""))
        for index, other in enumerate(merged):
            if (entry.kind, entry.name) != (other.kind, other.name) or not _are_equal_except_condition(entry, other):
                continue
            other_terms = split_condition(other.settings.get(CONDITION, ""))
            common = [term for term in terms if term in other_terms]
            tests = [term for term in (*terms, *other_terms) if term not in common]
            if len(terms) == len(other_terms) == len(common) + 1 and _are_opposite(*tests):
                settings = {name: value for name, value in other.settings.items() if name != CONDITION}
                condition = {CONDITION: " and ".join(common)} if common else {}
                merged[index] = replace(other, settings=settings | condition)
                break
        else:
            merged.append(entry)
    return merged


def _are_equal_except_condition(first: Entry, second: Entry) -> bool:
    settings = [
        {name: value for name, value in entry.settings.items() if name != CONDITION} for entry in (first, second)
    ]
    return settings[0] == settings[1] and (first.namespaces, first.groups) == (second.namespaces, second.groups)


def _are_opposite(first: str, second: str) -> bool:
    """Return whether two conditions are those of the branches of one test of Python."""
    words, tests = zip(*(term.split(" ", 1) for term in (first, second)), strict=True)
    return set(words) == {"if", "unless"} and tests[0] == tests[1] and tests[0].startswith("`")
