"""Parameters of plugins: a dataclass declares their names, types and defaults.

    @dataclass(frozen=True, kw_only=True)
    class Parameters:
        left_joint: tuple[str, ...] = parameter(aliases=("leftJoint",))  # required, because it has no default
        wheel_separation: tuple[float, ...] = parameter((0.34,), aliases=("wheelSeparation",))
        update_rate: float = 100.0
        publish_odom: bool = False

Each field is named after a child element of ``<plugin>``. The types are ``str``, ``float``, ``int``, ``bool``,
`Vector3`, and ``tuple[str, ...]`` or ``tuple[float, ...]`` for elements that may occur several times. ``bool | None``,
``float | None`` and ``Vector3 | None`` are for parameters whose defaults depend on other parameters.
"""

from __future__ import annotations

from collections.abc import Callable, Collection, Hashable, Mapping, Sequence
from dataclasses import MISSING, Field, dataclass, field, fields
from functools import cache
from typing import Any, TypeVar, get_type_hints

from linkwright.diagnostics import Diagnostic, LinkwrightError, Phrase, Severity, did_you_mean, phrase
from linkwright.geometry.single import Vector3
from linkwright.xmltree import Element

P = TypeVar("P")

_ALIASES_KEY = "aliases"
_COMMON_ELEMENTS = frozenset(
    (
        *("ros", "robotNamespace", "robot_namespace"),
        *("alwaysOn", "always_on", "rosDebugLevel", "legacyMode", "legacyModeNS", "gui"),
    )
)
"""Elements that any plugin may contain: the first three describe its node, the others are obsolete."""
_BOOLEANS = {"true": True, "1": True, "false": False, "0": False}


@dataclass(frozen=True)
class NoParameters:
    """The parameters of a plugin that has none."""


def parameter(default: Any = MISSING, *, aliases: Sequence[str] = ()) -> Any:
    """Return a dataclass field for a parameter, with its default and its other names.

    A parameter without a default is required.
    """
    return field(default=default, metadata={_ALIASES_KEY: tuple(aliases)})


def parameters_from(
    parameter_class: type[P], element: Element | None, ignored: Collection[str] = ()
) -> tuple[P, list[Diagnostic]]:
    """Read the parameters of a plugin from its element.

    Args:
        parameter_class: the dataclass that declares the parameters, as described in this module.
        element: the element of the plugin; None for a sensor without a plugin.
        ignored: the names of parameters that have no effect here and give no warning.

    Returns:
        The parameters, and warnings for unknown names and for invalid values. Defaults replace invalid values.

    Raises:
        LinkwrightError: SIM132, a parameter without a default is missing.
    """
    findings: list[Diagnostic] = []
    children_by_name: dict[str, list[Element]] = {}
    for child in element.elements() if element is not None else ():
        children_by_name.setdefault(child.tag, []).append(child)
    values: dict[str, Any] = {}
    names: dict[str, None] = {}
    types = _get_types(parameter_class)  # type: ignore[arg-type]  # a class is hashable
    for declared_field in fields(parameter_class):  # type: ignore[arg-type]  # a dataclass is asked for
        accepted_names = (declared_field.name, *declared_field.metadata.get(_ALIASES_KEY, ()))
        names |= dict.fromkeys(accepted_names)
        elements = next((children_by_name[name] for name in accepted_names if name in children_by_name), [])
        value = _read_value(declared_field, types[declared_field.name], elements, findings)
        if value is not None:
            values[declared_field.name] = value
        elif declared_field.default is MISSING:
            raise LinkwrightError(_missing_parameter_error(declared_field, element))
    for name, children in children_by_name.items():
        if name not in names and name not in _COMMON_ELEMENTS and name not in ignored and ":" not in name:
            findings.append(
                _create_warning(
                    "SIM130",
                    phrase("'{name}' is not a parameter of this plugin", name=name),
                    children[0],
                    did_you_mean(name, names),
                )
            )
    return parameter_class(**values), findings


@cache
def _get_types(table: Hashable) -> Mapping[str, Any]:
    return get_type_hints(table)


def _read_value(declared_field: Field[Any], kind: Any, elements: list[Element], findings: list[Diagnostic]) -> Any:
    """Return the value of a parameter, or None if there is no valid value.

    A finding is added for each invalid value.
    """
    is_list = kind in (tuple[str, ...], tuple[float, ...])
    convert = _CONVERTERS[str if kind == tuple[str, ...] else float if kind == tuple[float, ...] else kind]
    values = []
    for child in elements if is_list else elements[:1]:
        text = child.text().strip()
        try:
            values.append(convert(text))
        except ValueError:
            message = phrase("'{text}' is not a valid value for '{name}'", text=text, name=declared_field.name)
            findings.append(_create_warning("SIM131", message, child, phrase("the default is used")))
    if not values:
        return None
    return tuple(values) if is_list else values[0]


def _parse_bool(text: str) -> bool:
    try:
        return _BOOLEANS[text.lower()]
    except KeyError:
        raise ValueError(text) from None


def _parse_vector(text: str) -> Vector3:
    x, y, z = (float(item) for item in text.split())
    return x, y, z


_CONVERTERS: dict[Any, Callable[[str], Any]] = {
    str: str,
    float: float,
    int: int,
    bool: _parse_bool,
    bool | None: _parse_bool,
    float | None: float,
    Vector3: _parse_vector,
    Vector3 | None: _parse_vector,
}


def _missing_parameter_error(declared_field: Field[Any], element: Element | None) -> Diagnostic:
    message = phrase("the plugin needs the parameter '{name}'", name=declared_field.name)
    if element is None:
        return Diagnostic("SIM132", message)
    return Diagnostic("SIM132", message, span=element.span(), source=element.source)


def _create_warning(code: str, message: Phrase, element: Element, hint: Phrase | None) -> Diagnostic:
    return Diagnostic(code, message, element.span(), Severity.WARNING, hint=hint, source=element.source)
