"""Select processes of a launch in tests (``launch_testing.util``)."""

from __future__ import annotations

import sys
from collections.abc import Collection, Iterable, Sequence
from typing import Any, Protocol

from linkwright.launch.model.actions.execute import ExecuteLocal, ExecuteProcess
from linkwright.launch.model.substitution import Substitution, TextSubstitution

NO_CMD_ARGS: Any = object()
"""Selects processes whose command has no arguments."""

_KEEP_ALIVE_SCRIPT = (
    "import signal, threading; signal.signal(signal.SIGINT, lambda *_: exit(0)); threading.Event().wait()"
)


class NoMatchingProcessException(Exception):
    """Raised when no process matches."""


class ProcessRecords(Protocol):
    """The interface of records that are stored by process."""

    def processes(self) -> Collection[ExecuteLocal]:
        """Return the actions of the processes."""

    def __getitem__(self, key: Any) -> Any:
        """Return the record of a process."""


def KeepAliveProc() -> ExecuteProcess:
    """Return an idle process that keeps the launch running until the tests end."""
    return ExecuteProcess(cmd=[sys.executable, "-c", _KEEP_ALIVE_SCRIPT])


def resolveProcesses(
    info_obj: ProcessRecords,
    *,
    process: ExecuteLocal | str | None = None,
    cmd_args: str | Sequence[str] | None = None,
    strict_proc_matching: bool = True,
) -> list[ExecuteLocal]:
    """Return the actions of the matching processes, at least one.

    Args:
        info_obj: the records of processes.
        process: an action, or a part of the name of a process; None for all processes.
        cmd_args: arguments that the command must contain in addition to a matching name; `NO_CMD_ARGS` for a command
            without arguments.
        strict_proc_matching: whether a name must match only one process.

    Raises:
        NoMatchingProcessException: no process matches.
        Exception: several processes match the name.
        TypeError: `process` has another type.
    """
    actions = list(info_obj.processes())
    if process is None:
        if not actions:
            raise NoMatchingProcessException("No data recorded for any process")
        return actions
    if isinstance(process, ExecuteLocal):
        if process not in actions:
            raise NoMatchingProcessException(f"No data recorded for proc {_format_process(process)}")
        return [process]
    if not isinstance(process, str):
        raise TypeError(f"proc argument must be 'ExecuteProcess' or 'str' not {type(process)}")
    arguments = [cmd_args] if isinstance(cmd_args, str) else cmd_args
    matching_actions = [
        execute_local
        for execute_local in actions
        if process in get_name(execute_local) and _has_arguments(execute_local, arguments)
    ]
    if matching_actions and not (strict_proc_matching and len(matching_actions) > 1):
        return matching_actions
    names = ", ".join(sorted(map(_format_process, actions)))
    if not matching_actions:
        raise NoMatchingProcessException(
            f"Did not find any processes matching name '{process}' and args '{arguments}'. Procs: {names}"
        )
    raise Exception(  # noqa: TRY002 - launch_testing raises it
        f"Found multiple processes matching name '{process}' and cmd_args '{arguments}'. Procs: {names}"
    )


def get_name(action: ExecuteLocal) -> str:
    """Return the name of an action's process in log lines, or an empty string without one."""
    return str((action.process_details or {}).get("name") or action.process_description.final_name or "")


def _has_arguments(action: ExecuteLocal, words: Sequence[str] | None) -> bool:
    command = (action.process_details or {}).get("cmd", [])
    if words is None:
        return True
    if words is NO_CMD_ARGS:
        return len(command) == 1
    return all(argument in command[1:] for argument in words)


def _format_process(action: ExecuteLocal) -> str:
    """Return the name and arguments of a process for messages."""
    details = action.process_details
    if details:
        return " ".join([details["name"], *details["cmd"][1:]])
    arguments = [_as_plain_text(parts) for parts in action.process_description.cmd]
    plain_arguments = [argument for argument in arguments if argument is not None]
    return " ".join(plain_arguments) if len(plain_arguments) == len(arguments) else "Unknown - Process not launched yet"


def _as_plain_text(substitutions: Iterable[Substitution]) -> str | None:
    """Return a command-line argument as plain text, or None if it contains substitutions."""
    texts = [substitution.text for substitution in substitutions if isinstance(substitution, TextSubstitution)]
    return "".join(texts) if len(texts) == len(list(substitutions)) else None
