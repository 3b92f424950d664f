"""The list of a description's arguments as text for a terminal."""

from __future__ import annotations

import re
from collections.abc import Iterable

from linkwright.diagnostics import Diagnostic, Note, Severity, phrase
from linkwright.xacro.tracing.arguments import Argument, Arguments
from linkwright.xacro.tracing.provenance_text import format_location


def format_arguments(arguments: tuple[Argument, ...]) -> str:
    """Return a line for each argument: name, default, location, and remarks."""
    if not arguments:
        return "the file has no arguments\n"
    name_width = max(len(argument.name) for argument in arguments)
    default_width = min(max(len(_format_default(argument)) for argument in arguments), 40)
    lines = []
    for argument in arguments:
        remarks = "".join(f"  {remark}" for remark in _list_remarks(argument))
        lines.append(
            f"{argument.name:{name_width}}  {_format_default(argument):{default_width}}  "
            f"{format_location(argument.span)}{remarks}"
        )
    return "".join(f"{line.rstrip()}\n" for line in lines)


def find_incompleteness(findings: Arguments) -> list[Diagnostic]:
    """Return a warning that the list of arguments may be incomplete.

    The list is empty if the expansion finished.
    """
    if not findings.problems:
        return []
    first_problem = findings.problems[0]
    message = phrase(
        "the list of arguments may be incomplete because the file cannot be expanded with the arguments given"
    )
    suspected_arguments = _find_arguments_causing(findings.arguments, first_problem.message)
    required = [
        f"{argument.name}:=..."
        for argument in suspected_arguments or findings.arguments
        if suspected_arguments or argument.required
    ]
    hint = phrase("pass {required}", required=" ".join(required)) if required else None
    notes = (Note(first_problem.message), *first_problem.notes)
    return [Diagnostic("XAC803", message, first_problem.span, Severity.WARNING, notes, hint, first_problem.source)]


def _find_arguments_causing(arguments: Iterable[Argument], message: str) -> list[Argument]:
    """Return the arguments whose defaults occur in an error message, as in a missing file."""
    return [
        argument
        for argument in arguments
        if argument.default
        and not argument.is_given
        and "$" not in argument.default
        and re.search(rf"(?<!\w){re.escape(argument.default)}(?!\w)", message)
    ]


def _format_default(argument: Argument) -> str:
    if argument.required:
        return "required"
    return "no default" if argument.default is None else f'"{argument.default}"'


def _list_remarks(argument: Argument) -> list[str]:
    remarks = []
    if argument.is_given:
        remarks.append(f'given "{argument.value}"')
    elif argument.required and argument.default is not None:
        remarks.append(f'used before its default "{argument.default}" is declared')
    elif argument.default is None:
        remarks.append("not declared")
    elif argument.value is not None and argument.value != argument.default:
        remarks.append(f'which is "{argument.value}"')
    if not argument.used:
        remarks.append("not used")
    return remarks
