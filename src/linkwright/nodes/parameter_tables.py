"""Parameters of nodes and controllers, declared by dataclasses with names, types and defaults.

    @dataclass(frozen=True, kw_only=True)
    class Gains:
        p: float = 0.0

    @dataclass(frozen=True, kw_only=True)
    class Parameters:
        joints: tuple[str, ...] = parameter((), check=not_empty)
        cmd_vel_timeout: float = parameter(0.5, description="seconds")
        linear: Axes = Axes()  # another table: linear.x.max_velocity
        gains: Mapping[str, Gains] = for_each("joints", Gains)  # gains.JOINT.p

The types are ``str``, ``float``, ``int``, ``bool``, and ``tuple[...]`` of them; ``float | None`` and ``bool | None``
are declared without a value. Some parameters exist only in Humble or only in Jazzy. Such a parameter is declared if
``ROS_DISTRO`` names that distribution, or if a value is given, so that files for either distribution can be used
unchanged. Source: generate_parameter_library, which the controllers of ros2_controllers use.

`declared` reads a table once; a `ParameterTable` follows later changes.
"""

from __future__ import annotations

from collections.abc import Callable, Hashable, Iterable, Iterator, Mapping
from dataclasses import MISSING, dataclass, field, fields, is_dataclass
from functools import cache
from typing import Any, Generic, TypeVar, get_type_hints

from linkwright.diagnostics import Diagnostic, LinkwrightError, Phrase, did_you_mean, joined, phrase
from linkwright.graph import Node, Parameter, ParameterDescriptor, SetParametersResult
from linkwright.graph.parameters.parameter import ParameterType
from linkwright.messages.distribution import is_before_iron

P = TypeVar("P")

Check = Callable[[str, Any], "Phrase | None"]
"""A validator, which takes the name and value of a parameter and returns an error message or None."""

_TYPES: dict[Any, ParameterType] = {
    str: ParameterType.STRING,
    float: ParameterType.DOUBLE,
    int: ParameterType.INTEGER,
    bool: ParameterType.BOOL,
    tuple[str, ...]: ParameterType.STRING_ARRAY,
    tuple[float, ...]: ParameterType.DOUBLE_ARRAY,
    tuple[int, ...]: ParameterType.INTEGER_ARRAY,
    tuple[bool, ...]: ParameterType.BOOL_ARRAY,
    float | None: ParameterType.DOUBLE,
    bool | None: ParameterType.BOOL,
}
HUMBLE, JAZZY = "humble", "jazzy"
"""The distributions to which a parameter may be limited; each represents one side of the change in Iron."""

_UNCHANGED = object()
_NAMES, _TABLE, _BELOW, _DETAILS = "names", "table", "below", "about"
_COMMON_PREFIXES = ("use_sim_time", "params_file", "type", "qos_overrides", "start_type_description_service")


@dataclass(frozen=True)
class NoParameters:
    """The empty table, for controllers without parameters."""


@dataclass(frozen=True, slots=True)
class _Details:
    description: str = ""
    read_only: bool = False
    check: Check | None = None
    only: str = ""
    later: Any = _UNCHANGED


def parameter(
    default: Any,
    *,
    description: str = "",
    read_only: bool = False,
    check: Check | None = None,
    only: str = "",
    later: Any = _UNCHANGED,
) -> Any:
    """Return a dataclass field for a parameter with a constraint, a description or distribution-specific values.

    Args:
        default: the default value.
        description: the purpose of the parameter, with its unit.
        read_only: whether the value cannot change after the declaration.
        check: the constraint on the value.
        only: the distributions that have the parameter: `HUMBLE` for those before Iron, `JAZZY` for Iron and later;
            empty for all.
        later: the default in Iron and later distributions, if it differs.
    """
    return field(default=default, metadata={_DETAILS: _Details(description, read_only, check, only, later)})


def for_each(names: str, table: type[Any], *, below: str = "") -> Any:
    """Return a dataclass field for a group of parameters for each name in another parameter, as in ``gains.JOINT.p``.

    Args:
        names: the fields of the same table that contain the names, separated by spaces; they must precede this field.
        table: the dataclass with the parameters for one name.
        below: the prefix of the parameters, if it differs from the name of the field.
    """
    return field(default_factory=dict, metadata={_NAMES: tuple(names.split()), _TABLE: table, _BELOW: below})


@dataclass(frozen=True, slots=True)
class _Declaration:
    name: str
    kind: ParameterType
    default: Any
    about: _Details


def declared(node: Node, table: type[P], prefix: str = "", usual: P | None = None) -> P:
    """Declare the parameters of a table unless they are declared already, and return their values.

    Args:
        node: the node.
        table: the dataclass.
        prefix: the prefix of the names, such as the name of a plugin for ``PLUGIN.parameter``.
        usual: the defaults to use instead of the defaults of the table.

    Raises:
        LinkwrightError: a value has another type (GRAPH201) or is not allowed (CTL101).
    """
    values: P = _Reader(node).read(table, f"{prefix}." if prefix else "", usual)
    return values


class ParameterTable(Generic[P]):
    """The parameters of a node, declared by a dataclass and updated when they change.

    Args:
        node: the node.
        table: the dataclass.

    Raises:
        LinkwrightError: a value has another type (GRAPH201) or is not allowed (CTL101).

    Attributes:
        values: the current values; each change replaces this object.
    """

    def __init__(self, node: Node, table: type[P]) -> None:
        self._node = node
        self._table = table
        self._reader = _Reader(node)
        self.values: P = self._read()
        node.add_on_set_parameters_callback(self._validate)
        node.add_post_set_parameters_callback(lambda _: self.refresh())

    def refresh(self) -> None:
        """Read the parameters again, and declare the groups for names that were added."""
        self.values = self._read()

    def unknown(self) -> Iterator[tuple[str, Phrase | None]]:
        """Yield each given parameter that does not exist, with a suggestion of the intended name or None."""
        for name in self._node.undeclared_overrides():
            if not name.startswith(_COMMON_PREFIXES):
                yield name, did_you_mean(name, self._reader.declared)

    def _read(self) -> P:
        values: P = self._reader.read(self._table)
        return values

    def _validate(self, parameters: list[Parameter]) -> SetParametersResult:
        for parameter in parameters:
            declaration = self._reader.declared.get(parameter.name)
            if declaration is None or declaration.about.check is None or parameter.value is None:
                continue
            problem = declaration.about.check(parameter.name, parameter.value)
            if problem is not None:
                return SetParametersResult(successful=False, reason=problem)
        return SetParametersResult(successful=True)


class _Reader:
    """Declares and reads the parameters of tables.

    Attributes:
        declared: the declared parameters by name, including those that were declared before.
    """

    def __init__(self, node: Node) -> None:
        self._node = node
        self.declared: dict[str, _Declaration] = {}

    def read(self, table: Any, prefix: str = "", defaults: Any = None) -> Any:
        kinds = _field_types(table)
        values: dict[str, Any] = {}
        for entry in fields(table):
            kind, name = kinds[entry.name], f"{prefix}{entry.name}"
            if _NAMES in entry.metadata:
                keys = dict.fromkeys(key for names in entry.metadata[_NAMES] for key in _split_names(values[names]))
                inner_table = entry.metadata[_TABLE]
                name = f"{prefix}{entry.metadata[_BELOW] or entry.name}"
                values[entry.name] = {key: self.read(inner_table, f"{name}.{key}.") for key in keys}
            elif is_dataclass(kind):
                values[entry.name] = self.read(kind, f"{name}.")
            else:
                default = entry.default if entry.default is not MISSING else None
                details = entry.metadata.get(_DETAILS, _Details())
                if defaults is not None:
                    default = getattr(defaults, entry.name)
                elif details.later is not _UNCHANGED and not is_before_iron():
                    default = details.later
                values[entry.name] = self._value(_Declaration(name, _TYPES[kind], default, details))
        return table(**values)

    def _value(self, declaration: _Declaration) -> Any:
        name, details = declaration.name, declaration.about
        if name not in self.declared:
            if details.only not in ("", _distribution()) and name not in self._node.undeclared_overrides():
                return declaration.default
            descriptor = ParameterDescriptor(
                type=declaration.kind.value, description=details.description, read_only=details.read_only
            )
            default = list(declaration.default) if isinstance(declaration.default, tuple) else declaration.default
            if not self._node.has_parameter(name):
                self._node.declare_parameter(name, declaration.kind if default is None else default, descriptor)
            self.declared[name] = declaration
            value = self._get(name)
            problem = details.check(name, value) if details.check is not None and value is not None else None
            if problem is not None:
                raise LinkwrightError(Diagnostic("CTL101", problem))
            return value
        return self._get(name)

    def _get(self, name: str) -> Any:
        value = self._node.get_parameter_or(name).value
        return tuple(value) if self.declared[name].kind.is_array and value is not None else value


def _distribution() -> str:
    return HUMBLE if is_before_iron() else JAZZY


def _split_names(names: Any) -> Iterable[str]:
    """Return the names in a parameter value, which is a string or a sequence of strings."""
    return (names,) if isinstance(names, str) else names


@cache
def _field_types(table: Hashable) -> Mapping[str, Any]:
    return get_type_hints(table)


# --- checks ----------------------------------------------------------------------------------------------------------


def not_empty(name: str, value: Any) -> Phrase | None:
    """Check that a string or sequence is not empty; return the error message, or None if it is valid."""
    return None if len(value) else phrase("Parameter '{name}' cannot be empty", name=name)


def above(limit: float) -> Check:
    """Return a validator that requires a value above a limit."""
    return lambda name, value: (
        None
        if value > limit
        else phrase(
            "Parameter '{name}' with the value {value:g} must be above {limit:g}", name=name, value=value, limit=limit
        )
    )


def at_least(limit: float) -> Check:
    """Return a validator that requires a value greater than or equal to a limit."""
    return lambda name, value: (
        None
        if value >= limit
        else phrase(
            "Parameter '{name}' with the value {value:g} must not be below {limit:g}",
            name=name,
            value=value,
            limit=limit,
        )
    )


def one_of(*words: str) -> Check:
    """Return a validator that requires one of the given words, or a list of them."""

    def check(name: str, value: Any) -> Phrase | None:
        for item in (value,) if isinstance(value, str) else value:
            if item not in words:
                text = phrase(
                    "Parameter '{name}' with the value '{value}' is not one of: {words}",
                    name=name,
                    value=item,
                    words=", ".join(words),
                )
                hint = did_you_mean(item, words)
                return text if hint is None else joined((text, hint), "; ")
        return None

    return check
