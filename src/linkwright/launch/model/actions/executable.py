"""The program of a process (``launch.descriptions.Executable``).

The program has a command, an environment, a folder and a name.
"""

from __future__ import annotations

import re
import shlex
from collections.abc import Iterable, Mapping
from itertools import count
from pathlib import Path
from typing import Any

from linkwright.launch.model.actions.named import Pairs, normalize_pairs, perform_pairs
from linkwright.launch.model.context import LaunchContext
from linkwright.launch.model.substitution import (
    SomeSubstitutionsType,
    Substitution,
    normalize_to_list_of_substitutions,
    perform_substitutions,
)

_process_numbers = count(1)


class Executable:
    """A program to be run as a process.

    Args:
        cmd: the program and its arguments. Each is a string, a substitution, or a list of these that is joined.
        prefix: a command to insert before the program, such as ``gdb -ex run --args``. By default, this is the launch
            configuration ``launch-prefix``, if the program's name matches the pattern ``launch-prefix-filter``.
        name: the name in the log, to which a number is appended; by default the file name of the program.
        cwd: the folder in which the program runs; by default the launcher's.
        env: the complete environment; by default the launcher's.
        additional_env: additional environment variables.
        arguments: arguments to append to `cmd`.

    Attributes:
        final_name: the evaluated name in the log, such as ``talker-1``.
        final_cmd: the evaluated command as a list of arguments.
        final_cwd: the evaluated folder.
        final_env: the evaluated environment.
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
        arguments: Iterable[SomeSubstitutionsType] | None = None,
    ) -> None:
        command_parts = [cmd] if isinstance(cmd, (str, Substitution, Path)) else list(cmd)
        self.cmd = [
            normalize_to_list_of_substitutions(command_part) for command_part in (*command_parts, *(arguments or ()))
        ]
        self.arguments = arguments
        self.prefix = _normalize_optional(prefix)
        self.name = _normalize_optional(name)
        self.cwd = _normalize_optional(cwd)
        self.env: Pairs | None = None if env is None else normalize_pairs(env)
        self.additional_env: Pairs | None = None if additional_env is None else normalize_pairs(additional_env)
        self.final_name: str | None = None
        self.final_cmd: list[str] | None = None
        self.final_cwd: str | None = None
        self.final_env: dict[str, str] | None = None

    def prepare(self, context: LaunchContext, action: Any = None) -> None:
        """Evaluate the command, environment, folder and name."""
        command = [perform_substitutions(context, argument) for argument in self.cmd]
        self.final_cmd = [*self.prefix_arguments(context, command), *command]
        self.final_name = f"{self.base_name(context, self.final_cmd)}-{next(_process_numbers)}"
        self.final_cwd = None if self.cwd is None else perform_substitutions(context, self.cwd)
        self.final_env = self.evaluate_environment(context)

    apply_context = prepare

    def prefix_arguments(self, context: LaunchContext, command: list[str]) -> list[str]:
        """Return the arguments of the command prefix, or an empty list if there is none."""
        if self.prefix is not None:
            return shlex.split(perform_substitutions(context, self.prefix))
        prefix = context.launch_configurations.get("launch-prefix", "")
        pattern = context.launch_configurations.get("launch-prefix-filter", "")
        is_applicable = not prefix or re.match(pattern, Path(command[0]).name)
        return shlex.split(prefix) if prefix and is_applicable else []

    def base_name(self, context: LaunchContext, command: list[str]) -> str:
        """Return the name of the process in the log, without its number."""
        return Path(command[0]).name if self.name is None else perform_substitutions(context, self.name)

    def evaluate_environment(self, context: LaunchContext) -> dict[str, str]:
        """Return the evaluated environment of the process."""
        environment = dict(context.environment) if self.env is None else perform_pairs(context, self.env)
        environment.update(perform_pairs(context, self.additional_env or []))
        return environment


def _normalize_optional(value: Any) -> list[Substitution] | None:
    return None if value is None else normalize_to_list_of_substitutions(value)
