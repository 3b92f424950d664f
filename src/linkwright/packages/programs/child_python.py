"""Start of processes whose Python programs can import ``rclpy`` and related modules.

The processes import the installed modules or, if there are none, the stand-ins. This package cannot import the package
of the stand-ins, so the stand-ins register functions for the start of such a process here; see
`linkwright.standins.activate`.
"""

from __future__ import annotations

import sys
from collections.abc import Callable, Mapping, Sequence

Environment = Callable[[Mapping[str, str]], Mapping[str, str]]
Command = Callable[[Sequence[str]], Sequence[str]]

_environment: Environment | None = None
_python_command: Command | None = None


def register_launcher(environment: Environment, python_command: Command) -> None:
    """Register the functions that determine how processes are started.

    Args:
        environment: the function that changes the environment of a process.
        python_command: the function that adds the interpreter before a Python program's file and arguments.
    """
    global _environment, _python_command  # noqa: PLW0603 - a process has one set of stand-ins
    _environment = environment
    _python_command = python_command


def process_environment(base: Mapping[str, str]) -> dict[str, str]:
    """Return the environment of a process, derived from a base environment."""
    return dict(base if _environment is None else _environment(base))


def python_command(program: Sequence[str]) -> list[str]:
    """Return the command that runs a Python program, given its file and arguments."""
    return [sys.executable, *program] if _python_command is None else list(_python_command(program))
