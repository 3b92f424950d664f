"""The substitution that runs a command. xacro is expanded inside this process, so that positions are kept."""

from __future__ import annotations

import shlex
import subprocess
from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any

from linkwright.diagnostics import Diagnostic, LinkwrightError, Severity
from linkwright.launch.context import LaunchContext
from linkwright.launch.engine.descriptions import Descriptions, parse_xacro_words
from linkwright.launch.frontend.expose import expose_substitution
from linkwright.launch.places import error_at, located
from linkwright.launch.substitution import (
    SomeSubstitutionsType,
    Substitution,
    SubstitutionFailure,
    describe,
    normalize_to_list_of_substitutions,
    perform_substitutions,
)
from linkwright.workspace import current_finder

if TYPE_CHECKING:
    from linkwright.launch.engine.descriptions import XacroCall

_ON_STDERR = ("fail", "warn", "ignore", "capture")


@expose_substitution("command")
class Command(Substitution):
    """What a command writes to stdout.

    Args:
        command: program and arguments, as in a shell.
        on_stderr: what it means that the command writes to stderr: ``fail`` (the default), ``warn``,
        ``ignore``
            or ``capture`` (the text is given after that of stdout).
    """

    def __init__(self, command: SomeSubstitutionsType | Path, *, on_stderr: SomeSubstitutionsType = "fail") -> None:
        self._command = normalize_to_list_of_substitutions(command)
        self._on_stderr = normalize_to_list_of_substitutions(on_stderr)

    @classmethod
    def parse(cls, data: Sequence[Any]) -> tuple[type[Substitution], dict[str, Any]]:
        """The class and its arguments, for a command and perhaps the rule for stderr.

        Raises:
            ValueError: there are none, or more.
        """
        if len(data) not in (1, 2):
            raise ValueError("command substitution expects 1 or 2 arguments")
        return cls, {"command": data[0]} if len(data) == 1 else {"command": data[0], "on_stderr": data[1]}

    @property
    def command(self) -> list[Substitution]:
        """The command, as substitutions."""
        return self._command

    @property
    def on_stderr(self) -> list[Substitution]:
        """The rule for stderr, as substitutions."""
        return self._on_stderr

    def describe(self) -> str:
        """The command."""
        return f"Command({describe(self._command)})"

    def perform(self, context: LaunchContext) -> str:
        """The output.

        Raises:
            DescriptionError: if it is xacro, and the model is wrong.
            LinkwrightError: LAUNCH128 or LAUNCH129, if the command cannot be run or fails.
        """
        text = perform_substitutions(context, self._command)
        try:
            words = shlex.split(text)
        except ValueError as error:
            raise error_at(self.place, "LAUNCH128", f"command '{text}' cannot be split: {error}") from error
        if not words:
            raise error_at(self.place, "LAUNCH128", "the command is empty")
        after_xacro = _words_of_xacro(words)
        if after_xacro is not None:
            before = len(words) - len(after_xacro)
            written = text.split(None, before)[before:]
            return self._expand(context, after_xacro, written[0] if written else "")
        return self._run(context, text, words)

    def _expand(self, context: LaunchContext, words: list[str], written: str) -> str:
        try:
            call, remark = parse_xacro_words(words, written, Path.cwd())
        except LinkwrightError as error:
            raise located(error, self.place) from error
        if remark:
            self._warn(context, "LAUNCH128", remark, "put quotes around it: Command(['xacro \"', path, '\"'])")
        return _expand(context, call)

    def _run(self, context: LaunchContext, text: str, words: list[str]) -> str:
        rule = perform_substitutions(context, self._on_stderr)
        if rule not in _ON_STDERR:
            message = f"'on_stderr' is '{rule}', not one of 'fail', 'warn', 'ignore', 'capture'"
            promised = SubstitutionFailure(
                f"expected 'on_stderr' to be one of: ['fail', 'ignore', 'warn', 'capture'], got '{rule}'"
            )
            raise error_at(self.place, "LAUNCH129", message, promises=promised)
        try:
            done = subprocess.run(  # noqa: S603 - running what the launch file says is the task
                words, check=False, capture_output=True, text=True, errors="replace", env=dict(context.environment)
            )
        except OSError as error:
            message = f"command '{text}' cannot be run: {error.strerror or error}: '{words[0]}'"
            promised = SubstitutionFailure(f"file not found: {error}")
            raise error_at(self.place, "LAUNCH129", message, promises=promised) from error
        if done.returncode != 0:
            message = f"command '{text}' failed with exit status {done.returncode}{_quoted(done.stderr)}"
            promised = SubstitutionFailure(
                f"executed command failed. Command: {text}\nCaptured stderr output: {done.stderr}"
            )
            raise error_at(self.place, "LAUNCH129", message, promises=promised)
        if done.stderr and rule == "fail":
            message = f"command '{text}' wrote to stderr{_quoted(done.stderr)}"
            hint = "if that is no error, give Command the argument on_stderr='warn'"
            promised = SubstitutionFailure(
                f"executed command showed stderr output. Command: {text}\nCaptured stderr output:\n{done.stderr}"
            )
            raise error_at(self.place, "LAUNCH129", message, hint, promises=promised)
        if done.stderr and rule == "warn":
            self._warn(context, "LAUNCH129", f"command '{text}' wrote to stderr{_quoted(done.stderr)}")
        return done.stdout + done.stderr if rule == "capture" else done.stdout

    def _warn(self, context: LaunchContext, code: str, message: str, hint: str | None = None) -> None:
        source = self.place.source() if self.place else None
        span = self.place.span(source) if self.place else None
        context.warn(Diagnostic(code, message, span, Severity.WARNING, hint=hint, source=source))


def _words_of_xacro(words: list[str]) -> list[str] | None:
    """What follows ``xacro`` if the command runs it, else None."""
    if words[:3] == ["ros2", "run", "xacro"] and words[3:4] == ["xacro"]:
        return words[4:]
    if Path(words[0]).name == "xacro":
        return words[1:]
    return None


def _expand(context: LaunchContext, call: XacroCall) -> str:
    descriptions = context.descriptions or Descriptions(current_finder())
    text = descriptions.expand(call)
    context.remark(call, descriptions.warnings_of(call))
    return text


def _quoted(output: str) -> str:
    return f":\n{output.strip()}" if output.strip() else ""
