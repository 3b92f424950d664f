"""The supervisor of a run, a process between the grader and the student's program.

It reads a plan from standard input, starts the program confined, watches it, ends all its processes, and prints the
outcome. The grader starts it with ``python -c`` and its own search path, so no code of the student is imported.
"""

from __future__ import annotations

import contextlib
import os
import select
import signal
import sys
from types import FrameType

from linkwright.learning.sandbox.contents import change_owner, remove_harmful, remove_user_files
from linkwright.learning.sandbox.outcome import Exceeded, Outcome, Protection
from linkwright.learning.sandbox.plan import Plan, outcome_to_json
from linkwright.learning.sandbox.processes import end_descendants
from linkwright.learning.sandbox.run_start import Confinement, Messages, Start
from linkwright.learning.sandbox.usage import Watchdog

_POLL_INTERVAL_S = 0.05
_NAMESPACES = frozenset({"processes", "mounts", "ipc", "network"})
_TRUNCATE_VERSION = 3
"""The version of Landlock since which the size of files outside cannot be changed."""
_FOLDERS_WITHOUT_PROGRAMS = ("/etc/", "/proc/", "/sys/")
_UMASK = 0o022
"""That of the run, whatever that of the grader: the user of the run passes through the new root folder."""


class RunFailedError(Exception):
    """Raised when the program cannot be started."""


def main() -> None:
    """Supervise the run whose plan is read from standard input, and print its outcome as JSON."""
    os.umask(_UMASK)
    plan = Plan.from_json(sys.stdin.read())
    supervisor = _Supervisor(plan)
    signal.signal(signal.SIGTERM, supervisor.on_end_requested)
    try:
        outcome = supervisor.run()
    except RunFailedError as error:
        sys.exit(str(error))
    sys.stdout.write(outcome_to_json(outcome))


class _Supervisor:
    def __init__(self, plan: Plan) -> None:
        self._plan = plan
        self._grader = os.getppid()
        self._output = _Output(plan.limits.output_bytes)
        self._messages = Messages()
        self._confinement = Confinement()
        self._owner = os.lstat(plan.folder)
        self._leader = 0
        self._status: int | None = None
        self._end_requested = False

    def on_end_requested(self, _number: int, _frame: FrameType | None) -> None:
        self._end_requested = True

    def run(self) -> Outcome:
        """Run the program until it ends or exceeds a limit, and return the outcome.

        All processes of the run have ended when this method returns.
        """
        folder = self._plan.folder
        if sys.platform == "linux":
            from linkwright.learning.sandbox.linux import adopt_orphans

            adopt_orphans()
        watchdog = Watchdog(self._plan.limits, folder)
        try:
            try:
                self._start()
                watchdog.user = self._confinement.user
                exceeded = self._watch(watchdog)
            finally:
                end_descendants(self._confinement.user)
                self._remove_temporary_files()
        finally:
            if not os.path.samestat(os.lstat(folder), self._owner):
                raise RunFailedError("the program has replaced its folder")
            change_owner(self._owner.st_uid, self._owner.st_gid, folder)
        self._output.read_all()
        exceeded = exceeded or watchdog.find_exceeded_at_end() or self._find_limit_of_signal()
        return Outcome(
            status=-signal.SIGKILL if self._status is None else self._status,
            stdout=bytes(self._output.stdout),
            stderr=bytes(self._output.stderr),
            exceeded=exceeded,
            protections=find_protections(self._confinement),
            removed=remove_harmful(folder),
            seconds=watchdog.seconds,
            cpu_seconds=watchdog.cpu_seconds,
        )

    def _remove_temporary_files(self) -> None:
        """Delete the run's files in shared folders of the system, if their user identifies them."""
        if self._confinement.user is not None and "root" not in self._confinement.namespaces:
            remove_user_files(self._confinement.user)

    def _start(self) -> None:
        """Start the program with all namespaces, or with the namespaces that this system allows."""
        user = self._find_user()
        needs_root_folder = user is not None and not self._can_reach()
        if self._try_to_start(user, _NAMESPACES, needs_root_folder=needs_root_folder):
            return
        if needs_root_folder:
            user = None
        for namespaces in (_NAMESPACES - {"mounts"}, frozenset[str]()):
            if self._try_to_start(user, namespaces):
                return
        raise RunFailedError("the program's process ended before the program started")

    def _find_user(self) -> int | None:
        if sys.platform != "linux":
            return None
        from linkwright.learning.sandbox.identity import find_unused_user, is_readable_for_others

        programs = [path for path in self._plan.readable if not path.startswith(_FOLDERS_WITHOUT_PROGRAMS)]
        return find_unused_user() if all(map(is_readable_for_others, programs)) else None

    def _can_reach(self) -> bool:
        from linkwright.learning.sandbox.identity import can_be_reached

        return can_be_reached([self._plan.folder, *self._plan.readable])

    def _try_to_start(self, user: int | None, namespaces: frozenset[str], *, needs_root_folder: bool = False) -> bool:
        owner = (self._owner.st_uid, self._owner.st_gid) if user is None else (user, user)
        change_owner(*owner, self._plan.folder)
        self._confinement.user = user
        self._messages = Messages()
        go_reader, go_pipe = os.pipe()
        start = Start(
            self._plan, self._messages, (go_reader, go_pipe), self._output.writers, user, namespaces, needs_root_folder
        )
        supervisor = os.getpid()
        self._leader = os.fork()
        if self._leader == 0:
            start.run_child(supervisor)
        os.close(go_reader)
        self._messages.close_writer()
        try:
            is_started = self._follow_start(go_pipe)
        finally:
            os.close(go_pipe)
        if is_started:
            self._output.close_writers()
        else:
            end_descendants(user)
        return is_started

    def _follow_start(self, go_pipe: int) -> bool:
        """Handle the messages of the start until the program runs.

        Returns whether the namespaces are usable.
        """
        while (message := self._messages.receive()) is not None:
            if "map" in message:
                from linkwright.learning.sandbox.namespaces import map_users

                try:
                    map_users(message["map"])
                except OSError:
                    os.write(go_pipe, b"n")
                    return False
                os.write(go_pipe, b"y")
            elif "applied" in message:
                self._confinement.update(message["applied"])
                return True
            elif "failed" in message:
                raise RunFailedError(message["failed"])
            else:
                return False
        return False

    def _watch(self, watchdog: Watchdog) -> Exceeded | None:
        """Monitor the program until it ends or exceeds a limit, and return that limit or None."""
        poll = select.poll()
        sources = [*self._output.readers, self._messages.reader]
        for source in sources:
            poll.register(source, select.POLLIN)
        while True:
            for descriptor, _ in poll.poll(_POLL_INTERVAL_S * 1000):
                is_open = self._take_message() if descriptor == self._messages.reader else self._output.read(descriptor)
                if not is_open:
                    poll.unregister(descriptor)
            self._reap()
            if self._status is not None or self._end_requested or os.getppid() != self._grader:
                return None
            if self._output.is_full:
                return Exceeded.OUTPUT_BYTES
            if exceeded := watchdog.check_in_time():
                return exceeded

    def _take_message(self) -> bool:
        message = self._messages.receive()
        if message is None:
            return False
        if "failed" in message:
            raise RunFailedError(message["failed"])
        self._status = message["ended"]
        return True

    def _reap(self) -> None:
        """Reap children and adopted orphans that have ended."""
        with contextlib.suppress(ChildProcessError):
            while (ended := os.waitpid(-1, os.WNOHANG))[0]:
                if ended[0] == self._leader and self._status is None:
                    self._status = self._get_leader_status(ended[1])

    def _get_leader_status(self, status: int) -> int:
        if "processes" not in self._confinement.namespaces:
            return os.waitstatus_to_exitcode(status)
        message = self._messages.receive()  # the leader is not the program, whose status came before
        return -signal.SIGKILL if message is None or "ended" not in message else int(message["ended"])

    def _find_limit_of_signal(self) -> Exceeded | None:
        if self._status == -signal.SIGXCPU:
            return Exceeded.CPU_SECONDS
        if self._status == -signal.SIGXFSZ:
            return Exceeded.FILE_BYTES
        return None


class _Output:
    """The captured standard output and standard error of the run, up to a limit."""

    def __init__(self, limit: int) -> None:
        self._limit = limit
        out, err = os.pipe(), os.pipe()
        self.readers = (out[0], err[0])
        self.writers = (out[1], err[1])
        self.stdout, self.stderr = bytearray(), bytearray()
        self.is_full = False
        for reader in self.readers:
            os.set_blocking(reader, False)

    def close_writers(self) -> None:
        for writer in self.writers:
            os.close(writer)

    def read(self, descriptor: int) -> bool:
        """Read the available output of a stream, and return False at its end."""
        try:
            part = os.read(descriptor, 65536)
        except BlockingIOError:
            return True
        room = self._limit - len(self.stdout) - len(self.stderr)
        self.is_full = self.is_full or len(part) > room
        buffer = self.stdout if descriptor == self.readers[0] else self.stderr
        buffer += part[:room]
        return bool(part)

    def read_all(self) -> None:
        """Read the remaining output after all writers have ended."""
        for descriptor in self.readers:
            while self.read(descriptor):
                pass


def find_protections(confinement: Confinement) -> frozenset[Protection]:
    """Return the protections that a confinement provides."""
    if sys.platform != "linux":
        return frozenset({Protection.LIMITS})
    has_root = "root" in confinement.namespaces
    has_user = confinement.user is not None
    is_alone = has_root or has_user or confinement.local_servers_forbidden  # no server of the user acts for the run
    protections = {Protection.LIMITS}
    if is_alone and (has_user or confinement.landlock_signals or "processes" in confinement.namespaces):
        protections |= {Protection.PROCESSES, Protection.ENDED}
    if is_alone and (has_root or confinement.landlock):
        protections.add(Protection.READ)
    if is_alone and (has_root or confinement.landlock >= _TRUNCATE_VERSION):
        protections.add(Protection.WRITE)
    if has_root and "network" in confinement.namespaces:
        protections.add(Protection.NETWORK)
    return frozenset(protections)
