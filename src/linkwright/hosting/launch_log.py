"""The log of a launch, and the folder of log files.

The log contains the lines of the launcher, of processes and of nodes, and findings.
"""

from __future__ import annotations

import os
import socket
import sys
import time
from collections.abc import Callable, Iterable, Mapping
from contextlib import suppress
from pathlib import Path
from typing import IO, TYPE_CHECKING

from linkwright.diagnostics import Diagnostic, Severity, foreign, phrase, print_diagnostics, wants_color
from linkwright.process.nanoseconds import NANOSECONDS_PER_SECOND

if TYPE_CHECKING:
    from linkwright.graph import LogRecord


SCREEN = "screen"
LOG = "log"
OWN_LOG = "own_log"
SHARED_OWN_LOG = "own_log of both"
"""The destination for a log file with both streams of a process, in addition to a log file for each stream."""

LAUNCH_LOG = "launch.log"

_LEVEL_COLORS = {"DEBUG": "32", "WARNING": "33", "ERROR": "31"}
_OWN_FILES = frozenset({OWN_LOG, SHARED_OWN_LOG})

_OUTPUT_MODES: Mapping[str, tuple[frozenset[str], frozenset[str]]] = {
    "screen": (frozenset({SCREEN}), frozenset({SCREEN})),
    "log": (frozenset({LOG}), frozenset({LOG, SCREEN})),
    "both": (frozenset({SCREEN, LOG}), frozenset({SCREEN, LOG})),
    "own_log": (_OWN_FILES, _OWN_FILES),
    "full": (_OWN_FILES | {SCREEN, LOG}, _OWN_FILES | {SCREEN, LOG}),
}

OUTPUT_MODES = tuple(_OUTPUT_MODES)


def output_destinations(mode: str | Mapping[str, Iterable[str] | str]) -> dict[int, frozenset[str]]:
    """Return the destinations of a process's stdout (1) and stderr (2) for an ``output`` mode.

    Raises:
        KeyError: the mode, a stream or a destination does not exist.
    """
    if isinstance(mode, str):
        stdout, stderr = _OUTPUT_MODES[mode]
        return {1: stdout, 2: stderr}
    destinations_by_stream: dict[int, frozenset[str]] = {1: frozenset(), 2: frozenset()}
    for stream, destinations in mode.items():
        names = frozenset([destinations] if isinstance(destinations, str) else destinations)
        unknown_names = names - {SCREEN, LOG, OWN_LOG}
        if unknown_names:
            raise KeyError(min(unknown_names))
        if stream == "both" and OWN_LOG in names:
            names = names - {OWN_LOG} | {SHARED_OWN_LOG}
        for stream_number in {"stdout": (1,), "stderr": (2,), "both": (1, 2)}[stream]:
            destinations_by_stream[stream_number] |= names
    return destinations_by_stream


class LaunchLog:
    """The log of one launch.

    On the screen, lines of the launcher and of nodes go to stderr. The output of a process goes to the stream that the
    process uses. In the log folder of the launch, ``launch.log`` contains all lines of the launcher, and all output
    with the destination `LOG`. Processes with their own log have a file next to it. As in ROS, the environment
    variables ``OVERRIDE_LAUNCH_SCREEN_FORMAT`` and ``OVERRIDE_LAUNCH_LOG_FORMAT`` change the format of lines.

    Args:
        stdout: the stream for the output of processes.
        stderr: the stream for all other lines.
        debug: whether to log debug lines.
    """

    def __init__(self, stdout: IO[str] | None = None, stderr: IO[str] | None = None, *, debug: bool = False) -> None:
        self._streams = {1: stdout or sys.stdout, 2: stderr or sys.stderr}
        self._uses_color = wants_color(self._streams[2])
        self._debug = debug
        self._files: dict[str, IO[str] | None] = {}
        self._folder: Path | None = None
        self._has_folder = True
        self._closed = False
        self._format_screen_line = create_line_formatter(os.environ.get("OVERRIDE_LAUNCH_SCREEN_FORMAT"), FORMATS)
        self._format_file_line = create_line_formatter(os.environ.get("OVERRIDE_LAUNCH_LOG_FORMAT"), FILE_FORMATS)

    @property
    def folder(self) -> Path:
        """The folder for the log files of this launch.

        The folder is created on first access. If that fails, this is the folder of all logs.
        """
        if self._folder is None:
            base_folder = find_log_base()
            try:
                self._folder = create_log_folder(base_folder)
            except OSError as error:
                self._folder = base_folder
                self._files[LAUNCH_LOG] = None
                self._has_folder = False
                self._report_unwritable(base_folder, error)
        return self._folder

    def begin(self) -> None:
        """Log the first lines, which name the folder of the log files and the log level."""
        folder = self.folder
        if self._has_folder:
            self.write_info("launch", f"All log files can be found below {folder}")
        self.write_info("launch", f"Default logging verbosity is set to {'DEBUG' if self._debug else 'INFO'}")

    def write_debug(self, name: str, text: str) -> None:
        """Log a line for debugging a launch file, if debug lines are enabled."""
        if self._debug:
            self._write_own_line("DEBUG", name, text)

    def write_info(self, name: str, text: str) -> None:
        """Log a line of information."""
        self._write_own_line("INFO", name, text)

    def write_warning(self, name: str, text: str) -> None:
        """Log a warning."""
        self._write_own_line("WARNING", name, text)

    def write_error(self, name: str, text: str) -> None:
        """Log an error."""
        self._write_own_line("ERROR", name, text)

    def announce(self, line: str) -> None:
        """Print a line to stdout and flush the stream, for programs that read the output."""
        self._print(1, line)

    def write_diagnostics(self, diagnostics: Iterable[Diagnostic]) -> None:
        """Log findings about the user's files."""
        with suppress(OSError):
            print_diagnostics(diagnostics, self._streams[2])

    def write_node_record(self, process: str, record: LogRecord, destinations: frozenset[str]) -> None:
        """Log a record of a node in this process.

        The line consists of the process name and the record in rcutils' format.
        """
        from linkwright.graph import format_console_line

        line = f"[{process}] {format_console_line(record)}"
        if SCREEN in destinations:
            color = {"WARN": "33", "ERROR": "31", "FATAL": "31"}.get(record.level.name)
            self._print(2, self._colorize(line, color))
        self._write_to_files(process, 2, line, destinations)

    def write_process_line(self, process: str, stream: int, line: str, destinations: frozenset[str]) -> None:
        """Log a line that a process wrote.

        Args:
            process: the name of the process, such as ``talker-1``.
            stream: 1 for stdout, 2 for stderr.
            line: the line as it is displayed.
            destinations: the subset of the launch log's destinations to which the line is written.
        """
        if SCREEN in destinations:
            self._print(stream, line)
        self._write_to_files(process, stream, line, destinations)

    def close(self) -> None:
        """Close the log files."""
        self._closed = True
        for file in self._files.values():
            if file is not None:
                file.close()
        self._files.clear()

    def _write_own_line(self, level: str, name: str, text: str) -> None:
        self._print(2, self._colorize(self._format_screen_line(level, name, text), _LEVEL_COLORS.get(level)))
        self._write(LAUNCH_LOG, self._format_file_line(level, name, text))

    def _write_to_files(self, process: str, stream: int, line: str, destinations: frozenset[str]) -> None:
        if LOG in destinations:
            self._write(LAUNCH_LOG, f"{time.time():.7f} {line}")
        if OWN_LOG in destinations:
            self._write(f"{process}-{'stdout' if stream == 1 else 'stderr'}.log", line)
        if SHARED_OWN_LOG in destinations:
            self._write(f"{process}.log", line)

    def _print(self, stream: int, line: str) -> None:
        with suppress(OSError):  # the reader (such as head) may have exited, or the disk be full
            print(line, file=self._streams[stream], flush=True)

    def _colorize(self, line: str, color: str | None) -> str:
        return f"\x1b[{color}m{line}\x1b[0m" if color and self._uses_color else line

    def _write(self, name: str, line: str) -> None:
        if self._closed:
            return
        if name not in self._files:
            folder = self.folder  # This may log a line, and logging may also fail.
            if name not in self._files:
                self._files[name] = self._open(folder / name)
        file = self._files[name]
        if file is not None:
            try:
                print(line, file=file, flush=True)
            except OSError as error:  # A full disk must not end the launch.
                self._files[name] = None
                self._report_unwritable(self.folder / name, error)

    def _open(self, path: Path) -> IO[str] | None:
        try:
            return path.open("a", encoding="utf-8")
        except OSError as error:
            self._report_unwritable(path, error)
            return None

    def _report_unwritable(self, path: Path, error: OSError) -> None:
        message = phrase("log file '{path}' cannot be written: {strerror}", path=path, strerror=foreign(error.strerror))
        self.write_diagnostics([Diagnostic("LAUNCH145", message, severity=Severity.WARNING)])


FORMATS = {
    "default": "[{levelname}] [{name}]: {msg}",
    "default_with_timestamp": "{created:.7f} [{levelname}] [{name}]: {msg}",
}
FILE_FORMATS = {"default": FORMATS["default_with_timestamp"]}

Line = Callable[[str, str, str], str]
"""Returns a formatted line for a level, the name of a logger, and a text."""


def create_line_formatter(format_name: str | None, formats: dict[str, str]) -> Line:
    """Return a function that formats log lines.

    Args:
        format_name: a key of `formats`, or a format with the fields of Python's log records in braces; None for the
            default.
        formats: formats by name, including ``default``.

    Returns:
        The function, which uses the default format if the given format has unknown fields.
    """
    template = formats.get(format_name or "default", format_name or "")

    def format_line(level: str, name: str, text: str) -> str:
        created = time.time()
        fields = {
            "levelname": level,
            "name": name,
            "msg": text,
            "message": text,
            "created": created,
            "msecs": (created % 1.0) * 1000.0,
            "asctime": time.strftime("%Y-%m-%d %H:%M:%S", time.localtime(created)),
        }
        try:
            return template.format(**fields)
        except (LookupError, ValueError):
            return formats["default"].format(**fields)

    return format_line


LATEST = "latest"


def find_log_base(environment: Mapping[str, str] | None = None) -> Path:
    """Return the folder of all logs: ``ROS_LOG_DIR``, or ``ROS_HOME/log``, or ``~/.ros/log``."""
    environment = os.environ if environment is None else environment
    log_folder = environment.get("ROS_LOG_DIR")
    if log_folder:
        return Path(log_folder).expanduser()
    home = environment.get("ROS_HOME")
    return (Path(home).expanduser() if home else Path.home() / ".ros") / "log"


def create_log_folder(base: Path) -> Path:
    """Create the log folder of a launch, and return its path.

    Its name consists of the date, the computer and the process. The link ``latest`` refers to the newest folder.

    Raises:
        OSError: the folder cannot be created.
    """
    while True:
        # Folder names contain local time, as in ROS.
        seconds, nanoseconds = divmod(time.time_ns(), NANOSECONDS_PER_SECOND)
        stamp = f"{time.strftime('%Y-%m-%d-%H-%M-%S', time.localtime(seconds))}-{nanoseconds // 1000:06d}"
        folder = base / f"{stamp}-{socket.gethostname()}-{os.getpid()}"
        try:
            folder.mkdir(parents=True)
        except FileExistsError:
            continue
        _link_latest(base, folder)
        return folder


def _link_latest(base: Path, folder: Path) -> None:
    temporary_link = base / f".{LATEST}-{os.getpid()}"
    with suppress(OSError, NotImplementedError):  # Some file systems do not support links.
        temporary_link.unlink(missing_ok=True)
        temporary_link.symlink_to(folder.name)
        temporary_link.replace(base / LATEST)
