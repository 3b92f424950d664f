"""The form for the arguments without which a description cannot be expanded."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from typing import TYPE_CHECKING

from linkwright.diagnostics import Diagnostic, LinkwrightError
from linkwright.hosting.xacro_calls import XacroCall
from linkwright.packages import PackageFinder

if TYPE_CHECKING:
    from linkwright.page.protocol.description import ArgumentForm

_MAX_TRIED_SETS = 12
"""The maximum number of argument sets that are tried, because users do not choose between more."""


def create_argument_form(call: XacroCall, finder: PackageFinder, findings: Iterable[Diagnostic]) -> ArgumentForm | None:
    """Return the arguments that a description needs, with argument sets for its expansion.

    The description is expanded with each argument set, which takes time, so call this function in another thread.

    Args:
        call: the xacro call that failed.
        finder: the finder of ROS packages.
        findings: the errors of the failed call.

    Returns:
        The form, or None if no argument is known to change the result.
    """
    from linkwright.descriptions.argument_sets import argument_sets
    from linkwright.lint.argument_sets import find_undeclared_argument
    from linkwright.page.protocol.description import ArgumentChoice, ArgumentForm

    if call.path.suffix == ".sdf":
        return None
    given_values = dict(call.arguments)
    expandable_sets: list[dict[str, str]] = []
    for argument_set in argument_sets(call.path, finder)[:_MAX_TRIED_SETS]:
        values = {**given_values, **argument_set.values}
        if argument_set.values and values not in expandable_sets and _can_expand(call, values, finder):
            expandable_sets.append(values)
    missing_names = [name for finding in findings if (name := find_undeclared_argument(finding))]
    names = list(
        dict.fromkeys(
            [
                *missing_names,
                *(name for values in expandable_sets for name in values),
                *(given_values if missing_names else ()),
            ]
        )
    )
    if not names:
        return None
    choices = [ArgumentChoice(_create_label(values, expandable_sets), values) for values in expandable_sets]
    return ArgumentForm(call.path.name, names, expandable_sets[0] if expandable_sets else given_values, choices)


def _can_expand(call: XacroCall, values: Mapping[str, str], finder: PackageFinder) -> bool:
    from linkwright.descriptions import examine

    try:
        return not examine(call.path, arguments=values, packages=finder, xacro=True, partly=True).problems
    except LinkwrightError:
        return False


def _create_label(values: Mapping[str, str], sets: Sequence[Mapping[str, str]]) -> str:
    """Return a label for an argument set.

    The label contains the values of the arguments in which the sets differ.
    """
    differing_names = [name for name in values if any(other_values.get(name) != values[name] for other_values in sets)]
    return " ".join(f"{name}:={values[name]}" for name in differing_names or values)
