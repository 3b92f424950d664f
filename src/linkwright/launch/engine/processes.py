"""Processes of a launch: started in groups of their own, read line by line, ended for sure."""

from __future__ import annotations

import asyncio
import contextlib
import os
import signal
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

from linkwright.launch import events

if TYPE_CHECKING:
    from linkwright.launch.actions.execute import ExecuteProcess
    from linkwright.launch.engine.log import LaunchLog

_CHUNK = 1 << 16
_HAS_GROUPS = hasattr(os, "killpg")


@dataclass(frozen=True)
class ProcessPlan:
    """A process to be started; see `ExecuteProcess` for what the parts mean."""

    action: ExecuteProcess
    name: str
    command: Sequence[str]
    folder: str | None
    environment: Mapping[str, str]
    shell: bool
    emulate_tty: bool
    destinations: Mapping[int, frozenset[str]]
    output_format: str
    log_command: bool
    respawn: bool
    respawn_delay: float
    respawn_limit: int
    seconds_to_sigterm: float
    seconds_to_sigkill: float


class RunningProcess:
    """One process from its start to its end.

    Args:
        plan: what to start.
        name: its name in the log, such as ``talker-1``.
        log: where its lines go.
        emit: takes the events about it.
        wants_output: whether any handler is for what it writes.
    """

    def __init__(
        self,
        plan: ProcessPlan,
        name: str,
        log: LaunchLog,
        emit: Callable[[events.Event], None],
        wants_output: Callable[[events.Event], bool],
    ) -> None:
        self.plan = plan
        self.name = name
        self._log = log
        self._emit = emit
        self._wants_output = wants_output
        self._process: asyncio.subprocess.Process | None = None
        self._rests = {1: b"", 2: b""}
        self._ended = asyncio.Event()
        self._stopping = False

    @property
    def stopping(self) -> bool:
        """Whether it was asked to end."""
        return self._stopping

    async def run(self) -> int | None:
        """Follow the process from start to end; returns its exit status, None if it could not be started."""
        plan = self.plan
        if plan.log_command:
            self._log.say(self.name, f"process details: cmd='{' '.join(plan.command)}', cwd='{plan.folder}'")
        reader_ends: list[int] = []
        try:
            process = await self._start(reader_ends)
        except (OSError, ValueError) as error:
            for descriptor in reader_ends:
                os.close(descriptor)
            self._report_start_failure(error)
            self._ended.set()
            return None
        self._process = process
        details = self._details()
        plan.action.process_details = details
        self._log.say(self.name, f"process started with pid [{process.pid}]")
        self._emit(events.ProcessStarted(action=plan.action, **details))
        try:
            await self._follow(process, reader_ends)
        finally:
            # Whatever happens to us, nothing of the process's group may outlive us.
            self.signal_group(signal.SIGKILL if process.returncode is None else 0)
        returncode = await process.wait()
        if process.stdin is not None:
            process.stdin.close()
        self._flush()
        self._ended.set()
        self._report_end(returncode)
        self._emit(events.ProcessExited(action=plan.action, returncode=returncode, **details))
        return returncode

    async def stop(self, seconds_to_sigterm: float, seconds_to_sigkill: float, *, interrupt: bool = True) -> None:
        """Ask the process to end, with SIGINT, then SIGTERM, then SIGKILL."""
        if self._stopping or self._ended.is_set():
            return
        self._stopping = True
        if interrupt:
            self._log.say(self.name, f"sending signal 'SIGINT' to process[{self.name}]")
            self.signal_group(signal.SIGINT)
        for seconds, sent, following in (
            (seconds_to_sigterm, "SIGINT", "SIGTERM"),
            (seconds_to_sigkill, "SIGTERM", "SIGKILL"),
        ):
            with contextlib.suppress(asyncio.TimeoutError):
                await asyncio.wait_for(self._ended.wait(), seconds)
            if self._ended.is_set():
                return
            self._log.complain(
                self.name,
                f"process[{self.name}] failed to terminate '{seconds:g}' seconds after receiving '{sent}', "
                f"escalating to '{following}'",
            )
            self.signal_group(getattr(signal, following, signal.SIGTERM))

    def signal(self, number: signal.Signals) -> None:
        """Send a signal, as a launch file asked."""
        self._log.say(self.name, f"sending signal '{number.name}' to process[{self.name}]")
        self.signal_group(number)

    def signal_group(self, number: int) -> None:
        """Send a signal to the process and all that it started; 0 sends none."""
        process = self._process
        if process is None or number == 0:
            return
        with contextlib.suppress(ProcessLookupError, PermissionError):
            if _HAS_GROUPS:
                os.killpg(process.pid, number)
            elif process.returncode is None:
                process.terminate()

    # --- the start ------------------------------------------------------------------------------------------

    async def _start(self, reader_ends: list[int]) -> asyncio.subprocess.Process:
        plan = self.plan
        options: dict[str, Any] = {
            "stdin": asyncio.subprocess.PIPE,
            "stdout": asyncio.subprocess.PIPE,
            "stderr": asyncio.subprocess.PIPE,
            "cwd": plan.folder,
            "env": plan.environment,
            "start_new_session": True,
        }
        writer_ends: list[int] = []
        if plan.emulate_tty and hasattr(os, "openpty"):
            for stream in ("stdout", "stderr"):
                reader, writer = os.openpty()
                reader_ends.append(reader)
                writer_ends.append(writer)
                options[stream] = writer
        try:
            if plan.shell:
                return await asyncio.create_subprocess_shell(" ".join(plan.command), **options)
            return await asyncio.create_subprocess_exec(*plan.command, **options)
        finally:
            for writer in writer_ends:
                os.close(writer)

    def _details(self) -> dict[str, Any]:
        assert self._process is not None
        return {
            "name": self.name,
            "cmd": list(self.plan.command),
            "cwd": self.plan.folder,
            "env": dict(self.plan.environment),
            "pid": self._process.pid,
        }

    def _report_start_failure(self, error: Exception) -> None:
        from linkwright.launch.places import error_at

        program = self.plan.command[0]
        hint = None
        if isinstance(error, FileNotFoundError) and self.plan.folder and not os.path.isdir(self.plan.folder):  # noqa: PTH112
            message = f"process '{self.name}' cannot be started: folder '{self.plan.folder}' does not exist"
        elif isinstance(error, FileNotFoundError):
            message = f"process '{self.name}' cannot be started: program '{program}' does not exist"
            if " " in program:
                hint = "give program and arguments as separate items of cmd, or set shell=True"
        else:
            reason = error.strerror if isinstance(error, OSError) else str(error)
            message = f"process '{self.name}' cannot be started: {reason}: '{program}'"
        self._log.diagnostics(error_at(self.plan.action.place, "LAUNCH142", message, hint).diagnostics)

    # --- output ---------------------------------------------------------------------------------------------

    async def _follow(self, process: asyncio.subprocess.Process, reader_ends: Sequence[int]) -> None:
        """Read both streams until the last writer is gone or the process has ended."""
        if reader_ends:
            streams = [await _pty_reader(descriptor) for descriptor in reader_ends]
        else:
            assert process.stdout is not None
            assert process.stderr is not None
            streams = [process.stdout, process.stderr]
        readers = [asyncio.ensure_future(self._read(number, each)) for number, each in enumerate(streams, 1)]
        try:
            await process.wait()
            # A grandchild may hold the pipes open for ever: what the process itself wrote is there by now.
            await asyncio.wait(readers, timeout=0.2)
        finally:
            for reader in readers:
                reader.cancel()
            await asyncio.gather(*readers, return_exceptions=True)

    async def _read(self, number: int, stream: asyncio.StreamReader) -> None:
        while True:
            try:
                chunk = await stream.read(_CHUNK)
            except OSError:  # a pseudo terminal ends with an error on Linux
                return
            if not chunk:
                return
            self._take(number, chunk)

    def _take(self, number: int, chunk: bytes) -> None:
        plan = self.plan
        plan.action.wrote(number, chunk)
        kind = events.ProcessStdout if number == 1 else events.ProcessStderr
        event = kind(text=chunk, action=plan.action, **self._details())
        if self._wants_output(event):
            self._emit(event)
        *lines, self._rests[number] = (self._rests[number] + chunk).split(b"\n")
        for line in lines:
            self._show(number, line)

    def _flush(self) -> None:
        for number, rest in self._rests.items():
            if rest:
                self._show(number, rest)

    def _show(self, number: int, line: bytes) -> None:
        text = line.decode(errors="replace").rstrip("\r")
        shown = self.plan.output_format.format(line=text, this=self.plan.action)
        self._log.process_line(self.name, number, shown, self.plan.destinations[number])

    def _report_end(self, returncode: int) -> None:
        assert self._process is not None
        if returncode == 0 or (self._stopping and returncode in (-signal.SIGINT, 128 + signal.SIGINT)):
            self._log.say(self.name, f"process has finished cleanly [pid {self._process.pid}]")
            return
        command = " ".join(self.plan.command)
        self._log.complain(
            self.name,
            f"process has died [pid {self._process.pid}, exit code {returncode}, cmd '{command}'].",
        )


async def _pty_reader(descriptor: int) -> asyncio.StreamReader:
    reader = asyncio.StreamReader()
    loop = asyncio.get_running_loop()
    pipe = os.fdopen(descriptor, "rb", 0)
    await loop.connect_read_pipe(lambda: asyncio.StreamReaderProtocol(reader), pipe)
    return reader
