"""Parser for the arguments of rqt's programs that open a panel of the page."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field

from linkwright.diagnostics import Diagnostic, LinkwrightError, Phrase, Severity, did_you_mean, phrase
from linkwright.hosting.rqt_perspectives import read_perspective
from linkwright.hosting.rqt_programs import PanelProgram, find_program_of_plugin, find_replacement

_IGNORED_OPTIONS: Mapping[str, int] = {
    "-f": 0,
    "--freeze-layout": 0,
    "--force-discover": 0,
    "-l": 0,
    "--lock-perspective": 0,
    "-ht": 0,
    "--hide-title": 0,
    "-t": 0,
    "--on-top": 0,
    "-m": 0,
    "--multi-thread": 0,
    "-q": 0,
    "--quiet": 0,
    "-v": 0,
    "--verbose": 0,
    "--clear-config": 0,
    "--qt-binding": 1,
}
"""The options of all programs of rqt that have no effect here, each with the number of its values."""

_PERSPECTIVE_OPTIONS = ("-p", "--perspective")
_PERSPECTIVE_FILE_OPTION = "--perspective-file"
_STANDALONE_OPTIONS = ("-s", "--standalone")
_OPTIONS_WITH_VALUE = (*_STANDALONE_OPTIONS, *_PERSPECTIVE_OPTIONS, _PERSPECTIVE_FILE_OPTION)
_PLUGIN_ARGUMENTS = "--args"

_POSITIONAL_ARGUMENTS = {
    "": "",
    "topic": " [TOPIC]",
    "fields": " [TOPIC/FIELD[:FIELD ...] ...]",
    "node": " [NODE]",
    "recordings": " [FILE ...]",
}


@dataclass
class RqtArguments:
    """The arguments of a program of rqt.

    Attributes:
        program: the program whose panel opens, which an option may select.
        values: the positional arguments: a topic, fields to plot, a node, or recordings.
        perspective: the programs of the plugins in a perspective file, with their topics or fields.
        findings: the findings about arguments without an effect.
    """

    program: PanelProgram
    values: list[str] = field(default_factory=list)
    perspective: list[tuple[PanelProgram, list[str]]] = field(default_factory=list)
    findings: list[Diagnostic] = field(default_factory=list)

    def warn(self, message: Phrase, hint: Phrase | None = None) -> None:
        """Add a finding about an argument."""
        self.findings.append(Diagnostic("LAUNCH144", message, hint=hint).with_changes(severity=Severity.WARNING))


def format_usage(executable: str, program: PanelProgram) -> str:
    """Return the help text of a program.

    Args:
        executable: the name of the executable in its package.
        program: the program of rqt and its panel.
    """
    plugin = "" if program.panel else " [-s PLUGIN]"
    return f"""\
usage: {executable}{plugin}{_POSITIONAL_ARGUMENTS[program.positional_kind]} [--ros-args ...]

Opens the page with the panel that replaces the window of {executable}.
"""


def read_rqt_arguments(executable: str, program: PanelProgram, arguments: Sequence[str]) -> RqtArguments:
    """Return the arguments of a program of rqt.

    Arguments without an effect are findings.

    Args:
        executable: the name of the executable in its package.
        program: the program of rqt and its panel.
        arguments: the command line without ROS arguments.
    """
    parsed = RqtArguments(program)
    is_for_plugin = False
    remaining_arguments = iter(arguments)
    for argument in remaining_arguments:
        ignored_options = {**_IGNORED_OPTIONS, **parsed.program.ignored_options}
        known_options = (*_OPTIONS_WITH_VALUE, *ignored_options)
        if argument == _PLUGIN_ARGUMENTS and not is_for_plugin:
            is_for_plugin = True
        elif argument in ignored_options:
            for _ in range(ignored_options[argument]):
                next(remaining_arguments, None)
        elif argument in _OPTIONS_WITH_VALUE:
            value = next(remaining_arguments, None)
            if value is None:
                parsed.warn(
                    phrase("argument '{argument}' of {program} needs a value", argument=argument, program=executable)
                )
            elif argument in _STANDALONE_OPTIONS:
                _select_plugin(parsed, value)
            elif argument == _PERSPECTIVE_FILE_OPTION:
                _add_perspective(parsed, value)
            else:
                parsed.warn(
                    phrase("{program} ignores the perspective '{value}'", program=executable, value=value),
                    phrase("arrange the panels in the page, which keeps the arrangement"),
                )
        elif argument and not argument.startswith("-") and _accepts_another_value(parsed):
            parsed.values.append(argument)
        elif argument:
            parsed.warn(
                phrase("{program} has no argument '{argument}'", program=executable, argument=argument),
                did_you_mean(argument, known_options),
            )
    return parsed


def _accepts_another_value(parsed: RqtArguments) -> bool:
    return parsed.program.positional_kind in ("fields", "recordings") or (
        parsed.program.positional_kind != "" and not parsed.values
    )


def _select_plugin(parsed: RqtArguments, plugin: str) -> None:
    program = find_program_of_plugin(plugin)
    if program is None:
        _warn_of_plugin(parsed, plugin)
    else:
        parsed.program = program


def _add_perspective(parsed: RqtArguments, path: str) -> None:
    """Add the plugins of a perspective file whose panels the page has."""
    try:
        plugins = read_perspective(path)
    except LinkwrightError as error:
        parsed.findings.extend(diagnostic.with_changes(severity=Severity.WARNING) for diagnostic in error.diagnostics)
        return
    for plugin, values in plugins:
        program = find_program_of_plugin(plugin)
        if program is None:
            _warn_of_plugin(parsed, plugin)
        else:
            parsed.perspective.append((program, values))


def _warn_of_plugin(parsed: RqtArguments, plugin: str) -> None:
    parsed.warn(phrase("the page has no panel for the rqt plugin '{plugin}'", plugin=plugin), find_replacement(plugin))
