"""The form for a description that cannot be expanded because arguments have no value."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from typing import TYPE_CHECKING

from linkwright.diagnostics import Diagnostic, LinkwrightError
from linkwright.hosting.xacro_calls import XacroCall
from linkwright.packages import PackageFinder

if TYPE_CHECKING:
    from linkwright.page.protocol.description import ArgumentForm

_MOST_TRIED = 12
"""Sets of values with which the description is expanded; no user chooses between more."""


def argument_form(call: XacroCall, finder: PackageFinder, findings: Iterable[Diagnostic]) -> ArgumentForm | None:
    """Return the arguments that a description needs, and argument sets of callers that give a robot.

    This takes as long as expanding the description with each argument set, and may run in another thread.

    Args:
        call: the use of xacro that failed.
        finder: finds packages.
        findings: the errors of that use.

    Returns:
        The form, or None if no other values are known to change the result.
    """
    from linkwright.descriptions.argument_sets import argument_sets
    from linkwright.lint.argument_sets import undeclared_argument
    from linkwright.page.protocol.description import ArgumentChoice, ArgumentForm

    if call.path.suffix == ".sdf":
        return None
    given = dict(call.arguments)
    sets: list[dict[str, str]] = []
    for argument_set in argument_sets(call.path, finder)[:_MOST_TRIED]:
        values = {**given, **argument_set.values}
        if argument_set.values and values not in sets and _expands(call, values, finder):
            sets.append(values)
    asked = [name for finding in findings if (name := undeclared_argument(finding))]
    names = list(dict.fromkeys([*asked, *(name for values in sets for name in values), *(given if asked else ())]))
    if not names:
        return None
    choices = [ArgumentChoice(_label(values, sets), values) for values in sets]
    return ArgumentForm(call.path.name, names, sets[0] if sets else given, choices)


def _expands(call: XacroCall, values: Mapping[str, str], finder: PackageFinder) -> bool:
    from linkwright.descriptions import examine

    try:
        return not examine(call.path, arguments=values, packages=finder, xacro=True, partly=True).problems
    except LinkwrightError:
        return False


def _label(values: Mapping[str, str], sets: Sequence[Mapping[str, str]]) -> str:
    """Return a label for an argument set: its values for the arguments in which the sets differ."""
    apart = [name for name in values if any(other.get(name) != values[name] for other in sets)]
    return " ".join(f"{name}:={values[name]}" for name in apart or values)
