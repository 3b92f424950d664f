"""Starting processes."""

from __future__ import annotations

import shlex
from collections.abc import Callable, Iterable, Mapping, Sequence
from pathlib import Path
from types import SimpleNamespace
from typing import Any

from linkwright.diagnostics import did_you_mean
from linkwright.launch import events
from linkwright.launch.conditions import evaluate_condition_expression
from linkwright.launch.context import LaunchContext
from linkwright.launch.engine.log import OUTPUT_MODES, output_destinations
from linkwright.launch.engine.processes import ProcessPlan
from linkwright.launch.entity import Action, LaunchDescriptionEntity, SomeEntitiesType, as_entities
from linkwright.launch.places import error_at
from linkwright.launch.substitution import (
    SomeSubstitutionsType,
    Substitution,
    normalize_to_list_of_substitutions,
    perform_substitutions,
)

OnExit = SomeEntitiesType | Callable[..., Any] | None


class ExecuteProcess(Action):
    """Starts a process and follows it to its end.

    Args:
        cmd: program and arguments, each a text, a substitution, or a list of these to be joined.
        name: its name in the log, the program's by default; a number is put behind.
        cwd: the folder it runs in.
        env: its whole environment; that of the launcher by default.
        additional_env: variables set besides.
        prefix: a command to put before it, such as ``gdb -ex run --args``; the launch configuration
            ``launch-prefix`` by default.
        shell: whether a shell runs it.
        output: where what it writes goes: ``screen``, ``log``, ``both``, ``own_log``, ``full``, or a mapping
        of
            ``stdout``, ``stderr`` and ``both`` to sets of ``screen``, ``log`` and ``own_log``.
        output_format: how a line is shown; ``{line}`` and ``{this}`` (the action) can be used.
        log_cmd: whether the command is shown before it runs.
        on_exit: what is visited when it has ended, or a function of event and context that returns that.
        respawn: whether it is started again when it ends before the launch does.
        respawn_delay: seconds to wait before that.
        respawn_max_retries: how often at most; any number if negative.
        sigterm_timeout: seconds between SIGINT and SIGTERM when it is to end.
        sigkill_timeout: seconds between SIGTERM and SIGKILL.
        emulate_tty: whether it shall think that it writes to a terminal.
        cached_output: whether `get_stdout` and `get_stderr` give what it wrote.
        condition: see `Action`.
    """

    def __init__(
        self,
        *,
        cmd: Iterable[SomeSubstitutionsType],
        name: SomeSubstitutionsType | None = None,
        cwd: SomeSubstitutionsType | None = None,
        env: Mapping[Any, Any] | None = None,
        additional_env: Mapping[Any, Any] | None = None,
        prefix: SomeSubstitutionsType | None = None,
        shell: bool = False,
        output: SomeSubstitutionsType | Mapping[str, Any] = "log",
        output_format: str = "[{this.process_description.final_name}] {line}",
        log_cmd: bool = False,
        on_exit: OnExit = None,
        respawn: bool | SomeSubstitutionsType = False,
        respawn_delay: float | None = None,
        respawn_max_retries: int = -1,
        sigterm_timeout: float | SomeSubstitutionsType | None = None,
        sigkill_timeout: float | SomeSubstitutionsType | None = None,
        emulate_tty: bool | SomeSubstitutionsType = False,
        cached_output: bool = False,
        **kwargs: Any,
    ) -> None:
        super().__init__(**kwargs)
        self._cmd = [normalize_to_list_of_substitutions(part) for part in _as_parts(cmd)]
        self._name = _optional(name)
        self._cwd = _optional(cwd)
        self._env = _variables(env)
        self._additional_env = _variables(additional_env)
        self._prefix = _optional(prefix)
        self._shell = shell
        self._output = dict(output) if isinstance(output, Mapping) else normalize_to_list_of_substitutions(output)
        self._output_format = output_format
        self._log_cmd = log_cmd
        is_function = callable(on_exit) and not isinstance(on_exit, LaunchDescriptionEntity)
        self._after_exit: Callable[..., Any] | None = on_exit if is_function else None  # type: ignore[assignment]
        self._on_exit = [] if is_function else as_entities(on_exit)
        self._respawn = normalize_to_list_of_substitutions(_truth_text(respawn))
        self._respawn_delay = respawn_delay
        self._respawn_max_retries = respawn_max_retries
        self._sigterm_timeout = _optional(_number_text(sigterm_timeout))
        self._sigkill_timeout = _optional(_number_text(sigkill_timeout))
        self._emulate_tty = normalize_to_list_of_substitutions(_truth_text(emulate_tty))
        self._cached: dict[int, list[bytes]] | None = {1: [], 2: []} if cached_output else None
        self.process_details: dict[str, Any] | None = None
        self.return_code: int | None = None

    # --- what others read of it -----------------------------------------------------------------------------

    @property
    def cmd(self) -> list[list[Substitution]]:
        """Program and arguments, as substitutions."""
        return self._cmd

    @property
    def name(self) -> str | None:
        """The process's name in the log once it runs, such as ``talker-1``."""
        return None if self.process_details is None else self.process_details["name"]

    @property
    def process_description(self) -> SimpleNamespace:
        """The process once it runs: ``final_name``, ``final_cmd``."""
        details = self.process_details or {"name": None, "cmd": None}
        return SimpleNamespace(final_name=details["name"], final_cmd=details["cmd"])

    @property
    def shell(self) -> bool:
        """Whether a shell runs it."""
        return self._shell

    @property
    def output(self) -> Any:
        """Where its output goes, as it was given."""
        return self._output

    def get_stdout(self) -> str:
        """What it wrote to stdout; needs ``cached_output``."""
        return self._cached_text(1)

    def get_stderr(self) -> str:
        """What it wrote to stderr; needs ``cached_output``."""
        return self._cached_text(2)

    def get_sub_entities(self) -> Sequence[LaunchDescriptionEntity]:
        """What is visited when it has ended."""
        return self._on_exit

    # --- the run --------------------------------------------------------------------------------------------

    def execute(self, context: LaunchContext) -> Sequence[LaunchDescriptionEntity] | None:
        """Start the process.

        Raises:
            LinkwrightError: LAUNCH141, what cannot be understood of how it is to run.
        """
        if not context.is_shutdown:
            self._start(context, self._command(context))
        return None

    def exited(self, event: events.ProcessExited, context: LaunchContext) -> list[LaunchDescriptionEntity]:
        """What is to be visited now that the process has ended."""
        self.return_code = event.returncode
        if self._after_exit is None:
            return self._on_exit
        return as_entities(self._after_exit(event, context))

    def wrote(self, stream: int, text: bytes) -> None:
        """Take note of what the process wrote to stdout (1) or stderr (2)."""
        if self._cached is not None:
            self._cached[stream].append(text)

    def _start(self, context: LaunchContext, command: list[str]) -> None:
        plan = self._plan(context, command)
        session = context.session
        session.processes.start(plan, session.number_process(plan.name), context)

    def _command(self, context: LaunchContext) -> list[str]:
        return [perform_substitutions(context, part) for part in self._cmd]

    def _plan(self, context: LaunchContext, command: list[str]) -> ProcessPlan:
        def text(substitutions: list[Substitution] | None) -> str | None:
            return None if substitutions is None else perform_substitutions(context, substitutions)

        if not command or not command[0].strip():
            raise error_at(self.place, "LAUNCH141", "the command of the process is empty")
        base_name = text(self._name) or Path(shlex.split(command[0])[0] if self._shell else command[0]).name
        prefix = text(self._prefix) or context.launch_configurations.get("launch-prefix")
        environment = dict(context.environment)
        if self._env is not None:
            environment = self._evaluated(context, self._env)
        environment.update(self._evaluated(context, self._additional_env or []))
        return ProcessPlan(
            action=self,
            name=base_name,
            command=[*shlex.split(prefix), *command] if prefix else command,
            folder=text(self._cwd),
            environment=environment,
            shell=self._shell,
            emulate_tty=evaluate_condition_expression(context, self._emulate_tty),
            destinations=self._destinations(context),
            output_format=self._output_format,
            log_command=self._log_cmd,
            respawn=evaluate_condition_expression(context, self._respawn),
            respawn_delay=self._respawn_delay or 0.0,
            respawn_limit=self._respawn_max_retries,
            seconds_to_sigterm=self._seconds(context, self._sigterm_timeout, "sigterm_timeout"),
            seconds_to_sigkill=self._seconds(context, self._sigkill_timeout, "sigkill_timeout"),
        )

    def _evaluated(
        self, context: LaunchContext, variables: list[tuple[list[Substitution], list[Substitution]]]
    ) -> dict[str, str]:
        return {
            perform_substitutions(context, name): perform_substitutions(context, value) for name, value in variables
        }

    def _destinations(self, context: LaunchContext) -> dict[int, frozenset[str]]:
        mode: Any = context.environment.get("OVERRIDE_LAUNCH_PROCESS_OUTPUT") or self._output
        if isinstance(mode, list):
            mode = perform_substitutions(context, mode)
        try:
            return output_destinations(mode)
        except KeyError as error:
            wrong = str(error.args[0])
            modes = ", ".join(f"'{each}'" for each in OUTPUT_MODES)
            hint = did_you_mean(wrong, OUTPUT_MODES) or f"use one of {modes}"
            raise error_at(self.place, "LAUNCH141", f"there is no output '{wrong}'", hint) from error

    def _seconds(self, context: LaunchContext, given: list[Substitution] | None, name: str) -> float:
        text = perform_substitutions(context, given) if given else context.launch_configurations.get(name, "5")
        try:
            return float(text)
        except ValueError as error:
            raise error_at(self.place, "LAUNCH141", f"'{name}' is '{text}', which is no number") from error

    def _cached_text(self, stream: int) -> str:
        if self._cached is None:
            raise RuntimeError("the output of the process is not kept: give it cached_output=True")
        return b"".join(self._cached[stream]).decode(errors="replace")


def _as_parts(cmd: Any) -> list[Any]:
    return [cmd] if isinstance(cmd, (str, Substitution, Path)) else list(cmd)


def _optional(value: Any) -> list[Substitution] | None:
    return None if value is None else normalize_to_list_of_substitutions(value)


def _variables(env: Mapping[Any, Any] | None) -> list[tuple[list[Substitution], list[Substitution]]] | None:
    if env is None:
        return None
    return [
        (normalize_to_list_of_substitutions(name), normalize_to_list_of_substitutions(value))
        for name, value in env.items()
    ]


def _truth_text(value: Any) -> Any:
    return str(value).lower() if isinstance(value, bool) else value


def _number_text(value: Any) -> Any:
    return str(value) if isinstance(value, (int, float)) else value
