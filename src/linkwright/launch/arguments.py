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
from linkwright.launch.model.declared_arguments import undeclared_names
from linkwright.launch.model.description import LaunchDescription
from linkwright.launch.model.substitution import describe
from linkwright.process.assignments import parse_assignments

UNDECLARED = frozenset({"launch-prefix", "sigterm_timeout", "sigkill_timeout", "emulate_tty", "ros_namespace"})
"""Launch configurations that have an effect without being declared."""


def parse_arguments(words: Iterable[str]) -> dict[str, str]:
    """Parse launch arguments into a mapping of names to values.

    The last value of a repeated name wins.

    Raises:
        LinkwrightError: LAUNCH111, listing all arguments that are not of the form ``name:=value``.
    """
    return parse_assignments(words, _malformed)


def _malformed(word: str, hint: Phrase) -> Diagnostic:
    return Diagnostic("LAUNCH111", phrase("malformed launch argument '{word}'", word=word), hint=hint)


def check_arguments(description: LaunchDescription, given: Mapping[str, str]) -> list[Diagnostic]:
    """Check the arguments against the declarations of the launch file, before anything starts.

    Returns:
        Warnings (LAUNCH113) about undeclared arguments. As in ROS, these arguments are still set.

    Raises:
        LinkwrightError: LAUNCH112 and LAUNCH114, listing all invalid values and all missing arguments.
    """
    declared = description.get_launch_arguments()
    names = [argument.name for argument in declared]
    undeclared = undeclared_names(description.entities, [name for name in given if name not in UNDECLARED])
    errors: list[Diagnostic] = []
    for argument in declared:
        value = given.get(argument.name)
        if value is not None and argument.choices is not None and not argument.conditionally_included:
            errors += _argument_errors(argument, given)
        elif value is None and argument.default_value is None and not argument.conditionally_included:
            errors += [_misspelt(argument.name, undeclared, error) for error in _argument_errors(argument, given)]
    if errors:
        raise LinkwrightError(*errors)
    return [_undeclared(name, names) for name in undeclared]


def _argument_errors(argument: DeclareLaunchArgument, given: Mapping[str, str]) -> Sequence[Diagnostic]:
    from linkwright.launch.model.context import LaunchContext

    context = LaunchContext()
    context.launch_configurations.update(given)
    try:
        argument.execute(context)
    except LinkwrightError as error:
        return error.diagnostics
    return ()


def _misspelt(name: str, undeclared: Sequence[str], error: Diagnostic) -> Diagnostic:
    """Add a hint on a similar undeclared argument, if any, to the error for a missing argument."""
    near = nearest(name, undeclared, limit=1)
    return (
        error.with_changes(hint=phrase("'{near}' is given; did you mean '{name}'?", near=near[0], name=name))
        if near
        else error
    )


def _undeclared(name: str, declared: Sequence[str]) -> Diagnostic:
    hint = did_you_mean(name, declared)
    if hint is None:
        hint = (
            phrase("it declares {names}", names=quoted_names(declared))
            if declared
            else phrase("it declares no arguments")
        )
    message = phrase("argument '{name}' is not declared by the launch file", name=name)
    return Diagnostic("LAUNCH113", message, severity=Severity.WARNING, hint=hint)


def format_arguments(description: LaunchDescription) -> str:
    """Return the text that ``ros2 launch --show-args`` prints.

    The text lists the names, descriptions and defaults of the declared arguments.
    """
    lines = ["Arguments (pass arguments as '<name>:=<value>'):"]
    declared = description.get_launch_arguments()
    for argument in declared:
        lines += ["", f"    '{argument.name}':{'*' if argument.conditionally_included else ''}"]
        lines.append(f"        {argument.description}")
        if argument.default_value is not None:
            lines.append(f"        (default: {describe(argument.default_value)})")
    if not declared:
        lines += ["", "  No arguments."]
    if any(argument.conditionally_included for argument in declared):
        lines += ["", "* argument(s) which are only used if specific conditions occur"]
    return "\n".join(lines)
