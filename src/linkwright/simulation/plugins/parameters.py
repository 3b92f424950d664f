"""Parameters of plugins, declared by a dataclass with their names, types and defaults.

    @dataclass(frozen=True, kw_only=True)
    class Parameters:
        left_joint: tuple[str, ...] = parameter(aliases=("leftJoint",))  # required, as it has no default
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

_ALIASES = "aliases"
_COMMON = frozenset(
    (
        *("ros", "robotNamespace", "robot_namespace"),
        *("alwaysOn", "always_on", "rosDebugLevel", "legacyMode", "legacyModeNS", "gui"),
    )
)
"""Elements that any plugin may contain; the first three describe its node, the rest had a meaning once."""
_TRUTHS = {"true": True, "1": True, "false": False, "0": False}


@dataclass(frozen=True)
class NoParameters:
    """The parameters of a plugin that has none."""


def parameter(default: Any = MISSING, *, aliases: Sequence[str] = ()) -> Any:
    """Return the field of a parameter, with its default and its names in older simulators.

    A parameter without a default is required.
    """
    return field(default=default, metadata={_ALIASES: tuple(aliases)})


def parameters_from(
    table: type[P], element: Element | None, ignored: Collection[str] = ()
) -> tuple[P, list[Diagnostic]]:
    """Read the parameters of a plugin from its element.

    Args:
        table: the dataclass of the parameters, as described in this module.
        element: the element of the plugin; None for a sensor without a plugin.
        ignored: names that are known but have no effect here.

    Returns:
        The parameters, and warnings for unknown names and for invalid values, which are replaced by their defaults.

    Raises:
        LinkwrightError: SIM132, a parameter without a default is missing.
    """
    findings: list[Diagnostic] = []
    given: dict[str, list[Element]] = {}
    for child in element.elements() if element is not None else ():
        given.setdefault(child.tag, []).append(child)
    values: dict[str, Any] = {}
    names: dict[str, None] = {}
    kinds = _types(table)  # type: ignore[arg-type]  # a class is hashable
    for declared in fields(table):  # type: ignore[arg-type]  # a dataclass is asked for
        spellings = (declared.name, *declared.metadata.get(_ALIASES, ()))
        names |= dict.fromkeys(spellings)
        written = next((given[name] for name in spellings if name in given), [])
        value = _read(declared, kinds[declared.name], written, findings)
        if value is not None:
            values[declared.name] = value
        elif declared.default is MISSING:
            raise LinkwrightError(_missing(declared, element))
    for name, children in given.items():
        if name not in names and name not in _COMMON and name not in ignored and ":" not in name:
            findings.append(
                _warning(
                    "SIM130",
                    phrase("'{name}' is not a parameter of this plugin", name=name),
                    children[0],
                    did_you_mean(name, names),
                )
            )
    return table(**values), findings


@cache
def _types(table: Hashable) -> Mapping[str, Any]:
    return get_type_hints(table)


def _read(known: Field[Any], kind: Any, written: list[Element], findings: list[Diagnostic]) -> Any:
    """Return the value of a parameter, or None if there is no valid value.

    A finding is added for each invalid value.
    """
    many = kind in (tuple[str, ...], tuple[float, ...])
    convert = _CONVERTERS[str if kind == tuple[str, ...] else float if kind == tuple[float, ...] else kind]
    values = []
    for child in written if many else written[:1]:
        text = child.text().strip()
        try:
            values.append(convert(text))
        except ValueError:
            message = phrase("'{text}' is not a valid value of '{name}'", text=text, name=known.name)
            findings.append(_warning("SIM131", message, child, phrase("the default is used")))
    if not values:
        return None
    return tuple(values) if many else values[0]


def _truth(text: str) -> bool:
    try:
        return _TRUTHS[text.lower()]
    except KeyError:
        raise ValueError(text) from None


def _vector(text: str) -> Vector3:
    x, y, z = (float(item) for item in text.split())
    return x, y, z


_CONVERTERS: dict[Any, Callable[[str], Any]] = {
    str: str,
    float: float,
    int: int,
    bool: _truth,
    bool | None: _truth,
    float | None: float,
    Vector3: _vector,
    Vector3 | None: _vector,
}


def _missing(known: Field[Any], element: Element | None) -> Diagnostic:
    message = phrase("the plugin needs the parameter '{name}'", name=known.name)
    if element is None:
        return Diagnostic("SIM132", message)
    return Diagnostic("SIM132", message, span=element.span(), source=element.source)


def _warning(code: str, message: Phrase, element: Element, hint: Phrase | None) -> Diagnostic:
    return Diagnostic(code, message, element.span(), Severity.WARNING, hint=hint, source=element.source)
