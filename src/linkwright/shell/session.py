"""Runs a shell, or a command, in an environment with the commands of ROS 2.

The folder of Linkwright's programs is last on the search path, so that installed programs take precedence. The user's
start-up files often set the search path (``~/.bashrc`` may source ROS 2). Therefore, the shell reads them first, and
Linkwright's start-up file after them.
"""

from __future__ import annotations

import os
import shlex
import shutil
import subprocess
import sys
from collections.abc import Callable, Mapping, Sequence
from pathlib import Path

from linkwright.diagnostics import phrase
from linkwright.files.scratch_folders import ScratchFolder
from linkwright.process.interruption import interrupt
from linkwright.shell.instead import unknown_command_error
from linkwright.shell.programs import PROGRAMS, write_programs
from linkwright.standins import process

_PR_SET_PDEATHSIG = 1
"""The option of prctl(2) that requests a signal when the parent process ends."""
MARK_VARIABLE = "LINKWRIGHT_SHELL"
"""The environment variable that contains the folder of the shell's programs."""


def run_shell(
    command: Sequence[str] = (),
    environment: Mapping[str, str] | None = None,
    additions: Callable[[str], str] | None = None,
) -> int:
    """Run the user's shell, or a command, until it ends.

    Args:
        command: the program and its arguments; empty to start the user's interactive shell.
        environment: the environment to extend; None for the environment of this process.
        additions: returns additional start-up commands for a shell: ``bash``, ``zsh`` or ``fish``. None for no
            additions.

    Returns:
        The exit status; 128 plus the number of the signal if a signal ended the program, as in shells.

    Raises:
        LinkwrightError: SHELL101, the command does not exist.
    """
    with ScratchFolder("shell") as scratch:
        folder = Path(scratch) / "bin"
        folder.mkdir()
        write_programs(folder)
        variables = shell_environment(folder, os.environ if environment is None else environment)
        command_line = list(command) or _create_interactive_command(
            Path(scratch), variables, additions or (lambda _: "")
        )
        path = shutil.which(command_line[0], path=variables["PATH"])
        if path is None:
            raise unknown_command_error(command_line[0], tuple(PROGRAMS), _COMMAND_HINT)
        return _run([path, *command_line[1:]], variables)


_COMMAND_HINT = phrase(
    "write one command with its arguments after `--`; for several commands, run `linkwright shell -- bash -c '...'`"
)


def shell_environment(folder: Path, base: Mapping[str, str]) -> dict[str, str]:
    """Return the environment variables of the shell.

    If no ``ros2`` is installed, the folder of Linkwright's interpreter is first on the search path. ``python3`` then
    finds the stand-ins and their dependencies.

    Args:
        folder: the folder of Linkwright's programs.
        base: the environment variables to extend.
    """
    variables = process.create_environment(base)
    folders = [
        folder_name
        for folder_name in variables.get("PATH", os.defpath).split(os.pathsep)
        if folder_name and folder_name != base.get(MARK_VARIABLE)
    ]
    if shutil.which("ros2", path=os.pathsep.join(folders)) is None:
        interpreter_folder = str(Path(sys.executable).parent)
        folders = [interpreter_folder, *(part for part in folders if part != interpreter_folder)]
    variables["PATH"] = os.pathsep.join([*folders, str(folder)])
    variables[MARK_VARIABLE] = str(folder)
    return variables


_SHELLS_WITH_START_FILE = ("bash", "zsh", "fish")


def _create_interactive_command(scratch: Path, variables: dict[str, str], additions: Callable[[str], str]) -> list[str]:
    """Return the command that starts the user's shell and then sets the search path again.

    The search path is set after the user's start-up files, because they often change it.
    """
    if sys.platform == "win32":
        return [os.environ.get("COMSPEC", "cmd.exe")]
    shell = os.environ.get("SHELL") or "/bin/sh"
    shell_name = Path(shell).name
    if shell_name in _SHELLS_WITH_START_FILE:
        # The folder is appended after the start-up file has run, so that the user's own entries come first.
        folders = variables["PATH"].split(os.pathsep)
        variables["PATH"] = os.pathsep.join(folder for folder in folders if folder != variables[MARK_VARIABLE])
    if shell_name == "bash":
        start_file = scratch / "bashrc"
        start_file.write_text(_format_start_file("~/.bashrc", variables) + additions(shell_name), encoding="utf-8")
        return [shell, "--rcfile", str(start_file), "-i"]
    if shell_name == "zsh":
        home = variables.get("ZDOTDIR") or variables.get("HOME") or "~"
        (scratch / ".zshrc").write_text(
            f"ZDOTDIR={shlex.quote(home)}\n" + _format_start_file(f"{home}/.zshrc", variables) + additions(shell_name),
            encoding="utf-8",
        )
        variables["ZDOTDIR"] = str(scratch)
        return [shell, "-i"]
    if shell_name == "fish":
        settings = "; ".join(
            f"set -gx {name} {shlex.quote(variables[name])}"
            for name in ("PYTHONPATH", MARK_VARIABLE)
            if name in variables
        )
        start_file = scratch / "start.fish"
        start_file.write_text(additions(shell_name), encoding="utf-8")
        return [
            shell,
            "-i",
            "--init-command",
            f"{settings}; set -gx PATH $PATH ${MARK_VARIABLE}; source {shlex.quote(str(start_file))}",
        ]
    return [shell, "-i"]


def _format_start_file(user_file: str, variables: Mapping[str, str]) -> str:
    """Return the contents of a start-up file for bash or zsh.

    The start-up file reads the user's own file, and then appends the commands to the search path.
    """
    interpreter = shlex.quote(str(Path(sys.executable).parent))
    standins = shlex.quote(process.standin_path())
    return f"""\
[ -f {user_file} ] && . {user_file}
command -v ros2 >/dev/null 2>&1 || case "$PATH:" in {interpreter}:*) ;; *) export PATH={interpreter}:"$PATH" ;; esac
export PATH="$PATH":{shlex.quote(variables[MARK_VARIABLE])}
case ":$PYTHONPATH:" in *:{standins}:*) ;; *) export PYTHONPATH="${{PYTHONPATH:+$PYTHONPATH:}}"{standins} ;; esac
PS1="(linkwright) $PS1"
"""


def _run(words: Sequence[str], variables: Mapping[str, str]) -> int:
    """Run a command until it ends, forward signals to it, and return its exit status.

    Ctrl-C in a terminal is not forwarded, because both processes receive it. Without a terminal, the command has its
    own process group, so that signals to the group of this process do not reach it twice. Ctrl-C must not raise
    KeyboardInterrupt here: just after the end of the wait, it would make `subprocess` lose the exit status and return
    0.
    """
    import signal

    child: subprocess.Popen[bytes] | None = None
    early_signals: list[int] = []  # signals that were received before the command was running
    is_detached = os.name == "posix" and not _has_terminal()

    def forward_signal(signal_number: int, _frame: object) -> None:
        if child is None:
            early_signals.append(signal_number)
        elif is_detached or signal_number != signal.SIGINT:
            child.send_signal(signal_number)

    previous = {number: signal.signal(number, forward_signal) for number in _find_forwarded_signals()}
    try:
        setup = _create_setup() if is_detached else None
        # The command is the user's own (S603). There is only one thread, and `setup` imports nothing (PLW1509).
        with subprocess.Popen(words, env=dict(variables), preexec_fn=setup) as child:  # noqa: S603, PLW1509
            for number in early_signals:
                if number == signal.SIGINT:
                    interrupt(child)
                else:
                    child.send_signal(number)
            status = child.wait()
    finally:
        for number, handler in previous.items():
            signal.signal(number, handler)
    return status if status >= 0 else 128 - status


def _has_terminal() -> bool:
    """Return whether a terminal controls this process.

    In that case, Ctrl-C also reaches the command.
    """
    try:
        os.close(os.open("/dev/tty", os.O_RDWR | os.O_NOCTTY))
    except OSError:
        return False
    return True


def _create_setup() -> Callable[[], None]:
    """Return a function that the process of the command calls before it runs the command.

    The function leaves the process group of its parent. On Linux, it also ends the command if the parent is killed.
    """
    import ctypes
    import signal

    prctl = ctypes.CDLL(None).prctl if sys.platform == "linux" else None

    def detach_from_parent() -> None:
        os.setpgid(0, 0)
        if prctl is not None:
            prctl(_PR_SET_PDEATHSIG, signal.SIGTERM)

    return detach_from_parent


def _find_forwarded_signals() -> list[int]:
    """Return the numbers of the signals that are forwarded.

    A signal that this process ignored from its start is excluded, because the command ignores it too.
    """
    import signal

    signals = [getattr(signal, name) for name in ("SIGINT", "SIGTERM", "SIGHUP") if hasattr(signal, name)]
    return [signal_number for signal_number in signals if signal.getsignal(signal_number) is not signal.SIG_IGN]
