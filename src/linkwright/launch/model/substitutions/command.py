"""The substitution that runs a command.

xacro commands are expanded in this process, so that their errors have locations.
"""

from __future__ import annotations

import shlex
import subprocess
from pathlib import Path
from typing import TYPE_CHECKING

from linkwright.diagnostics import Diagnostic, LinkwrightError, Phrase, Severity, foreign, joined, phrase
from linkwright.hosting.xacro_calls import Descriptions
from linkwright.launch.errors.exceptions import SubstitutionFailure
from linkwright.launch.errors.places import error_at, located
from linkwright.launch.model.context import LaunchContext
from linkwright.launch.model.declared_substitution import (
    DeclaredSubstitution,
    Texts,
)
from linkwright.launch.model.substitution import (
    perform_substitutions,
)
from linkwright.launch.model.xacro_words import parse_xacro_arguments
from linkwright.packages import current_finder

if TYPE_CHECKING:
    from linkwright.hosting.xacro_calls import XacroCall

_ON_STDERR = ("fail", "warn", "ignore", "capture")


class Command(DeclaredSubstitution, tag="command", shown="Command({command})"):
    """The standard output of a command.

    Args:
        command: program and arguments, quoted as in a shell.
        on_stderr: the reaction to output on stderr: ``fail`` (the default), ``warn``, ``ignore`` or ``capture`` (append
            the output to the result).
    """

    command: Texts = Texts()
    on_stderr: Texts = Texts(default="fail", kw_only=True)

    @classmethod
    def wrong_count(cls, expected: str, given: int) -> Exception:
        """Return a ValueError, as ROS does."""
        return ValueError(*super().wrong_count(expected, given).args)

    def perform(self, context: LaunchContext) -> str:
        """Run the command, and return its output.

        Raises:
            DescriptionError: the command is xacro, and the model has errors.
            LinkwrightError: LAUNCH128 or LAUNCH129, the command is invalid, cannot be run or fails.
        """
        text = perform_substitutions(context, self.command)
        try:
            words = shlex.split(text)
        except ValueError as error:
            raise error_at(
                self.place,
                "LAUNCH128",
                phrase("command '{text}' cannot be split: {error}", text=text, error=foreign(error)),
            ) from error
        if not words:
            raise error_at(self.place, "LAUNCH128", phrase("the command is empty"))
        after_xacro = _xacro_arguments(words)
        if after_xacro is not None:
            before = len(words) - len(after_xacro)
            written = text.split(None, before)[before:]
            return self._expand(context, after_xacro, written[0] if written else "")
        return self._run(context, text, words)

    def _expand(self, context: LaunchContext, words: list[str], written: str) -> str:
        try:
            call, remark = parse_xacro_arguments(words, written, Path.cwd())
        except LinkwrightError as error:
            raise located(error, self.place) from error
        if remark:
            self._warn(context, "LAUNCH128", remark, phrase("put quotes around it: Command(['xacro \"', path, '\"'])"))
        return _expand(context, call)

    def _run(self, context: LaunchContext, text: str, words: list[str]) -> str:
        rule = perform_substitutions(context, self.on_stderr)
        if rule not in _ON_STDERR:
            message = phrase("'on_stderr' is '{rule}', not one of 'fail', 'warn', 'ignore', 'capture'", rule=rule)
            ros_error = SubstitutionFailure(
                f"expected 'on_stderr' to be one of: ['fail', 'ignore', 'warn', 'capture'], got '{rule}'"
            )
            raise error_at(self.place, "LAUNCH129", message, ros_error=ros_error)
        try:
            done = subprocess.run(  # noqa: S603 - the launch file's command
                words, check=False, capture_output=True, text=True, errors="replace", env=dict(context.environment)
            )
        except OSError as error:
            message = phrase(
                "command '{text}' cannot be run: {strerror}: '{words}'",
                text=text,
                strerror=foreign(error.strerror or error),
                words=words[0],
            )
            ros_error = SubstitutionFailure(f"file not found: {error}")
            raise error_at(self.place, "LAUNCH129", message, ros_error=ros_error) from error
        if done.returncode != 0:
            message = _append_output(
                phrase("command '{text}' failed with exit status {status}", text=text, status=done.returncode),
                done.stderr,
            )
            ros_error = SubstitutionFailure(
                f"executed command failed. Command: {text}\nCaptured stderr output: {done.stderr}"
            )
            raise error_at(self.place, "LAUNCH129", message, ros_error=ros_error)
        if done.stderr and rule == "fail":
            message = _append_output(phrase("command '{text}' wrote to stderr", text=text), done.stderr)
            hint = phrase("if that is not an error, pass on_stderr='warn' to Command")
            ros_error = SubstitutionFailure(
                f"executed command showed stderr output. Command: {text}\nCaptured stderr output:\n{done.stderr}"
            )
            raise error_at(self.place, "LAUNCH129", message, hint, ros_error=ros_error)
        if done.stderr and rule == "warn":
            message = _append_output(phrase("command '{text}' wrote to stderr", text=text), done.stderr)
            self._warn(context, "LAUNCH129", message)
        return done.stdout + done.stderr if rule == "capture" else done.stdout

    def _warn(self, context: LaunchContext, code: str, message: Phrase, hint: Phrase | None = None) -> None:
        source = self.place.source() if self.place else None
        span = self.place.span(source) if self.place else None
        context.warn(Diagnostic(code, message, span, Severity.WARNING, hint=hint, source=source))


def _xacro_arguments(words: list[str]) -> list[str] | None:
    """Return the arguments of a ``xacro`` command, or None if the command runs another program."""
    if words[:3] == ["ros2", "run", "xacro"] and words[3:4] == ["xacro"]:
        return words[4:]
    if Path(words[0]).name == "xacro":
        return words[1:]
    return None


def _expand(context: LaunchContext, call: XacroCall) -> str:
    descriptions = context.descriptions or Descriptions(current_finder())
    text = descriptions.expand(call)
    context.report_findings(call, descriptions.warnings_of(call))
    return text


def _append_output(message: Phrase, output: str) -> Phrase:
    return joined([message, output.strip()], ":\n") if output.strip() else message
