"""The actions that start processes."""

from __future__ import annotations

import shlex
from collections.abc import Callable, Iterable, Mapping, Sequence
from types import NoneType
from typing import TYPE_CHECKING, Any

from linkwright.diagnostics import did_you_mean, phrase
from linkwright.hosting.launch_log import OUTPUT_MODES, output_destinations
from linkwright.hosting.plans import HostedPlan
from linkwright.launch.errors.locations import error_at
from linkwright.launch.model import events
from linkwright.launch.model.action import Action
from linkwright.launch.model.actions.executable import Executable
from linkwright.launch.model.conditions import InvalidConditionExpressionError, evaluate_condition_expression
from linkwright.launch.model.context import LaunchContext
from linkwright.launch.model.entity import LaunchDescriptionEntity, SomeEntitiesType, as_entities
from linkwright.launch.model.markup.expose import expose_action
from linkwright.launch.model.markup.values import normalize_typed_substitution, perform_typed_substitution, read_boolean
from linkwright.launch.model.plans import ProcessPlan
from linkwright.launch.model.substitution import (
    SomeSubstitutionsType,
    Substitution,
    describe,
    normalize_to_list_of_substitutions,
    perform_substitutions,
)

if TYPE_CHECKING:
    from linkwright.launch.model.actions.named import Pairs
    from linkwright.launch.model.markup.entity import Entity, Parser

OnExit = SomeEntitiesType | Callable[..., Any] | None

_DEFAULT_TIMEOUT_S = "5"
"""The default of `sigterm_timeout` and `sigkill_timeout` in seconds."""


class ExecuteLocal(Action):
    """An action that starts a process and monitors it until it ends.

    Args:
        process_description: the program to run.
        shell: whether a shell runs the command.
        sigterm_timeout: the seconds between SIGINT and SIGTERM when the process must end. By default, this is the
            launch configuration with this name, or 5.
        sigkill_timeout: the seconds between SIGTERM and SIGKILL, with the same default.
        emulate_tty: whether the process gets a pseudo-terminal. The launch configuration with this name takes
            precedence.
        output: the destination of the output: ``screen``, ``log``, ``both``, ``own_log``, ``full``, or a mapping of
            ``stdout``, ``stderr`` and ``both`` to sets of ``screen``, ``log`` and ``own_log``. The environment variable
            ``OVERRIDE_LAUNCH_PROCESS_OUTPUT`` takes precedence.
        output_format: the format of an output line, which may contain ``{line}`` and ``{this}`` (the action).
        cached_output: whether the output is stored, so that `get_stdout` and `get_stderr` can return it.
        log_cmd: whether the command is logged before it runs.
        on_exit: the entities to visit when the process has ended, or a function of event and context that returns them.
        respawn: whether the process is restarted if it ends before the launch.
        respawn_delay: seconds to wait before a restart.
        respawn_max_retries: the maximum number of restarts; unlimited if negative.
        split_arguments: whether each argument is split into words as in a shell, because a substitution may produce
            several words.
        kwargs: see `Action`.

    Attributes:
        process_details: ``name``, ``cmd``, ``cwd``, ``env`` and ``pid`` of the process; None before it runs.
        return_code: the exit status of the process; None before it has ended.
    """

    def __init__(
        self,
        *,
        process_description: Executable,
        shell: bool = False,
        sigterm_timeout: float | SomeSubstitutionsType | None = None,
        sigkill_timeout: float | SomeSubstitutionsType | None = None,
        emulate_tty: bool | SomeSubstitutionsType = False,
        output: SomeSubstitutionsType | Mapping[str, Any] = "log",
        output_format: str = "[{this.process_description.final_name}] {line}",
        cached_output: bool = False,
        log_cmd: bool = False,
        on_exit: OnExit = None,
        respawn: bool | SomeSubstitutionsType = False,
        respawn_delay: float | None = None,
        respawn_max_retries: int = -1,
        split_arguments: bool = False,
        **kwargs: Any,
    ) -> None:
        super().__init__(**kwargs)
        self._description = process_description
        self._shell = shell
        self._output = dict(output) if isinstance(output, Mapping) else normalize_to_list_of_substitutions(output)
        self._output_format = output_format
        self._log_cmd = log_cmd
        self._exit_callback: Callable[..., Any] | None = None
        self._on_exit: list[LaunchDescriptionEntity] = []
        reaction: Any = on_exit
        if isinstance(reaction, (LaunchDescriptionEntity, Iterable, NoneType)):
            self._on_exit = as_entities(reaction)
        else:  # as in ROS, the type is checked when the process has ended
            self._exit_callback = reaction if callable(reaction) else lambda *_: reaction
        self._respawn = normalize_typed_substitution(read_boolean(respawn), bool)
        self._respawn_delay = respawn_delay
        self._respawn_max_retries = respawn_max_retries
        self._split_arguments = split_arguments
        self._sigterm_timeout = _normalize_timeout(sigterm_timeout, "sigterm_timeout")
        self._sigkill_timeout = _normalize_timeout(sigkill_timeout, "sigkill_timeout")
        self._emulate_tty = emulate_tty
        self._output_chunks: dict[int, list[bytes]] | None = {1: [], 2: []} if cached_output else None
        self._has_started = False
        self.process_details: dict[str, Any] | None = None
        self.return_code: int | None = None

    # --- properties -----------------------------------------------------------------------------------------

    @property
    def process_description(self) -> Executable:
        """The program to run."""
        return self._description

    @property
    def shell(self) -> bool:
        """Whether a shell runs the command."""
        return self._shell

    @property
    def emulate_tty(self) -> Any:
        """The value of `emulate_tty` as passed to the constructor: a boolean or substitutions."""
        return self._emulate_tty

    @property
    def sigterm_timeout(self) -> list[Substitution]:
        """The seconds between SIGINT and SIGTERM, as substitutions."""
        return self._sigterm_timeout

    @property
    def sigkill_timeout(self) -> list[Substitution]:
        """The seconds between SIGTERM and SIGKILL, as substitutions."""
        return self._sigkill_timeout

    @property
    def output(self) -> Any:
        """The destination of the output: a mapping or substitutions."""
        return self._output

    def get_stdout(self) -> str:
        """Return the text that the process has written to stdout.

        Raises:
            RuntimeError: `cached_output` was not set.
        """
        return self._read_cached_output(1)

    def get_stderr(self) -> str:
        """Return the text that the process has written to stderr.

        Raises:
            RuntimeError: `cached_output` was not set.
        """
        return self._read_cached_output(2)

    def get_sub_entities(self) -> Sequence[LaunchDescriptionEntity]:
        """Return the entities to visit when the process has ended.

        The result is empty if a function returns the entities.
        """
        return self._on_exit

    def describe(self) -> str:
        """Return a text with the command, folder and environment, and whether a shell is used."""
        description = self._description
        command = ", ".join(describe(argument) for argument in description.cmd)
        folder_text = None if description.cwd is None else describe(description.cwd)
        variable_texts = (
            None
            if description.env is None
            else [f"{describe(name)}: {describe(value)}" for name, value in description.env]
        )
        environment_text = None if variable_texts is None else "{" + ", ".join(variable_texts) + "}"
        return f"{type(self).__name__}(cmd=[{command}], cwd={folder_text}, env={environment_text}, shell={self._shell})"

    # --- execution ------------------------------------------------------------------------------------------

    def prepare(self, context: LaunchContext) -> None:
        """Evaluate the name, command, working directory and environment of the process.

        Launch files can read these values before the process starts.
        """
        self._description.prepare(context, self)

    def execute(self, context: LaunchContext) -> Sequence[LaunchDescriptionEntity] | None:
        """Start the process.

        Raises:
            RuntimeError: LAUNCH141, the process was started before.
            LinkwrightError: LAUNCH141, an option of the process is invalid.
        """
        if not context.is_shutdown:
            self._start(context, [perform_substitutions(context, argument) for argument in self._description.cmd])
        return None

    def record_exit(self, event: events.ProcessExited, context: LaunchContext) -> list[LaunchDescriptionEntity]:
        """Record the exit status of the process, and return the entities to visit next."""
        self.return_code = event.returncode
        if self._exit_callback is None:
            return self._on_exit
        return as_entities(self._exit_callback(event, context))

    def record_output(self, stream: int, text: bytes) -> None:
        """Store output of the process to stdout (1) or stderr (2), if `cached_output` is set."""
        if self._output_chunks is not None:
            self._output_chunks[stream].append(text)

    def _start(self, context: LaunchContext, command: list[str]) -> str:
        """Start the process with an evaluated command, and return its name in the log."""
        if self._has_started:
            text = f"ExecuteLocal action '{self._description.final_name}': executed more than once: {self.describe()}"
            message = phrase(
                "the action that starts process '{final_name}' was executed twice",
                final_name=self._description.final_name,
            )
            hint = phrase("create a new action for each start, for example in a function")
            raise error_at(self.source_location, "LAUNCH141", message, hint, ros_error=RuntimeError(text))
        plan = self._create_plan(context, command)
        name = context.session.assign_process_name(plan.name)
        description = self._description
        description.final_name, description.final_cmd = name, list(plan.command)
        description.final_cwd, description.final_env = plan.folder, dict(plan.environment)
        self._has_started = True
        context.session.start_process(plan, name)
        return name

    def _create_plan(self, context: LaunchContext, command: list[str]) -> ProcessPlan:
        description = self._description
        if not command or not command[0].strip():
            raise error_at(self.source_location, "LAUNCH141", phrase("the command of the process is empty"))
        if self._split_arguments and not self._shell:
            command = [word for argument in command for word in self._split_argument(argument)]
        program = [shlex.split(command[0])[0]] if self._shell else command
        return ProcessPlan(
            action=self,
            name=description.base_name(context, program),
            command=[*description.prefix_arguments(context, program), *command],
            folder=None if description.cwd is None else perform_substitutions(context, description.cwd),
            environment=self._evaluate_environment(context),
            shell=self._shell,
            emulate_tty=self._evaluate_condition(context, "emulate_tty", self._emulate_tty),
            destinations=self._evaluate_destinations(context),
            output_format=self._output_format,
            log_command=self._log_cmd,
            respawn=bool(self._evaluate_boolean(context, "respawn", self._respawn)),
            respawn_delay=self._respawn_delay or 0.0,
            respawn_limit=self._respawn_max_retries,
            seconds_to_sigterm=self._evaluate_seconds(context, self._sigterm_timeout, "sigterm_timeout"),
            seconds_to_sigkill=self._evaluate_seconds(context, self._sigkill_timeout, "sigkill_timeout"),
        )

    def _split_argument(self, text: str) -> list[str]:
        try:
            return shlex.split(text)
        except ValueError as error:
            message = phrase(
                "argument '{text}' cannot be split into words: {error}", text=text, error=str(error).lower()
            )
            raise error_at(self.source_location, "LAUNCH118", message, ros_error=error) from error

    def _evaluate_environment(self, context: LaunchContext) -> dict[str, str]:
        return self._description.evaluate_environment(context)

    def _evaluate_destinations(self, context: LaunchContext) -> dict[int, frozenset[str]]:
        mode: Any = context.environment.get("OVERRIDE_LAUNCH_PROCESS_OUTPUT") or self._output
        if isinstance(mode, list):
            mode = perform_substitutions(context, mode)
        try:
            return output_destinations(mode)
        except KeyError as error:
            invalid_mode = str(error.args[0])
            modes = ", ".join(f"'{output_mode}'" for output_mode in OUTPUT_MODES)
            hint = did_you_mean(invalid_mode, OUTPUT_MODES) or phrase("use one of {names}", names=modes)
            text = f'{invalid_mode} is not a valid standard output config i.e. "screen", "log" or "both"'
            message = phrase("output destination '{wrong}' does not exist", wrong=invalid_mode)
            raise error_at(self.source_location, "LAUNCH141", message, hint, ros_error=ValueError(text)) from error

    def _evaluate_condition(self, context: LaunchContext, name: str, default: Any) -> bool:
        value = context.launch_configurations.get(name, default)
        try:
            return value if isinstance(value, bool) else evaluate_condition_expression(context, value)
        except InvalidConditionExpressionError as error:
            message = phrase("'{name}' is '{text}', which is neither true nor false", name=name, text=error.text)
            raise error_at(self.source_location, "LAUNCH141", message, ros_error=error) from error

    def _evaluate_boolean(self, context: LaunchContext, name: str, value: Any) -> Any:
        try:
            return perform_typed_substitution(context, value, bool)
        except ValueError as error:
            message = phrase(
                "'{name}' is '{text}', which is neither true nor false",
                name=name,
                text=perform_substitutions(context, value),
            )
            raise error_at(self.source_location, "LAUNCH141", message, ros_error=error) from error

    def _evaluate_seconds(self, context: LaunchContext, substitutions: list[Substitution], name: str) -> float:
        text = perform_substitutions(context, substitutions)
        try:
            return float(text)
        except ValueError as error:
            message = phrase("'{name}' is '{text}', which is not a number", name=name, text=text)
            raise error_at(self.source_location, "LAUNCH141", message, ros_error=error) from error

    def _read_cached_output(self, stream: int) -> str:
        if self._output_chunks is None:
            raise RuntimeError("cached output must be true to be able to get stdout: pass cached_output=True")
        return b"".join(self._output_chunks[stream]).decode(errors="replace")


@expose_action("executable")
class ExecuteProcess(ExecuteLocal):
    """An action that starts a process from a command and monitors the process until it ends.

    Args:
        cmd: program and arguments, see `Executable`.
        prefix: see `Executable`.
        name: see `Executable`.
        cwd: see `Executable`.
        env: see `Executable`.
        additional_env: see `Executable`.
        kwargs: see `ExecuteLocal`.
    """

    def __init__(
        self,
        *,
        cmd: Iterable[SomeSubstitutionsType],
        prefix: SomeSubstitutionsType | None = None,
        name: SomeSubstitutionsType | None = None,
        cwd: SomeSubstitutionsType | None = None,
        env: Mapping[Any, Any] | None = None,
        additional_env: Mapping[Any, Any] | None = None,
        **kwargs: Any,
    ) -> None:
        description = Executable(cmd=cmd, prefix=prefix, name=name, cwd=cwd, env=env, additional_env=additional_env)
        super().__init__(process_description=description, **kwargs)

    @classmethod
    def parse(
        cls, entity: Entity, parser: Parser, ignore: Sequence[str] | None = None
    ) -> tuple[type[Action], dict[str, Any]]:
        """Return the class and keyword arguments for the tag of a process.

        Args:
            entity: the tag.
            parser: parses the substitutions in the tag.
            ignore: names of arguments to skip.
        """
        from linkwright.launch.model.actions.process_tag import parse_process

        _, kwargs = super().parse(entity, parser)
        kwargs.update(parse_process(entity, parser, frozenset(ignore or ())))
        return cls, kwargs

    @classmethod
    def _parse_cmdline(cls, cmd: str, parser: Parser) -> list[list[Substitution]]:
        """Return the arguments of a command line, each as substitutions.

        The method has this name in ROS.
        """
        from linkwright.launch.model.markup.command_line import parse_command_line

        return parse_command_line(cmd, parser)

    def execute(self, context: LaunchContext) -> Sequence[LaunchDescriptionEntity] | None:
        """Start the process, or the Linkwright node that replaces a missing program.

        Raises:
            RuntimeError: LAUNCH141, the process was started before.
            LinkwrightError: LAUNCH141, an option of the process is invalid; NODE002, the package with the node that
                replaces the program cannot be imported.
        """
        if not context.is_shutdown:
            command = [perform_substitutions(context, argument) for argument in self._description.cmd]
            if not self._start_replacement(context, command):
                self._start(context, command)
        return None

    def _start_replacement(self, context: LaunchContext, command: list[str]) -> bool:
        """Start the Linkwright node that replaces the program of the command, if there is one.

        Returns:
            Whether a node was started.
        """
        from linkwright.launch.model.replaced_programs import find_replacing_node

        try:
            arguments = shlex.split(" ".join(command)) if self._shell else command
        except ValueError:
            return False
        replacement = find_replacing_node(arguments, context.environment)
        if replacement is None:
            return False
        description = self._description
        plan = HostedPlan(
            self,
            context.session.assign_process_name(description.base_name(context, arguments)),
            replacement.package,
            replacement.executable,
            None,
            "/",
            dict(replacement.parameters),
            [],
            list(replacement.ros_arguments),
            destinations=self._evaluate_destinations(context),
        )
        description.final_name, description.final_cmd = plan.process_name, list(arguments)
        context.session.host.schedule_node(plan)
        return True

    @property
    def cmd(self) -> list[list[Substitution]]:
        """The program and its arguments, as substitutions."""
        return self._description.cmd

    @property
    def name(self) -> Any:
        """The process's name in the log, such as ``talker-1``, or its unevaluated substitutions."""
        return self._description.final_name or self._description.name

    @property
    def cwd(self) -> Any:
        """The working folder of the process, or its substitutions before evaluation."""
        return self._description.final_cwd or self._description.cwd

    @property
    def env(self) -> Any:
        """The environment of the process, or substitutions before evaluation."""
        return self._description.final_env or self._description.env

    @property
    def additional_env(self) -> Pairs | None:
        """The additional environment variables, as substitutions, or None."""
        return self._description.additional_env

    @property
    def _name(self) -> list[Substitution] | None:
        return self._description.name


def _normalize_timeout(timeout: Any, name: str) -> list[Substitution]:
    from linkwright.launch.model.substitutions.configuration import LaunchConfiguration

    if timeout is None:
        return [LaunchConfiguration(name, default=_DEFAULT_TIMEOUT_S)]
    return normalize_to_list_of_substitutions(str(timeout) if isinstance(timeout, (int, float)) else timeout)
