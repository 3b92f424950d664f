"""Define the names in a source that other programs use or pass.

Such names are topics, parameters, frames and options.
"""

from __future__ import annotations

import re
from collections import Counter
from collections.abc import Collection, Iterator, Sequence
from dataclasses import dataclass, field, replace
from enum import Enum
from typing import NamedTuple

from linkwright.diagnostics import Phrase, Span, phrase
from linkwright.review.sources.name_patterns import can_make

HEADER_SUFFIXES = (".hpp", ".hh", ".hxx", ".h")
CPP_SUFFIXES = (".cpp", ".cc", ".cxx", ".c", *HEADER_SUFFIXES)
PYTHON_SUFFIX = ".py"
DYNAMIC_SUFFIX = ".cfg"
"""The suffix of dynamic_reconfigure descriptions, which are Python files."""

YES, NO = "yes", "no"
"""The values of boolean properties."""


class NameKind(Enum):
    """The kind of a name, with its title in the singular and the plural for reports."""

    PUBLISHER = (phrase("publisher"), phrase("publishers"))
    SUBSCRIPTION = (phrase("subscription"), phrase("subscriptions"))
    SERVICE = (phrase("service"), phrase("services"))
    CLIENT = (phrase("service client"), phrase("service clients"))
    ACTION = (phrase("action"), phrase("actions"))
    ACTION_CLIENT = (phrase("action client"), phrase("action clients"))
    GAZEBO_PUBLISHER = (phrase("publisher in Gazebo"), phrase("publishers in Gazebo"))
    GAZEBO_SUBSCRIPTION = (phrase("subscription in Gazebo"), phrase("subscriptions in Gazebo"))
    GAZEBO_SERVICE = (phrase("service in Gazebo"), phrase("services in Gazebo"))
    GAZEBO_CLIENT = (phrase("service client in Gazebo"), phrase("service clients in Gazebo"))
    PARAMETER = (phrase("parameter"), phrase("parameters"))
    ELEMENT = (phrase("parameter of the plugin"), phrase("parameters of the plugin"))
    YAML_KEY = (phrase("key of YAML files"), phrase("keys of YAML files"))
    NODE = (phrase("node"), phrase("nodes"))
    FRAME = (phrase("frame"), phrase("frames"))
    MESSAGE_FRAME = (phrase("frame of messages"), phrase("frames of messages"))
    FRAME_LOOKUP = (phrase("frame that is looked up"), phrase("frames that are looked up"))
    COMMAND_INTERFACE = (phrase("command interface"), phrase("command interfaces"))
    STATE_INTERFACE = (phrase("state interface"), phrase("state interfaces"))
    CLAIMED_INTERFACE = (phrase("claimed interface"), phrase("claimed interfaces"))
    HARDWARE_PARAMETER = (phrase("parameter of the hardware"), phrase("parameters of the hardware"))
    HARDWARE_ELEMENT = (
        phrase("element of ros2_control that the hardware reads"),
        phrase("elements of ros2_control that the hardware reads"),
    )
    OPTION = (phrase("command-line option"), phrase("command-line options"))
    PLUGIN = (phrase("exported class"), phrase("exported classes"))
    PLUGINLIB_CLASS = (phrase("class for pluginlib"), phrase("classes for pluginlib"))
    SIMULATION_PLUGIN = (phrase("plugin of Gazebo"), phrase("plugins of Gazebo"))
    LIBRARY_PLUGIN = (phrase("plugin of Gazebo Classic"), phrase("plugins of Gazebo Classic"))
    TREE_NODE = (phrase("node of behavior trees"), phrase("nodes of behavior trees"))
    TREE_PORT = (phrase("port of behavior trees"), phrase("ports of behavior trees"))
    CLASS = (phrase("class"), phrase("classes"))
    FUNCTION = (phrase("function"), phrase("functions"))
    MEMBER = (phrase("public member"), phrase("public members"))
    RECONFIGURATION = (phrase("server of dynamic_reconfigure"), phrase("servers of dynamic_reconfigure"))
    ROUTE = (phrase("web route"), phrase("web routes"))
    WEB_EVENT = (phrase("event of Socket.IO"), phrase("events of Socket.IO"))
    IMPORT = (phrase("name of the package"), phrase("names of the package"))

    def __init__(self, title: Phrase, plural: Phrase) -> None:
        self.title = title
        self.plural = plural


class Detail(Enum):
    """A property of a name besides its type, with its title for reports."""

    QOS = phrase("QoS")
    QUEUE = phrase("queue")
    LATCH = phrase("latched")
    DEFAULT = phrase("default")
    VALUE_TYPE = phrase("type")
    READ_AS = phrase("read as")
    MINIMUM = phrase("minimum")
    MAXIMUM = phrase("maximum")
    CHOICES = phrase("choices")
    SHORT_FORM = phrase("short form")
    LEVEL = phrase("level")
    REQUIRED = phrase("required")
    UNDEFINED = phrase("undefined")
    ARGUMENTS = phrase("arguments")
    RESULT = phrase("result")
    RETURNED = phrase("returned value")
    RETURNED_COUNT = phrase("number of returned values")
    CONSTANT = phrase("const")
    BASES = phrase("base classes")
    CREATED_IN = phrase("created in")
    CONDITION = phrase("condition")
    GIVEN_BY = phrase("parameter")

    @property
    def title(self) -> Phrase:
        """The name of the property in a report."""
        return self.value


@dataclass(frozen=True)
class SourceName:
    """A name in a source.

    Attributes:
        kind: the kind of the name.
        name: the name as written, or the text of the expression that computes it.
        type: the type of the messages, or the default of a parameter or option; empty if it is not literal.
        span: the location in the file.
        details: the other properties that are literal.
        full_type: the type of the messages with its package, such as ``std_msgs/String``; empty if it is not certain.
    """

    kind: NameKind
    name: str
    type: str
    span: Span
    details: tuple[tuple[Detail, str], ...] = ()
    full_type: str = ""

    def has_type_of(self, other: SourceName) -> bool:
        """Return whether two names have the same type. The packages count if both are known."""
        if self.full_type and other.full_type:
            return self.full_type == other.full_type
        return self.type == other.type


class FoundName(NamedTuple):
    """A name and its place in the text of a source.

    Attributes:
        kind: the kind of the name.
        name: the name by which others use it, such as ``gripper/position`` of an interface of ros2_control.
        start: the offset of the name.
        end: the end of the name.
        base: the base class as which programs load an exported class; empty if there is none.
        is_required: whether a program fails without the parameter.
        variable: the variable or literal that is the value without the parameter; empty if it is unknown.
    """

    kind: NameKind
    name: str
    start: int
    end: int
    base: str = ""
    is_required: bool = False
    variable: str = ""


@dataclass(frozen=True)
class DefaultName:
    """A name that a source has by default, because a parameter gives it.

    Attributes:
        parameter: the name of the parameter.
        kind: the kind of the name.
        name: the default.
        pattern: the texts and parameters of a sum, such as ``<prefix>/state``; empty for a single parameter.
    """

    parameter: str
    kind: NameKind
    name: str
    pattern: str = ""


class ConditionalLines(NamedTuple):
    """The lines in a branch of an ``if`` statement.

    Attributes:
        first: the first line of the branch.
        last: the last line of the branch.
        condition: the condition of the branch as code.
        line: the line of the statement.
    """

    first: int
    last: int
    condition: str
    line: int


class OwnUse(NamedTuple):
    """A use of an attribute or method by a class of a Python source that does not have it.

    Attributes:
        class_name: the name of the class.
        span: the location of the attribute.
        is_call: whether the class calls it.
    """

    class_name: str
    span: Span
    is_call: bool


class TimerClock(Enum):
    """The clock by which a timer runs, with its name for reports."""

    WALL = phrase("wall time")
    ROS = phrase("ROS time")


@dataclass(frozen=True)
class Timer:
    """A timer of a source.

    Attributes:
        callback: the name of the function that it calls; empty if it is another expression.
        text: the call with the period.
        span: the location of the period.
        clock: the clock by which it runs; None if it is unknown.
    """

    callback: str
    text: str
    span: Span
    clock: TimerClock | None = None


@dataclass
class SourceNames:
    """The names in a source.

    Attributes:
        names: the distinct literal names.
        typed_names: the literal names with a type, one for each place.
        expressions: the names that are expressions, whose values are unknown.
        defaults: the names that expressions have by default, by the text of the expression.
        choices: the texts that expressions may have as their values, by the text of the expression. Expressions with
            unknown values are left out.
        counts: the number of places with a literal name, by kind and name.
        conditional_lines: the branches of ``if`` statements.
        default_names: the names that parameters give by default.
        parameter_reads: the lines in which a Python source reads a parameter that it declares, by name.
        unknown_scopes: the parameters of ROS 1 that may be private, because a caller passes the node handle, or
            another function has it.
        rates: the texts of rates and periods, each with its location.
        timers: the timers, in the order of the source.
        forward_classes: the classes outside of namespaces that a C++ header only declares.
        parameter_names: the names of the parameters of functions in C++, by the function and their types.
        declared_only: the names of functions whose code is in no header, so that callers need a library.
        overrides: the names of functions that override a function of a base class, qualified by their classes.
        bases: the names of the base classes of each public class of a C++ source.
        is_program: whether the source is a program and not a library.
        makes_node: whether the source makes a node, even if the name of the node is computed.
        helper_nodes: the names of the nodes of a C++ source that offer nothing; see `is_helper_node`.
        error_line: the line of the syntax error in a source that cannot be parsed; 0 for other sources.
        is_error_certain: whether it is a syntax error in all versions of Python.
        absolute_imports: the modules that an ``__init__.py`` imports by their full names, each with its location.
        callbacks: the topic, service or action that calls a function, by the name of the function, qualified by its
            class; its kind is None for a timer.
        inherited_names: the names that each class of a Python source inherits. Classes with unknown base classes are
            left out.
        class_names: the names that each class of a Python source has or inherits from classes of the package.
        data_classes: the classes of a Python source whose fields are the parameters of their constructors.
        bound_names: the names that a Python 3 source defines or imports.
        undefined_names: the undefined names that a source uses, each with the location of its first use.
        attributes: the attributes that a Python 3 source defines in classes or assigns to objects.
        undefined_attributes: the first uses of the undefined attributes and methods that classes of a source use of
            themselves, by name.
        non_public: the private and protected members of the classes of a C++ header, with the names of the classes.
        protected: the protected members, functions and nested classes of the classes of a C++ header.
        aliases: the types that a C++ header names with ``typedef`` and ``using``, by name.
        namespaces: the named namespaces that a C++ header opens, each with its first location.
        enumerations: the values and locations of the enumerators of each public enumeration of a C++ header.
        ignoring_keywords: the functions and classes of a Python source that take any keyword argument but use none.
        passed_on: the methods of a Python source that it passes on, such as callbacks, qualified by their classes.
        hidden_classes: the names of the protected and private classes in a C++ source.
        wrapper_arguments: the expressions that name topics and services in classes of a Python source, for which the
            callers of the classes pass the names.
        imported_objects: the names that an ``__init__.py`` imports from modules of its package. The other names may be
            modules themselves.
        has_star_import: whether an ``__init__.py`` imports all names of a module, so that it may have other names.
    """

    names: list[SourceName] = field(default_factory=list)
    typed_names: list[SourceName] = field(default_factory=list)
    expressions: list[SourceName] = field(default_factory=list)
    defaults: dict[str, str] = field(default_factory=dict)
    choices: dict[str, Sequence[str]] = field(default_factory=dict)
    counts: Counter[tuple[NameKind, str]] = field(default_factory=Counter)
    conditional_lines: list[ConditionalLines] = field(default_factory=list)
    default_names: set[DefaultName] = field(default_factory=set)
    parameter_reads: dict[str, list[int]] = field(default_factory=dict)
    unknown_scopes: set[str] = field(default_factory=set)
    rates: list[tuple[str, Span]] = field(default_factory=list)
    timers: list[Timer] = field(default_factory=list)
    forward_classes: set[str] = field(default_factory=set)
    parameter_names: dict[tuple[str, str], tuple[str, ...]] = field(default_factory=dict)
    declared_only: set[str] = field(default_factory=set)
    overrides: set[str] = field(default_factory=set)
    bases: dict[str, list[str]] = field(default_factory=dict)
    is_program: bool = False
    makes_node: bool = False
    helper_nodes: set[str] = field(default_factory=set)
    error_line: int = 0
    is_error_certain: bool = True
    absolute_imports: list[tuple[str, Span]] = field(default_factory=list)
    callbacks: dict[str, tuple[NameKind | None, str]] = field(default_factory=dict)
    inherited_names: dict[str, Collection[str]] = field(default_factory=dict)
    class_names: dict[str, Collection[str]] = field(default_factory=dict)
    data_classes: set[str] = field(default_factory=set)
    bound_names: frozenset[str] = frozenset()
    undefined_names: dict[str, Span] = field(default_factory=dict)
    attributes: frozenset[str] = frozenset()
    undefined_attributes: dict[str, OwnUse] = field(default_factory=dict)
    non_public: frozenset[str] = frozenset()
    protected: list[SourceName] = field(default_factory=list)
    aliases: dict[str, str] = field(default_factory=dict)
    namespaces: dict[str, Span] = field(default_factory=dict)
    enumerations: dict[str, dict[str, tuple[str, Span]]] = field(default_factory=dict)
    ignoring_keywords: set[str] = field(default_factory=set)
    passed_on: set[str] = field(default_factory=set)
    hidden_classes: set[str] = field(default_factory=set)
    wrapper_arguments: set[str] = field(default_factory=set)
    imported_objects: set[str] = field(default_factory=set)
    has_star_import: bool = False

    def add(self, name: SourceName) -> None:
        """Add a literal name, or complete an equal name."""
        self.counts[name.kind, name.name] += 1
        if name.type:
            self.typed_names.append(name)
        for index, other in enumerate(self.names):
            if (other.kind, other.name) == (name.kind, name.name):
                self.names[index] = _merge(other, name)
                return
        self.names.append(name)

    def resolve_aliases(self, types: str) -> str:
        """Return a text with types in which the names that the header gives to types are replaced by these."""
        return re.sub(r"\w+", lambda word: self.aliases.get(word[0], word[0]), types)

    def find_callback(self, function: str) -> tuple[NameKind | None, str] | None:
        """Return the topic, service or action that calls a function, or None.

        Args:
            function: the name of the function, qualified by its namespaces and classes.
        """
        separator = "::" if "::" in function else "."
        parts = function.split(separator)
        return self.callbacks.get(function) or self.callbacks.get(separator.join(parts[-2:]))

    def add_default(self, kind: NameKind, expression: str, parameter: str, default: str, pattern: str) -> None:
        """Add the name that an expression has by default, because it reads a parameter."""
        self.defaults[expression] = default
        self.default_names.add(DefaultName(parameter, kind, default, pattern))

    def find_default(self, item: SourceName) -> DefaultName | None:
        """Return the name that an expression has by default and its parameter, or None if it is unknown."""
        default = self.defaults.get(item.name)
        found = (known for known in self.default_names if (known.kind, known.name) == (item.kind, default))
        return min(found, key=lambda known: known.parameter, default=None)

    def can_give(self, expression: SourceName, name: str) -> bool:
        """Return whether an expression for a name may have a text as its value; True if that is not certain.

        Texts that differ only in an initial ``/`` are equal.
        """
        choices = [text.lstrip("/") for text in self.choices.get(expression.name, ())]
        return name.lstrip("/") in choices if choices else can_make(expression.name, name)

    def has_default(self, item: SourceName) -> bool:
        """Return whether a parameter gives a frame by default."""
        is_frame = item.kind in (NameKind.FRAME, NameKind.MESSAGE_FRAME, NameKind.FRAME_LOOKUP)
        return is_frame and any((item.kind, item.name) == (known.kind, known.name) for known in self.default_names)

    def of_kind(self, kind: NameKind) -> Iterator[SourceName]:
        """Yield the literal names of a kind."""
        return (name for name in self.names if name.kind is kind)


def _merge(first: SourceName, second: SourceName) -> SourceName:
    """Return one name for two occurrences: the first one with a type.

    If their conditions differ, the name has no condition, and no type unless both have the same. It is read as a type
    only if both are.
    """
    name = second if second.type and not first.type else first
    if dict(first.details).get(Detail.READ_AS) != dict(second.details).get(Detail.READ_AS):
        name = replace(name, details=tuple(item for item in name.details if item[0] is not Detail.READ_AS))
    conditions = [dict(item.details).get(Detail.CONDITION) for item in (first, second)]
    if conditions[0] == conditions[1]:
        return name
    details = tuple(item for item in name.details if item[0] is not Detail.CONDITION)
    is_same = first.has_type_of(second) or not second.type or not first.type
    return replace(
        name, details=details, type=name.type if is_same else "", full_type=name.full_type if is_same else ""
    )
