"""The substitution that runs a command.

xacro commands run in the launcher's process, so that their errors have locations.
"""

from __future__ import annotations

import shlex
import subprocess
from pathlib import Path
from typing import TYPE_CHECKING

from linkwright.diagnostics import Diagnostic, LinkwrightError, Phrase, Severity, foreign, joined, phrase
from linkwright.hosting.xacro_calls import Descriptions
from linkwright.launch.errors.exceptions import SubstitutionFailure
from linkwright.launch.errors.locations import error_at, with_location
from linkwright.launch.model.context import LaunchContext
from linkwright.launch.model.declared_substitution import (
    DeclaredSubstitution,
    Texts,
)
from linkwright.launch.model.substitution import (
    perform_substitutions,
)
from linkwright.launch.model.substitutions.hosted_parameters import read_hosted_parameter
from linkwright.launch.model.xacro_arguments import parse_xacro_arguments
from linkwright.packages import current_finder

if TYPE_CHECKING:
    from linkwright.hosting.xacro_calls import XacroCall

_STDERR_MODES = ("fail", "warn", "ignore", "capture")


class Command(DeclaredSubstitution, tag="command", shown="Command({command})"):
    """A substitution that evaluates to the standard output of a command.

    Args:
        command: the program and its arguments, quoted as in a shell.
        on_stderr: the effect of output to stderr: ``fail`` (the default), ``warn``, ``ignore``, or ``capture`` to
            append the output to the result.
    """

    command: Texts = Texts()
    on_stderr: Texts = Texts(default="fail", kw_only=True)

    @classmethod
    def wrong_count_error(cls, expected: str, argument_count: int) -> Exception:
        """Return a ValueError for a wrong number of arguments, as ROS does."""
        return ValueError(*super().wrong_count_error(expected, argument_count).args)

    def perform(self, context: LaunchContext) -> str:
        """Run the command, and return its standard output.

        Raises:
            DescriptionError: the command is xacro, and the robot description has errors.
            LinkwrightError: LAUNCH128 or LAUNCH129, the command is invalid, cannot be run or fails.
        """
        text = perform_substitutions(context, self.command)
        try:
            arguments = shlex.split(text)
        except ValueError as error:
            raise error_at(
                self.source_location,
                "LAUNCH128",
                phrase("command '{text}' cannot be split into arguments: {error}", text=text, error=foreign(error)),
            ) from error
        if not arguments:
            raise error_at(self.source_location, "LAUNCH128", phrase("the command is empty"))
        xacro_arguments = _find_xacro_arguments(arguments)
        if xacro_arguments is not None:
            skipped_count = len(arguments) - len(xacro_arguments)
            argument_text = text.split(None, skipped_count)[skipped_count:]
            return self._expand_xacro(context, xacro_arguments, argument_text[0] if argument_text else "")
        output = read_hosted_parameter(context.session.host, arguments) if context.is_running else None
        return self._run(context, text, arguments) if output is None else output

    def _expand_xacro(self, context: LaunchContext, words: list[str], argument_text: str) -> str:
        try:
            call, warning = parse_xacro_arguments(words, argument_text, Path.cwd())
        except LinkwrightError as error:
            raise with_location(error, self.source_location) from error
        if warning:
            self._warn(
                context,
                "LAUNCH128",
                warning,
                phrase("put quotes around a path with spaces: Command(['xacro \"', path, '\"'])"),
            )
        return _expand_call(context, call)

    def _run(self, context: LaunchContext, text: str, words: list[str]) -> str:
        mode = perform_substitutions(context, self.on_stderr)
        if mode not in _STDERR_MODES:
            message = phrase("'on_stderr' is '{value}', not one of 'fail', 'warn', 'ignore', 'capture'", value=mode)
            ros_error = SubstitutionFailure(
                f"expected 'on_stderr' to be one of: ['fail', 'ignore', 'warn', 'capture'], got '{mode}'"
            )
            raise error_at(self.source_location, "LAUNCH129", message, ros_error=ros_error)
        try:
            process = subprocess.run(  # noqa: S603 - the launch file's command
                words, check=False, capture_output=True, text=True, errors="replace", env=dict(context.environment)
            )
        except OSError as error:
            message = phrase(
                "command '{text}' cannot be run, because program '{program}' does not start: {strerror}",
                text=text,
                strerror=foreign(error.strerror or error),
                program=words[0],
            )
            ros_error = SubstitutionFailure(f"file not found: {error}")
            hint = phrase("write a space after 'xacro'") if words[0].startswith("xacro/") else None
            raise error_at(self.source_location, "LAUNCH129", message, hint, ros_error=ros_error) from error
        if process.returncode != 0:
            message = _append_output(
                phrase("command '{text}' failed with exit status {status}", text=text, status=process.returncode),
                process.stderr,
            )
            ros_error = SubstitutionFailure(
                f"executed command failed. Command: {text}\nCaptured stderr output: {process.stderr}"
            )
            raise error_at(self.source_location, "LAUNCH129", message, ros_error=ros_error)
        if process.stderr and mode == "fail":
            message = _append_output(phrase("command '{text}' wrote to stderr", text=text), process.stderr)
            hint = phrase("if that is not an error, pass on_stderr='warn' to Command")
            ros_error = SubstitutionFailure(
                f"executed command showed stderr output. Command: {text}\nCaptured stderr output:\n{process.stderr}"
            )
            raise error_at(self.source_location, "LAUNCH129", message, hint, ros_error=ros_error)
        if process.stderr and mode == "warn":
            message = _append_output(phrase("command '{text}' wrote to stderr", text=text), process.stderr)
            self._warn(context, "LAUNCH129", message)
        return process.stdout + process.stderr if mode == "capture" else process.stdout

    def _warn(self, context: LaunchContext, code: str, message: Phrase, hint: Phrase | None = None) -> None:
        source = self.source_location.source() if self.source_location else None
        span = self.source_location.span(source) if self.source_location else None
        context.warn(Diagnostic(code, message, span, Severity.WARNING, hint=hint, source=source))


def _find_xacro_arguments(words: list[str]) -> list[str] | None:
    """Return the arguments of a ``xacro`` command, or None if the command runs another program."""
    if words[:3] == ["ros2", "run", "xacro"] and words[3:4] == ["xacro"]:
        return words[4:]
    if Path(words[0]).name == "xacro":
        return words[1:]
    return None


def _expand_call(context: LaunchContext, call: XacroCall) -> str:
    descriptions = context.descriptions or Descriptions(current_finder())
    text = descriptions.expand(call)
    context.report_findings(call, descriptions.get_warnings(call))
    return text


def _append_output(message: Phrase, output: str) -> Phrase:
    return joined([message, output.strip()], ":\n") if output.strip() else message
