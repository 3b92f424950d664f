"""Parameters of nodes and controllers, declared by the fields of a dataclass.

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

`declare_table` reads a table once; a `ParameterTable` follows later changes.
"""

from __future__ import annotations

from collections.abc import Callable, Hashable, Iterable, Iterator, Mapping
from dataclasses import MISSING, Field, dataclass, field, fields, is_dataclass
from functools import cache
from inspect import cleandoc
from typing import Any, Generic, TypeVar, get_type_hints

from linkwright.diagnostics import Diagnostic, LinkwrightError, Phrase, did_you_mean, joined, phrase
from linkwright.graph import Node, Parameter, ParameterDescriptor, SetParametersResult
from linkwright.graph.parameters.parameter import ParameterType
from linkwright.loading.deferred import lazy_pattern
from linkwright.messages.distribution import is_before_iron

P = TypeVar("P")

Check = Callable[[str, Any], "Phrase | None"]
"""A validator: the problem of a named parameter's value, or None."""

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
"""The distributions to which a parameter may be limited."""

_UNCHANGED = object()
_ATTRIBUTE = lazy_pattern(r"(?m)^    (\w+): (.*(?:\n     .*)*)")
"""An entry below ``Attributes:`` of a docstring."""
_NAMES_KEY, _TABLE_KEY, _PREFIX_KEY, _PROPERTIES_KEY = "names", "table", "below", "about"
_COMMON_PARAMETERS = ("use_sim_time", "params_file", "type", "qos_overrides", "start_type_description_service")


@dataclass(frozen=True)
class NoParameters:
    """The empty table, for controllers without parameters."""


@dataclass(frozen=True, slots=True)
class _Properties:
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
    """Declare a parameter with a constraint, a description or a default that varies.

    Args:
        default: the default value.
        description: the purpose of the parameter, with its unit.
        read_only: whether the value cannot change after the declaration.
        check: the constraint on the value.
        only: the only distribution that has the parameter, `HUMBLE` or `JAZZY`; empty if both have the parameter.
            `HUMBLE` includes all distributions before Iron, and `JAZZY` includes Iron and later.
        later: the default in Iron and later, if it differs.
    """
    return field(default=default, metadata={_PROPERTIES_KEY: _Properties(description, read_only, check, only, later)})


def for_each(names: str, table: type[Any], *, prefix: str | None = None) -> Any:
    """Declare a group of parameters for each name in a parameter, such as ``gains.JOINT.p``.

    Args:
        names: the parameter that contains the names, which precedes this field in the same table; several parameters
            are separated by spaces.
        table: the dataclass with the parameters for one name.
        prefix: the prefix of the parameters, empty for ``JOINT.p``; by default, the name of the field.
    """
    return field(
        default_factory=dict, metadata={_NAMES_KEY: tuple(names.split()), _TABLE_KEY: table, _PREFIX_KEY: prefix}
    )


@dataclass(frozen=True, slots=True)
class TableEntry:
    """A parameter of a table, as `list_entries` describes it.

    Attributes:
        name: the name with dots; ``*`` represents the names in another parameter, as in ``gains.*.p``.
        kind: the type.
        default: the default value; None if it has none.
        description: the purpose, with its unit; empty if the table does not contain it.
        choices: the allowed values; empty if any value of the type is allowed.
        only: the only distribution that has the parameter; empty if both have it.
        keys: the parameters that contain the names for ``*``.
    """

    name: str
    kind: ParameterType
    default: Any
    description: str = ""
    choices: tuple[str, ...] = ()
    only: str = ""
    keys: tuple[str, ...] = ()


def list_entries(table: Any, prefix: str = "", keys: tuple[str, ...] = ()) -> Iterator[TableEntry]:
    """Yield the parameters of a table, without a node.

    If a parameter has no description, its entry below ``Attributes:`` in the docstring of the table is used.

    Args:
        table: the dataclass.
        prefix: the text before the names, such as ``gains.*.``.
        keys: the parameters that contain the names for ``*`` in the prefix.
    """
    kinds, descriptions = _find_kinds(table), _parse_attributes(table)
    for entry in fields(table):
        name = f"{prefix}{entry.name}"
        if _NAMES_KEY in entry.metadata:
            yield from list_entries(
                entry.metadata[_TABLE_KEY], f"{prefix}{_compute_group_prefix(entry)}*.", entry.metadata[_NAMES_KEY]
            )
        elif is_dataclass(kinds[entry.name]):
            yield from list_entries(kinds[entry.name], f"{name}.", keys)
        else:
            properties: _Properties = entry.metadata.get(_PROPERTIES_KEY, _Properties())
            default = None if entry.default is MISSING else entry.default
            if properties.later is not _UNCHANGED and not is_before_iron():
                default = properties.later
            choices = properties.check.choices if isinstance(properties.check, _OneOf) else ()
            description = properties.description or descriptions.get(entry.name, "")
            yield TableEntry(name, _TYPES[kinds[entry.name]], default, description, choices, properties.only, keys)


def _parse_attributes(table: Any) -> dict[str, str]:
    """Return the descriptions of fields in a docstring."""
    _, _, text = cleandoc(table.__doc__ or "").partition("\nAttributes:\n")
    return {match[1]: " ".join(match[2].split()) for match in _ATTRIBUTE.finditer(text)}


@dataclass(frozen=True, slots=True)
class _Declaration:
    name: str
    kind: ParameterType
    default: Any
    properties: _Properties


def declare_table(node: Node, table: type[P], prefix: str = "", defaults: P | None = None) -> P:
    """Declare the parameters of a table that are not yet declared, and return their values.

    Args:
        node: the node that declares the parameters.
        table: the dataclass that declares the parameters.
        prefix: the prefix of the names, such as the name of a plugin for ``PLUGIN.parameter``.
        defaults: the defaults to use instead of the defaults of the table.

    Raises:
        LinkwrightError: a value has another type (GRAPH201) or is not allowed (CTL101).
    """
    values: P = _Reader(node).read(table, f"{prefix}." if prefix else "", defaults)
    return values


class ParameterTable(Generic[P]):
    """The parameters of a node, declared by a dataclass and updated when they change.

    Args:
        node: the node that declares the parameters.
        table: the dataclass that declares the parameters.

    Raises:
        LinkwrightError: a value has another type (GRAPH201) or is not allowed (CTL101).

    Attributes:
        values: the current values, which are replaced by a new object on each change.
    """

    def __init__(self, node: Node, table: type[P]) -> None:
        self._node = node
        self._table = table
        self._reader = _Reader(node)
        self.values: P = self._read()
        node.add_on_set_parameters_callback(self._check_parameters)
        node.add_post_set_parameters_callback(lambda _: self.refresh())

    def refresh(self) -> None:
        """Read the parameters again, and declare the groups for names that were added."""
        self.values = self._read()

    def unknown_parameters(self) -> Iterator[tuple[str, Phrase | None]]:
        """Yield the name of each given parameter that does not exist.

        Each name is yielded with a suggestion of the intended name, or None.
        """
        for name in self._node.undeclared_overrides():
            if not name.startswith(_COMMON_PARAMETERS):
                yield name, did_you_mean(name, self._reader.declared)

    def _read(self) -> P:
        values: P = self._reader.read(self._table)
        return values

    def _check_parameters(self, parameters: list[Parameter]) -> SetParametersResult:
        for parameter in parameters:
            declaration = self._reader.declared.get(parameter.name)
            if declaration is None or declaration.properties.check is None or parameter.value is None:
                continue
            problem = declaration.properties.check(parameter.name, parameter.value)
            if problem is not None:
                return SetParametersResult(successful=False, reason=problem)
        return SetParametersResult(successful=True)


class _Reader:
    """A reader that declares and reads the parameters of tables.

    Attributes:
        declared: the declared parameters by name, including previously declared ones.
    """

    def __init__(self, node: Node) -> None:
        self._node = node
        self.declared: dict[str, _Declaration] = {}

    def read(self, table: Any, prefix: str = "", defaults: Any = None) -> Any:
        kinds = _find_kinds(table)
        values: dict[str, Any] = {}
        for entry in fields(table):
            kind, name = kinds[entry.name], f"{prefix}{entry.name}"
            if _NAMES_KEY in entry.metadata:
                keys = dict.fromkeys(key for names in entry.metadata[_NAMES_KEY] for key in _to_names(values[names]))
                name_table = entry.metadata[_TABLE_KEY]
                group = f"{prefix}{_compute_group_prefix(entry)}"
                values[entry.name] = {key: self.read(name_table, f"{group}{key}.") for key in keys}
            elif is_dataclass(kind):
                values[entry.name] = self.read(kind, f"{name}.")
            else:
                default = entry.default if entry.default is not MISSING else None
                properties = entry.metadata.get(_PROPERTIES_KEY, _Properties())
                if defaults is not None:
                    default = getattr(defaults, entry.name)
                elif properties.later is not _UNCHANGED and not is_before_iron():
                    default = properties.later
                values[entry.name] = self._declare_and_get(_Declaration(name, _TYPES[kind], default, properties))
        return table(**values)

    def _declare_and_get(self, declaration: _Declaration) -> Any:
        name, properties = declaration.name, declaration.properties
        if name not in self.declared:
            if properties.only not in ("", _find_distribution()) and name not in self._node.undeclared_overrides():
                return declaration.default
            descriptor = ParameterDescriptor(
                type=declaration.kind.value, description=properties.description, read_only=properties.read_only
            )
            default = list(declaration.default) if isinstance(declaration.default, tuple) else declaration.default
            if not self._node.has_parameter(name):
                self._node.declare_parameter(name, declaration.kind if default is None else default, descriptor)
            self.declared[name] = declaration
            value = self._get(name)
            problem = properties.check(name, value) if properties.check is not None and value is not None else None
            if problem is not None:
                raise LinkwrightError(Diagnostic("CTL101", problem))
            return value
        return self._get(name)

    def _get(self, name: str) -> Any:
        value = self._node.get_parameter_or(name).value
        return tuple(value) if self.declared[name].kind.is_array and value is not None else value


def _compute_group_prefix(group: Field[Any]) -> str:
    """Return the prefix of the parameters of a group, with a final dot, or an empty text."""
    prefix = group.name if group.metadata[_PREFIX_KEY] is None else group.metadata[_PREFIX_KEY]
    return f"{prefix}." if prefix else ""


def _find_distribution() -> str:
    return HUMBLE if is_before_iron() else JAZZY


def _to_names(names: Any) -> Iterable[str]:
    """Return the names in a parameter value.

    The value is one string or a sequence of strings.
    """
    return (names,) if isinstance(names, str) else names


@cache
def _find_kinds(table: Hashable) -> Mapping[str, Any]:
    return get_type_hints(table)


# --- checks ----------------------------------------------------------------------------------------------------------


def not_empty(name: str, value: Any) -> Phrase | None:
    """Return an error message if a string or sequence is empty, otherwise None."""
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


@dataclass(frozen=True, slots=True)
class _OneOf:
    choices: tuple[str, ...]

    def __call__(self, name: str, value: Any) -> Phrase | None:
        """Return an error message if the value, or an item of it, is not one of the choices."""
        for item in (value,) if isinstance(value, str) else value:
            if item not in self.choices:
                text = phrase(
                    "Parameter '{name}' with the value '{value}' is not one of: {choices}",
                    name=name,
                    value=item,
                    choices=", ".join(self.choices),
                )
                hint = did_you_mean(item, self.choices)
                return text if hint is None else joined((text, hint), "; ")
        return None


def one_of(*choices: str) -> Check:
    """Return a validator that requires one of the given words, or a list of them."""
    return _OneOf(choices)
