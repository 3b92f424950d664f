"""The processes of a launch.

Each process has its own process group, and its output is logged line by line.
"""

from __future__ import annotations

import asyncio
import codecs
import contextlib
import os
import signal
import time
from collections.abc import Callable
from functools import partial
from typing import TYPE_CHECKING, Any

from linkwright.diagnostics import foreign, phrase
from linkwright.launch.model import events
from linkwright.launch.model.plans import ProcessPlan
from linkwright.packages.programs.child_python import process_environment

if TYPE_CHECKING:
    from linkwright.diagnostics import LinkwrightError
    from linkwright.hosting.launch_log import LaunchLog
    from linkwright.launch.engine.guardian import Guardian

_HAS_PROCESS_GROUPS = hasattr(os, "killpg")
_KILL_SIGNAL = getattr(signal, "SIGKILL", signal.SIGTERM)
_OUTPUT_DRAIN_S = 0.2
"""The maximum seconds to read output after a process has ended.

Its children may keep the streams open.
"""
_MAX_LINE_LENGTH = 100_000
"""The maximum number of characters of an incomplete line."""
_ESCALATION_S = {"SIGTERM": 0.0, "SIGKILL": 0.5}
"""The seconds to wait before each signal after the user has repeated the interrupt.

The keys are the names of the signals.
"""
_TERMINALS = frozenset({"xterm", "gnome-terminal", "konsole", "terminator", "x-terminal-emulator", "xfce4-terminal"})
"""Terminal programs that launch files use as ``prefix``.

In a terminal, the process can read the keyboard.
"""


class RunningProcess:
    """A process of a launch, from its start to its end.

    Args:
        plan: the plan of the process.
        name: the name of the process in the log, such as ``talker-1``.
        log: the log that receives the output of the process.
        emit: the function that receives the events of the process.
        wants_output: returns whether any handler would accept an output event.
        guardian: the guardian that ends the process if the launcher is killed.
    """

    def __init__(
        self,
        plan: ProcessPlan,
        name: str,
        log: LaunchLog,
        emit: Callable[[events.Event], None],
        wants_output: Callable[[events.Event], bool],
        guardian: Guardian,
    ) -> None:
        self.plan = plan
        self.name = name
        self._log = log
        self._emit = emit
        self._wants_output = wants_output
        self._guardian = guardian
        self._transport: asyncio.SubprocessTransport | None = None
        self._lines = {1: _LineSplitter(), 2: _LineSplitter()}
        self._open_streams = {1, 2}
        self._streams_closed = asyncio.Event()
        self._ended = asyncio.Event()
        self._is_stopping = False
        self._is_hurried = False
        self._change = asyncio.Event()

    async def run(self) -> int:
        """Start the process, wait for it to end, and return its exit status.

        Raises:
            LinkwrightError: LAUNCH142, the process cannot be started.
        """
        plan = self.plan
        if plan.log_command:
            self._log.write_info(self.name, f"process details: cmd='{' '.join(plan.command)}', cwd='{plan.folder}'")
        try:
            await self._start()
        except (OSError, ValueError) as error:
            self.handle_end()
            raise self._create_start_error(error) from error
        transport = self._transport
        assert transport is not None
        try:
            await self._ended.wait()
            with contextlib.suppress(asyncio.TimeoutError):
                await asyncio.wait_for(self._streams_closed.wait(), _OUTPUT_DRAIN_S)
        finally:
            # Even after an exception, no member of the process group may outlive the launcher.
            if not self._ended.is_set():
                self.signal_group(_KILL_SIGNAL)
            transport.close()
        returncode = transport.get_returncode()
        assert returncode is not None
        if not self.is_group_alive():
            self._guardian.release(transport.get_pid())
        self._flush()
        self._report_end(transport.get_pid(), returncode)
        self._emit(events.ProcessExited(action=plan.action, returncode=returncode, **self._collect_details(transport)))
        return returncode

    async def stop(self) -> None:
        """End the process with SIGINT, then with SIGTERM, and then with SIGKILL.

        The plan contains the delays between the signals.
        """
        if self._is_stopping or self._ended.is_set():
            return
        self._is_stopping = True
        self._log.write_info(self.name, f"sending signal 'SIGINT' to process[{self.name}]")
        self.signal_group(signal.SIGINT)
        for seconds, sent_signal, next_signal in (
            (self.plan.seconds_to_sigterm, "SIGINT", "SIGTERM"),
            (self.plan.seconds_to_sigkill, "SIGTERM", "SIGKILL"),
        ):
            start = time.monotonic()
            if await self._ends_within(seconds, _ESCALATION_S[next_signal]):
                return
            waited_seconds = round(time.monotonic() - start, 1) if self._is_hurried else seconds
            self._log.write_error(
                self.name,
                f"process[{self.name}] failed to terminate '{waited_seconds:g}' seconds after receiving "
                f"'{sent_signal}', "
                f"escalating to '{next_signal}'",
            )
            self.signal_group(_KILL_SIGNAL if next_signal == "SIGKILL" else signal.SIGTERM)

    def escalate(self) -> None:
        """Shorten the delays before the next signals, because the user repeated the interrupt."""
        self._is_hurried = True
        self._change.set()

    async def _ends_within(self, seconds: float, hurried_seconds: float) -> bool:
        with contextlib.suppress(asyncio.TimeoutError):
            await asyncio.wait_for(self._change.wait(), seconds)
        if self._is_hurried and not self._ended.is_set():
            with contextlib.suppress(asyncio.TimeoutError):
                await asyncio.wait_for(self._ended.wait(), min(seconds, hurried_seconds))
        return self._ended.is_set()

    def signal(self, signal_number: signal.Signals) -> None:
        """Send a signal that the launch file requested, and log it."""
        self._log.write_info(self.name, f"sending signal '{signal_number.name}' to process[{self.name}]")
        self.signal_group(signal_number)

    def is_group_alive(self) -> bool:
        """Return whether the process or any of its children is still running."""
        if self._transport is None or not _HAS_PROCESS_GROUPS:
            return False
        try:
            os.killpg(self._transport.get_pid(), 0)
        except (ProcessLookupError, PermissionError):
            return False
        return True

    def signal_group(self, signal_number: int) -> None:
        """Send a signal to the process and its children."""
        transport = self._transport
        if transport is None:
            return
        with contextlib.suppress(ProcessLookupError, PermissionError):
            if _HAS_PROCESS_GROUPS:
                os.killpg(transport.get_pid(), signal_number)
            elif transport.get_returncode() is None:
                transport.terminate()

    # --- start ------------------------------------------------------------------------------------------

    async def _start(self) -> None:
        plan = self.plan
        loop = asyncio.get_running_loop()
        environment = self._guardian.start_and_mark(process_environment(plan.environment))
        options: dict[str, Any] = {"cwd": plan.folder, "env": environment, "start_new_session": True}
        terminals = _open_pseudo_terminals() if plan.emulate_tty else []
        if terminals:
            options["stdout"], options["stderr"] = (slave_fd for _, slave_fd in terminals)
        try:
            if plan.shell:
                start_coroutine = loop.subprocess_shell(
                    lambda: _ProcessProtocol(self), " ".join(plan.command), **options
                )
            else:
                start_coroutine = loop.subprocess_exec(lambda: _ProcessProtocol(self), *plan.command, **options)
            await start_coroutine
        except BaseException:
            for master_fd, _ in terminals:
                os.close(master_fd)
            raise
        finally:
            for _, slave_fd in terminals:
                os.close(slave_fd)
        for stream_number, (master_fd, _) in enumerate(terminals, 1):
            pipe = os.fdopen(master_fd, "rb", 0)
            await loop.connect_read_pipe(partial(_TerminalProtocol, self, stream_number), pipe)

    def handle_start(self, transport: asyncio.SubprocessTransport) -> None:
        """Record that the process is running, and emit `ProcessStarted`.

        asyncio calls this method before any output arrives.
        """
        self._transport = transport
        self._guardian.watch(transport.get_pid())
        details = self._collect_details(transport)
        self.plan.action.process_details = details
        self._log.write_info(self.name, f"process started with pid [{transport.get_pid()}]")
        self._emit(events.ProcessStarted(action=self.plan.action, **details))
        if self._is_stopping:  # `stop` was called while the process was being created
            self.signal_group(signal.SIGINT)

    def _collect_details(self, transport: asyncio.SubprocessTransport) -> dict[str, Any]:
        return {
            "name": self.name,
            "cmd": list(self.plan.command),
            "cwd": self.plan.folder,
            "env": dict(self.plan.environment),
            "pid": transport.get_pid(),
        }

    def _create_start_error(self, error: Exception) -> LinkwrightError:
        from linkwright.launch.errors.locations import error_at

        program = self.plan.command[0]
        hint = None
        if isinstance(error, FileNotFoundError) and self.plan.folder and not os.path.isdir(self.plan.folder):  # noqa: PTH112
            message = phrase(
                "process '{name}' cannot be started: folder '{folder}' does not exist",
                name=self.name,
                folder=self.plan.folder,
            )
        elif isinstance(error, FileNotFoundError):
            message = phrase(
                "process '{name}' cannot be started: program '{program}' does not exist",
                name=self.name,
                program=program,
            )
            if " " in program:
                hint = phrase("pass the program and its arguments as separate items of cmd, or set shell=True")
            elif program in _TERMINALS:
                hint = phrase(
                    "install '{program}', which opens a window for the process, or run the process in its own "
                    "terminal with 'linkwright run'",
                    program=program,
                )
        else:
            reason = error.strerror if isinstance(error, OSError) else str(error)
            message = phrase(
                "process '{name}' cannot be started from program '{program}': {reason}",
                name=self.name,
                reason=foreign(reason),
                program=program,
            )
        return error_at(self.plan.action.source_location, "LAUNCH142", message, hint)

    # --- output ---------------------------------------------------------------------------------------------

    def handle_output(self, stream_number: int, chunk: bytes) -> None:
        """Log output that the process wrote to stdout (1) or stderr (2), and emit it as an event."""
        action = self.plan.action
        action.record_output(stream_number, chunk)
        event_class = events.ProcessStdout if stream_number == 1 else events.ProcessStderr
        assert self._transport is not None
        event = event_class(text=chunk, action=action, **self._collect_details(self._transport))
        if self._wants_output(event):
            self._emit(event)
        for line in self._lines[stream_number].feed(chunk):
            self._log_line(stream_number, line)

    def handle_stream_end(self, stream_number: int) -> None:
        """Record that stdout (1) or stderr (2) is closed."""
        self._open_streams.discard(stream_number)
        if not self._open_streams:
            self._streams_closed.set()

    def handle_end(self) -> None:
        """Record that the process has ended."""
        self._ended.set()
        self._change.set()

    def _flush(self) -> None:
        for stream_number, splitter in self._lines.items():
            for line in splitter.finish():
                self._log_line(stream_number, line)

    def _log_line(self, stream_number: int, line: str) -> None:
        formatted_line = self.plan.output_format.format(line=line, this=self.plan.action)
        self._log.write_process_line(self.name, stream_number, formatted_line, self.plan.destinations[stream_number])

    def _report_end(self, pid: int, returncode: int) -> None:
        is_requested_end = (
            returncode in (-signal.SIGINT, 128 + signal.SIGINT) or not _HAS_PROCESS_GROUPS
        )  # ended by terminate()
        if returncode == 0 or (self._is_stopping and is_requested_end):
            self._log.write_info(self.name, f"process has finished cleanly [pid {pid}]")
            return
        command = " ".join(self.plan.command)
        self._log.write_error(self.name, f"process has died [pid {pid}, exit code {returncode}, cmd '{command}'].")


class _LineSplitter:
    """A splitter of a process's output into lines of text.

    An incomplete line that exceeds the maximum length is returned in chunks.
    """

    def __init__(self) -> None:
        self._decode = codecs.getincrementaldecoder("utf-8")("replace").decode
        self._chunks: list[str] = []
        self._length = 0

    def feed(self, chunk: bytes) -> list[str]:
        """Add a chunk of bytes, and return the lines that it completes, without line ends."""
        first_text, *other_lines = self._decode(chunk).split("\n")
        self._chunks.append(first_text)
        self._length += len(first_text)
        if not other_lines and self._length < _MAX_LINE_LENGTH:
            return []
        complete_lines = ["".join(self._chunks), *other_lines]
        remaining_text = complete_lines.pop() if other_lines else ""
        self._chunks, self._length = [remaining_text], len(remaining_text)
        return [line.rstrip("\r") for line in complete_lines]

    def finish(self) -> list[str]:
        """Return a list with the unterminated last line, or an empty list if there is none."""
        remaining_text = "".join(self._chunks) + self._decode(b"", final=True)
        return [remaining_text.rstrip("\r")] if remaining_text else []


class _ProcessProtocol(asyncio.SubprocessProtocol):
    """The asyncio protocol of a process, which forwards the callbacks to its `RunningProcess`."""

    def __init__(self, process: RunningProcess) -> None:
        self._process = process

    def connection_made(self, transport: asyncio.BaseTransport) -> None:
        assert isinstance(transport, asyncio.SubprocessTransport)
        self._process.handle_start(transport)

    def pipe_data_received(self, fd: int, data: bytes) -> None:
        self._process.handle_output(fd, data)

    def pipe_connection_lost(self, fd: int, exc: Exception | None) -> None:
        self._process.handle_stream_end(fd)

    def process_exited(self) -> None:
        self._process.handle_end()


class _TerminalProtocol(asyncio.Protocol):
    """The asyncio protocol of a pseudo-terminal, which forwards the output of a process."""

    def __init__(self, process: RunningProcess, stream_number: int) -> None:
        self._process = process
        self._stream_number = stream_number

    def data_received(self, data: bytes) -> None:
        self._process.handle_output(self._stream_number, data)

    def connection_lost(self, exc: Exception | None) -> None:
        self._process.handle_stream_end(self._stream_number)


def _open_pseudo_terminals() -> list[tuple[int, int]]:
    """Open pseudo-terminals for stdout and stderr, if the system supports them.

    Returns:
        The master and slave file descriptors of each pseudo-terminal; an empty list without such support.
    """
    return [os.openpty(), os.openpty()] if hasattr(os, "openpty") else []
