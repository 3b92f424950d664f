"""Substitutions written inside text, ``$(var NAME)``, as parameter files may have them."""

from __future__ import annotations

import os
import re
import shlex
from collections.abc import Callable
from pathlib import Path

from linkwright.diagnostics import Diagnostic, LinkwrightError, SourceText, did_you_mean
from linkwright.launch.context import LaunchContext
from linkwright.workspace import current_finder

_SUBSTITUTION = re.compile(r"\$\(([^()$]*)\)")


def substitute_text(text: str, context: LaunchContext, source: SourceText) -> str:
    """The text with its substitutions made, those inside others first.

    Raises:
        LinkwrightError: LAUNCH133 for one that is unknown, or that has no value; with its place in the
        source.
    """

    def replaced(match: re.Match[str]) -> str:
        try:
            return _perform(match.group(1), context, source)
        except LinkwrightError as error:
            start = source.text.find(match.group(0))
            span = source.span(start, start + len(match.group(0))) if start >= 0 else None
            first = error.diagnostics[0]
            raise LinkwrightError(
                Diagnostic(first.code, first.message, span, notes=first.notes, hint=first.hint, source=source)
            ) from error

    previous = None
    while previous != text:
        previous, text = text, _SUBSTITUTION.sub(replaced, text)
    return text


def _perform(inside: str, context: LaunchContext, source: SourceText) -> str:
    try:
        name, *arguments = shlex.split(inside)
    except ValueError:
        name, arguments = "", []
    function = _FUNCTIONS.get(name)
    if function is None:
        raise _error(f"substitution '$({inside})' is unknown", did_you_mean(name, _FUNCTIONS))
    if not arguments and name != "dirname":
        raise _error(f"substitution '$({inside})' needs a name")
    return function(arguments, context, source)


def _variable(arguments: list[str], context: LaunchContext, _: SourceText) -> str:
    known = context.launch_configurations
    if arguments[0] in known:
        return str(known[arguments[0]])
    if len(arguments) > 1:
        return arguments[1]
    raise _error(f"launch configuration '{arguments[0]}' is not set", did_you_mean(arguments[0], known))


def _environment(arguments: list[str], context: LaunchContext, _: SourceText) -> str:
    if arguments[0] in context.environment:
        return context.environment[arguments[0]]
    if len(arguments) > 1:
        return arguments[1]
    raise _error(f"environment variable '{arguments[0]}' is not set")


def _package_share(arguments: list[str], _: LaunchContext, __: SourceText) -> str:
    return str(current_finder().share(arguments[0]))


def _folder(_: list[str], context: LaunchContext, source: SourceText) -> str:
    folder = context.get_locals_as_dict().get("current_launch_file_directory")
    return str(folder or os.fspath(Path(source.name).parent))


_FUNCTIONS: dict[str, Callable[[list[str], LaunchContext, SourceText], str]] = {
    "var": _variable,
    "env": _environment,
    "find-pkg-share": _package_share,
    "dirname": _folder,
}


def _error(message: str, hint: str | None = None) -> LinkwrightError:
    return LinkwrightError(Diagnostic("LAUNCH133", message, hint=hint))
