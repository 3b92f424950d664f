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

_numbers = count(1)


class Executable:
    """A program to be run as a process.

    Args:
        cmd: program and arguments, each a string, a substitution, or a list of these to join.
        prefix: a command to put before the program, such as ``gdb -ex run --args``; by default the launch configuration
            ``launch-prefix``, if the program's name matches the pattern ``launch-prefix-filter``.
        name: the name in the log, to which a number is appended; the program's name by default.
        cwd: the folder in which the program runs.
        env: the entire environment; the launcher's by default.
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
        parts = [cmd] if isinstance(cmd, (str, Substitution, Path)) else list(cmd)
        self.cmd = [normalize_to_list_of_substitutions(part) for part in (*parts, *(arguments or ()))]
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
        command = [perform_substitutions(context, part) for part in self.cmd]
        self.final_cmd = [*self.prefix_words(context, command), *command]
        self.final_name = f"{self.base_name(context, self.final_cmd)}-{next(_numbers)}"
        self.final_cwd = None if self.cwd is None else perform_substitutions(context, self.cwd)
        self.final_env = self.environment(context)

    apply_context = prepare

    def prefix_words(self, context: LaunchContext, command: list[str]) -> list[str]:
        """Return the arguments of the command prefix; empty if there is none."""
        if self.prefix is not None:
            return shlex.split(perform_substitutions(context, self.prefix))
        wanted = context.launch_configurations.get("launch-prefix", "")
        pattern = context.launch_configurations.get("launch-prefix-filter", "")
        applies = not wanted or re.match(pattern, Path(command[0]).name)
        return shlex.split(wanted) if wanted and applies else []

    def base_name(self, context: LaunchContext, command: list[str]) -> str:
        """Return the process's name in the log, without its number."""
        return Path(command[0]).name if self.name is None else perform_substitutions(context, self.name)

    def environment(self, context: LaunchContext) -> dict[str, str]:
        """Return the environment for the process."""
        environment = dict(context.environment) if self.env is None else perform_pairs(context, self.env)
        environment.update(perform_pairs(context, self.additional_env or []))
        return environment


def _normalize_optional(value: Any) -> list[Substitution] | None:
    return None if value is None else normalize_to_list_of_substitutions(value)
