"""Assertions about the output and exit codes of processes (``launch_testing.asserts``)."""

from __future__ import annotations

import os
from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager
from typing import Any

from linkwright.launch.model.actions.execute import ExecuteLocal
from linkwright.launch.standins.launch_testing_api.processes import ProcessRecords, name_of, resolveProcesses
from linkwright.launch.standins.launch_testing_api.text import build_text_match
from linkwright.standins.terminal_color import remove_ansi_escape_sequences

EXIT_OK = 0
EXIT_SIGINT = 130
EXIT_SIGQUIT = 131
EXIT_SIGKILL = 137
EXIT_SIGSEGV = 139
EXIT_FORCED = 1
"""The exit code of a process that a launch on Windows ended."""

_STREAMS = ("stdout", "stderr")
_LINES_AROUND = 3
_FINE = (EXIT_OK,) if os.name != "nt" else (EXIT_OK, EXIT_FORCED)


def assertExitCodes(
    proc_info: ProcessRecords,
    allowable_exit_codes: Sequence[int] = _FINE,
    process: ExecuteLocal | str | None = None,
    cmd_args: str | Sequence[str] | None = None,
    *,
    strict_proc_matching: bool = True,
) -> None:
    """Raise AssertionError unless all matching processes ended with an allowed exit code.

    Args:
        proc_info: the records of exits.
        allowable_exit_codes: the allowed exit codes.
        process: an action, or a part of the name of a process; None for all processes.
        cmd_args: arguments of the process, see `resolveProcesses`.
        strict_proc_matching: whether a name must match only one process.
    """
    for code in allowable_exit_codes:
        _check(isinstance(code, int), f"Provided exit code {code} is not an int")
    for execute_local in resolveProcesses(
        proc_info, process=process, cmd_args=cmd_args, strict_proc_matching=strict_proc_matching
    ):
        info = proc_info[execute_local]
        _check(info.returncode in allowable_exit_codes, f"Proc {info.process_name} exited with code {info.returncode}")


def assertInStream(
    proc_output: ProcessRecords,
    expected_output: Any,
    process: ExecuteLocal | str | None,
    cmd_args: str | Sequence[str] | None = None,
    *,
    output_filter: Callable[[str], str] | None = None,
    strict_proc_matching: bool = True,
    strip_ansi_escape_sequences: bool = True,
    stream: str = "stderr",
) -> None:
    """Raise AssertionError unless the output of a matching process contains a text.

    Args:
        proc_output: the output of the processes.
        expected_output: a text, a regular expression, or several of them in order.
        process: an action, or a part of the name of a process; None for any process.
        cmd_args: arguments of the process, see `resolveProcesses`.
        output_filter: a function that filters the output before the search.
        strict_proc_matching: whether a name must match only one process.
        strip_ansi_escape_sequences: whether to remove ANSI escape sequences before the search.
        stream: ``stdout`` or ``stderr``.

    Raises:
        ValueError: `output_filter` cannot be called, or there is no such stream.
        NoMatchingProcessException: no such process wrote any output.
    """
    found = resolveProcesses(proc_output, process=process, cmd_args=cmd_args, strict_proc_matching=strict_proc_matching)
    if output_filter is not None and not callable(output_filter):
        raise ValueError("output_filter is not callable")
    if stream not in _STREAMS:
        raise ValueError("Invalid value for stream; must be 'stdout' or 'stderr'")
    match = build_text_match(expected_output)
    for execute_local in found:
        written = text_of(proc_output[execute_local], stream)
        if strip_ansi_escape_sequences:
            written = remove_ansi_escape_sequences(written)
        if match(written if output_filter is None else output_filter(written)) is not None:
            return
    names = ", ".join(sorted(map(name_of, found)))
    raise AssertionError(f"Did not find '{expected_output}' in output for any of the matching processes: {names}")


def assertInStdout(
    proc_output: ProcessRecords,
    expected_output: Any,
    process: ExecuteLocal | str | None,
    cmd_args: str | Sequence[str] | None = None,
    **kwargs: Any,
) -> None:
    """Raise AssertionError unless the standard output of a matching process contains a text.

    See `assertInStream`.
    """
    assertInStream(proc_output, expected_output, process, cmd_args, stream="stdout", **kwargs)


def assertInStderr(
    proc_output: ProcessRecords,
    expected_output: Any,
    process: ExecuteLocal | str | None,
    cmd_args: str | Sequence[str] | None = None,
    **kwargs: Any,
) -> None:
    """Raise AssertionError unless the standard error of a matching process contains a text.

    See `assertInStream`.
    """
    assertInStream(proc_output, expected_output, process, cmd_args, stream="stderr", **kwargs)


def assertDefaultStream() -> str:
    """Return the name of the stream that `assertInStream` searches by default."""
    return "stderr"


def text_of(written: Sequence[Any], stream: str | None = None) -> str:
    """Return the recorded output of a process as one text.

    Args:
        written: the output events of the process.
        stream: ``stdout`` or ``stderr``; None for both.
    """
    kept = (event for event in written if stream is None or getattr(event, f"from_{stream}"))
    return b"".join(event.text for event in kept).decode(errors="replace")


@contextmanager
def assertSequentialStdout(
    proc_output: ProcessRecords, process: ExecuteLocal | str, cmd_args: str | Sequence[str] | None = None
) -> Iterator[SequentialTextChecker]:
    """Yield a checker that finds texts in the output of a process in order.

    Args:
        proc_output: the output of the processes.
        process: an action, or a part of the name of a process.
        cmd_args: arguments of the process, see `resolveProcesses`.
    """
    (found,) = resolveProcesses(proc_output, process=process, cmd_args=cmd_args)
    yield SequentialTextChecker([text_of([event]) for event in proc_output[found]])


class SequentialTextChecker:
    """Finds texts in the output of a process, each after the last match.

    Args:
        output: the output in chunks; each text must be within a single chunk.
    """

    def __init__(self, output: Sequence[str]) -> None:
        self._output = list(output)
        self._piece = 0
        self._offset = 0

    def assertInText(self, msg: str) -> None:
        """Raise AssertionError unless the output after the last match contains a text."""
        offset = self._offset
        for piece in range(self._piece, len(self._output)):
            at = self._output[piece].find(msg, offset)
            if at >= 0:
                self._piece, self._offset = piece, at + len(msg)
                return
            offset = 0
        raise AssertionError(
            f"'{msg}' not found in sequence after previous match.  "
            f"The output near the last matched line:\n{self.get_nearby_lines()}"
        )

    assertInStdout = assertInText

    def get_nearby_lines(self) -> str:
        """Return the lines around the last match."""
        text = "".join(self._output)
        at = sum(map(len, self._output[: self._piece])) + self._offset
        begin = at
        for _ in range(_LINES_AROUND):
            begin = max(text.rfind("\n", 0, begin), 0)
        end = at
        for _ in range(_LINES_AROUND):
            end = max(text.find("\n", end + 1), end)
        return text[begin + 1 if begin else 0 : end]


def _check(holds: bool, message: str) -> None:
    if not holds:
        raise AssertionError(message)
