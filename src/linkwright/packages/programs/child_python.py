"""How processes are started so that Python programs in them find ``rclpy`` and its kin.

These are the installed modules, else the stand-ins. The stand-ins are a room above this one, so they register here how
a process is started with them; see `linkwright.standins.activate`.
"""

from __future__ import annotations

import sys
from collections.abc import Callable, Mapping, Sequence

Environment = Callable[[Mapping[str, str]], Mapping[str, str]]
Command = Callable[[Sequence[str]], Sequence[str]]

_environment: Environment | None = None
_python_command: Command | None = None


def provide(environment: Environment, python_command: Command) -> None:
    """Set how processes are started.

    Args:
        environment: changes the environment that a process would have.
        python_command: puts an interpreter before a Python program's file and arguments.
    """
    global _environment, _python_command  # noqa: PLW0603 - a process has one set of stand-ins
    _environment = environment
    _python_command = python_command


def process_environment(base: Mapping[str, str]) -> dict[str, str]:
    """The environment for a process, from that of a launch file."""
    return dict(base if _environment is None else _environment(base))


def python_command(program: Sequence[str]) -> list[str]:
    """The command that runs a Python program, of its file and arguments."""
    return [sys.executable, *program] if _python_command is None else list(_python_command(program))
