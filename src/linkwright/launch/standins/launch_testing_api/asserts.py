"""Assertions about the output and exit codes of processes (``launch_testing.asserts``)."""

from __future__ import annotations

import os
from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager
from typing import Any

from linkwright.launch.model.actions.execute import ExecuteLocal
from linkwright.launch.standins.launch_testing_api.processes import ProcessRecords, get_name, resolveProcesses
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
_CONTEXT_LINES = 3
_DEFAULT_EXIT_CODES = (EXIT_OK,) if os.name != "nt" else (EXIT_OK, EXIT_FORCED)


def assertExitCodes(
    proc_info: ProcessRecords,
    allowable_exit_codes: Sequence[int] = _DEFAULT_EXIT_CODES,
    process: ExecuteLocal | str | None = None,
    cmd_args: str | Sequence[str] | None = None,
    *,
    strict_proc_matching: bool = True,
) -> None:
    """Raise AssertionError unless all matching processes exited with an allowed code.

    Args:
        proc_info: the records of exits.
        allowable_exit_codes: the allowed exit codes.
        process: the action or a part of the name of the process; None for all processes.
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
        process: the action or a part of the name of the process; None for any process.
        cmd_args: arguments of the process, see `resolveProcesses`.
        output_filter: a function that filters the output before the search.
        strict_proc_matching: whether a name must match only one process.
        strip_ansi_escape_sequences: whether to remove ANSI escape sequences before the search.
        stream: ``stdout`` or ``stderr``.

    Raises:
        ValueError: `output_filter` cannot be called, or there is no such stream.
        NoMatchingProcessException: no matching process wrote output.
    """
    matching_actions = resolveProcesses(
        proc_output, process=process, cmd_args=cmd_args, strict_proc_matching=strict_proc_matching
    )
    if output_filter is not None and not callable(output_filter):
        raise ValueError("output_filter is not callable")
    if stream not in _STREAMS:
        raise ValueError("Invalid value for stream; must be 'stdout' or 'stderr'")
    match = build_text_match(expected_output)
    for execute_local in matching_actions:
        output = join_output(proc_output[execute_local], stream)
        if strip_ansi_escape_sequences:
            output = remove_ansi_escape_sequences(output)
        if match(output if output_filter is None else output_filter(output)) is not None:
            return
    names = ", ".join(sorted(map(get_name, matching_actions)))
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


def join_output(output_events: Sequence[Any], stream: str | None = None) -> str:
    """Return the recorded output of a process as one text.

    Args:
        output_events: the output events of the process.
        stream: ``stdout`` or ``stderr``; None for both.
    """
    stream_events = (event for event in output_events if stream is None or getattr(event, f"from_{stream}"))
    return b"".join(event.text for event in stream_events).decode(errors="replace")


@contextmanager
def assertSequentialStdout(
    proc_output: ProcessRecords, process: ExecuteLocal | str, cmd_args: str | Sequence[str] | None = None
) -> Iterator[SequentialTextChecker]:
    """Yield a checker that finds texts in the output of a process, in order.

    Args:
        proc_output: the output of the processes.
        process: the action or a part of the name of the process.
        cmd_args: arguments of the process, see `resolveProcesses`.
    """
    (action,) = resolveProcesses(proc_output, process=process, cmd_args=cmd_args)
    yield SequentialTextChecker([join_output([event]) for event in proc_output[action]])


class SequentialTextChecker:
    """A search for texts in the output of a process, each after the previous match.

    Args:
        output: the output in chunks; each text must be within a single chunk.
    """

    def __init__(self, output: Sequence[str]) -> None:
        self._output = list(output)
        self._chunk_index = 0
        self._offset = 0

    def assertInText(self, msg: str) -> None:
        """Raise AssertionError unless the output after the previous match contains a text."""
        offset = self._offset
        for chunk_index in range(self._chunk_index, len(self._output)):
            position = self._output[chunk_index].find(msg, offset)
            if position >= 0:
                self._chunk_index, self._offset = chunk_index, position + len(msg)
                return
            offset = 0
        raise AssertionError(
            f"'{msg}' not found in sequence after previous match.  "
            f"The output near the last matched line:\n{self.get_nearby_lines()}"
        )

    assertInStdout = assertInText

    def get_nearby_lines(self) -> str:
        """Return the previous match with the lines around it."""
        text = "".join(self._output)
        position = sum(map(len, self._output[: self._chunk_index])) + self._offset
        start = position
        for _ in range(_CONTEXT_LINES):
            start = max(text.rfind("\n", 0, start), 0)
        end = position
        for _ in range(_CONTEXT_LINES):
            end = max(text.find("\n", end + 1), end)
        return text[start + 1 if start else 0 : end]


def _check(condition: bool, message: str) -> None:
    if not condition:
        raise AssertionError(message)
