"""Runs a shell, or a command, in an environment with the commands of ROS 2.

The folder of our programs is last on the search path, so that installed programs take precedence. Start-up files of
shells often set the path again (``~/.bashrc`` may source ROS 2), so the shell reads them before our own start-up file.
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
from linkwright.shell.instead import no_such_command
from linkwright.shell.programs import PROGRAMS, write_programs
from linkwright.standins import process

_PR_SET_PDEATHSIG = 1
"""The option of prctl(2) for a signal on the parent's end."""
MARK = "LINKWRIGHT_SHELL"
"""The environment variable with the folder of the shell's programs."""


def run_shell(
    command: Sequence[str] = (),
    environment: Mapping[str, str] | None = None,
    additions: Callable[[str], str] | None = None,
) -> int:
    """Run the user's shell, or a command, until it ends.

    Args:
        command: the program and its arguments; empty for the user's interactive shell.
        environment: the environment to extend; None for the environment of this process.
        additions: returns additional start-up commands for ``bash``, ``zsh`` or ``fish``.

    Returns:
        The exit status; 128 plus the signal's number if a signal ended the program, as in shells.

    Raises:
        LinkwrightError: SHELL101, there is no such command.
    """
    with ScratchFolder("shell") as scratch:
        folder = Path(scratch) / "bin"
        folder.mkdir()
        write_programs(folder)
        variables = shell_environment(folder, os.environ if environment is None else environment)
        words = list(command) or _interactive(Path(scratch), variables, additions or (lambda _: ""))
        path = shutil.which(words[0], path=variables["PATH"])
        if path is None:
            raise no_such_command(words[0], tuple(PROGRAMS), _QUOTES)
        return _run([path, *words[1:]], variables)


_QUOTES = phrase(
    "`--` is followed by one command with its arguments; for several commands, write `linkwright "
    "shell -- bash -c '...'`"
)


def shell_environment(folder: Path, base: Mapping[str, str]) -> dict[str, str]:
    """Return the environment of the shell.

    If no ``ros2`` is installed, the folder of Linkwright's interpreter is first on the search path, so that ``python3``
    finds our stand-ins and their dependencies.

    Args:
        folder: the folder of our programs.
        base: the environment to extend.
    """
    variables = process.environment(base)
    parts = [part for part in variables.get("PATH", os.defpath).split(os.pathsep) if part and part != base.get(MARK)]
    if shutil.which("ros2", path=os.pathsep.join(parts)) is None:
        own = str(Path(sys.executable).parent)
        parts = [own, *(part for part in parts if part != own)]
    variables["PATH"] = os.pathsep.join([*parts, str(folder)])
    variables[MARK] = str(folder)
    return variables


_STARTED_BY_A_FILE = ("bash", "zsh", "fish")


def _interactive(scratch: Path, variables: dict[str, str], additions: Callable[[str], str]) -> list[str]:
    """Return the command that starts the user's shell and then restores our search path.

    The shell's start-up files often set the search path, so ours is set after them.
    """
    if sys.platform == "win32":
        return [os.environ.get("COMSPEC", "cmd.exe")]
    shell = os.environ.get("SHELL") or "/bin/sh"
    kind = Path(shell).name
    if kind in _STARTED_BY_A_FILE:  # the entries of the user's start-up file precede our folder
        parts = variables["PATH"].split(os.pathsep)
        variables["PATH"] = os.pathsep.join(part for part in parts if part != variables[MARK])
    if kind == "bash":
        start = scratch / "bashrc"
        start.write_text(_start_file("~/.bashrc", variables) + additions(kind), encoding="utf-8")
        return [shell, "--rcfile", str(start), "-i"]
    if kind == "zsh":
        home = variables.get("ZDOTDIR") or variables.get("HOME") or "~"
        (scratch / ".zshrc").write_text(
            f"ZDOTDIR={shlex.quote(home)}\n" + _start_file(f"{home}/.zshrc", variables) + additions(kind),
            encoding="utf-8",
        )
        variables["ZDOTDIR"] = str(scratch)
        return [shell, "-i"]
    if kind == "fish":
        settings = "; ".join(
            f"set -gx {name} {shlex.quote(variables[name])}" for name in ("PYTHONPATH", MARK) if name in variables
        )
        start = scratch / "start.fish"
        start.write_text(additions(kind), encoding="utf-8")
        return [
            shell,
            "-i",
            "--init-command",
            f"{settings}; set -gx PATH $PATH ${MARK}; source {shlex.quote(str(start))}",
        ]
    return [shell, "-i"]


def _start_file(own: str, variables: Mapping[str, str]) -> str:
    """Return the contents of the start-up file for bash and zsh.

    It reads the user's own file, then appends our commands to the search path.
    """
    interpreter = shlex.quote(str(Path(sys.executable).parent))
    standins = shlex.quote(process.standin_path())
    return f"""\
[ -f {own} ] && . {own}
command -v ros2 >/dev/null 2>&1 || case "$PATH:" in {interpreter}:*) ;; *) export PATH={interpreter}:"$PATH" ;; esac
export PATH="$PATH":{shlex.quote(variables[MARK])}
case ":$PYTHONPATH:" in *:{standins}:*) ;; *) export PYTHONPATH="${{PYTHONPATH:+$PYTHONPATH:}}"{standins} ;; esac
PS1="(linkwright) $PS1"
"""


def _run(words: Sequence[str], variables: Mapping[str, str]) -> int:
    """Run a command until it ends, and forward signals to it; return its exit status.

    Ctrl-C in a terminal is not forwarded, because both processes receive it. Without a terminal, the command has its
    own process group, so that signals to our group do not reach it twice. Ctrl-C must not raise KeyboardInterrupt
    here: if it does so just after the wait ends, the exit status is lost, and `subprocess` returns 0.
    """
    import signal

    child: subprocess.Popen[bytes] | None = None
    early: list[int] = []  # signals that arrived before the command was running
    alone = os.name == "posix" and not _has_terminal()

    def pass_on(number: int, _frame: object) -> None:
        if child is None:
            early.append(number)
        elif alone or number != signal.SIGINT:
            child.send_signal(number)

    previous = {number: signal.signal(number, pass_on) for number in _forwarded_signals()}
    try:
        first = _detaching() if alone else None
        # The command is the user's own (S603). There is only one thread, and `first` imports nothing (PLW1509).
        with subprocess.Popen(words, env=dict(variables), preexec_fn=first) as child:  # noqa: S603, PLW1509
            for number in early:
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
    """Return whether a terminal controls this process; its Ctrl-C then reaches the command, too."""
    try:
        os.close(os.open("/dev/tty", os.O_RDWR | os.O_NOCTTY))
    except OSError:
        return False
    return True


def _detaching() -> Callable[[], None]:
    """Return a function that the command's process runs before the command.

    The function leaves our process group and, on Linux, ends the command if our process is killed.
    """
    import ctypes
    import signal

    prctl = ctypes.CDLL(None).prctl if sys.platform == "linux" else None

    def stand_alone() -> None:
        os.setpgid(0, 0)
        if prctl is not None:
            prctl(_PR_SET_PDEATHSIG, signal.SIGTERM)

    return stand_alone


def _forwarded_signals() -> list[int]:
    """Return the numbers of the signals to forward.

    Signals that this process was started to ignore are excluded; the command ignores them, too.
    """
    import signal

    known = [getattr(signal, name) for name in ("SIGINT", "SIGTERM", "SIGHUP") if hasattr(signal, name)]
    return [number for number in known if signal.getsignal(number) is not signal.SIG_IGN]
