"""What the launcher prints: its own lines, those of processes and nodes, and diagnostics."""

from __future__ import annotations

import os
import socket
import sys
import time
from collections.abc import Iterable, Mapping
from contextlib import suppress
from pathlib import Path
from typing import IO, TYPE_CHECKING

from linkwright.diagnostics import Diagnostic, Severity, print_diagnostics, wants_colour

if TYPE_CHECKING:
    from linkwright.graph import LogRecord

SCREEN = "screen"
LOG = "log"
OWN_LOG = "own_log"

_LEVEL_COLOURS = {"WARNING": "33", "ERROR": "31"}

_OUTPUT_MODES: Mapping[str, tuple[frozenset[str], frozenset[str]]] = {
    "screen": (frozenset({SCREEN}), frozenset({SCREEN})),
    "log": (frozenset({LOG}), frozenset({LOG, SCREEN})),
    "both": (frozenset({SCREEN, LOG}), frozenset({SCREEN, LOG})),
    "own_log": (frozenset({OWN_LOG}), frozenset({OWN_LOG})),
    "full": (frozenset({SCREEN, LOG, OWN_LOG}), frozenset({SCREEN, LOG, OWN_LOG})),
}

OUTPUT_MODES = tuple(_OUTPUT_MODES)


def output_destinations(mode: str | Mapping[str, Iterable[str] | str]) -> dict[int, frozenset[str]]:
    """Where stdout (1) and stderr (2) of a process go, by the ``output`` of its action.

    Raises:
        KeyError: with the mode, stream or destination that does not exist.
    """
    if isinstance(mode, str):
        stdout, stderr = _OUTPUT_MODES[mode]
        return {1: stdout, 2: stderr}
    chosen: dict[int, frozenset[str]] = {1: frozenset(), 2: frozenset()}
    for stream, destinations in mode.items():
        names = frozenset([destinations] if isinstance(destinations, str) else destinations)
        unknown = names - {SCREEN, LOG, OWN_LOG}
        if unknown:
            raise KeyError(min(unknown))
        for number in {"stdout": (1,), "stderr": (2,), "both": (1, 2)}[stream]:
            chosen[number] |= names
    return chosen


class LaunchLog:
    """The log of one launch.

    Launcher and node lines go to stderr, what processes write to the stream they write it to. Files are only
    made when a process's output is to go to one; they lie where ROS puts them: in ``ROS_LOG_DIR``, else
    ``ROS_HOME/log``, else ``~/.ros/log``.

    Args:
        stdout: where the output of processes goes.
        stderr: where all else goes.
    """

    def __init__(self, stdout: IO[str] | None = None, stderr: IO[str] | None = None) -> None:
        self._streams = {1: stdout or sys.stdout, 2: stderr or sys.stderr}
        self._colour = wants_colour(self._streams[2])
        self._files: dict[str, IO[str] | None] = {}
        self._folder: Path | None = None

    @property
    def folder(self) -> Path:
        """The folder for the log files of this launch; it exists once a file is written."""
        if self._folder is None:
            base = os.environ.get("ROS_LOG_DIR")
            home = os.environ.get("ROS_HOME") or Path.home() / ".ros"
            stamp = time.strftime("%Y-%m-%d-%H-%M-%S")
            self._folder = Path(base or Path(home, "log")) / f"{stamp}-{socket.gethostname()}-{os.getpid()}"
        return self._folder

    def say(self, name: str, text: str) -> None:
        """A line that says what goes on."""
        self._own_line("INFO", name, text)

    def caution(self, name: str, text: str) -> None:
        """A line that says what may be wrong."""
        self._own_line("WARNING", name, text)

    def complain(self, name: str, text: str) -> None:
        """A line that says what is wrong."""
        self._own_line("ERROR", name, text)

    def announce(self, line: str) -> None:
        """A line for programs that read our stdout; written at once."""
        self._print(1, line)

    def diagnostics(self, diagnostics: Iterable[Diagnostic]) -> None:
        """Findings about the user's files."""
        with suppress(BrokenPipeError):
            print_diagnostics(diagnostics, self._streams[2])

    def node_record(self, process: str, record: LogRecord) -> None:
        """What a node of this process logs, in rcutils' format behind the name of its process."""
        from linkwright.graph import console_line

        line = f"[{process}] {console_line(record)}"
        colour = {"WARN": "33", "ERROR": "31", "FATAL": "31"}.get(record.level.name)
        self._print(2, self._painted(line, colour))

    def process_line(self, process: str, stream: int, line: str, destinations: frozenset[str]) -> None:
        """A line that a process wrote.

        Args:
            process: its name, such as ``talker-1``.
            stream: 1 for stdout, 2 for stderr.
            line: the line as it is to be shown.
            destinations: of `SCREEN`, `LOG` and `OWN_LOG`.
        """
        if SCREEN in destinations:
            self._print(stream, line)
        if LOG in destinations:
            self._write("launch.log", line)
        if OWN_LOG in destinations:
            self._write(f"{process}-{'stdout' if stream == 1 else 'stderr'}.log", line)

    def close(self) -> None:
        """Close the files."""
        for file in self._files.values():
            if file is not None:
                file.close()
        self._files.clear()

    def _own_line(self, level: str, name: str, text: str) -> None:
        line = f"[{level}] [{name}]: {text}"
        self._print(2, self._painted(line, _LEVEL_COLOURS.get(level)))

    def _print(self, stream: int, line: str) -> None:
        with suppress(BrokenPipeError):  # the reader, such as head, has gone; the launch goes on
            print(line, file=self._streams[stream], flush=True)

    def _painted(self, line: str, colour: str | None) -> str:
        return f"\x1b[{colour}m{line}\x1b[0m" if colour and self._colour else line

    def _write(self, name: str, line: str) -> None:
        if name not in self._files:
            self._files[name] = self._open(name)
        file = self._files[name]
        if file is not None:
            print(line, file=file, flush=True)

    def _open(self, name: str) -> IO[str] | None:
        first = not self._files
        path = self.folder / name
        try:
            path.parent.mkdir(parents=True, exist_ok=True)
            file = path.open("a", encoding="utf-8")
        except OSError as error:
            problem = f"log file '{path}' cannot be written: {error.strerror}"
            self.diagnostics([Diagnostic("LAUNCH145", problem, severity=Severity.WARNING)])
            return None
        if first:
            self.say("launch", f"Output that does not go to the screen can be found below {self.folder}")
        return file
