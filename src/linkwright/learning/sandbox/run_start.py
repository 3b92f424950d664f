"""Start of the program of a run, with the confinement that the system supports.

The supervisor forks a child. If namespaces are allowed, the child enters them and forks twice: first process 1 of
the new namespace, whose end ends all others, then the program. Otherwise the child becomes the program.
Each process reports to the supervisor through a pipe.
"""

from __future__ import annotations

import contextlib
import json
import os
import signal
import sys
from collections.abc import Callable
from dataclasses import dataclass, field
from typing import Any, NoReturn

from linkwright.learning.sandbox.plan import Plan
from linkwright.learning.sandbox.process_limits import apply_limits, count_threads_of_user, lower_priority

_TEMPORARY_SHARE = 8
"""/tmp and /dev/shm may each contain this part of the memory limit."""


@dataclass
class Confinement:
    """The protections that have been applied to the run so far."""

    namespaces: set[str] = field(default_factory=set)
    """`user`, `processes`, `mounts`, `ipc`, `network`; `root` when the run has a root folder of its own."""
    landlock: int = 0
    """The version of Landlock."""
    landlock_signals: bool = False
    user: int | None = None
    """The user that only this run has."""
    local_servers_forbidden: bool = False

    def to_message(self) -> dict[str, Any]:
        """Return the confinement as a message to the supervisor."""
        return {**vars(self), "namespaces": sorted(self.namespaces)}

    def update(self, message: dict[str, Any]) -> None:
        """Update the confinement from a message of `to_message`."""
        self.namespaces = set(message["namespaces"])
        self.landlock = message["landlock"]
        self.landlock_signals = message["landlock_signals"]
        self.user = message["user"]
        self.local_servers_forbidden = message["local_servers_forbidden"]


class Messages:
    """A pipe through which the processes of a run send lines of JSON to the supervisor."""

    def __init__(self) -> None:
        self.reader, self.writer = os.pipe()
        self._rest = b""

    def send(self, **message: Any) -> None:
        """Send a message, which must be short enough for an atomic write to a pipe."""
        os.write(self.writer, json.dumps(message).encode() + b"\n")

    def close_writer(self) -> None:
        """Close this process's end for writing.

        `receive` ends when all processes have closed their ends.
        """
        os.close(self.writer)

    def receive(self) -> dict[str, Any] | None:
        """Wait for the next message, and return it, or None if the pipe is closed."""
        while b"\n" not in self._rest:
            part = os.read(self.reader, 65536)
            if not part:
                return None
            self._rest += part
        line, _, self._rest = self._rest.partition(b"\n")
        message: dict[str, Any] = json.loads(line)
        return message


@dataclass
class Start:
    """The start of the program, with the data that all processes of the start need."""

    plan: Plan
    messages: Messages
    go_pipe: tuple[int, int]
    """A pipe on which the supervisor lets the child continue."""
    output: tuple[int, int]
    user: int | None
    requested_namespaces: frozenset[str]
    """Of `processes`, `mounts`, `ipc` and `network`."""
    needs_root_folder: bool
    """Whether the program could not run without a root folder of its own."""

    def run_child(self, supervisor: int) -> NoReturn:
        """Run as the child process of the supervisor. Never returns."""
        try:
            os.close(self.go_pipe[1])
            os.close(self.messages.reader)
            self._enter(supervisor)
        except BaseException as error:  # noqa: BLE001 - this process must not continue as another supervisor
            with contextlib.suppress(OSError):
                self.messages.send(failed=f"{type(error).__name__}: {error}")
        finally:
            os._exit(125)

    def _enter(self, supervisor: int) -> NoReturn:
        confinement = Confinement(user=self.user)
        if sys.platform != "linux":
            self._become_program(confinement, supervisor)
        from linkwright.learning.sandbox.linux import die_with_parent

        die_with_parent(signal.SIGKILL, supervisor)
        if self.requested_namespaces:
            confinement.namespaces = self._enter_namespaces()
        if "processes" not in confinement.namespaces:
            self._prepare_namespaces(confinement)
            self._become_program(confinement, supervisor)
        _fork(lambda: self._run_first_process(confinement))
        os.closerange(0, 3)
        _wait_for_all()
        os._exit(0)

    def _enter_namespaces(self) -> set[str]:
        from linkwright.learning.sandbox.namespaces import enter_namespaces, enter_user_namespace

        if os.geteuid() == 0 and (entered := enter_namespaces(self.requested_namespaces)):
            return entered
        try:
            enter_user_namespace()
        except OSError:
            return set()
        self.messages.send(map=os.getpid())
        if os.read(self.go_pipe[0], 1) != b"y":
            os._exit(125)
        entered = enter_namespaces(self.requested_namespaces)
        if not entered:
            self._give_up()
        return entered | {"user"}

    def _give_up(self) -> NoReturn:
        self.messages.send(useless="namespaces")
        os._exit(125)

    def _prepare_namespaces(self, confinement: Confinement) -> None:
        from linkwright.learning.sandbox.namespaces import bring_up_loopback
        from linkwright.learning.sandbox.new_root import enter_new_root

        if "network" in confinement.namespaces:
            bring_up_loopback()
        if "mounts" in confinement.namespaces:
            temporary_bytes = max(1 << 20, self.plan.limits.memory // _TEMPORARY_SHARE)
            try:
                enter_new_root(
                    list(self.plan.readable),
                    self.plan.folder,
                    temporary_bytes,
                    own_processes="processes" in confinement.namespaces,
                )
            except OSError:  # the mounts made so far cannot stay
                self._give_up()
            confinement.namespaces.add("root")
        if self.needs_root_folder and "root" not in confinement.namespaces:
            self._give_up()

    def _run_first_process(self, confinement: Confinement) -> NoReturn:
        """Run as process 1 of the run's process namespace.

        The end of the program ends all its processes.
        """
        from linkwright.learning.sandbox.linux import die_with_parent

        die_with_parent(signal.SIGKILL, 0)  # the parent is outside this namespace, which shows it as 0
        _restore_signals()  # the kernel ignores those to this process that have no handler
        self._prepare_namespaces(confinement)
        program = _fork(lambda: self._become_program(confinement, 1))
        os.closerange(0, 3)
        status = _wait_for(program)
        with contextlib.suppress(OSError):
            self.messages.send(ended=status)
        os._exit(0)

    def _become_program(self, confinement: Confinement, parent: int) -> NoReturn:
        plan = self.plan
        os.setsid()
        _take_standard_streams(self.output)
        lower_priority(plan.processors)
        os.chdir(plan.folder)
        other_threads = 0 if self._is_counted_alone(confinement) else count_threads_of_user()
        if sys.platform == "linux":
            self._restrict(confinement, parent)
        apply_limits(plan.limits, other_threads=other_threads)
        self.messages.send(applied=confinement.to_message())
        _restore_signals()
        os.closerange(3, self.messages.writer)
        os.closerange(self.messages.writer + 1, 4096)
        try:
            os.execvpe(plan.arguments[0], plan.arguments, plan.environment)  # noqa: S606 - the purpose of this module
        except OSError as error:
            self.messages.send(failed=f"{plan.arguments[0]}: {error.strerror}")
        os._exit(127)

    def _is_counted_alone(self, confinement: Confinement) -> bool:
        """Return whether the kernel counts the run's processes separately from the user's others."""
        return self.user is not None or ("user" in confinement.namespaces and _does_kernel_count_in_namespaces())

    def _restrict(self, confinement: Confinement, parent: int) -> None:
        from linkwright.learning.sandbox import landlock
        from linkwright.learning.sandbox.identity import become
        from linkwright.learning.sandbox.linux import die_with_parent, drop_capabilities, forbid_new_privileges
        from linkwright.learning.sandbox.seccomp import filter_system_calls

        if self.user is not None:
            become(self.user)
        drop_capabilities()
        forbid_new_privileges()
        die_with_parent(signal.SIGKILL, parent)
        shares_servers = "root" not in confinement.namespaces and self.user is None
        is_filtered = filter_system_calls(forbid_local_servers=shares_servers)
        confinement.local_servers_forbidden = is_filtered and shares_servers
        if "root" in confinement.namespaces and landlock.landlock_version() < landlock.MOVE_VERSION:
            return  # Landlock would forbid moving files between folders, and the root folder protects as well
        special = [path for path in ("/tmp", "/dev/shm", "/dev/pts") if "root" in confinement.namespaces]
        devices = [f"/dev/{name}" for name in ("null", "zero", "full", "random", "urandom", "ptmx", "tty")]
        proc = ["/proc"] if "root" in confinement.namespaces else []
        with contextlib.suppress(OSError):
            confinement.landlock, confinement.landlock_signals = landlock.restrict(
                [*self.plan.readable, *proc],
                ["/"] if "root" in confinement.namespaces else [],
                [self.plan.folder, *special, *devices],
            )


def _fork(run: Callable[[], NoReturn]) -> int:
    """Fork, call a function in the child, and return the child's process ID in the parent."""
    child = os.fork()
    if child == 0:
        run()
    return child


def _does_kernel_count_in_namespaces() -> bool:
    """Return whether the kernel counts processes per user namespace (Linux 5.14 and later)."""
    major, minor, *_ = os.uname().release.split(".")
    return (int(major), int(minor.partition("-")[0])) >= (5, 14)


def _take_standard_streams(output: tuple[int, int]) -> None:
    nothing = os.open(os.devnull, os.O_RDONLY)
    os.dup2(nothing, 0)
    os.dup2(output[0], 1)
    os.dup2(output[1], 2)


def _restore_signals() -> None:
    """Restore the default handling of the signals that Python ignores."""
    for number in signal.valid_signals() - {signal.SIGKILL, signal.SIGSTOP}:
        with contextlib.suppress(OSError, ValueError):
            signal.signal(number, signal.SIG_DFL)
    signal.pthread_sigmask(signal.SIG_SETMASK, ())


def _wait_for(program: int) -> int:
    """Reap children until a program ends, and return its exit status, negative for a signal."""
    while True:
        pid, status = os.waitpid(-1, 0)
        if pid == program:
            return os.waitstatus_to_exitcode(status)


def _wait_for_all() -> None:
    with contextlib.suppress(ChildProcessError):
        while True:
            os.waitpid(-1, 0)
