"""Launch arguments in the form ``name:=value``."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence

from linkwright.diagnostics import (
    Diagnostic,
    LinkwrightError,
    Phrase,
    Severity,
    did_you_mean,
    nearest,
    phrase,
    quoted_names,
)
from linkwright.launch.model.actions import DeclareLaunchArgument
from linkwright.launch.model.declared_arguments import find_undeclared_names
from linkwright.launch.model.description import LaunchDescription
from linkwright.launch.model.substitution import describe
from linkwright.process.assignments import parse_assignments

UNDECLARED = frozenset({"launch-prefix", "sigterm_timeout", "sigkill_timeout", "emulate_tty", "ros_namespace"})
"""Launch configurations that have an effect even if they are not declared."""


def parse_arguments(words: Iterable[str]) -> dict[str, str]:
    """Return a mapping of names to values for launch arguments in the form ``name:=value``.

    If a name is repeated, the last value counts.

    Raises:
        LinkwrightError: LAUNCH111, some arguments do not have this form; the error lists all of them.
    """
    return parse_assignments(words, _malformed_error)


def _malformed_error(argument: str, hint: Phrase) -> Diagnostic:
    return Diagnostic("LAUNCH111", phrase("launch argument '{argument}' is malformed", argument=argument), hint=hint)


def check_arguments(description: LaunchDescription, values: Mapping[str, str]) -> list[Diagnostic]:
    """Check launch arguments before the launch starts, and return warnings.

    Returns:
        Warnings (LAUNCH113) about undeclared arguments. As in ROS, these are still set.

    Raises:
        LinkwrightError: LAUNCH112 and LAUNCH114, values are not valid or arguments are missing; the error lists all.
    """
    declared_arguments = description.get_launch_arguments()
    declared_names = [argument.name for argument in declared_arguments]
    undeclared = find_undeclared_names(description.entities, [name for name in values if name not in UNDECLARED])
    errors: list[Diagnostic] = []
    for argument in declared_arguments:
        value = values.get(argument.name)
        if value is not None and argument.choices is not None and not argument.conditionally_included:
            errors += _find_argument_errors(argument, values)
        elif value is None and argument.default_value is None and not argument.conditionally_included:
            errors += [
                _misspelled_argument_error(argument.name, undeclared, error)
                for error in _find_argument_errors(argument, values)
            ]
    if errors:
        raise LinkwrightError(*errors)
    return [_undeclared_warning(name, declared_names) for name in undeclared]


def _find_argument_errors(argument: DeclareLaunchArgument, values: Mapping[str, str]) -> Sequence[Diagnostic]:
    from linkwright.launch.model.context import LaunchContext

    context = LaunchContext()
    context.launch_configurations.update(values)
    try:
        argument.execute(context)
    except LinkwrightError as error:
        return error.diagnostics
    return ()


def _misspelled_argument_error(name: str, undeclared: Sequence[str], error: Diagnostic) -> Diagnostic:
    """Return the error for a missing argument.

    If a similar undeclared argument was passed, the error has a hint.
    """
    similar_names = nearest(name, undeclared, limit=1)
    return (
        error.with_changes(
            hint=phrase("did you mean '{name}' instead of '{given_name}'?", given_name=similar_names[0], name=name)
        )
        if similar_names
        else error
    )


def _undeclared_warning(name: str, declared_names: Sequence[str]) -> Diagnostic:
    hint = did_you_mean(name, declared_names)
    if hint is None:
        hint = (
            phrase("the launch file declares {names}", names=quoted_names(declared_names))
            if declared_names
            else phrase("the launch file declares no arguments")
        )
    message = phrase("argument '{name}' is not declared by the launch file", name=name)
    return Diagnostic("LAUNCH113", message, severity=Severity.WARNING, hint=hint)


def format_arguments(description: LaunchDescription) -> str:
    """Return the text that ``ros2 launch --show-args`` prints for a launch description.

    The text contains the names, descriptions and default values of the declared arguments.
    """
    lines = ["Arguments (pass arguments as '<name>:=<value>'):"]
    declared_arguments = description.get_launch_arguments()
    for argument in declared_arguments:
        lines += ["", f"    '{argument.name}':{'*' if argument.conditionally_included else ''}"]
        lines.append(f"        {argument.description}")
        if argument.default_value is not None:
            lines.append(f"        (default: {describe(argument.default_value)})")
    if not declared_arguments:
        lines += ["", "  No arguments."]
    if any(argument.conditionally_included for argument in declared_arguments):
        lines += ["", "* argument(s) which are only used if specific conditions occur"]
    return "\n".join(lines)
